// Trees of VascuSynth, in its dialect of GXL: names and texts are padded with blanks.
#include <unordered_map>

#include "edge_radii.h"
#include "formats.h"
#include "text.h"
#include "xml.h"

namespace vmesh::io {
namespace {

class GxlReader {
 public:
  GxlReader(std::string_view content, const std::string& source, const CenterlineReadOptions& options)
      : file_(parse_xml(content, source)), options_(options) {
    raw_.source = source;
    raw_.segment_word = "edge";
  }

  RawCenterline run() {
    const pugi::xml_node graph = file_.document.child("gxl").child("graph");
    if (!graph) fail("this is not a GXL file: it contains no <gxl> with a <graph>");
    if (!options_.voxel_size)
      fail("positions in GXL files of VascuSynth are in voxels: give the sides of one with --voxel-size");
    if (!((options_.voxel_size->array() > 0).all())) fail("the sides of a voxel must be above 0");
    for (const pugi::xml_node node : graph.children("node")) read_node(node);
    for (const pugi::xml_node edge : graph.children("edge")) read_edge(edge);
    if (raw_.segments.empty()) fail("it contains no <edge>");
    set_radii_of_segments(raw_, radii_);
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(raw_.source + ": " + what); }

  /// The element <attr> of that name, ignoring blanks around it.
  static pugi::xml_node attribute(pugi::xml_node owner, std::string_view name) {
    for (const pugi::xml_node attr : owner.children("attr")) {
      if (trim(attr.attribute("name").value()) == name) return attr;
    }
    return {};
  }

  double number(pugi::xml_node element, const std::string& place, const char* what) const {
    const std::string_view text = trim(element.text().get());
    const auto value = parse_double(text);
    if (!value) fail(place + ": its " + what + " " + cite(text) + " is not a number");
    return *value;
  }

  void read_node(pugi::xml_node node) {
    const std::string place = "node " + std::to_string(raw_.nodes.size());
    const std::string id(trim(node.attribute("id").value()));
    if (!node_of_.try_emplace(id, static_cast<Index>(raw_.nodes.size())).second)
      fail(place + ": the id " + cite(id) + " occurs twice");
    Vec3 position = Vec3::Zero();
    Eigen::Index axis = 0;
    for (const pugi::xml_node value : attribute(node, "position").child("tup").children("float")) {
      if (axis < 3) position[axis] = number(value, place, "position") * (*options_.voxel_size)[axis];
      ++axis;
    }
    if (axis != 3) fail(place + ": its position must be a <tup> of three <float>");
    raw_.nodes.push_back({position, 0});
  }

  Index end(pugi::xml_node edge, const char* which, const std::string& place) const {
    const std::string id(trim(edge.attribute(which).value()));
    const auto found = node_of_.find(id);
    if (found == node_of_.end()) fail(place + ": there is no node " + cite(id));
    return found->second;
  }

  void read_edge(pugi::xml_node edge) {
    const std::string place = "edge " + std::to_string(raw_.segments.size());
    const Index from = end(edge, "from", place);
    raw_.segments.push_back({from, end(edge, "to", place)});
    const pugi::xml_node radius = attribute(edge, "radius");
    if (radius) {
      radii_.push_back(number(radius.child("float"), place, "radius"));
    } else if (options_.radius) {
      radii_.push_back(0);
    } else {
      fail(place + ": it has no radius; give all of them one with --radius");
    }
  }

  XmlFile file_;
  const CenterlineReadOptions& options_;
  RawCenterline raw_;
  std::vector<double> radii_;
  std::unordered_map<std::string, Index> node_of_;
};

}  // namespace

RawCenterline parse_gxl(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  return GxlReader(content, source, options).run();
}

}  // namespace vmesh::io
