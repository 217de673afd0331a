#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"

namespace vmesh::io {

/// Whether the document is a graph in the node-link form of networkx.
bool is_node_link(const nlohmann::json& document);

/// Such a graph. Throws InvalidInput.
RawCenterline read_node_link(const nlohmann::json& document, const std::string& source,
                             const CenterlineReadOptions& options);

}  // namespace vmesh::io
