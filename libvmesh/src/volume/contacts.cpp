#include "vmesh/volume/contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "volume/contact_pairs.h"

namespace vmesh {
namespace {

std::vector<Index> branch_of_cones(const ConeAxes& cones) {
  std::vector<Index> branch_of(cones.cone_count(), kNone);
  const BranchTable branches(cones.centerline());
  for (Index b = 0; b < branches.size(); ++b) {
    for (const Index s : branches.segments(b)) branch_of[s] = b;
  }
  return branch_of;
}

Contact contact_at(const ConeAxes& cones, const ContactPair& pair) {
  const double r = cones.radius_at(pair.i, pair.closest.s), q = cones.radius_at(pair.j, pair.closest.t);
  const Vec3 from = cones.axis_point(pair.i, pair.closest.s), to = cones.axis_point(pair.j, pair.closest.t);
  const double distance = pair.closest.distance;
  Contact contact;
  contact.depth = r + q - distance;
  contact.position = distance > 0 ? Vec3(from + (distance + r - q) / (2 * distance) * (to - from)) : from;
  contact.sides[0] = {pair.i, pair.closest.s, kNone, r};
  contact.sides[1] = {pair.j, pair.closest.t, kNone, q};
  return contact;
}

}  // namespace

std::vector<Contact> find_contacts(const ConeRelations& cones, double gap) {
  if (!(gap >= 0 && gap <= 1)) throw InvalidInput("gap must be in [0, 1]");
  return contacts_of(ConeAxes(cones.centerline()), find_contact_pairs(cones, gap));
}

std::vector<Contact> contacts_of(const ConeAxes& cones, const std::vector<ContactPair>& pairs) {
  std::vector<Contact> contacts;
  for (const ContactPair& pair : pairs) {
    Contact contact = contact_at(cones, pair);
    if (pair.region == contacts.size()) {
      contacts.push_back(contact);
    } else if (contact.depth > contacts[pair.region].depth) {
      contact.cone_pairs = contacts[pair.region].cone_pairs;
      contacts[pair.region] = contact;
    }
    ++contacts[pair.region].cone_pairs;
  }
  if (contacts.empty()) return contacts;
  const std::vector<Index> branch_of = branch_of_cones(cones);
  for (Contact& contact : contacts) {
    for (ContactSide& side : contact.sides) side.branch = branch_of[side.segment];
  }
  std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
    if (a.depth != b.depth) return a.depth > b.depth;
    return std::tie(a.sides[0].segment, a.sides[1].segment) < std::tie(b.sides[0].segment, b.sides[1].segment);
  });
  return contacts;
}

std::string describe(const Contact& contact) {
  const auto& [first, second] = contact.sides;
  return formatted("at (%.3f, %.3f, %.3f): segments %u and %u %s %.3g mm, %.0f %% of the radius", contact.position.x(),
                   contact.position.y(), contact.position.z(), first.segment, second.segment,
                   contact.depth >= 0 ? "overlap by" : "leave a gap of", std::abs(contact.depth),
                   100 * std::abs(contact.depth) / std::min(first.radius, second.radius));
}

}  // namespace vmesh
