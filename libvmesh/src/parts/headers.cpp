#include "parts/headers.h"

namespace vmesh {

using nlohmann::json;

namespace {

json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Vec3 point_of(const json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

}  // namespace

json to_json(const GrowthSimplification& note) {
  return {{"kind", static_cast<int>(note.kind)},
          {"position", to_json(note.position)},
          {"nodes", note.nodes},
          {"segments", note.segments},
          {"message", note.message}};
}

GrowthSimplification note_of(const json& j) {
  const int kind = j.at("kind").get<int>();
  if (kind < 0 || kind > static_cast<int>(GrowthSimplification::Kind::filled_loop))
    throw InvalidInput("a note is of no known kind");
  return {static_cast<GrowthSimplification::Kind>(kind), point_of(j.at("position")),
          j.at("nodes").get<std::vector<Index>>(), j.at("segments").get<std::vector<Index>>(),
          j.at("message").get<std::string>()};
}

Index around_of(const json& j) {
  const Index around = j.get<Index>();
  if (!(around >= 3 && around <= 200)) throw InvalidInput("the number of vertices around a vessel is out of range");
  return around;
}

}  // namespace vmesh
