#include "vmesh/production/notes.h"

#include <algorithm>

namespace vmesh {
namespace {

constexpr std::size_t kNamed = 5;  // places, in a warning

std::vector<std::string> notes_on_left(const std::vector<Contact>& left) {
  std::vector<std::string> notes;
  for (std::size_t c = 0; c < std::min(kNamed, left.size()); ++c)
    notes.push_back("vessels still touch " + describe(left[c]) +
                    "; neither narrowing nor a small move can part them: move nodes of one, or join them if they are "
                    "one vessel");
  if (left.size() > kNamed) notes.push_back("vessels still touch in " + counted(left.size(), "place"));
  return notes;
}

}  // namespace

std::string counted(std::size_t count, const std::string& word, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? word : many.empty() ? word + "s" : many);
}

std::vector<std::string> notes_on(const PreparedCenterline& prepared) {
  if (prepared.separated) return notes_on_left(prepared.separated->report.left);
  const std::vector<Contact>& contacts = prepared.contacts();
  if (contacts.empty()) return {};
  return {"vessels that are not neighbours touch in " + counted(contacts.size(), "place") + ", the deepest " +
          describe(contacts.front()) +
          "; there the surface intersects itself (overlap=\"separate\", the default, moves them apart)"};
}

std::vector<std::string> notes_on(const ErrorSummary& error, const ErrorLimit& limit) {
  if (error.unproven_faces == 0) return {};
  return {"the surface may be farther than " + to_string(limit) + " from the boundary, or the boundary from it, at " +
          counted(error.unproven_faces, "face") + " in " + counted(error.unproven_places.size(), "place") +
          ": triangles are already as small as allowed; allow a larger error there, or check the radii"};
}

}  // namespace vmesh
