#include "xml.h"

#include "text.h"

namespace vmesh::io {
namespace {

/// The content between the tags of <AppendedData>; empty and at the end if there is none.
std::string_view find_appended(std::string_view content, const std::string& source) {
  const std::size_t tag = content.find("<AppendedData");
  const std::size_t begin = tag == std::string_view::npos ? tag : content.find('>', tag);
  if (begin == std::string_view::npos || content[begin - 1] == '/') return content.substr(content.size());
  const std::size_t end = content.rfind("</AppendedData");
  if (end == std::string_view::npos || end < begin) {
    throw InvalidInput(source + ": the file ends within its appended data; it is cut off, get the whole file");
  }
  return content.substr(begin + 1, end - begin - 1);
}

}  // namespace

XmlFile parse_xml(std::string_view content, const std::string& source) {
  XmlFile file;
  file.appended = find_appended(content, source);
  const auto before = static_cast<std::size_t>(file.appended.data() - content.data());
  std::string markup(content.substr(0, before));
  markup += content.substr(before + file.appended.size());
  const pugi::xml_parse_result result =
      file.document.load_buffer(markup.data(), markup.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    auto place = static_cast<std::size_t>(result.offset);
    if (place > before) place += file.appended.size();
    throw InvalidInput(source + ": byte " + std::to_string(place) + ": this is not valid XML: " + result.description() +
                       "; if the file is cut off, get the whole file");
  }
  return file;
}

}  // namespace vmesh::io
