// Small valid files of every format, made here.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace vmesh::testing {

using MakeSeeds = std::vector<std::string> (*)();

// By extension.
std::map<std::string, MakeSeeds> centerline_seeds();
std::map<std::string, MakeSeeds> surface_seeds();
std::map<std::string, MakeSeeds> volume_seeds();
std::map<std::string, MakeSeeds> image_seeds();

}  // namespace vmesh::testing
