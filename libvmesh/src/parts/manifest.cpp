#include "vmesh/core/atomic_file.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/text.h"
#include "vmesh/parts/part_files.h"

#include "parts/headers.h"

namespace vmesh {

using nlohmann::json;

namespace {

constexpr const char* kSchema = "vmesh.parts/1";

}  // namespace

std::string part_name(std::size_t number) { return formatted("part_%05zu", number + 1); }

void write_manifest(const std::filesystem::path& path, const PartsManifest& m) {
  json notes = json::array();
  for (const GrowthSimplification& note : m.simplifications) notes.push_back(to_json(note));
  const json text = {{"schema", kSchema},
                     {"id", m.id},
                     {"generator", m.source.generator},
                     {"options", m.source.options},
                     {"input", m.source.input_name},
                     {"input_sha256", m.source.input_sha256},
                     {"parts", m.parts},
                     {"pieces", m.pieces},
                     {"seams", m.seams},
                     {"around", m.around},
                     {"components", m.components},
                     {"cycle_rank", m.cycle_rank},
                     {"expected_vertices", m.expected_vertices},
                     {"simplifications", notes}};
  AtomicFile file(path);
  file.write(text.dump(2) + "\n");
  file.commit();
}

PartsManifest read_manifest(const std::filesystem::path& path) {
  const json j = json::parse(read_file(path), nullptr, false);
  if (!j.is_object() || j.value("schema", std::string()) != kSchema)
    throw InvalidInput(path.string() + ": is not a list of parts; vmesh split writes it");
  try {
    PartsManifest m;
    m.id = j.at("id").get<std::string>();
    m.source = {j.at("generator").get<std::string>(), j.at("options").get<std::string>(),
                j.at("input").get<std::string>(), j.at("input_sha256").get<std::string>()};
    m.parts = j.at("parts").get<std::size_t>();
    m.pieces = j.at("pieces").get<std::size_t>();
    m.seams = j.at("seams").get<std::size_t>();
    m.around = around_of(j.at("around"));
    m.components = j.at("components").get<std::size_t>();
    m.cycle_rank = j.at("cycle_rank").get<std::size_t>();
    m.expected_vertices = j.at("expected_vertices").get<double>();
    for (const json& note : j.at("simplifications")) m.simplifications.push_back(note_of(note));
    return m;
  } catch (const json::exception&) {
    throw InvalidInput(path.string() + ": is damaged: something is missing or of another kind");
  } catch (const InvalidInput& error) {
    throw InvalidInput(path.string() + ": is damaged: " + error.what());
  }
}

}  // namespace vmesh
