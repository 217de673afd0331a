#pragma once

#include <algorithm>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Items sorted by a vertex of each, then by `less` among those of one vertex; linear time if vertices have few items.
/// visit_items(visit) calls visit(vertex, item) for all items, with vertex < `vertices`; it is called twice.
template <class Item, class VisitItems, class Less>
std::vector<Item> sorted_by_vertex(std::size_t vertices, VisitItems&& visit_items, Less&& less) {
  std::vector<std::size_t> end(vertices + 1, 0);  // of a vertex's items; during filling, of those present so far
  visit_items([&](Index vertex, const Item&) { ++end[vertex + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<Item> items(end.back());
  visit_items([&](Index vertex, const Item& item) { items[end[vertex]++] = item; });
  std::size_t first = 0;
  for (std::size_t v = 0; v < vertices; first = end[v++]) {
    std::sort(items.begin() + first, items.begin() + end[v], less);
  }
  return items;
}

}  // namespace vmesh
