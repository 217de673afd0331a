// The little of XML that VTK's files are made of, internal to the module.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vmesh::io {

/// An element with what it holds, as parts of the file.
struct XmlElement {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text;              ///< between its first tags that is not blank
  std::vector<std::size_t> children;  ///< in XmlFile::elements, ascending

  /// Empty when it is not there.
  std::string_view attribute(std::string_view key) const;
};

struct XmlFile {
  std::vector<XmlElement> elements;  ///< the first is the root, children come after their parent
  /// What follows the tag <AppendedData ...>, which need not be XML, up to its end tag.
  std::string_view appended;

  const XmlElement& child(const XmlElement& element, std::size_t i) const { return elements[element.children[i]]; }
  /// The first child of that name, or null.
  const XmlElement* find(const XmlElement& element, std::string_view name) const;
};

/// Comments, declarations and instructions are left out, entities left as they are. The file must be closed as it was
/// opened. Memory is at most about 70 times the content. Throws InvalidInput.
XmlFile parse_xml(std::string_view content, const std::string& source);

/// `text` with its five named entities (&amp; ...) replaced.
std::string unescaped(std::string_view text);

}  // namespace vmesh::io
