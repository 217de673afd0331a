// All verbs that write surfaces write them as they are told: as text, compressed, in another unit and frame.
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using Words = std::vector<std::string>;

struct WritingVerb {
  const char* name;
  /// What follows to write y.ply, without words about how; another extension takes the place of the last "ply".
  Words words;
  bool has_attributes = true;
  /// Of the file, as the verb names it.
  std::string stem = "y";
};

std::ostream& operator<<(std::ostream& out, const WritingVerb& verb) { return out << verb.name; }

class Writing : public CommandTest, public ::testing::WithParamInterface<WritingVerb> {
 protected:
  Writing() {
    write_y("tree.swc");
    write("scene.json", R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.02, "frame_every": 10,
                            "drag": [{"node": 3, "path": [[0, 0, 0, 0], [0.02, 0, 1, 0]]}]})");
    EXPECT_EQ(vmesh({"generate", "@tree.swc", "-o", "@tree.ply"}).exit_code, 0);
    EXPECT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "100000"}).exit_code, 0);
    EXPECT_EQ(vmesh({"generate", "@parts/part_00001.vpart"}).exit_code, 0);
  }

  Outcome written(const std::string& extension, const Words& how) const {
    std::filesystem::remove_all(path("frames"));
    Words words = GetParam().words;
    words.back().replace(words.back().size() - 3, 3, extension);
    words.insert(words.begin(), GetParam().name);
    words.insert(words.end(), how.begin(), how.end());
    return vmesh(words);
  }
  std::string file(const std::string& extension) const { return GetParam().stem + "." + extension; }

  /// The corners of all faces, in what the file says is its unit and frame.
  std::vector<Vec3> corners(const std::string& name) const {
    const LoadedSurface surface = read_surface(path(name));
    std::vector<Vec3> result;
    for (const Triangle& face : surface.mesh.faces) {
      for (const Index v : face) result.push_back(surface.mesh.vertices[v]);
    }
    return result;
  }
};

TEST_P(Writing, AsText) {
  ASSERT_EQ(written("ply", {}).exit_code, 0);
  const std::vector<Vec3> plain = corners(file("ply"));
  ASSERT_GT(plain.size(), 100u);
  const Outcome run = written("stl", {"--ascii"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(read(file("stl")).starts_with("solid "));
  EXPECT_EQ(corners(file("stl")), plain);
  const Outcome ply = written("ply", {"--ascii"});
  ASSERT_EQ(ply.exit_code, 0) << ply.err;
  EXPECT_TRUE(read(file("ply")).starts_with("ply\nformat ascii 1.0\n"));
  EXPECT_EQ(corners(file("ply")), plain);
}

TEST_P(Writing, OnlyAsTheFormatCan) {
  const auto before = files();
  for (const auto& [extension, option] : {std::pair{"vtp", "--ascii"}, {"ply", "--compress"}}) {
    const Outcome run = written(extension, {option});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
    EXPECT_EQ(files(), before);
  }
}

TEST_P(Writing, Compressed) {
  ASSERT_EQ(written("glb", {}).exit_code, 0);
  const std::size_t plain = read(file("glb")).size();
  const Outcome run = written("glb", {"--compress"});
  if (run.exit_code == 4) {
    EXPECT_NE(run.err.find("VMESH_WITH_MESHOPTIMIZER"), std::string::npos) << run.err;
    return;
  }
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(read(file("glb")).find("EXT_meshopt_compression"), std::string::npos);
  EXPECT_LT(read(file("glb")).size(), plain);
}

TEST_P(Writing, InAnotherUnitAndFrame) {
  ASSERT_EQ(written("ply", {}).exit_code, 0);
  const std::vector<Vec3> plain = corners(file("ply"));
  ASSERT_EQ(written("ply", {"--output-unit", "cm", "--output-space", "RAS"}).exit_code, 0);
  const std::vector<Vec3> other = corners(file("ply"));
  ASSERT_EQ(other.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Vec3& p = plain[i];
    ASSERT_LT((other[i] - Vec3(-p.x(), -p.y(), p.z()) / 10).norm(), 1e-9) << i;
  }
}

TEST_P(Writing, WithoutAttributes) {
  if (!GetParam().has_attributes) {
    EXPECT_EQ(written("ply", {"--attributes", "none"}).exit_code, 2);
    return;
  }
  ASSERT_EQ(written("ply", {}).exit_code, 0);
  EXPECT_FALSE(read_surface(path(file("ply"))).attributes.vertex.empty() &&
               read_surface(path(file("ply"))).attributes.face.empty());
  ASSERT_EQ(written("ply", {"--attributes", "none"}).exit_code, 0);
  EXPECT_TRUE(read_surface(path(file("ply"))).attributes.vertex.empty());
  EXPECT_TRUE(read_surface(path(file("ply"))).attributes.face.empty());
}

const WritingVerb kWritingVerbs[] = {
    {"generate", {"@tree.swc", "-o", "@y.ply"}},
    {"convert", {"@tree.ply", "-o", "@y.ply"}},
    {"fit", {"@tree.ply", "@tree.ply", "--centerline", "@tree.swc", "-o", "@y.ply"}},
    {"cones", {"@tree.swc", "-o", "@y.ply"}},
    {"reference", {"@tree.swc", "--voxel", "2", "-o", "@y.ply"}, false},
    {"evaluate", {"@tree.ply", "-o", "@y.ply"}},
    {"join", {"@parts", "-o", "@y.ply"}},
    {"deform",
     {"@tree.swc", "@tree.ply", "--script", "@scene.json", "-o", "@frames", "--format", "ply"},
     true,
     "frames/frame_000001"},
};

INSTANTIATE_TEST_SUITE_P(Of, Writing, ::testing::ValuesIn(kWritingVerbs),
                         [](const auto& of) { return std::string(of.param.name); });

TEST_F(CommandTest, HowToWriteWithoutWhereIsRefused) {
  write_y("tree.swc");
  ASSERT_EQ(vmesh({"generate", "@tree.swc", "-o", "@tree.ply"}).exit_code, 0);
  const Outcome run = vmesh({"evaluate", "@tree.ply", "--ascii"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("-o FILE"), std::string::npos) << run.err;
}

TEST_F(CommandTest, CenterlinesHaveNoAttributesToLeaveOut) {
  write_y("tree.swc");
  const Outcome run = vmesh({"convert", "@tree.swc", "@tree.json", "--attributes", "none"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--attributes"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vmesh::testing
