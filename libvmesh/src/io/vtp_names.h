// Names of arrays in VTK's files and ours. Internal to the module.
#pragma once

#include <array>
#include <string>
#include <utility>

namespace vmesh::io {

constexpr std::array<std::pair<const char*, const char*>, 3> kPointNames = {
    {{"radius", "MaximumInscribedSphereRadius"}, {"distance", "Distance"}, {"group", "GroupIds"}}};
constexpr std::array<std::pair<const char*, const char*>, 2> kCellNames = {
    {{"quality", "Quality"}, {"group", "GroupIds"}}};

template <std::size_t N>
std::string to_vtk(const std::array<std::pair<const char*, const char*>, N>& names, const std::string& name) {
  for (const auto& [ours, theirs] : names) {
    if (name == ours) return theirs;
  }
  return name;
}

template <std::size_t N>
std::string from_vtk(const std::array<std::pair<const char*, const char*>, N>& names, const std::string& name) {
  for (const auto& [ours, theirs] : names) {
    if (name == theirs) return ours;
  }
  return name;
}

}  // namespace vmesh::io
