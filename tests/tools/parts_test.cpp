// vmesh split, generate and join: the same bytes as vmesh generate in one go.
#include <fstream>

#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"
#include "vmesh/synth/synthetic_tree.h"

#include "random_vessels.h"
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class Parts : public CommandTest {
 protected:
  void write_tree(const std::string& name, std::size_t nodes, std::uint64_t seed) const {
    write_centerline(path(name), synthetic_tree({.vertices = nodes, .seed = seed}), {});
  }

  std::size_t generate_all(const std::string& folder) const {
    std::size_t count = 0;
    for (char name[32]; std::snprintf(name, sizeof name, "part_%05zu.vpart", count + 1), exists(folder + "/" + name);
         ++count) {
      const Outcome run = vmesh({"generate", "@" + folder + "/" + name, "--threads", "1"});
      EXPECT_EQ(run.exit_code, 0) << run.err;
    }
    return count;
  }

  // Returns the number of parts.
  std::size_t expect_same(const std::string& centerline, const std::string& vertices, const Words& options = {}) const {
    const Outcome whole =
        vmesh(Words{"generate", "@" + centerline, "-o", "@whole.ply", "--json", "@whole.json"} + options);
    EXPECT_EQ(whole.exit_code, 0) << whole.err;
    const Outcome split = vmesh(Words{"split", "@" + centerline, "-o", "@parts", "--vertices", vertices} + options);
    EXPECT_EQ(split.exit_code, 0) << split.err;
    const std::size_t parts = generate_all("parts");
    const Outcome join = vmesh({"join", "@parts", "-o", "@joined.ply", "--json", "@joined.json"});
    EXPECT_EQ(join.exit_code, 0) << join.err;
    EXPECT_TRUE(read("whole.ply") == read("joined.ply"));
    // Junctions, tubes, rungs, and all that was merged, filled or left out, as numbers of the file's centerline.
    EXPECT_EQ(nlohmann::json::parse(read("whole.json"))["growth"],
              nlohmann::json::parse(read("joined.json"))["growth"]);
    return parts;
  }
};

TEST_F(Parts, MakeTheBytesOfTheWhole) {
  write_tree("tree.swc", 400, 3);
  EXPECT_GE(expect_same("tree.swc", "700"), 5u);
  EXPECT_EQ(expect_same("tree.swc", "100000000"), 1u);
  EXPECT_GE(expect_same("tree.swc", "2000", {"--around", "9", "--simplification", "0.8", "--blend", "1"}), 3u);
}

// Vessels that had to be narrowed and moved, with nodes left out before or, where there were too few, after that; walls
// of different pieces that cross are parted.
TEST_F(Parts, MakeTheBytesOfTheWholeOfCrowdedVessels) {
  std::size_t parted = 0, several = 0;
  for (const std::uint32_t seed : {0u, 1u, 2u, 3u, 4u, 5u, 38u, 44u}) {  // walls cross in the last two
    SCOPED_TRACE("seed " + std::to_string(seed));
    write_centerline(path("crowded.swc"), seed % 2 == 0 ? noisy_tree(seed) : plausible_tree(seed, 0), {});
    several += expect_same("crowded.swc", "1") > 1;
    parted += nlohmann::json::parse(read("joined.json"))["walls_parted"].get<std::size_t>();
  }
  EXPECT_GE(several, 6u);
  EXPECT_GE(parted, 1u);
}

// A twig within another vessel is left out of the surface, and reported.
TEST_F(Parts, TellOfBranchesThatWereLeftOut) {
  write("buried.swc",
        "1 2 0 0 0 3 -1\n2 2 10 0 0 3 1\n3 2 20 0 0 3 2\n4 2 30 0 0 3 3\n5 2 40 0 0 3 4\n6 2 50 0 0 3 5\n"
        "7 2 21 0.8 0 0.5 3\n8 2 22 1.2 0 0.5 7\n");
  expect_same("buried.swc", "100");
  const auto notes = nlohmann::json::parse(read("joined.json"))["growth"]["simplifications"];
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0]["kind"], "buried_branch");
}

TEST_F(Parts, TellInTheirSummaries) {
  write_tree("tree.swc", 200, 1);
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "1000", "--json", "@split.json"}).exit_code, 0);
  const auto split = nlohmann::json::parse(read("split.json"));
  EXPECT_EQ(split["parts"], generate_all("parts"));
  ASSERT_EQ(vmesh({"generate", "@parts/part_00001.vpart", "--json", "@part.json"}).exit_code, 0);
  EXPECT_GT(nlohmann::json::parse(read("part.json"))["vertices"], 500);
  ASSERT_EQ(vmesh({"join", "@parts", "-o", "@joined.obj", "--json", "@joined.json"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@tree.swc", "-o", "@whole.obj", "--json", "@whole.json"}).exit_code, 0);
  EXPECT_EQ(read("joined.obj"), read("whole.obj"));
  const auto joined = nlohmann::json::parse(read("joined.json")), whole = nlohmann::json::parse(read("whole.json"));
  EXPECT_EQ(joined["vertices"], whole["vertices"]);
  EXPECT_EQ(joined["faces"], whole["faces"]);
  EXPECT_EQ(joined["skewness"], whole["skewness"]);
  EXPECT_EQ(joined["topology"]["euler_characteristic"], whole["topology"]["euler_characteristic"]);
  EXPECT_EQ(joined["growth"], whole["growth"]);
}

TEST_F(Parts, AreListedForParaView) {
  write_tree("tree.swc", 200, 1);
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "1000"}).exit_code, 0);
  const std::size_t count = generate_all("parts");
  const Outcome join = vmesh({"join", "@parts", "-o", "@whole.vtm"});
  EXPECT_EQ(join.exit_code, 0) << join.err;
  const std::string list = read("whole.vtm");
  for (std::size_t p = 1; p <= count; ++p) {
    const std::string name = "whole/part_0000" + std::to_string(p) + ".vtp";
    EXPECT_TRUE(exists(name));
    EXPECT_NE(list.find("file=\"" + name + "\""), std::string::npos);
  }
}

TEST_F(Parts, AreRefusedWhereTheyDoNotFit) {
  write_tree("tree.swc", 200, 1);
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "1000"}).exit_code, 0);
  const Outcome early = vmesh({"join", "@parts", "-o", "@whole.ply"});
  EXPECT_EQ(early.exit_code, 3);
  EXPECT_NE(early.err.find("part_00001.vsurf: is missing; make it with: vmesh generate"), std::string::npos)
      << early.err;
  EXPECT_FALSE(exists("whole.ply"));
  const Outcome options = vmesh({"generate", "@parts/part_00001.vpart", "--around", "8"});
  EXPECT_EQ(options.exit_code, 2);
  EXPECT_NE(options.err.find("options given to vmesh split"), std::string::npos) << options.err;
  EXPECT_EQ(vmesh({"generate", "@parts/part_00001.vpart", "--allow-defects"}).exit_code, 2);
  const Outcome format = vmesh({"generate", "@parts/part_00001.vpart", "-o", "@part.ply"});
  EXPECT_EQ(format.exit_code, 2);
  EXPECT_NE(format.err.find("vmesh join"), std::string::npos) << format.err;
  write("parts/part_00002.vpart", read("parts/part_00002.vpart").substr(0, 5000));
  const Outcome cut = vmesh({"generate", "@parts/part_00002.vpart"});
  EXPECT_EQ(cut.exit_code, 3);
  EXPECT_NE(cut.err.find("part_00002.vpart: is cut off or damaged"), std::string::npos) << cut.err;
  EXPECT_FALSE(exists("parts/part_00002.vsurf"));
  write("notes.txt", "mine");
  EXPECT_EQ(vmesh({"split", "@tree.swc", "-o", "@notes.txt"}).exit_code, 5);
  std::filesystem::create_directory(path("mine"));
  write("mine/notes.txt", "mine");
  const Outcome folder = vmesh({"split", "@tree.swc", "-o", "@mine"});
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_NE(folder.err.find("is not empty"), std::string::npos) << folder.err;
  EXPECT_EQ(vmesh({"join", "@mine", "-o", "@whole.ply"}).exit_code, 3);
}

TEST_F(Parts, StayWhereANewSplittingDoesNotBegin) {
  write_tree("tree.swc", 200, 1);
  write("broken.swc", "1 2 0 0 x\n");
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "2000"}).exit_code, 0);
  generate_all("parts");
  EXPECT_EQ(vmesh({"split", "@broken.swc", "-o", "@parts"}).exit_code, 3);
  EXPECT_EQ(vmesh({"split", "@missing.swc", "-o", "@parts"}).exit_code, 3);
  EXPECT_EQ(vmesh({"join", "@parts", "-o", "@whole.ply"}).exit_code, 0);
  EXPECT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--max-vertices", "100"}).exit_code, 3);
  EXPECT_FALSE(exists("parts/parts.json"));
  EXPECT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "2000"}).exit_code, 0);
}

TEST_F(Parts, OfAnotherSplittingAreTakenAway) {
  write_tree("tree.swc", 200, 1);
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "500"}).exit_code, 0);
  generate_all("parts");
  ASSERT_EQ(vmesh({"split", "@tree.swc", "-o", "@parts", "--vertices", "2000"}).exit_code, 0);
  EXPECT_FALSE(exists("parts/part_00001.vsurf"));
  EXPECT_EQ(generate_all("parts"), 2u);
  EXPECT_EQ(vmesh({"join", "@parts", "-o", "@whole.ply"}).exit_code, 0);
}

}  // namespace
}  // namespace vmesh::testing
