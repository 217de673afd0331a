// Small valid files of every format, made here.
#pragma once

#include <string>
#include <vector>

namespace vmesh::testing {

std::vector<std::string> swc_seeds();
std::vector<std::string> vmv_seeds();
std::vector<std::string> json_seeds();
std::vector<std::string> csv_seeds();
std::vector<std::string> vtk_seeds();
std::vector<std::string> vtp_seeds();
std::vector<std::string> ctgr_seeds();
std::vector<std::string> pth_seeds();
std::vector<std::string> gxl_seeds();
std::vector<std::string> amira_seeds();
std::vector<std::string> network_seeds();
std::vector<std::string> markups_seeds();

std::vector<std::string> surface_vtp_seeds();
std::vector<std::string> surface_vtk_seeds();
std::vector<std::string> ply_seeds();
std::vector<std::string> stl_seeds();
std::vector<std::string> obj_seeds();
std::vector<std::string> off_seeds();

std::vector<std::string> nii_seeds();
std::vector<std::string> nii_gz_seeds();
std::vector<std::string> nrrd_seeds();
std::vector<std::string> mha_seeds();

}  // namespace vmesh::testing
