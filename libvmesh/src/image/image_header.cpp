#include "image_header.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"

namespace vmesh::image {

void set_size(ImageHeader& header, const std::vector<double>& sizes, const std::string& name) {
  if (sizes.size() < 3)
    throw InvalidInput(name + ": has " + std::to_string(sizes.size()) + " dimensions; give an image of 3");
  double product = 1;
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    if (!(sizes[a] >= 1 && sizes[a] <= 1e15) || sizes[a] != std::floor(sizes[a]))
      throw InvalidInput(name + ": the header gives no valid number of voxels along axis " + std::to_string(a));
    if (a >= 3 && sizes[a] != 1)
      throw Unsupported(name + ": has " + std::to_string(sizes.size()) + " dimensions; give an image of 3");
    product *= sizes[a];
    if (a < 3) header.size[a] = static_cast<std::uint64_t>(sizes[a]);
  }
  if (product > 1e17) throw InvalidInput(name + ": the header claims more than 10^17 voxels; it is broken");
}

void check_place(const Vec3& origin, const Eigen::Matrix3d& steps, const std::string& name) {
  // An image whose axes lie in a plane has no volume; 1e-9 is far above the effect of rounding.
  const double box = steps.colwise().norm().prod();
  const double volume = std::abs(steps.determinant());
  if (!origin.allFinite() || !steps.allFinite() || !std::isnormal(volume) || !(volume > 1e-9 * box))
    throw InvalidInput(name + ": the header gives axes or an origin that are not finite, or axes that span no volume");
}

std::string one_data_file(std::string_view given, const std::string& name) {
  if (given.empty()) throw InvalidInput(name + ": the header does not name the file of its voxels");
  if (given.starts_with("LIST") || given.find('%') != std::string_view::npos)
    throw Unsupported(name + ": voxels in many files, " + cited(given) + ", are not supported; store them in one");
  return std::string(given);
}

void set_data_begin(ImageHeader& header, std::uint64_t from, std::string_view skipped, const std::string& name,
                    std::string_view key) {
  header.data_begin = from;
  const std::vector<double> numbers = numbers_in(skipped, name, key);
  const double bytes = numbers.empty() ? 0 : numbers.front();
  if (numbers.size() > 1 || !(bytes >= -1 && bytes <= 1e15) || bytes != std::floor(bytes))
    throw InvalidInput(name + ": the header's \"" + std::string(key) + "\" is not a number of bytes");
  if (header.packed && bytes != 0)
    throw Unsupported(name + ": the header's \"" + std::string(key) +
                      "\" is not supported for compressed voxels; store the image anew");
  header.data_at_end = bytes < 0;
  if (bytes > 0) header.data_begin += static_cast<std::uint64_t>(bytes);
}

std::filesystem::path other_of_pair(std::filesystem::path path, const char* lower, const char* upper) {
  const std::string extension = path.extension().string();
  return path.replace_extension(extension == vmesh::lower(extension) ? lower : upper);
}

std::vector<double> numbers_in(std::string_view text, const std::string& name, std::string_view key) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '\t' || text[at] == ',' || text[at] == '(' || text[at] == ')') {
      ++at;
      continue;
    }
    double number = 0;
    const std::size_t sign = text[at] == '+' ? 1 : 0;
    const auto [end, error] = std::from_chars(text.data() + at + sign, text.data() + text.size(), number);
    if (error != std::errc())
      throw InvalidInput(name + ": the header's \"" + std::string(key) + "\" is not a list of numbers");
    numbers.push_back(number);
    at = static_cast<std::size_t>(end - text.data());
  }
  return numbers;
}

std::string folded(std::string_view text) { return lower(trimmed(text)); }

std::string cited(std::string_view text) {
  constexpr std::size_t kMostShown = 40;
  std::string shown(text.substr(0, kMostShown));
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  if (text.size() > kMostShown) shown += "...";
  return "\"" + shown + "\"";
}

std::string list_of(const std::vector<ImageSegment>& segments) {
  constexpr std::size_t kMostListed = 10;
  if (segments.empty()) return "the image names no segments, choose values";
  std::vector<std::string> words;
  for (std::size_t s = 0; s < segments.size() && s < kMostListed; ++s) {
    std::ostringstream word;
    word << cited(segments[s].name) << " (" << segments[s].value << ")";
    words.push_back(word.str());
  }
  if (segments.size() > kMostListed) words.push_back(std::to_string(segments.size() - kMostListed) + " more");
  return "the segments are " + listed(words, "and");
}

bool take_line(std::string_view& text, std::string_view& line) {
  if (text.empty()) return false;
  const std::size_t end = std::min(text.find('\n'), text.size());
  line = text.substr(0, end);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  text.remove_prefix(std::min(end + 1, text.size()));
  return true;
}

}  // namespace vmesh::image
