// The list of formats, and options for reading against every format.
#include <nlohmann/json.hpp>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using Json = nlohmann::json;

class Formats : public CommandTest {
 protected:
  Json listed() const {
    const Outcome run = vmesh({"formats", "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Json::parse(run.out);
  }

  /// Whether `vmesh info` refuses the option for the file by its name.
  bool refuses(const std::string& file, const std::string& option, const std::string& value) const {
    const Outcome run = vmesh({"info", file, "--" + option, value});
    const bool named = run.err.find("--" + option) != std::string::npos &&
                       (run.err.find("is for centerlines in") != std::string::npos ||
                        run.err.find("do not apply") != std::string::npos);
    EXPECT_EQ(run.exit_code == 2, named) << file << ": " << run.err;
    return named;
  }
};

const std::vector<std::pair<std::string, std::string>> kOptions = {{"radius-array", "R"},  {"radius", "2"},
                                                                   {"tolerance", "0.5mm"}, {"voxel-size", "0.5"},
                                                                   {"unit", "cm"},         {"space", "RAS"}};

TEST_F(Formats, AreListedAsTextAndJson) {
  const Json formats = listed();
  const std::string text = vmesh({"formats"}).out;
  EXPECT_NE(text.find("centerline .swc: SWC; read; written; --voxel-size, --radius, --tolerance, --unit, --space\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("volume polyMesh: OpenFOAM; written\n"), std::string::npos) << text;
  EXPECT_NE(text.find("surface .smesh: TetGen; written; --unit"), std::string::npos) << text;
  EXPECT_NE(text.find("centerline .gxl .xml: VascuSynth; read; --voxel-size"), std::string::npos) << text;
  for (const char* kind : {"centerline", "surface", "volume", "image"}) {
    ASSERT_GE(formats.at(kind).size(), 7u);
    for (const Json& format : formats.at(kind))
      EXPECT_NE(text.find(format.at("name").get<std::string>()), std::string::npos) << format;
  }
}

// Scripts that look for centerlines in a folder leave out its surfaces.
TEST_F(Formats, ThoseOfLinesThatMostlyHoldSurfacesSaySo) {
  const Json formats = listed();
  for (const Json& format : formats.at("centerline")) {
    const bool mostly = format.at("mostly_another_kind").get<bool>();
    const std::string extension = format.at("extensions")[0].get<std::string>();
    EXPECT_EQ(mostly, extension == ".ply" || extension == ".obj") << extension;
  }
}

TEST_F(Formats, LinesInFormatsOfSurfacesAreCenterlines) {
  write("l.obj", "# UNIT=mm SPACE=LPS\nv 0 0 0\nv 9 0 0\nl 1 2\n");
  write("l.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
        "0 0 0 1\n9 0 0 1\n0 1\n");
  EXPECT_EQ(vmesh({"generate", "@l.obj", "--radius", "1", "-o", "@o.stl"}).exit_code, 0);
  EXPECT_EQ(vmesh({"generate", "@l.ply", "-o", "@p.stl"}).exit_code, 0);
  EXPECT_EQ(read("o.stl"), read("p.stl"));
  EXPECT_EQ(vmesh({"convert", "@l.ply", "@l.swc"}).exit_code, 0);
  const Outcome written = vmesh({"convert", "@l.obj", "@lines.stl"});
  EXPECT_EQ(written.exit_code, 2);
  EXPECT_NE(written.err.find("l.obj: holds lines, no faces: a centerline, which cannot be written to "),
            std::string::npos)
      << written.err;
  const Outcome as_surface = vmesh({"evaluate", "@l.ply"});
  EXPECT_EQ(as_surface.exit_code, 3) << as_surface.err;
  EXPECT_NE(as_surface.err.find("l.ply: this file holds lines, no faces, and a surface is needed"), std::string::npos)
      << as_surface.err;
  // Errors are those of lines, not of a surface without triangles.
  write("bad.obj", "v 0 0 0\nv 9 0 0\nl 1 5\n");
  const Outcome bad = vmesh({"generate", "@bad.obj", "--radius", "1", "-o", "@o.stl"});
  EXPECT_EQ(bad.exit_code, 3) << bad.err;
  EXPECT_NE(bad.err.find("bad.obj: line 3: there is no vertex 5"), std::string::npos) << bad.err;
}

/// Expects the extensions of the formats of a kind that can be written in a message, and no others.
void expect_lists_written(const std::string& message, const Json& formats) {
  for (const Json& format : formats) {
    for (const std::string extension : format.at("extensions")) {
      const bool is_listed = (message + " ").find(extension + " ") != std::string::npos ||
                             message.find(extension + ",") != std::string::npos ||
                             message.find(extension + "\n") != std::string::npos;
      EXPECT_EQ(is_listed, format.at("written").get<bool>()) << extension << " in " << message;
    }
  }
}

TEST_F(Formats, UnknownOutputsAreRefusedWithAllThatCanBeWritten) {
  const Json formats = listed();
  write_y("y.swc");
  const Outcome surface = vmesh({"generate", "@y.swc", "-o", "@tree.xyz"});
  EXPECT_EQ(surface.exit_code, 4);
  expect_lists_written(surface.err, formats.at("surface"));
  const Outcome centerline = vmesh({"synth", "-o", "@frame.xyz"});
  EXPECT_EQ(centerline.exit_code, 4);
  expect_lists_written(centerline.err, formats.at("centerline"));
  const Outcome either = vmesh({"convert", "@y.swc", "@y.xyz"});
  EXPECT_EQ(either.exit_code, 4);
  EXPECT_NE(either.err.find("y.xyz: \".xyz\" is not supported; centerlines are written as .swc"), std::string::npos);
  EXPECT_NE(either.err.find(", surfaces as .off"), std::string::npos) << either.err;
}

TEST_F(Formats, UnknownInputsAreRefusedWithAllThatAreKnown) {
  const Json formats = listed();
  write("y.xyz", "");
  for (const auto& [kind, verb] : {std::pair{"surface", "render"}, std::pair{"centerline", "cones"}}) {
    const Outcome run = vmesh({verb, "@y.xyz", "-o", verb == std::string("render") ? "@y.png" : "@y.ply"});
    EXPECT_EQ(run.exit_code, 4);
    for (const Json& format : formats.at(kind)) {
      for (const std::string extension : format.at("extensions"))
        EXPECT_NE(run.err.find(extension), std::string::npos) << extension << " in " << run.err;
    }
  }
}

TEST_F(Formats, EveryOptionActsOnACenterlineOrIsRefusedByName) {
  const Json formats = listed();
  for (const Json& format : formats.at("centerline")) {
    const std::string extension = format.at("extensions").at(0);
    bool may_be_surface = false;
    for (const Json& surface : formats.at("surface")) may_be_surface |= surface.at("extensions").at(0) == extension;
    if (may_be_surface) continue;
    const std::string name = "@tree" + extension;
    write(name.substr(1), "nothing of use");
    write("tree.segments.csv", "");
    for (const auto& [option, value] : kOptions) {
      const Json& options = format.at("options");
      const bool acts = std::find(options.begin(), options.end(), option) != options.end();
      EXPECT_EQ(refuses(name, option, value), !acts) << extension << " --" << option;
    }
  }
}

TEST_F(Formats, EveryOptionActsOnASurfaceOrIsRefusedByName) {
  write_y("y.swc");
  for (const Json& format : listed().at("surface")) {
    if (!format.at("written") || !format.at("read")) continue;
    const std::string name = "@tree" + format.at("extensions").at(0).get<std::string>();
    ASSERT_EQ(vmesh({"cones", "@y.swc", "-o", name, "-q"}).exit_code, 0);
    for (const auto& [option, value] : kOptions)
      EXPECT_EQ(refuses(name, option, value), option != "unit" && option != "space") << name << " --" << option;
  }
}

TEST_F(Formats, EveryOptionActsOnAnImageOrIsRefusedByName) {
  for (const Json& format : listed().at("image")) {
    if (format.at("extensions").empty()) continue;
    const std::string name = "@liver" + format.at("extensions").at(0).get<std::string>();
    write(name.substr(1), "nothing of use");
    const Json& options = format.at("options");
    for (const auto& [option, value] : kOptions) {
      const bool acts = std::find(options.begin(), options.end(), option) != options.end();
      EXPECT_EQ(refuses(name, option, value), !acts) << name << " --" << option;
    }
  }
}

TEST_F(Formats, AnOptionForAFileThatIsNotGivenIsRefused) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"cones", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
  for (const char* option : {"--centerline-radius", "--reference-unit"}) {
    const Outcome run = vmesh({"evaluate", "@y.ply", option, std::string_view(option).ends_with("unit") ? "mm" : "2"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find(option), std::string::npos) << run.err;
  }
}

TEST_F(Formats, PlainJsonHasNoRadiusArray) {
  write("tree.json", R"({"schema": "vmesh.centerline/1", "nodes": [[0,0,0,2], [9,0,0,2]], "segments": [[0,1]]})");
  ASSERT_EQ(vmesh({"info", "@tree.json"}).exit_code, 0);
  const Outcome run = vmesh({"info", "@tree.json", "--radius-array", "Radius"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--radius-array does not apply"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vmesh::testing
