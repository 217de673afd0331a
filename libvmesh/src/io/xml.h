// VTK's XML files, as pugixml reads them; internal to the module.
#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

namespace vmesh::io {

struct XmlFile {
  pugi::xml_document document;
  /// The content of <AppendedData ...>, which need not be XML and is not part of the document.
  std::string_view appended;
};

/// `content` must outlive the result. Memory is at most about 30 times the content. Throws InvalidInput.
XmlFile parse_xml(std::string_view content, const std::string& source);

}  // namespace vmesh::io
