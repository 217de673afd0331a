#pragma once

#include "page/page.h"
#include "report/summary.h"

namespace vmesh::tool {

/// What the script of a page reads. Schema "vmesh.page/1".
Json to_json(const Page& page);

}  // namespace vmesh::tool
