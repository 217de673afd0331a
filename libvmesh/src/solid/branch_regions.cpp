#include "vmesh/solid/branch_regions.h"

#include <map>

#include "vmesh/core/error.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

std::vector<Index> branches_of_cells(const VolumeMesh& mesh, const Centerline& centerline) {
  const VesselField field(centerline);
  const std::vector<Index> branch_of_cone = branch_label_of_cones(centerline);
  std::vector<Index> branches;
  branches.reserve(mesh.cell_count());
  for_each_cell(mesh, [&](const auto& cell) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : cell) middle += mesh.points.at(v) / static_cast<double>(cell.size());
    branches.push_back(branch_of_cone[field.sample_global(middle).cone]);
  });
  return branches;
}

void divide_regions(VolumeMesh& mesh, const std::vector<Index>& branch) {
  if (branch.size() != mesh.cell_count() || mesh.cell_region.size() != mesh.cell_count())
    throw InvalidInput("dividing regions: there are " + std::to_string(mesh.cell_count()) + " cells, " +
                       std::to_string(mesh.cell_region.size()) + " regions of cells and " +
                       std::to_string(branch.size()) + " branches; every cell needs one of each");
  std::map<std::pair<Index, Index>, Index> number;  // of a region and a branch
  for (std::size_t c = 0; c < branch.size(); ++c) number[{mesh.cell_region[c], branch[c]}] = 0;
  std::vector<std::string> names;
  for (auto& [part, i] : number) {
    i = static_cast<Index>(names.size());
    names.push_back(mesh.region_names.at(part.first) + "_" + std::to_string(part.second));
  }
  for (std::size_t c = 0; c < branch.size(); ++c) mesh.cell_region[c] = number.at({mesh.cell_region[c], branch[c]});
  mesh.region_names = std::move(names);
}

}  // namespace vmesh
