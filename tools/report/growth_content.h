// What pages tell of a grown surface, those of the command and of the browser.
#pragma once

#include <cstddef>
#include <vector>

#include "vmesh/surface/deviation.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

#include "page/page.h"

namespace vmesh::tool {

/// Adds the distances of vertices to the vessels: in mm, and for each by its own radius. Caps and what goes on from
/// ends, from vertex `wall_vertices` on, are not of the wall.
void add_vessel_distances(const GenerateResult& result, const VesselField& field, std::size_t wall_vertices,
                          MeshAttributes& attributes);

/// Adds the facts of the distance between faces and vessels.
void add_facts_of(Page& page, const Deviation& deviation);

// These add places.
void add_defects(Page& page, const std::vector<Defect>& defects);
/// `surface` has what add_vessel_distances() adds.
void add_farthest_from_vessels(Page& page, const Deviation& deviation, const PageSurface& surface);
void add_unproven(Page& page, const ErrorSummary& error);
void add_contacts(Page& page, const std::vector<Contact>& contacts, const char* label);
/// Contacts that are left, and vessels that were moved.
void add_separation(Page& page, const SeparationReport& separation);

}  // namespace vmesh::tool
