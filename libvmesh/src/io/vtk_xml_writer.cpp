#include "vtk_xml_writer.h"

#include <zlib.h>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "text.h"

namespace vmesh::io {

std::string PackedArray::bytes() {
  const std::size_t rest = block_.size();
  if (rest > 0) pack();
  std::string result;
  store(result, static_cast<std::uint64_t>(sizes_.size()));
  store(result, static_cast<std::uint64_t>(kBlock));
  store(result, static_cast<std::uint64_t>(rest));
  for (const std::uint64_t size : sizes_) store(result, size);
  return result + packed_;
}

void PackedArray::pack() {
  uLongf size = compressBound(static_cast<uLong>(block_.size()));
  const std::size_t before = packed_.size();
  packed_.resize(before + size);
  if (compress2(reinterpret_cast<Bytef*>(packed_.data() + before), &size, reinterpret_cast<const Bytef*>(block_.data()),
                static_cast<uLong>(block_.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw WriteError("zlib cannot pack the data; is there enough free memory?");
  packed_.resize(before + size);
  sizes_.push_back(size);
  block_.clear();
}

std::string vtk_escaped(std::string_view text) { return xml_escaped(text, "&<>\""); }

void VtkXmlFile::add_texts(const char* name, const std::vector<std::string>& texts) {
  const std::string indent(2 * tags_.size(), ' ');
  xml_.append(indent).append("<Array type=\"String\" Name=\"").append(name).append("\" NumberOfTuples=\"");
  xml_.append(std::to_string(texts.size())).append("\" format=\"ascii\">\n");
  for (const std::string& text : texts) {
    xml_ += indent;
    for (const char c : one_line(text)) xml_ += std::to_string(static_cast<unsigned char>(c)) + " ";
    xml_ += "0\n";
  }
  xml_ += indent + "</Array>\n";
}

void VtkXmlFile::write(std::ostream& out) {
  while (!tags_.empty()) close();
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << kind_
      << "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n"
      << xml_ << "<AppendedData encoding=\"raw\">\n_" << appended_ << "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace vmesh::io
