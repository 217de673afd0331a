#include <set>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::shared_data;

std::vector<std::filesystem::path> files_in(const std::string& folder, const std::string& extension) {
  std::set<std::filesystem::path> sorted;
  for (const auto& entry : std::filesystem::directory_iterator(shared_data(folder))) {
    if (entry.path().extension() == extension) sorted.insert(entry.path());
  }
  return {sorted.begin(), sorted.end()};
}

TEST(SharedData, SwcAndVtpOfALiverTreeAreTheSameCenterline) {
  VMESH_NEED_SHARED_DATA("liver_portal_centerlines");
  int pairs = 0;
  for (const auto& swc : files_in("liver_portal_centerlines", ".swc")) {
    SCOPED_TRACE(swc);
    const auto vtp = std::filesystem::path(swc).replace_extension(".vtp");
    ASSERT_TRUE(std::filesystem::exists(vtp));
    const auto from_swc = load_centerline(swc).cleaned.centerline;
    testing::expect_same(from_swc, load_centerline(vtp).cleaned.centerline);
    EXPECT_EQ(from_swc.component_count(), 1u);
    EXPECT_EQ(from_swc.cycle_rank(), 0u);
    ++pairs;
  }
  EXPECT_GE(pairs, 14);
}

TEST(SharedData, LooseBranchesAreJoinedLikeInTheJoinedFiles) {
  const std::string folder = "pulmonary_aorta_coronary_centerlines";
  VMESH_NEED_SHARED_DATA(folder);
  for (const auto& vtp : files_in(folder, ".vtp")) {
    SCOPED_TRACE(vtp);
    const auto joined = load_centerline(shared_data(folder + "/" + vtp.stem().string() + "_joined.swc")).cleaned;
    const auto ours = load_centerline(vtp).cleaned;
    EXPECT_EQ(ours.centerline.component_count(), joined.centerline.component_count());
    EXPECT_EQ(ours.centerline.nodes().size(), joined.centerline.nodes().size());
    EXPECT_EQ(ours.centerline.segments().size(), joined.centerline.segments().size());
    EXPECT_EQ(ours.centerline.cycle_rank(), 0u);
    EXPECT_GT(ours.report.count(CleaningAction::Kind::joined_gap), 0u);
  }
}

TEST(SharedData, RepeatedTrunksOfVmtkBecomeOneTree) {
  VMESH_NEED_SHARED_DATA("pairs_centerline_surface/aorta-centerline.vtp");
  for (const std::string name :
       {"aorta-centerline.vtp", "aorta-centerline-branches.vtp", "generate-1d-mesh_example_SU201_2005_RPA1_cl.vtp",
        "centerline-based-material-props_c++_aorta_cl.vtp"}) {
    SCOPED_TRACE(name);
    const auto cleaned = load_centerline(shared_data("pairs_centerline_surface/" + name)).cleaned;
    EXPECT_EQ(cleaned.centerline.component_count(), 1u);
    EXPECT_EQ(cleaned.centerline.cycle_rank(), 0u);
    EXPECT_GT(cleaned.report.count(CleaningAction::Kind::merged_trunk), 0u);
  }
}

TEST(SharedData, LoopsOfCapillariesStayLoops) {
  VMESH_NEED_SHARED_DATA("microvascular_loops/vasculature1_most_cyclic_component.vtp");
  const auto result = load_centerline(shared_data("microvascular_loops/vasculature1_most_cyclic_component.vtp"));
  EXPECT_EQ(result.cleaned.centerline.cycle_rank(), 8u);
  EXPECT_EQ(result.cleaned.centerline.component_count(), 1u);
}

TEST(SharedData, EveryNeuronIsReadOrRefusedWithAMessageThatNamesTheLine) {
  VMESH_NEED_SHARED_DATA("adversarial_swc_neurom");
  int read = 0;
  std::set<std::string> refused;
  for (const auto& path : files_in("adversarial_swc_neurom", ".swc")) {
    SCOPED_TRACE(path);
    try {
      const auto result = load_centerline(path);
      EXPECT_EQ(result.cleaned.centerline.cycle_rank(), 0u) << "SWC knows trees only";
      ++read;
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      testing::expect_contains(text, path.filename().string() + ": line ");
      refused.insert(path.filename().string());
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_EQ(refused,
            (std::set<std::string>{"Neuron_missing_ids.swc", "Neuron_missing_parents.swc", "repeated_id.swc"}));
}

}  // namespace
}  // namespace vmesh
