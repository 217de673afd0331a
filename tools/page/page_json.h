#pragma once

#include "page/page.h"
#include "report/summary.h"

namespace vmesh::tool {

/// The data read by the script of a page. Schema "vmesh.page/1".
Json to_json(const Page& page);

}  // namespace vmesh::tool
