#include "vmesh/image/contour.h"

#include <bit>
#include <limits>

#include <tbb/parallel_for.h>

#include "vmesh/core/error.h"

#include "image/cell_surface.h"
#include "image/level_samples.h"

namespace vmesh {
namespace {

constexpr int kAxes = 3;

/// Numbers of vertices. Every row of samples (along the first axis) has its vertices one after the other: those on
/// edges along the first axis, then the second, then the third, each in the order of samples.
class VertexNumbers {
 public:
  explicit VertexNumbers(const LevelSamples& samples) : rows_(samples.size()[1]) {
    first_.assign(rows_ * samples.size()[2] + 1, {});
    tbb::parallel_for(std::size_t{0}, samples.size()[2], [&](std::size_t k) {
      for (std::size_t j = 0; j < rows_; ++j) count_row(samples, j, k);
    });
    std::size_t sum = 0;
    for (auto& row : first_)
      for (Index& axis : row) {
        const std::size_t count = axis;
        axis = static_cast<Index>(sum);
        sum += count;
        if (sum >= std::numeric_limits<Index>::max()) throw InvalidInput("the contour has more than 2^32 vertices");
      }
  }

  std::size_t count() const { return first_.back()[0]; }
  /// The number of the first vertex on an edge along `axis` from a sample of the row.
  Index first(std::size_t j, std::size_t k, int axis) const { return first_[k * rows_ + j][axis]; }

 private:
  void count_row(const LevelSamples& samples, std::size_t j, std::size_t k);

  std::size_t rows_;
  std::vector<std::array<Index, kAxes>> first_;
};

/// One word of a row moved by one sample: bit i is that of sample i + 1.
std::uint64_t moved(const std::uint64_t* row, std::size_t word, std::size_t words) {
  return row[word] >> 1 | (word + 1 < words ? row[word + 1] << 63 : 0);
}

/// Edges from samples of a row along every axis that cross the surface, a word of them at a time. The last sample of
/// every axis is on the border: outside like what would come after it.
class CrossingEdges {
 public:
  CrossingEdges(const LevelSamples& samples, std::size_t j, std::size_t k)
      : words_(samples.words_per_row()),
        row_(samples.inside_row(j, k)),
        next_row_(j + 1 < samples.size()[1] ? samples.inside_row(j + 1, k) : row_),
        next_slice_(k + 1 < samples.size()[2] ? samples.inside_row(j, k + 1) : row_) {}

  std::array<std::uint64_t, kAxes> word(std::size_t word) const {
    return {row_[word] ^ moved(row_, word, words_), row_[word] ^ next_row_[word], row_[word] ^ next_slice_[word]};
  }

 private:
  std::size_t words_;
  const std::uint64_t *row_, *next_row_, *next_slice_;
};

void VertexNumbers::count_row(const LevelSamples& samples, std::size_t j, std::size_t k) {
  const CrossingEdges edges(samples, j, k);
  for (std::size_t word = 0; word < samples.words_per_row(); ++word) {
    const auto crossing = edges.word(word);
    if ((crossing[0] | crossing[1] | crossing[2]) == 0) continue;
    for (int axis = 0; axis < kAxes; ++axis)
      first_[k * rows_ + j][axis] += static_cast<Index>(std::popcount(crossing[axis]));
  }
}

/// Where the surface crosses the edge along `axis` from a sample (LPS, mm), by linear interpolation. In sample
/// coordinates it is rounded to float, like the values.
Vec3 crossing_of_edge(const LevelSamples& samples, std::array<std::size_t, 3> at, int axis) {
  Vec3 position(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]));
  const float from = samples.value(at[0], at[1], at[2]);
  ++at[axis];
  const float to = samples.value(at[0], at[1], at[2]);
  const double share = -static_cast<double>(from) / static_cast<double>(to - from);
  position[axis] = static_cast<float>(position[axis] + share);
  return samples.position(position);
}

void place_vertices(const LevelSamples& samples, const VertexNumbers& numbers, std::vector<Vec3>& vertices) {
  const auto place_row = [&](std::size_t j, std::size_t k) {
    const CrossingEdges edges(samples, j, k);
    std::array<Index, kAxes> next;
    for (int axis = 0; axis < kAxes; ++axis) next[axis] = numbers.first(j, k, axis);
    for (std::size_t word = 0; word < samples.words_per_row(); ++word) {
      auto crossing = edges.word(word);
      for (int axis = 0; axis < kAxes; ++axis)
        for (std::uint64_t left = crossing[axis]; left != 0; left &= left - 1)
          vertices[next[axis]++] = crossing_of_edge(samples, {64 * word + std::countr_zero(left), j, k}, axis);
    }
  };
  tbb::parallel_for(std::size_t{0}, samples.size()[2], [&](std::size_t k) {
    for (std::size_t j = 0; j < samples.size()[1]; ++j) place_row(j, k);
  });
}

/// What a layer of cells adds to the mesh. Numbers of its inner vertices begin after those of all vertices on edges.
struct Layer {
  std::vector<Triangle> faces;
  std::vector<Vec3> inner;
};

/// The cells between the samples of slices k and k + 1.
class LayerMaker {
 public:
  LayerMaker(const LevelSamples& samples, const CellSurfaces& surfaces, const VertexNumbers& numbers,
             const std::vector<Vec3>& vertices, std::size_t k)
      : samples_(samples),
        surfaces_(surfaces),
        numbers_(numbers),
        vertices_(vertices),
        mirrored_(samples.steps().determinant() < 0),
        k_(k) {}

  Layer made() && {
    for (std::size_t j = 0; j + 1 < samples_.size()[1]; ++j) add_row(j);
    return std::move(layer_);
  }

 private:
  /// Rows of samples and edges around a row of cells: n counts j and k, the lower first.
  void add_row(std::size_t j) {
    for (int n = 0; n < 4; ++n) {
      const std::size_t row = j + (n & 1), slice = k_ + (n >> 1);
      rows_[n] = samples_.inside_row(row, slice);
      along_x_[n] = numbers_.first(row, slice, 0);
    }
    for (int n = 0; n < 2; ++n) {
      along_y_[n] = numbers_.first(j, k_ + n, 1);
      along_z_[n] = numbers_.first(j + n, k_, 2);
    }
    const std::size_t words = samples_.words_per_row();
    for (std::size_t word = 0; word < words; ++word) {
      std::uint64_t any = 0, all = ~std::uint64_t{0};
      for (int n = 0; n < 4; ++n) {
        near_[n] = rows_[n][word];
        far_[n] = moved(rows_[n], word, words);
        any |= near_[n] | far_[n];
        all &= near_[n] & far_[n];
      }
      for (std::uint64_t left = any & ~all; left != 0; left &= left - 1)
        add_cell(64 * word + std::countr_zero(left), j, std::countr_zero(left));
    }
  }

  void add_cell(std::size_t i, std::size_t j, int bit) {
    unsigned pattern = 0;
    for (int n = 0; n < 4; ++n)
      pattern |= static_cast<unsigned>((near_[n] >> bit & 1) | (far_[n] >> bit & 1) << 1) << 2 * n;
    const std::array<Index, kCellEdges> numbers = pass_edges(pattern);
    const auto as_pattern = static_cast<CellPattern>(pattern);
    const CellSurface* surface = surfaces_.without_values(as_pattern);
    if (!surface) surface = &surfaces_.with_values(as_pattern, values_of(i, j), room_);
    if (surface->inner.empty()) {
      for (const auto& [a, b, c] : surface->triangles) add_face(numbers[a], numbers[b], numbers[c]);
    } else {
      add_with_inner(*surface, numbers);
    }
  }

  /// The numbers of the vertices on the cell's edges, of which those from its first samples are passed. Those of edges
  /// without a vertex mean nothing.
  std::array<Index, kCellEdges> pass_edges(unsigned pattern) {
    std::array<Index, kCellEdges> numbers;
    const auto crosses = [&](int a, int b) { return (pattern >> a ^ pattern >> b) & 1; };
    for (int n = 0; n < 4; ++n) {
      numbers[n] = along_x_[n];
      along_x_[n] += crosses(2 * n, 2 * n + 1);
    }
    for (int n = 0; n < 2; ++n) {
      numbers[4 + 2 * n] = along_y_[n];
      numbers[5 + 2 * n] = along_y_[n] += crosses(4 * n, 4 * n + 2);
      numbers[8 + 2 * n] = along_z_[n];
      numbers[9 + 2 * n] = along_z_[n] += crosses(2 * n, 2 * n + 4);
    }
    return numbers;
  }

  CellValues values_of(std::size_t i, std::size_t j) const {
    CellValues values;
    for (int c = 0; c < kCellCorners; ++c) values[c] = samples_.value(i + (c & 1), j + (c >> 1 & 1), k_ + (c >> 2));
    return values;
  }

  void add_face(Index a, Index b, Index c) {
    if (mirrored_) std::swap(b, c);
    layer_.faces.push_back({a, b, c});
  }

  void add_with_inner(const CellSurface& surface, const std::array<Index, kCellEdges>& numbers) {
    const auto first = static_cast<Index>(vertices_.size() + layer_.inner.size());
    for (const auto& weights : surface.inner) {
      Vec3& vertex = layer_.inner.emplace_back(Vec3::Zero());
      for (int edge = 0; edge < kCellEdges; ++edge)
        if (weights[edge] > 0) vertex += weights[edge] * vertices_[numbers[edge]];
    }
    const auto number = [&](std::uint8_t corner) {
      return corner < kCellEdges ? numbers[corner] : first + (corner - kCellEdges);
    };
    for (const auto& [a, b, c] : surface.triangles) add_face(number(a), number(b), number(c));
  }

  const LevelSamples& samples_;
  const CellSurfaces& surfaces_;
  const VertexNumbers& numbers_;
  const std::vector<Vec3>& vertices_;
  bool mirrored_;
  std::size_t k_;
  Layer layer_;
  CellSurface room_;

  // Around the row of cells at hand: samples, the word at hand of them and of those after them, and the numbers of the
  // next vertices on edges along every axis.
  std::array<const std::uint64_t*, 4> rows_{};
  std::array<std::uint64_t, 4> near_{}, far_{};
  std::array<Index, 4> along_x_{};
  std::array<Index, 2> along_y_{}, along_z_{};
};

std::vector<Layer> make_layers(const LevelSamples& samples, const VertexNumbers& numbers,
                               const std::vector<Vec3>& vertices) {
  const CellSurfaces surfaces(samples.steps());
  std::vector<Layer> layers(samples.size()[2] - 1);
  tbb::parallel_for(std::size_t{0}, layers.size(),
                    [&](std::size_t k) { layers[k] = LayerMaker(samples, surfaces, numbers, vertices, k).made(); });
  return layers;
}

/// Puts the layers one after the other; each is emptied.
void join_layers(std::vector<Layer> layers, TriMesh& mesh) {
  std::size_t faces = 0;
  for (const Layer& layer : layers) faces += layer.faces.size();
  mesh.faces.reserve(faces);
  const auto on_edges = static_cast<Index>(mesh.vertices.size());
  for (Layer& layer : layers) {
    const auto before = static_cast<Index>(mesh.vertices.size() - on_edges);
    mesh.vertices.insert(mesh.vertices.end(), layer.inner.begin(), layer.inner.end());
    for (Triangle face : layer.faces) {
      for (Index& corner : face)
        if (corner >= on_edges) corner += before;
      mesh.faces.push_back(face);
    }
    layer = {};
  }
}

}  // namespace

TriMesh contour(const VoxelImage& image, double isovalue) {
  for (const std::size_t size : image.size)
    if (size == 0) throw InvalidInput("an image without voxels has no contour");
  const LevelSamples samples(image, isovalue);
  const VertexNumbers numbers(samples);
  TriMesh mesh;
  mesh.vertices.resize(numbers.count());
  place_vertices(samples, numbers, mesh.vertices);
  join_layers(make_layers(samples, numbers, mesh.vertices), mesh);
  if (mesh.faces.empty()) throw InvalidInput("there is nothing to contour: no voxel is inside");
  return mesh;
}

}  // namespace vmesh
