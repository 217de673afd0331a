#pragma once

#include <string>

#include "vmesh/core/error.h"
#include "vmesh/surface/part.h"

#include "parts/array_file.h"

namespace vmesh {

/// What headers of parts' files and their list have in common. Reading throws nlohmann's exceptions for what is missing
/// or of another kind, and InvalidInput for what is out of range.
nlohmann::json to_json(const GrowthSimplification& note);
GrowthSimplification note_of(const nlohmann::json& json);
Index around_of(const nlohmann::json& json);

/// Calls read(header). What is wrong with it is said with the file's name.
template <class Read>
void read_header(const ArrayFile& file, Read&& read) {
  try {
    read(file.header());
  } catch (const nlohmann::json::exception&) {
    file.refuse("is damaged: its header lacks something, or it is of another kind");
  } catch (const InvalidInput& error) {
    file.refuse(std::string("is damaged: ") + error.what());
  }
}

}  // namespace vmesh
