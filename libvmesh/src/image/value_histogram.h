// How often values occur, internal to the module.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vmesh::image {

/// Counts of finite values with 16 significant bits; what has more is taken for the next such value nearer to 0. Takes
/// half a megabyte, and 2 kB for every 256 values beside each other that occur.
class ValueHistogram {
 public:
  ValueHistogram() : pages_(std::size_t{1} << 16) {}

  void add(float value, std::uint64_t count = 1);

  /// The least value that at least `fraction` of all do not exceed. Precondition: there are values.
  float quantile(double fraction) const;

 private:
  using Page = std::array<std::uint64_t, 256>;

  std::vector<std::unique_ptr<Page>> pages_;  ///< ascending
  std::uint64_t total_ = 0;
};

}  // namespace vmesh::image
