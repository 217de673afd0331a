#include "vmesh/centerline/centerline.h"

#include <utility>

#include "vmesh/centerline/validation.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

constexpr std::size_t kMaxListedProblems = 20;

std::string describe(const std::vector<CenterlineProblem>& problems) {
  std::string text =
      "not a valid centerline: " + std::to_string(problems.size()) + (problems.size() == 1 ? " problem" : " problems");
  for (std::size_t i = 0; i < problems.size() && i < kMaxListedProblems; ++i) text += "\n  " + problems[i].message;
  if (problems.size() > kMaxListedProblems) {
    text += "\n  ... and " + std::to_string(problems.size() - kMaxListedProblems) + " more";
  }
  return text;
}

}  // namespace

Centerline::Centerline(std::vector<CenterlineNode> nodes, std::vector<CenterlineSegment> segments)
    : nodes_(std::move(nodes)), segments_(std::move(segments)) {
  const auto problems = validate(nodes_, segments_);
  if (!problems.empty()) throw InvalidInput(describe(problems));
  index_incidence();
  number_components();
}

void Centerline::index_incidence() {
  offsets_.assign(nodes_.size() + 1, 0);
  for (const auto& s : segments_) {
    ++offsets_[s.a + 1];
    ++offsets_[s.b + 1];
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) offsets_[n + 1] += offsets_[n];
  incidence_.resize(2 * segments_.size());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (Index s = 0; s < segments_.size(); ++s) {
    incidence_[next[segments_[s].a]++] = s;
    incidence_[next[segments_[s].b]++] = s;
  }
}

void Centerline::number_components() {
  component_.assign(nodes_.size(), kNone);
  std::vector<Index> stack;
  for (Index root = 0; root < nodes_.size(); ++root) {
    if (component_[root] != kNone) continue;
    const auto number = static_cast<Index>(component_count_++);
    component_[root] = number;
    stack.push_back(root);
    while (!stack.empty()) {
      const Index n = stack.back();
      stack.pop_back();
      for (const Index s : incident_segments(n)) {
        const Index m = other_node(s, n);
        if (component_[m] != kNone) continue;
        component_[m] = number;
        stack.push_back(m);
      }
    }
  }
}

double Centerline::length_in_radii() const {
  double sum = 0;
  for (Index s = 0; s < segments_.size(); ++s) sum += length(s) / radius_at(s, 0.5);
  return sum;
}

}  // namespace vmesh
