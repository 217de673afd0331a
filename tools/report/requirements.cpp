#include "report/requirements.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <sstream>

#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

enum class Needs { surface, reference, centerline };
enum class Kind { flag, at_most, at_least, equal };

/// A flag is met when the value is not 0.
struct Rule {
  const char* name;
  Kind kind;
  Needs needs;
  std::function<double(const EvaluationReport&)> value;
};

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

double least(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::min_element(values.begin(), values.end());
}

const std::vector<Rule>& rules() {
  using Report = const EvaluationReport&;
  static const std::vector<Rule> list = {
      {"closed", Kind::flag, Needs::surface, [](Report r) { return r.defects.topology.closed; }},
      {"manifold", Kind::flag, Needs::surface, [](Report r) { return r.defects.topology.manifold; }},
      {"oriented", Kind::flag, Needs::surface, [](Report r) { return r.defects.topology.oriented; }},
      {"outward", Kind::flag, Needs::surface, [](Report r) { return r.defects.topology.outward; }},
      {"no-self-intersections", Kind::flag, Needs::surface,
       [](Report r) { return r.defects.self_intersections.empty(); }},
      {"no-degenerate-faces", Kind::flag, Needs::surface, [](Report r) { return r.defects.degenerate_faces.empty(); }},
      {"components", Kind::equal, Needs::surface,
       [](Report r) { return static_cast<double>(r.defects.topology.components); }},
      {"genus", Kind::equal, Needs::surface,
       [](Report r) {
         const Topology& t = r.defects.topology;
         return t.closed && t.manifold && t.oriented ? static_cast<double>(t.genus) : NAN;
       }},
      {"max-faces", Kind::at_most, Needs::surface, [](Report r) { return static_cast<double>(r.faces); }},
      {"max-skewness", Kind::at_most, Needs::surface, [](Report r) { return largest(r.measures.equiangle_skewness); }},
      {"mean-skewness", Kind::at_most, Needs::surface,
       [](Report r) { return summarize(r.measures.equiangle_skewness).mean; }},
      {"min-angle", Kind::at_least, Needs::surface, [](Report r) { return least(r.measures.min_angle_deg); }},
      {"hausdorff", Kind::at_most, Needs::reference, [](Report r) { return r.reference->hausdorff.upper(); }},
      {"hausdorff-to-reference", Kind::at_most, Needs::reference,
       [](Report r) { return r.reference->hausdorff.forward.upper; }},
      {"hausdorff-from-reference", Kind::at_most, Needs::reference,
       [](Report r) { return r.reference->hausdorff.backward.upper; }},
      {"mean-distance", Kind::at_most, Needs::reference,
       [](Report r) { return std::max(r.reference->forward.distance.mean, r.reference->backward.distance.mean); }},
      {"volume-distance", Kind::at_most, Needs::centerline,
       [](Report r) { return std::max(r.volume->distance.from_mesh.mm.max, r.volume->distance.from_volume.mm.max); }},
      {"mean-volume-distance", Kind::at_most, Needs::centerline,
       [](Report r) { return std::max(r.volume->distance.from_mesh.mm.mean, r.volume->distance.from_volume.mm.mean); }},
      {"relative-volume-distance", Kind::at_most, Needs::centerline,
       [](Report r) {
         return std::max(r.volume->distance.from_mesh.relative.max, r.volume->distance.from_volume.relative.max);
       }},
  };
  return list;
}

const Rule& rule_of(const std::string& name) {
  for (const Rule& rule : rules())
    if (name == rule.name) return rule;
  throw UsageError("--require: there is no requirement \"" + name + "\"; there are " + describe_requirements());
}

double parse_limit(const std::string& item, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError("--require: \"" + item + "\": \"" + text + "\" is not a number");
  return value;
}

Requirement parse_requirement(const std::string& item) {
  const std::size_t equals = item.find('=');
  Requirement requirement{item.substr(0, equals), std::nullopt};
  const Rule& rule = rule_of(requirement.name);
  if (equals != std::string::npos) requirement.value = parse_limit(item, item.substr(equals + 1));
  if (rule.kind == Kind::flag && requirement.value)
    throw UsageError("--require: \"" + item + "\": " + requirement.name + " takes no number");
  if (rule.kind != Kind::flag && !requirement.value)
    throw UsageError("--require: \"" + item + "\" needs a number: " + requirement.name + "=NUMBER");
  return requirement;
}

bool is_met(Kind kind, double found, double limit) {
  switch (kind) {
    case Kind::flag:
      return found != 0;
    case Kind::at_most:
      return found <= limit;
    case Kind::at_least:
      return found >= limit;
    case Kind::equal:
      return found == limit;
  }
  return false;
}

}  // namespace

std::vector<Requirement> parse_requirements(const std::string& list) {
  std::vector<Requirement> requirements;
  std::istringstream items(list);
  for (std::string item; std::getline(items, item, ',');) requirements.push_back(parse_requirement(item));
  return requirements;
}

void check_requirements_can_be_checked(const std::vector<Requirement>& requirements, bool with_reference,
                                       bool with_centerline) {
  for (const Requirement& requirement : requirements) {
    const Needs needs = rule_of(requirement.name).needs;
    if (needs == Needs::reference && !with_reference)
      throw UsageError("--require " + requirement.name + " needs a reference surface; give it with --reference");
    if (needs == Needs::centerline && !with_centerline)
      throw UsageError("--require " + requirement.name + " needs a vessel volume; give its --centerline");
  }
}

CheckedRequirement check_requirement(const Requirement& requirement, const EvaluationReport& report) {
  const Rule& rule = rule_of(requirement.name);
  const double found = rule.value(report), limit = requirement.value.value_or(0);
  const std::string words = std::isnan(found)         ? "not defined"
                            : rule.kind == Kind::flag ? (found != 0 ? "yes" : "no")
                                                      : format_number(found);
  const std::string text = requirement.value ? requirement.name + "=" + format_number(limit) : requirement.name;
  return {text, words, is_met(rule.kind, found, limit)};
}

std::string describe_requirements() {
  std::string text;
  for (const Rule& rule : rules()) {
    text += (text.empty() ? "" : ", ") + std::string(rule.name);
    if (rule.kind != Kind::flag) text += "=N";
  }
  return text;
}

}  // namespace vmesh::tool
