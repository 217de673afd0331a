#include "quality/face_blocks.h"

#include <array>

namespace vmesh {
namespace {

constexpr int kBitsPerAxis = 10;
constexpr int kDigitBits = 10;

// The lowest ten bits of `x`, two zeros behind each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FFu;
  x = (x | x << 8) & 0x0300F00Fu;
  x = (x | x << 4) & 0x030C30C3u;
  return (x | x << 2) & 0x09249249u;
}

struct KeyedFace {
  std::uint32_t key;
  Index face;
};

// Sort keys along a Morton curve.
std::vector<KeyedFace> key_faces(const TriMesh& mesh, const Extent& extent) {
  constexpr double kCells = 1 << kBitsPerAxis;
  const double longest = (extent.high - extent.low).maxCoeff();
  const double scale = longest > 0 ? 0.999 * kCells / (3 * longest) : 0;
  std::vector<KeyedFace> faces;
  faces.reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 place = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c] - 3 * extent.low) * scale;
    const Eigen::Vector3i cell = place.cast<int>().cwiseMax(0);
    faces.push_back({spread(cell.x()) | spread(cell.y()) << 1 | spread(cell.z()) << 2, f});
  }
  return faces;
}

void radix_sort(std::vector<KeyedFace>& faces) {
  constexpr std::uint32_t kMask = (1u << kDigitBits) - 1;
  std::vector<KeyedFace> other(faces.size());
  for (int shift = 0; shift < 3 * kBitsPerAxis; shift += kDigitBits) {
    std::array<std::size_t, kMask + 2> start{};
    for (const KeyedFace& f : faces) ++start[(f.key >> shift & kMask) + 1];
    for (std::size_t digit = 1; digit < start.size(); ++digit) start[digit] += start[digit - 1];
    for (const KeyedFace& f : faces) other[start[f.key >> shift & kMask]++] = f;
    faces.swap(other);
  }
}

FaceBlock make_block(const TriMesh& mesh, const std::vector<Index>& order, Index first, Index last) {
  Vec3 low = mesh.vertices[mesh.faces[order[first]][0]], high = low;
  for (Index i = first; i < last; ++i) {
    for (const Index v : mesh.faces[order[i]]) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  }
  FaceBlock block{first, last, 0.5 * (low + high), 0};
  for (Index i = first; i < last; ++i) {
    for (const Index v : mesh.faces[order[i]]) {
      block.radius = std::max(block.radius, (mesh.vertices[v] - block.center).squaredNorm());
    }
  }
  block.radius = std::sqrt(block.radius);
  return block;
}

}  // namespace

FaceBlocks cut_into_blocks(const TriMesh& mesh, const Extent& extent, Index faces_per_block) {
  std::vector<KeyedFace> faces = key_faces(mesh, extent);
  radix_sort(faces);
  FaceBlocks result;
  result.order.reserve(faces.size());
  for (const KeyedFace& f : faces) result.order.push_back(f.face);
  const auto count = static_cast<Index>(faces.size());
  for (Index first = 0; first < count; first += std::min(faces_per_block, count - first)) {
    result.blocks.push_back(make_block(mesh, result.order, first, first + std::min(faces_per_block, count - first)));
  }
  return result;
}

}  // namespace vmesh
