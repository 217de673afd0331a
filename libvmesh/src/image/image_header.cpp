#include "image_header.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "vmesh/core/error.h"

namespace vmesh::image {

bool has_own_format(const std::filesystem::path& path) {
  const std::string name = folded(path.filename().string());
  for (const char* ending : {".nii", ".nii.gz", ".nrrd", ".mha"})
    if (name.ends_with(ending)) return true;
  return false;
}

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

void check_place(const ImageHeader& header, const std::string& name) {
  // An image whose axes lie in a plane has no volume; 1e-9 is far above the effect of rounding.
  const double box = header.steps.colwise().norm().prod();
  const double volume = std::abs(header.steps.determinant());
  if (!header.origin.allFinite() || !header.steps.allFinite() || !std::isnormal(volume) || !(volume > 1e-9 * box))
    throw InvalidInput(name + ": the header gives axes or an origin that are not finite, or axes that span no volume");
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

std::string folded(std::string_view text) {
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string cited(std::string_view text) {
  constexpr std::size_t kMostShown = 40;
  std::string shown(text.substr(0, kMostShown));
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  if (text.size() > kMostShown) shown += "...";
  return "\"" + shown + "\"";
}

bool take_line(std::string_view& text, std::string_view& line) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return false;
  line = text.substr(0, end);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  text.remove_prefix(end + 1);
  return true;
}

}  // namespace vmesh::image
