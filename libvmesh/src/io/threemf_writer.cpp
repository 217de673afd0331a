// 3MF, for printing (3MF Core Specification 1.3).
#include <ostream>

#include "vmesh/core/text.h"

#include "formats.h"
#include "text.h"
#include "zip_archive.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kContentTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr std::string_view kRelations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

/// Throws Unsupported for a unit that 3MF does not have.
std::string_view unit_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::nm:
      throw Unsupported("3MF has no nanometres; use --unit um");
    case LengthUnit::um:
      return "micron";
    case LengthUnit::cm:
      return "centimeter";
    case LengthUnit::m:
      return "meter";
    case LengthUnit::mm:
    case LengthUnit::unknown:
      break;
  }
  return "millimeter";  // also what readers take for it if there is none
}

void add_metadata(std::string& xml, std::string_view name, std::string_view value) {
  if (!value.empty())
    xml += "<metadata name=\"" + std::string(name) + "\">" + xml_escaped(one_line(value), "&<>") + "</metadata>\n";
}

std::string model_of(const TriMesh& mesh, const SurfaceMetadata& metadata) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"" + std::string(unit_of(metadata.unit)) +
                    "\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n";
  add_metadata(xml, "Application", metadata.generator);
  const std::string space = metadata.space == Space::unknown ? "" : "SPACE=" + std::string(to_string(metadata.space));
  add_metadata(xml, "Description", metadata.options.empty() ? space : metadata.options + ", " + space);
  xml += "<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n";
  for (const Vec3& p : mesh.vertices) {
    append(xml += "<vertex x=\"", p.x());
    append(xml += "\" y=\"", p.y());
    append(xml += "\" z=\"", p.z());
    xml += "\"/>\n";
  }
  xml += "</vertices>\n<triangles>\n";
  for (const auto& [a, b, c] : mesh.faces)
    xml += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" + std::to_string(c) +
           "\"/>\n";
  return xml + "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n";
}

}  // namespace

void write_3mf(std::ostream& out, const TriMesh& mesh, const MeshAttributes&, const SurfaceMetadata& metadata,
               const SurfaceWriteOptions&) {
  ZipArchive archive;
  archive.add("[Content_Types].xml", kContentTypes);
  archive.add("_rels/.rels", kRelations);
  archive.add("3D/3dmodel.model", model_of(mesh, metadata));
  out << archive.finish();
}

}  // namespace vmesh::io
