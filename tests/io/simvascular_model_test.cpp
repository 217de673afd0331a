// SimVascular's models, parsed as it does.
#include <cmath>
#include <map>
#include <sstream>

#include <pugixml.hpp>

#include "vmesh/core/error.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;
using testing::tetrahedron;

/// No face has the second name.
MeshAttributes faces_with_names() {
  MeshAttributes attributes;
  attributes.face.push_back({"ModelFaceID", {3, 1, 1, 4}, true});
  attributes.patch_names = {"wall_0", "cap_1", "inlet", "outlet.left-2"};
  return attributes;
}

struct Face {
  std::string name, type;
  bool operator==(const Face&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Face& face) { return out << face.name << " " << face.type; }

/// A number all of whose text is one, as TinyXML's queries take it.
double number_in(pugi::xml_node node, const char* name) {
  const pugi::xml_attribute attribute = node.attribute(name);
  EXPECT_FALSE(attribute.empty()) << name;
  std::istringstream text(attribute.value());
  double number = -1;
  EXPECT_TRUE(text >> number && text.peek() == std::istringstream::traits_type::eof()) << name;
  return number;
}

/// As sv4guiModelIO::CreateGroupFromFile() goes through the file: every attribute and element that it looks at.
std::map<int, Face> faces_of_model(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str())) << text;
  const pugi::xml_node model = document.child("model");
  EXPECT_STREQ(model.attribute("type").value(), "PolyData");
  const pugi::xml_node step = model.child("timestep");
  EXPECT_TRUE(step.next_sibling("timestep").empty());  // each would be a model of its own
  const pugi::xml_node element = step.child("model_element");
  EXPECT_STREQ(element.attribute("type").value(), "PolyData");  // so the surface is in the .vtp of the same name
  EXPECT_EQ(number_in(element, "num_sampling"), 0);
  EXPECT_EQ(number_in(element, "use_uniform"), 0);  // else it looks for what lofting needs
  EXPECT_TRUE(element.child("segmentations").child("seg").empty());
  EXPECT_TRUE(element.child("blend_radii").child("face_pair").empty());  // its loop over these would not end
  std::map<int, Face> faces;
  for (const pugi::xml_node face : element.child("faces").children("face")) {
    EXPECT_STREQ(face.attribute("visible").value(), "true");
    for (const char* share : {"opacity", "color1", "color2", "color3"}) {
      EXPECT_GE(number_in(face, share), 0);
      EXPECT_LE(number_in(face, share), 1);
    }
    const Face entry{face.attribute("name").value(), face.attribute("type").value()};
    EXPECT_FALSE(entry.name.empty());
    EXPECT_TRUE(entry.type == "wall" || entry.type == "cap") << entry.type;
    const double id = number_in(face, "id");
    EXPECT_EQ(id, std::floor(id));
    EXPECT_TRUE(faces.emplace(static_cast<int>(id), entry).second) << id;
  }
  return faces;
}

/// As sv4guiModelLegacyIO::ReadFile() splits lines.
std::map<int, std::string> names_in(const std::string& text) {
  std::map<int, std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("set gPolyDataFaceNames(") == std::string::npos) continue;
    for (char& c : line) {
      if (std::string("(),{}").find(c) != std::string::npos) c = ' ';
    }
    std::istringstream words(line);
    std::string word, name;
    int number = 0;
    words >> word >> word >> number >> name;
    names[number] = name;
  }
  return names;
}

TEST(SimVascularModel, NamesTheFacesOfTheSurfaceBesideIt) {
  const TemporaryFolder folder;
  write_surface(folder / "m.mdl", tetrahedron(), faces_with_names());
  EXPECT_EQ(folder.file_count(), 3u);
  EXPECT_EQ(faces_of_model(content_of(folder / "m.mdl")),
            (std::map<int, Face>{{1, {"wall_0", "wall"}}, {3, {"inlet", "cap"}}, {4, {"outlet.left-2", "cap"}}}));
  EXPECT_EQ(names_in(content_of(folder / "m.vtp.facenames")),
            (std::map<int, std::string>{{1, "wall_0"}, {3, "inlet"}, {4, "outlet.left-2"}}));
  const LoadedSurface surface = read_surface(folder / "m.vtp");
  EXPECT_EQ(surface.mesh.faces, tetrahedron().faces);
  EXPECT_EQ(find_attribute(surface.attributes.face, "ModelFaceID")->values, (std::vector<double>{3, 1, 1, 4}));
}

TEST(SimVascularModel, WithoutNumbersOfFacesGetsThem) {
  const TemporaryFolder folder;
  MeshAttributes caps;
  caps.face.push_back({"CapID", {-1, 2, -1, 5}, true});
  write_surface(folder / "m.mdl", tetrahedron(), caps);
  EXPECT_EQ(faces_of_model(content_of(folder / "m.mdl")),
            (std::map<int, Face>{{1, {"wall", "wall"}}, {2, {"cap_2", "cap"}}, {3, {"cap_5", "cap"}}}));
  EXPECT_EQ(find_attribute(read_surface(folder / "m.vtp").attributes.face, "ModelFaceID")->values,
            (std::vector<double>{1, 2, 1, 3}));
  write_surface(folder / "m.mdl", tetrahedron());
  EXPECT_EQ(faces_of_model(content_of(folder / "m.mdl")), (std::map<int, Face>{{1, {"wall", "wall"}}}));
  EXPECT_EQ(find_attribute(read_surface(folder / "m.vtp").attributes.face, "ModelFaceID")->values,
            (std::vector<double>{1, 1, 1, 1}));
}

TEST(SimVascularModel, HasEveryNumberThatFacesHave) {
  const TemporaryFolder folder;
  MeshAttributes several;  // walls, as SimVascular numbers them
  several.face.push_back({"ModelFaceID", {7, 4, 5, 9}, true});
  several.face.push_back({"CapID", {-1, 2, -1, 3}, true});
  write_surface(folder / "m.mdl", tetrahedron(), several);
  EXPECT_EQ(faces_of_model(content_of(folder / "m.mdl")),
            (std::map<int, Face>{
                {4, {"cap_2", "cap"}}, {5, {"wall_5", "wall"}}, {7, {"wall_7", "wall"}}, {9, {"cap_3", "cap"}}}));
  several.face.pop_back();
  several.face[0].values = {1, 1, 2, 1};
  write_surface(folder / "m.mdl", tetrahedron(), several);
  EXPECT_EQ(faces_of_model(content_of(folder / "m.mdl")),
            (std::map<int, Face>{{1, {"face_1", "wall"}}, {2, {"face_2", "cap"}}}));
}

TEST(SimVascularModel, ThatCannotBeWrittenLeavesNothing) {
  const TemporaryFolder folder;
  MeshAttributes attributes;
  attributes.face.push_back({"ModelFaceID", {0, 1, 1, 2}, true});
  expect_contains(message_of<InvalidInput>([&] { write_surface(folder / "m.mdl", tetrahedron(), attributes); }),
                  "ModelFaceID");
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace vmesh
