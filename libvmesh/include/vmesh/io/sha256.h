#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vmesh {

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256_of(std::string_view bytes);

/// Throws ReadError when the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace vmesh
