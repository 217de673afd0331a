// Centerline files of other programs become surfaces in one command.
#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"
#include "shared_data.h"

namespace vmesh::testing {
namespace {

class CenterlineInputs : public CommandTest {
 protected:
  /// Runs `vmesh generate` with these files and options, and checks the surface. Returns its messages.
  std::string grow(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "generate");
    for (const char* more : {"-o", "@out.ply", "--check", "--json", "@out.json"}) arguments.emplace_back(more);
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    if (run.exit_code == 0) {
      EXPECT_GT(read_surface(path("out.ply")).mesh.faces.size(), 10u);
    }
    return run.err;
  }

  static std::string curve(const std::string& points, const std::string& radii) {
    return R"({"markups": [{"type": "Curve", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": [)" +
           points + R"(], "measurements": [{"name": "Radius", "controlPointValues": [)" + radii + "]}]}]}";
  }
};

TEST_F(CenterlineInputs, ASetOfSlicersCurves) {
  write("trunk.mrk.json", curve(R"({"position": [0,0,0]}, {"position": [0,0,20]})", "3, 2.8"));
  write("left.mrk.json", curve(R"({"position": [0,0,20]}, {"position": [-9,0,32]})", "2.2, 2.1"));
  write("right.mrk.json", curve(R"({"position": [0.4,0,20.5]}, {"position": [8,3,33]})", "2.3, 2.3"));
  grow({"@trunk.mrk.json", "@left.mrk.json", "@right.mrk.json"});
  const auto summary = nlohmann::json::parse(read("out.json"));
  EXPECT_EQ(summary.at("centerline").at("components"), 1);
  EXPECT_EQ(summary.at("centerline").at("ends"), 3);
}

TEST_F(CenterlineInputs, EndsThatNearlyMeetAreJoinedOnRequest) {
  write("a.swc", "# SPACE=LPS UNIT=mm\n1 0 0 0 0 2 -1\n2 0 0 0 20 2 1\n");
  write("b.swc", "# SPACE=LPS UNIT=mm\n1 0 0 0 23 2 -1\n2 0 0 0 40 2 1\n");
  const auto components = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"@a.swc", "@b.swc"});
    const std::string said = grow(more);
    const auto summary = nlohmann::json::parse(read("out.json"));
    const bool joins = summary.at("cleaning").at("joined_ends").size() == 1;
    EXPECT_EQ(joins, said.find("this end of a branch lies 3 mm from that in line 2 of") != std::string::npos) << said;
    return summary.at("centerline").at("components").get<int>();
  };
  EXPECT_EQ(components({}), 2);
  EXPECT_EQ(components({"--tolerance", "2.9mm"}), 2);
  EXPECT_EQ(components({"--tolerance", "3.1mm"}), 1);
  EXPECT_EQ(components({"--tolerance", "1.6"}), 1);
  EXPECT_EQ(vmesh({"info", "@a.swc", "--tolerance", "3cm"}).exit_code, 2);
}

TEST_F(CenterlineInputs, AFolderOfBranchesIsATree) {
  std::filesystem::create_directory(path("curves"));
  write("curves/a.mrk.json", curve(R"({"position": [0,0,0]}, {"position": [0,0,20]})", "3, 2.8"));
  write("curves/b.mrk.json", curve(R"({"position": [0,0,20]}, {"position": [-9,0,32]})", "2.2, 2.1"));
  write("curves/notes.txt", "not a branch");
  grow({"@curves"});
  EXPECT_EQ(nlohmann::json::parse(read("out.json")).at("centerline").at("ends"), 2);
}

TEST_F(CenterlineInputs, AnotherFolderIsRefusedWithWhatIsInIt) {
  std::filesystem::create_directory(path("trees"));
  Outcome run = vmesh({"generate", "@trees", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("contains no file that vmesh can read"), std::string::npos) << run.err;
  write_y("trees/y.swc");
  run = vmesh({"generate", "@trees", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("y.swc"), std::string::npos) << run.err;
  write("trees/a.mrk.json", curve(R"({"position": [0,0,0]}, {"position": [0,0,20]})", "3, 2.8"));
  write("trees/b.pth", "");
  run = vmesh({"generate", "@trees", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("several kinds (.mrk.json, .pth)"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("out.ply"));
}

#if !VMESH_HAS_DICOM
TEST_F(CenterlineInputs, AFolderOfDicomFilesNeedsGdcm) {
  std::filesystem::create_directory(path("ct"));
  write("ct/IM0001", std::string(128, '\0') + "DICM");
  for (const char* input : {"@ct", "@ct/IM0001"}) {
    for (const char* verb : {"generate", "centerline", "reference"}) {
      const Outcome run = vmesh({verb, input, "--threshold", "200", "-o", "@out.json"});
      EXPECT_EQ(run.exit_code, 4) << run.err;
    }
    const Outcome run = vmesh({"generate", input, "--threshold", "200", "-o", "@out.ply"});
    EXPECT_NE(run.err.find("built without GDCM (CMake option VMESH_WITH_DICOM)"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("convert the image"), std::string::npos) << run.err;
  }
}
#endif

TEST_F(CenterlineInputs, AFolderOfScansNamesThem) {
  std::filesystem::create_directories(path("patient/arterial"));
  std::string slice(132, '\0');
  write("patient/arterial/IM0001", slice.replace(128, 4, "DICM"));
  const Outcome run = vmesh({"generate", "@patient", "--threshold", "200", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("there are " + path("patient/arterial").string()), std::string::npos) << run.err;
}

TEST_F(CenterlineInputs, AFolderOfImagesIsNoScan) {
  std::filesystem::create_directory(path("images"));
  write("images/a.nii", "");
  const Outcome run = vmesh({"generate", "@images", "--threshold", "200", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("a.nii"), std::string::npos) << run.err;
}

TEST_F(CenterlineInputs, SeveralFilesAreNoSurface) {
  write_y("a.swc");
  const Outcome run = vmesh({"info", "@a.swc", "@b.ply"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
}

TEST_F(CenterlineInputs, NoneOfSeveralIsOverwritten) {
  write_y("a.swc");
  write_y("b.swc");
  const Outcome run = vmesh({"convert", "@a.swc", "@b.swc", "-o", "@b.swc"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("is an input"), std::string::npos) << run.err;
}

TEST_F(CenterlineInputs, SimVascularsContoursAndPaths) {
  const auto contour = [](const std::string& z) {
    std::string points;
    for (const char* xy : {"x=\"1\" y=\"0\"", "x=\".5\" y=\".87\"", "x=\"-.5\" y=\".87\"", "x=\"-1\" y=\"0\"",
                           "x=\"-.5\" y=\"-.87\"", "x=\".5\" y=\"-.87\""})
      points += "<point " + std::string(xy) + " z=\"" + z + "\"/>";
    return "<contour><contour_points>" + points + "</contour_points></contour>";
  };
  write("aorta.ctgr", "<format version=\"1.0\"/><contourgroup><timestep>" + contour("0") + contour("4") + contour("9") +
                          "</timestep></contourgroup>");
  grow({"@aorta.ctgr", "--unit", "cm"});
  write("aorta.pth",
        "<format version=\"1.0\"/><path><timestep><path_element><path_points><path_point><pos x=\"0\" y=\"0\" z=\"0\"/>"
        "</path_point><path_point><pos x=\"0\" y=\"0\" z=\"9\"/></path_point></path_points></path_element></timestep>"
        "</path>");
  grow({"@aorta.pth", "--unit", "cm", "--radius", "9"});
  const Outcome run = vmesh({"generate", "@aorta.pth", "-o", "@other.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--radius"), std::string::npos) << run.err;
}

TEST_F(CenterlineInputs, VascuSynthsGxl) {
  const auto node = [](const std::string& id, const std::string& x, const std::string& y) {
    return "<node id=\"" + id + "\"><attr name=\" position\"><tup><float>" + x + "</float><float>" + y +
           "</float><float>0</float></tup></attr></node>";
  };
  const auto edge = [](const std::string& from, const std::string& to, const std::string& radius) {
    return "<edge from=\"" + from + "\" to=\"" + to + "\"><attr name=\" radius\"><float>" + radius +
           "</float></attr></edge>";
  };
  write("tree.xml", "<gxl><graph>" + node("a", "0", "0") + node("b", "40", "0") + node("c", "70", "30") +
                        node("d", "70", "-30") + edge("a", "b", "2") + edge("b", "c", "1.2") + edge("b", "d", "1.5") +
                        "</graph></gxl>");
  grow({"@tree.xml", "--voxel-size", "0.5"});
  EXPECT_EQ(vmesh({"generate", "@tree.xml", "-o", "@other.ply", "--voxel-size", "0.5,0.5"}).exit_code, 2);
  EXPECT_EQ(vmesh({"generate", "@tree.xml", "-o", "@other.ply", "--voxel-size", "0"}).exit_code, 2);
}

TEST_F(CenterlineInputs, AmirasSpatialGraph) {
  write("graph.am",
        "# AmiraMesh 3D ASCII 2.0\ndefine VERTEX 2\ndefine EDGE 1\ndefine POINT 3\nParameters { ContentType "
        "\"HxSpatialGraph\" }\nVERTEX { float[3] VertexCoordinates } @1\nEDGE { int[2] EdgeConnectivity } @2\n"
        "EDGE { int NumEdgePoints } @3\nPOINT { float[3] EdgePointCoordinates } @4\nPOINT { float Caliber } @5\n"
        "@1\n0 0 0\n0 0 90\n@2\n0 1\n@3\n3\n@4\n0 0 0\n5 0 40\n0 0 90\n@5\n6\n5\n4\n");
  grow({"@graph.am", "--unit", "um", "--radius-array", "Caliber"});
}

TEST_F(CenterlineInputs, ANetworkOfSecomb) {
  write("network.dat",
        "Network\n550 550 230 box\n32 32 14 grid\n20 bound\n40 longest\n50 most\n3 segments\nname type from to diam\n"
        "1 5 1 2 12\n2 5 2 3 10\n3 5 2 4 10\n4 nodes\nname x y z\n1 0 0 0\n2 100 0 0\n3 180 60 0\n4 180 -60 0\n");
  const std::string said = grow({"@network.dat"});
  EXPECT_EQ(said.find("does not say its unit"), std::string::npos) << said;
}

#if VMESH_TEST_WITH_HDF5
TEST_F(CenterlineInputs, ANetworkOfMorphIo) {
  VMESH_NEED_SHARED_DATA("microvascular_loops/vasculature2.h5");
  grow({shared_data("microvascular_loops/vasculature2.h5").string()});
  EXPECT_GT(nlohmann::json::parse(read("out.json")).at("centerline").at("nodes"), 500);
}
#else
TEST_F(CenterlineInputs, ANetworkOfMorphIoNeedsHdf5) {
  write("network.h5", "\x89HDF\r\n\x1a\n");
  const Outcome run = vmesh({"generate", "@network.h5", "@out.ply"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("VMESH_WITH_HDF5"), std::string::npos) << run.err;
}
#endif

TEST_F(CenterlineInputs, ImplausibleRadiiAreHintedAt) {
  write("small.swc", "1 0 0 0 0 0.004 -1\n2 0 0 0 0.09 0.004 1\n");
  EXPECT_NE(grow({"@small.swc"}).find("--unit"), std::string::npos);
}

}  // namespace
}  // namespace vmesh::testing
