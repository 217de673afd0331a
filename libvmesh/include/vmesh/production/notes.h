// What users of a library should know of a surface, in words. The command has its own, which name its options.
#pragma once

#include <string>
#include <vector>

#include "vmesh/production/prepared_centerline.h"

namespace vmesh {

/// "1 node", "2 nodes"; `many`: an irregular plural.
std::string counted(std::size_t count, const std::string& word, const std::string& many = {});

/// Places where vessels touch: those left by separation, or those that were kept.
std::vector<std::string> notes_on(const PreparedCenterline& prepared);

/// Where the limit is not proven.
std::vector<std::string> notes_on(const ErrorSummary& error, const ErrorLimit& limit);

}  // namespace vmesh
