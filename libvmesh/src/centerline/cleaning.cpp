#include "vmesh/centerline/cleaning.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "cleaning_steps.h"

namespace vmesh {
namespace cleaning {
namespace {

constexpr std::size_t kMaxListedProblems = 20;

using Kind = CleaningAction::Kind;
using Element = CleaningAction::Element;

std::string number(double value) { return formatted("%g", value); }

constexpr double kLargest = 1e30;  // mm; larger lengths are refused for growth, and fourth powers are finite up to here

/// What is wrong with a flat end; empty if nothing is.
std::string problem_in(const RawCenterline& raw, const EndSection& section) {
  if (section.node >= raw.nodes.size()) return "there is no node with index " + std::to_string(section.node);
  if (std::string problem = problem_of(section); !problem.empty()) return problem;
  double size = std::max(section.center.cwiseAbs().maxCoeff(), radius_of(section));
  for (const Vec3& p : section.ring) size = std::max(size, p.cwiseAbs().maxCoeff());
  return size > kLargest ? number(size) + " mm is too much; check the unit" : "";
}

/// Problems that cleaning cannot mend.
std::vector<std::string> list_problems(const RawCenterline& raw) {
  std::vector<std::string> problems;
  for (Index n = 0; n < raw.nodes.size(); ++n) {
    const auto& [position, radius] = raw.nodes[n];
    if (!position.allFinite()) {
      problems.push_back(raw.name_of_node(n) +
                         ": the position is not finite (NaN or infinity); correct or remove the point");
    }
    if (!std::isfinite(radius)) {
      problems.push_back(
          raw.name_of_node(n) +
          ": the radius is not finite (NaN or infinity); correct it, or set it to 0 to have it interpolated");
    } else if (radius < 0) {
      problems.push_back(raw.name_of_node(n) + ": the radius " + number(radius) +
                         " is negative; correct it, or set it to 0 to have it interpolated");
    }
    const double size = std::max(position.cwiseAbs().maxCoeff(), radius);
    if (std::isfinite(size) && size > kLargest)
      problems.push_back(raw.name_of_node(n) + ": " + number(size) + " mm is too much; check the unit");
  }
  for (Index s = 0; s < raw.segments.size(); ++s) {
    const auto& [a, b] = raw.segments[s];
    if (a < raw.nodes.size() && b < raw.nodes.size()) continue;
    problems.push_back(raw.name_of_segment(s) + ": there is no node with index " +
                       std::to_string(a < raw.nodes.size() ? b : a) + "; the file has " +
                       std::to_string(raw.nodes.size()) + " nodes");
  }
  for (std::size_t i = 0; i < raw.end_sections.size(); ++i) {
    if (const std::string problem = problem_in(raw, raw.end_sections[i]); !problem.empty())
      problems.push_back((raw.source.empty() ? "" : raw.source + ": ") + "flat end " + std::to_string(i) + ": " +
                         problem);
  }
  return problems;
}

void check(const RawCenterline& raw) {
  const std::string prefix = raw.source.empty() ? "" : raw.source + ": ";
  if (raw.unit != LengthUnit::mm || raw.space != Space::lps) {
    throw InvalidInput(prefix + "a centerline must be in mm and LPS before it is cleaned (convert_to_internal)");
  }
  if (raw.nodes.empty()) throw InvalidInput(prefix + "it contains no point; give at least one point with a radius");
  if (raw.nodes.size() >= kNone || raw.segments.size() >= kNone) throw InvalidInput(prefix + "too many nodes");
  const auto problems = list_problems(raw);
  if (problems.empty()) return;
  std::string text = prefix + std::to_string(problems.size()) + (problems.size() == 1 ? " problem" : " problems");
  for (std::size_t i = 0; i < problems.size() && i < kMaxListedProblems; ++i) text += "\n  " + problems[i];
  if (problems.size() > kMaxListedProblems) {
    text += "\n  ... and " + std::to_string(problems.size() - kMaxListedProblems) + " more";
  }
  throw InvalidInput(text);
}

void remove_self_loops(Workspace& work) {
  for (Index s = 0; s < work.segments.size(); ++s) {
    if (work.segments[s].a != work.segments[s].b) continue;
    work.add(Kind::removed_self_loop, Element::segment, s,
             work.raw.name_of_segment(s) + ": it joins a node to itself; removed");
  }
}

/// Decimals of the grid to which positions and radii are rounded.
int grid_decimals(const std::vector<CenterlineNode>& nodes) {
  constexpr double kLeast = 1e-300;  // below, its ten-thousandth would be 0
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& node : nodes) {
    if (node.radius > 0) smallest = std::clamp(node.radius, kLeast, smallest);
  }
  if (!std::isfinite(smallest)) return 6;
  return std::max(6, -static_cast<int>(std::floor(std::log10(smallest * 1e-4))));
}

}  // namespace

Adjacency::Adjacency(std::size_t node_count, const std::vector<CenterlineSegment>& list)
    : offsets(node_count + 1, 0), segments(2 * list.size()) {
  for (const auto& [a, b] : list) {
    ++offsets[a + 1];
    ++offsets[b + 1];
  }
  for (std::size_t n = 0; n < node_count; ++n) offsets[n + 1] += offsets[n];
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  for (Index s = 0; s < list.size(); ++s) {
    segments[next[list[s].a]++] = s;
    segments[next[list[s].b]++] = s;
  }
}

Workspace::Workspace(const RawCenterline& raw_centerline, const CleaningOptions& cleaning_options)
    : raw(raw_centerline),
      options(cleaning_options),
      nodes(raw.nodes),
      segments(raw.segments),
      raw_segment(raw.segments.size()),
      is_path_start(raw.nodes.size(), 0),
      merged(raw.nodes.size()) {
  std::iota(raw_segment.begin(), raw_segment.end(), Index{0});
  for (const Index s : raw.path_starts) {
    if (s < segments.size()) is_path_start[segments[s].a] = 1;
  }
}

void Workspace::merge(Index a, Index b) {
  a = merged.find(a);
  b = merged.find(b);
  if (!merged.join(a, b)) return;
  const auto [low, high] = std::minmax(a, b);
  if (nodes[low].radius <= 0) nodes[low].radius = nodes[high].radius;
}

void Workspace::compact() {
  std::size_t kept = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Index a = merged.find(segments[s].a), b = merged.find(segments[s].b);
    if (a == b) continue;
    segments[kept] = {a, b};
    raw_segment[kept++] = raw_segment[s];
  }
  segments.resize(kept);
  raw_segment.resize(kept);
}

namespace {

/// `x` rounded to that many decimals: the number that the rounded decimal text reads back as.
double round_decimal(double x, int decimals, double power) {
  const double scaled = x * power;
  if (std::abs(scaled) > 0x1p52) return x;
  const double whole = std::nearbyint(scaled);
  // Near a tie the rounding of the product could decide; means of decimal numbers are often ties.
  if (std::abs(std::abs(scaled - whole) - 0.5) > std::abs(scaled) * 0x1p-50) return whole / power + 0.0;
  std::array<char, 400> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed, decimals).ptr;
  double rounded = x;
  std::from_chars(text.data(), end, rounded);
  return rounded + 0.0;
}

}  // namespace

void round_to_grid(Workspace& work) {
  const int decimals = grid_decimals(work.nodes);
  if (decimals > 22) return;  // powers of ten are exact up to there
  const double power = std::pow(10.0, decimals);
  double largest_change = 0;
  const auto round = [&](double& x) {
    const double rounded = round_decimal(x, decimals, power);
    largest_change = std::max(largest_change, std::abs(rounded - x));
    x = rounded;
  };
  for (auto& [position, radius] : work.nodes) {
    for (double& x : position) round(x);
    round(radius);
  }
  if (largest_change == 0) return;
  work.add(Kind::rounded, Element::graph, kNone,
           (work.raw.source.empty() ? "" : work.raw.source + ": ") + "positions and radii rounded to " +
               number(1 / power) + " mm (largest change " + number(largest_change) + " mm)");
}

void contract_short_segments(Workspace& work) {
  for (std::size_t s = 0; s < work.segments.size(); ++s) {
    const Index a = work.merged.find(work.segments[s].a), b = work.merged.find(work.segments[s].b);
    if (a == b) continue;
    const double length = work.distance(a, b);
    if (length > work.tolerance(a, b)) continue;
    const auto [low, high] = std::minmax(a, b);
    work.add(Kind::contracted_segment, Element::segment, work.raw_segment[s],
             work.raw.name_of_segment(work.raw_segment[s]) + ": its length " + number(length) + " mm counts as zero; " +
                 work.raw.place_of_node(high) + " merged into " + work.raw.place_of_node(low));
    work.merge(a, b);
  }
  work.compact();
}

void remove_duplicate_segments(Workspace& work) {
  std::vector<Index> order(work.segments.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto key = [&](Index s) { return std::minmax(work.segments[s].a, work.segments[s].b); };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index s, Index t) { return std::pair<Index, Index>(key(s)) < std::pair<Index, Index>(key(t)); });
  std::vector<Index> first(work.segments.size());
  std::iota(first.begin(), first.end(), Index{0});
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (std::pair<Index, Index>(key(order[i])) == std::pair<Index, Index>(key(order[i - 1]))) {
      first[order[i]] = first[order[i - 1]];
    }
  }
  for (Index s = 0; s < first.size(); ++s) {
    if (first[s] == s) continue;
    work.add(Kind::removed_duplicate_segment, Element::segment, work.raw_segment[s],
             work.raw.name_of_segment(work.raw_segment[s]) + ": it joins the same nodes as " +
                 work.raw.place_of_segment(work.raw_segment[first[s]]) + "; removed");
  }
  std::size_t kept = 0;
  for (Index s = 0; s < first.size(); ++s) {
    if (first[s] != s) continue;
    work.segments[kept] = work.segments[s];
    work.raw_segment[kept++] = work.raw_segment[s];
  }
  work.segments.resize(kept);
  work.raw_segment.resize(kept);
}

}  // namespace cleaning

std::string_view to_string(CleaningAction::Kind kind) {
  constexpr std::array<std::string_view, 12> kNames = {"rounded",
                                                       "removed_self_loop",
                                                       "merged_trunk",
                                                       "merged_overlap",
                                                       "contracted_segment",
                                                       "merged_node",
                                                       "kept_crossing",
                                                       "removed_duplicate_segment",
                                                       "repaired_radius",
                                                       "joined_gap",
                                                       "joined_ends",
                                                       "dropped_end_section"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::size_t CleaningReport::count(CleaningAction::Kind kind) const {
  return static_cast<std::size_t>(
      std::count_if(actions.begin(), actions.end(), [kind](const auto& action) { return action.kind == kind; }));
}

std::vector<std::string> CleaningReport::summary() const {
  std::vector<std::string> lines;
  for (int k = 0; k <= static_cast<int>(CleaningAction::Kind::dropped_end_section); ++k) {
    const auto kind = static_cast<CleaningAction::Kind>(k);
    const auto first = std::find_if(actions.begin(), actions.end(), [kind](const auto& a) { return a.kind == kind; });
    if (first == actions.end()) continue;
    const std::size_t more = count(kind) - 1;
    std::string line = first->message;
    if (more > 0) line += " (and " + std::to_string(more) + " more of this kind: " + std::string(to_string(kind)) + ")";
    lines.push_back(std::move(line));
  }
  return lines;
}

CleanedCenterline clean(const RawCenterline& raw, const CleaningOptions& options) {
  using namespace cleaning;
  check(raw);
  Workspace work(raw, options);
  if (options.round) round_to_grid(work);
  remove_self_loops(work);
  merge_trunks(work);
  merge_overlaps(work);
  work.compact();
  contract_short_segments(work);
  merge_coincident_nodes(work);
  work.compact();
  remove_duplicate_segments(work);
  repair_radii(work);
  join_ends(work);
  if (options.join_gaps.value_or(raw.loose_branches)) join_gaps(work);
  CleanedCenterline cleaned = build(work);
  keep_end_sections(work, cleaned);
  return cleaned;
}

}  // namespace vmesh
