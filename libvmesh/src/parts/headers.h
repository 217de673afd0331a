#pragma once

#include <string>

#include "vmesh/core/error.h"
#include "vmesh/surface/part.h"

#include "parts/array_file.h"

namespace vmesh {

/// JSON common to the headers of part files and the manifest. Reading throws nlohmann's exceptions for missing values
/// and wrong types, and InvalidInput for values out of range.
nlohmann::json to_json(const GrowthSimplification& note);
GrowthSimplification note_of(const nlohmann::json& json);
Index around_of(const nlohmann::json& json);

/// Calls read(header) and reports errors with the file's name.
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
