#include "vmesh/surface/error_bound.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "surface/check/triangle_test.h"

namespace vmesh {
namespace {

// Subdivisions of a face's edges in its shell: more follow the normals more closely; safe 2 to 3, below not sound,
// vertices +5 %.
constexpr int kPieces = 2;
// Heights of a corner that are tried, in limits: each is kLowerShell times the last, down to kLowestShell; kLowerShell:
// idle 0.42 to 0.84; kLowestShell: idle 0.028 to 0.056.
constexpr double kLowerShell = 0.6, kLowestShell = 0.04;
// Each bends the corners of faces that the last left unproven; one or two usually suffice; idle 3 to 6.
constexpr int kBendRounds = 4;

using Points = TrianglePoints;

// The cones that can be nearest or blended with the nearest within `radius` of `center`.
void find_cones(const VesselField& field, const Vec3& center, double radius, Index hint, std::vector<Index>& cones) {
  const Index nearest = field.sample(center, hint).cone;
  const double least = field.sample_cone(center, nearest).distance;
  field.local_cones_near(center, nearest, least + 2 * radius, cones);
  std::erase_if(cones, [&](Index cone) {
    const double widest = std::max(field.relations().radius_at(cone, 0), field.relations().radius_at(cone, 1));
    return field.sample_cone(center, cone).distance - least >= 2 * radius + 2 * field.relations().blend() * widest;
  });
}

void find_cones(const VesselField& field, const ErrorProof::Face& face, const std::array<double, 3>& heights,
                std::vector<Index>& cones) {
  const TrianglePoints corners = {face[0].position, face[1].position, face[2].position};
  const Vec3 center = triangle_center(corners);
  find_cones(field, center, triangle_reach(corners, center) + *std::max_element(heights.begin(), heights.end()),
             face[0].cone, cones);
}

// One side of a face's shell, on a grid of kPieces along each edge. Points on an edge depend on its ends alone. Heights
// and normals are interpolated, to follow the boundary around a vessel, but where a corner is bent the ways of corners:
// out of a notch, one may be many times as long as the other and across it.
std::vector<Points> shell(const ErrorProof::Face& face, const std::array<double, 3>& heights, double side) {
  const auto point = [&](int i, int j) {
    const double w[3] = {1 - double(i + j) / kPieces, double(i) / kPieces, double(j) / kPieces};
    Vec3 position = Vec3::Zero(), normal = Vec3::Zero(), way = Vec3::Zero();
    double height = 0;
    bool is_bent = false;
    for (int k = 0; k < 3; ++k) {
      position += w[k] * face[k].position;
      normal += w[k] * face[k].normal;
      way += w[k] * heights[k] * face[k].normal;
      height += w[k] * heights[k];
      is_bent = is_bent || (w[k] > 0 && face[k].is_bent);
    }
    return Vec3(position + side * (is_bent ? way : Vec3(height * normal.normalized())));
  };
  std::vector<Points> parts;
  for (int i = 0; i < kPieces; ++i) {
    for (int j = 0; i + j < kPieces; ++j) {
      parts.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + j + 2 <= kPieces) parts.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  return parts;
}

bool copy_holds(const VesselField& field, const ErrorProof::Face& face, const std::array<double, 3>& heights,
                ErrorProof::Side side, const std::vector<Index>& cones) {
  const std::vector<Points> parts = shell(face, heights, side == ErrorProof::Side::inner ? -1 : 1);
  return side == ErrorProof::Side::inner ? are_inside(field, parts, cones) : are_outside(field, parts, cones);
}

std::array<double, 3> heights_of(const ErrorProof::Face& face, double share) {
  return {share * face[0].limit, share * face[1].limit, share * face[2].limit};
}

double& share(ErrorProof::Shares& shares, ErrorProof::Side side) {
  return side == ErrorProof::Side::inner ? shares.inner : shares.outer;
}

double sign_of(ErrorProof::Side side) { return side == ErrorProof::Side::inner ? -1 : 1; }

// One side of the shell of a whole surface. Where the proof fails along the normals, the shell is bent.
class BentCopy {
 public:
  BentCopy(const ErrorProof& proof, const VesselField& field, ErrorProof::Side side,
           const std::vector<ErrorProof::Corner>& vertices, const std::vector<Triangle>& faces,
           const std::vector<ErrorProof::Shares>& shares)
      : proof_(proof), field_(field), side_(side), corners_(vertices), faces_(faces), bent_(vertices.size()) {
    for (const ErrorProof::Corner& corner : vertices) heights_.push_back(corner.limit);
    std::vector<Index> lowered;
    for (Index f = 0; f < faces.size(); ++f) {
      ErrorProof::Shares own = shares[f];
      const double s = share(own, side);
      if (s == 0) open_.push_back(f);
      for (const Index v : faces[f]) {
        if (s > 0) heights_[v] = std::min(heights_[v], s * vertices[v].limit);
      }
    }
    for (Index f = 0; f < faces.size(); ++f) {
      ErrorProof::Shares own = shares[f];
      const double s = share(own, side);
      if (s > 0 && heights(f) != heights_of(ErrorProof::face_of(corners_, faces[f]), s)) lowered.push_back(f);
    }
    keep_open(lowered);
  }

  // Bends the shell; returns the faces that remain unproven.
  std::vector<Index> open() {
    for (int round = 0; round < kBendRounds && !open_.empty(); ++round) {
      bool any = false;
      for (const Index f : open_) {
        for (const Index v : faces_[f]) any = bend(v) || any;
      }
      if (!any) break;
      std::vector<Index> touched;
      for (Index f = 0; f < faces_.size(); ++f) {
        if (std::any_of(faces_[f].begin(), faces_[f].end(), [&](Index v) { return bent_[v] != 0; }))
          touched.push_back(f);
      }
      open_.clear();
      keep_open(touched);
    }
    return open_;
  }

 private:
  std::array<double, 3> heights(Index f) const {
    return {heights_[faces_[f][0]], heights_[faces_[f][1]], heights_[faces_[f][2]]};
  }

  // Adds those of `faces` that are not proven to the open ones.
  void keep_open(const std::vector<Index>& faces) {
    std::vector<char> holds(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
      holds[i] = proof_.holds(ErrorProof::face_of(corners_, faces_[faces[i]]), heights(faces[i]), side_);
    });
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!holds[i]) open_.push_back(faces[i]);
    }
  }

  // Moves the corner to where it gets farthest from the boundary. Returns false if it was bent before.
  bool bend(Index v) {
    if (bent_[v]) return false;
    bent_[v] = 1;
    ErrorProof::Corner& corner = corners_[v];
    corner.is_bent = true;
    const double sign = sign_of(side_);
    const Vec3 normal = corner.normal;
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Vec3& direction : directions(corner.position, normal, corner.limit, corner.cone)) {
      for (double s = 1; s > kLowestShell; s *= kLowerShell) {
        const double height = s * corner.limit;
        const double away = sign * field_.sample(corner.position + sign * height * direction, corner.cone).distance;
        if (away <= farthest) continue;
        farthest = away;
        corner.normal = direction;
        heights_[v] = height;
      }
    }
    return true;
  }

  // Directions away from each cone nearby, and between any two of these.
  std::vector<Vec3> directions(const Vec3& p, const Vec3& normal, double limit, Index hint) const {
    std::vector<Vec3> gradients;
    const FieldSample sample = field_.sample(p, hint);
    const double nearest = field_.sample_cone(p, sample.cone).distance;
    for (const Index cone : field_.relations().local_cones(sample.cone)) {
      const FieldSample s = field_.sample_cone(p, cone);
      if (s.distance < nearest + 2 * limit) gradients.push_back(s.gradient);
    }
    std::vector<Vec3> result = {normal};
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      result.push_back(gradients[i]);
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 middle = gradients[i] + gradients[j];
        if (middle.squaredNorm() > 0) result.push_back(middle.normalized());
      }
    }
    return result;
  }

  const ErrorProof& proof_;
  const VesselField& field_;
  ErrorProof::Side side_;
  std::vector<ErrorProof::Corner> corners_;
  const std::vector<Triangle>& faces_;
  std::vector<double> heights_;
  std::vector<char> bent_;
  std::vector<Index> open_;
};

}  // namespace

bool ErrorProof::holds(const Face& face, const std::array<double, 3>& heights, Side side) const {
  thread_local std::vector<Index> cones;
  find_cones(field_, face, heights, cones);
  return copy_holds(field_, face, heights, side, cones);
}

ErrorProof::Shares ErrorProof::shares(const Face& face, const Shares& least) const {
  thread_local std::vector<Index> cones;
  const std::array<double, 3> highest = heights_of(face, 1);
  find_cones(field_, face, highest, cones);
  Shares result;
  for (const Side side : {Side::inner, Side::outer}) {
    const double lowest = side == Side::inner ? least.inner : least.outer;
    if (lowest <= 1 && copy_holds(field_, face, highest, side, cones)) share(result, side) = 1;
    for (double s = kLowerShell; s > kLowestShell && s >= lowest && share(result, side) == 0; s *= kLowerShell) {
      if (holds(face, heights_of(face, s), side)) share(result, side) = s;
    }
  }
  return result;
}

std::vector<Index> ErrorProof::unproven(const std::vector<Corner>& vertices, const std::vector<Triangle>& faces,
                                        const std::vector<Shares>& shares) const {
  std::vector<char> proven(faces.size(), 1);
  for (const Side side : {Side::inner, Side::outer}) {
    std::vector<double> height(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) height[v] = vertices[v].limit;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      Shares own = shares[f];
      if (share(own, side) == 0) proven[f] = 0;
      for (const Index v : faces[f]) {
        if (proven[f]) height[v] = std::min(height[v], share(own, side) * vertices[v].limit);
      }
    }
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t f) {
      if (!proven[f]) return;
      Shares own = shares[f];
      const Face face = face_of(vertices, faces[f]);
      const std::array<double, 3> heights = {height[faces[f][0]], height[faces[f][1]], height[faces[f][2]]};
      if (heights != heights_of(face, share(own, side))) proven[f] = holds(face, heights, side);
    });
  }
  std::vector<Index> result;
  for (Index f = 0; f < proven.size(); ++f) {
    if (!proven[f]) result.push_back(f);
  }
  return result;
}

std::vector<Index> ErrorProof::unproven_if_bent(const std::vector<Corner>& vertices, const std::vector<Triangle>& faces,
                                                const std::vector<Shares>& shares) const {
  std::vector<Index> result;
  for (const Side side : {Side::inner, Side::outer}) {
    const std::vector<Index> open = BentCopy(*this, field_, side, vertices, faces, shares).open();
    result.insert(result.end(), open.begin(), open.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace vmesh
