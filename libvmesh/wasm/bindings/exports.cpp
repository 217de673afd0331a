// The functions that vmesh.js calls: texts as UTF-8, options and answers as JSON. Where one fails it returns null or 0,
// and vmesh_error() tells why.
#include <new>

#include <emscripten.h>

#include "vmesh/core/error.h"
#include "vmesh/core/version.h"

#include "work.h"

namespace {

using namespace vmesh;
using namespace vmesh::wasm;

/// JavaScript's callback. It never throws: what it throws is kept there.
// clang-format off
EM_JS(int, report_to_javascript, (const char* stage, double fraction), {
  return Module.report ? Module.report(UTF8ToString(stage), fraction) : 1;
})
// clang-format on

bool report(std::string_view stage, double fraction) {
  return report_to_javascript(std::string(stage).c_str(), fraction) != 0;
}

/// What the last call returned; valid until the next one.
std::string& answer() {
  static std::string text;
  return text;
}

const char* answer(const Json& json) {
  answer() = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return answer().c_str();
}

std::string& last_error() {
  static std::string text;
  return text;
}

void fail(const char* kind, const char* message) {
  last_error() = Json{{"kind", kind}, {"message", message}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// What `work` returns, or nothing.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    fail("InvalidInput", error.what());
  } catch (const ReadError& error) {
    fail("ReadError", error.what());
  } catch (const WriteError& error) {
    fail("WriteError", error.what());
  } catch (const Unsupported& error) {
    fail("Unsupported", error.what());
  } catch (const Cancelled& error) {
    fail("Cancelled", error.what());
  } catch (const std::bad_alloc&) {
    fail("OutOfMemory", "there is not enough memory for this surface: ask for fewer vertices around");
  } catch (const std::exception& error) {
    fail("Error", error.what());
  }
  return {};
}

}  // namespace

extern "C" {

using CenterlineHandle = std::shared_ptr<const CenterlineObject>;

EMSCRIPTEN_KEEPALIVE const char* vmesh_version() { return version().data(); }

EMSCRIPTEN_KEEPALIVE const char* vmesh_error() { return last_error().c_str(); }

EMSCRIPTEN_KEEPALIVE CenterlineHandle* vmesh_read(const char* request) {
  return guarded([&] { return new CenterlineHandle(read(read_request(request))); });
}

EMSCRIPTEN_KEEPALIVE SurfaceObject* vmesh_generate(const CenterlineHandle* centerline, const char* options) {
  return guarded([&] {
    std::unique_ptr<SurfaceObject> surface = generate(*centerline, production_options(options), report);
    surface->options_text = options;
    return surface.release();
  });
}

EMSCRIPTEN_KEEPALIVE void vmesh_free_centerline(CenterlineHandle* centerline) { delete centerline; }
EMSCRIPTEN_KEEPALIVE void vmesh_free_surface(SurfaceObject* surface) { delete surface; }

EMSCRIPTEN_KEEPALIVE const char* vmesh_describe_centerline(const CenterlineHandle* centerline) {
  return guarded([&] { return answer(describe(**centerline)); });
}
EMSCRIPTEN_KEEPALIVE const char* vmesh_describe_surface(const SurfaceObject* surface) {
  return guarded([&] { return answer(describe(*surface)); });
}
EMSCRIPTEN_KEEPALIVE const char* vmesh_page(const SurfaceObject* surface) {
  return guarded([&] { return answer(page_about(*surface)); });
}

/// Four numbers for each: position and radius.
EMSCRIPTEN_KEEPALIVE const CenterlineNode* vmesh_nodes(const CenterlineHandle* centerline) {
  static_assert(sizeof(CenterlineNode) == 4 * sizeof(double));
  return (*centerline)->centerline.nodes().data();
}
EMSCRIPTEN_KEEPALIVE const CenterlineSegment* vmesh_segments(const CenterlineHandle* centerline) {
  static_assert(sizeof(CenterlineSegment) == 2 * sizeof(Index));
  return (*centerline)->centerline.segments().data();
}
EMSCRIPTEN_KEEPALIVE const Vec3* vmesh_vertices(const SurfaceObject* surface) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return surface->result().mesh.vertices.data();
}
EMSCRIPTEN_KEEPALIVE const Triangle* vmesh_faces(const SurfaceObject* surface) {
  static_assert(sizeof(Triangle) == 3 * sizeof(Index));
  return surface->result().mesh.faces.data();
}
/// By their order in the description.
EMSCRIPTEN_KEEPALIVE const double* vmesh_vertex_attribute(const SurfaceObject* surface, int i) {
  return surface->attributes.vertex[i].values.data();
}
EMSCRIPTEN_KEEPALIVE const double* vmesh_face_attribute(const SurfaceObject* surface, int i) {
  return surface->attributes.face[i].values.data();
}

/// Into a file of the module's own file system, by its extension. Returns whether it is there.
EMSCRIPTEN_KEEPALIVE int vmesh_write(const SurfaceObject* surface, const char* path, const char* options) {
  return guarded([&] {
    WriteRequest request = write_request(options);
    request.metadata.input_name = surface->centerline->title;
    request.metadata.options = surface->options_text;
    SurfaceWriteOptions writing;
    writing.encoding = request.encoding;
    write_surface(path, surface->result().mesh, surface->attributes, request.metadata, writing);
    return 1;
  });
}

/// The extensions of what is read and written.
EMSCRIPTEN_KEEPALIVE const char* vmesh_formats() {
  return guarded([] {
    return answer(Json{
        {"centerlines", extensions_of(centerline_formats(), [](const auto& f) { return f.parse || f.parse_pair; })},
        {"surfaces", extensions_of(surface_formats(), [](const auto& f) { return f.is_written(); })}});
  });
}

}  // extern "C"
