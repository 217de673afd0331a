// A DICOM series becomes a surface in one command.
#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"

#include "../image/dicom_bytes.h"
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class DicomInputs : public CommandTest {
 protected:
  void write_series(const std::string& folder, const std::vector<double>& values, const DicomTags& tags = {}) const {
    std::filesystem::create_directories(path(folder));
    for (int k = 0; k < image_.size[2]; ++k)  // under names that do not follow their order
      write(folder + "/IM" + std::to_string(k * 7 % image_.size[2]), dicom_slice(image_, values, k, tags));
  }

  static std::vector<double> mask_of(std::vector<double> values) {
    for (double& value : values) value = value >= 200 ? 1 : 0;
    return values;
  }

  /// Runs it with these arguments; the surface is sound, of the vessels' size, and where they are.
  void expect_surface(std::vector<std::string> arguments) const {
    for (const char* more : {"--check", "--json", "@out.json", "-o", "@out.ply"}) arguments.emplace_back(more);
    const Outcome run = vmesh(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const LoadedSurface surface = read_surface(path("out.ply"));
    EXPECT_GT(surface.mesh.faces.size(), 100u);
    const Eigen::Matrix3d to_voxels = (image_.direction * image_.spacing.asDiagonal()).inverse();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : surface.mesh.vertices)
      middle += to_voxels * (v - image_.origin) / static_cast<double>(surface.mesh.vertices.size());
    EXPECT_LT((middle - Vec3(16, 17, 18)).cwiseAbs().maxCoeff(), 4) << middle;
  }

  SampleImage image_ = scan_place();
  const std::vector<double> values_ = scan_of_vessels(image_, true, false);
};

TEST_F(DicomInputs, AFolderIsGrownAndFitted) {
  write_series("ct", values_);
  expect_surface({"generate", "@ct", "--threshold", "200"});
  const auto summary = nlohmann::json::parse(read("out.json"));
  EXPECT_EQ(summary.at("input").at("sha256").get<std::string>().size(), 64u);
  EXPECT_EQ(summary.at("centerline").at("ends"), 3);
}

TEST_F(DicomInputs, ABentTubeHasTwoEnds) {
  write_series("ct", scan_of_vessels(image_, false, true));
  const Outcome run = vmesh({"generate", "@ct", "--threshold", "200", "--json", "@out.json", "-o", "@out.ply"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(read("out.json")).at("centerline").at("ends"), 2);
}

TEST_F(DicomInputs, AFileOfTheSeriesStandsForIt) {
  write_series("ct", values_);
  expect_surface({"generate", "@ct/IM5", "--threshold", "200"});
}

TEST_F(DicomInputs, AMaskAsASeriesOrASegmentation) {
  write_series("mask", mask_of(values_), {.series = "1.2.3.6", .intercept = 0});
  expect_surface({"generate", "@mask", "--label", "1", "--smooth", "1"});
  std::vector<SegmentFrame> frames;
  for (int k = 0; k < image_.size[2]; ++k) frames.push_back({1, k});
  write("seg.dcm", dicom_segmentation(image_, mask_of(values_), frames));
  expect_surface({"generate", "@seg.dcm", "--label", "1", "--smooth", "1"});
}

TEST_F(DicomInputs, ASeriesIsFittedToAMask) {
  write_series("ct", values_);
  write("mask.nii", nifti_file<std::int16_t>(image_, mask_of(values_)));
  write_series("mask", mask_of(values_), {.series = "1.2.3.6", .intercept = 0});
  ASSERT_EQ(vmesh({"centerline", "@ct", "--threshold", "200", "-o", "@tree.json"}).exit_code, 0);
  for (const char* mask : {"@mask", "@mask.nii"})
    expect_surface({"generate", "@tree.json", "--fit", mask, "--label", "1", "--smooth", "1"});
}

TEST_F(DicomInputs, AllVerbsThatTakeImagesTakeIt) {
  write_series("ct/", values_);
  EXPECT_EQ(vmesh({"reference", "@ct", "--threshold", "200", "-o", "@wall.ply"}).exit_code, 0);
  EXPECT_EQ(vmesh({"reference", "@ct/", "--threshold", "200", "-o", "@slash.ply"}).exit_code, 0);
  write("ct.nii", nifti_file<std::int16_t>(image_, values_));
  EXPECT_EQ(vmesh({"reference", "@ct.nii", "--threshold", "200", "-o", "@nifti.ply"}).exit_code, 0);
  const TriMesh dicom = read_surface(path("wall.ply")).mesh, nifti = read_surface(path("nifti.ply")).mesh;
  // The diagonals of squares may differ: NIfTI headers hold float.
  ASSERT_EQ(dicom.faces.size(), nifti.faces.size());
  ASSERT_EQ(dicom.vertices.size(), nifti.vertices.size());
  for (std::size_t v = 0; v < dicom.vertices.size(); ++v)
    EXPECT_LT((dicom.vertices[v] - nifti.vertices[v]).norm(), 1e-4);
}

TEST_F(DicomInputs, InfoDescribesItLikeTheSameImageInOneFile) {
  write_series("mask", mask_of(values_), {.series = "1.2.3.6", .intercept = 0});
  write("mask.nii", nifti_file<std::int16_t>(image_, mask_of(values_)));
  const auto described = [&](const std::string& input) {
    const Outcome run = vmesh({"info", input, "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(run.out);
  };
  const nlohmann::json dicom = described("@mask"), nifti = described("@mask.nii");
  EXPECT_EQ(dicom.at("kind"), "image");
  EXPECT_EQ(dicom.at("size_voxels"), nifti.at("size_voxels"));
  ASSERT_EQ(dicom.at("labels").size(), 1u);
  for (const char* key : {"value", "voxels", "components"})
    EXPECT_EQ(dicom.at("labels")[0].at(key), nifti.at("labels")[0].at(key)) << key;
  EXPECT_EQ(dicom.at("next")[0], "vmesh generate " + path("mask").string() + " --label 1 -o mask.ply");
}

TEST_F(DicomInputs, SeveralSeriesAreListed) {
  write_series("ct", values_, {.description = "first"});
  write("ct/other", dicom_slice(image_, values_, 0, {.series = "1.2.3.7", .description = "scout"}));
  const Outcome run = vmesh({"generate", "@ct", "--threshold", "200", "-o", "@out.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("2 DICOM series"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("\n  CT \"scout\", 1 slices"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("out.ply"));
}

TEST_F(DicomInputs, ASliceIsNotOverwritten) {
  write_series("ct", values_);
  std::filesystem::rename(path("ct/IM5"), path("ct/IM5.ply"));
  const Outcome run = vmesh({"reference", "@ct", "--threshold", "200", "-o", "@ct/IM5.ply"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("is an input"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vmesh::testing
