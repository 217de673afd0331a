// What is done to a triangle soup before its connections are looked at, internal to the module.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// A side of a face at an edge.
struct EdgeSide {
  Index low, high;  ///< the edge's vertices
  Index side;       ///< 3 f + i, see Mates
};

/// The sides of all faces, those of an edge adjacent, ascending.
std::vector<EdgeSide> sides_by_edge(const TriMesh& mesh);

/// Calls visit(span of sides) for every edge.
template <class Visit>
void visit_edges(const std::vector<EdgeSide>& sides, Visit&& visit) {
  for (std::size_t i = 0, next; i < sides.size(); i = next) {
    for (next = i + 1; next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high;
         ++next) {
    }
    visit(std::span(sides).subspan(i, next - i));
  }
}

double area_of(const TriMesh& mesh);

/// The diagonal of the box around the vertices.
double extent_of(const TriMesh& mesh);

/// Keeps the faces that are marked.
void keep_faces(TriMesh& mesh, const std::vector<bool>& kept);

/// Without equal vertices and faces that do not have three; of duplicate faces one is left, or none where they divide a
/// volume from its neighbour. What was done is appended to `notes`.
TriMesh cleaned_soup(const TriMesh& surface, std::vector<std::string>& notes);

/// Leaves out fins: patches in one piece with a single border, part of which is an edge of others.
void drop_fins(TriMesh& mesh, std::vector<std::string>& notes);

/// Leaves out the faces at edges with an odd number of them, three or more, if those edges are few and scattered: the
/// holes are closed later.
void cut_out_odd_edges(TriMesh& mesh, std::vector<std::string>& notes);

}  // namespace vmesh::skeleton
