// Options as JavaScript gives them.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"

#include "objects.h"

namespace vmesh::wasm {

/// An object whose members are taken one by one; what is left over is refused.
class GivenOptions {
 public:
  /// `function` names the caller in messages. Throws InvalidInput unless the text is a JSON object.
  GivenOptions(const char* text, std::string function);

  /// Does nothing unless the option is given. Throws InvalidInput where it is of another type.
  void take(const char* name, double& value);
  void take(const char* name, int& value);
  void take(const char* name, std::size_t& value);
  void take(const char* name, bool& value);
  void take(const char* name, std::string& value);
  void take(const char* name, std::vector<std::string>& value);
  /// Throws InvalidInput naming an option that was not taken.
  void finish() const;

 private:
  const nlohmann::json* find(const char* name);
  [[noreturn]] void refuse(const char* name, const char* type) const;

  std::string function_;
  nlohmann::json options_;
  std::vector<std::string> taken_;
};

/// Files and options of read().
struct ReadRequest {
  std::vector<std::filesystem::path> paths;
  CenterlineLoadOptions options;
};
ReadRequest read_request(const char* json);

ProductionOptions production_options(const char* json);

struct WriteRequest {
  SurfaceMetadata metadata;
  SurfaceEncoding encoding = SurfaceEncoding::usual;
};
WriteRequest write_request(const char* json);

}  // namespace vmesh::wasm
