#include "xml.h"

#include <array>

#include "text.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kBlank = " \t\r\n";
constexpr std::string_view kAppendedData = "AppendedData";

class XmlReader {
 public:
  XmlReader(std::string_view content, const std::string& source) : content_(content), source_(source) {}

  XmlFile run() {
    while (next_tag()) {
      if (skip_remark()) continue;
      if (take("</")) {
        close();
      } else {
        open();
      }
    }
    if (!open_.empty()) fail("the file ends within <" + name_of(open_.back()) + ">; it is cut off, get the whole file");
    if (file_.elements.empty()) fail("there is no element in it");
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": byte " + std::to_string(at_) + ": this is no valid XML: " + what);
  }

  std::string name_of(std::size_t element) const { return one_line(file_.elements[element].name.substr(0, 40)); }
  std::string_view rest() const { return content_.substr(at_); }

  bool take(std::string_view word) {
    if (!rest().starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  void skip_blank() { at_ = std::min(content_.find_first_not_of(kBlank, at_), content_.size()); }

  void skip_to_end_of(std::string_view end) {
    const std::size_t found = content_.find(end, at_);
    if (found == std::string_view::npos) fail("there is no " + std::string(end) + " to what begins here");
    at_ = found + end.size();
  }

  /// To the next '<'; keeps the text before it. False at the end of the file.
  bool next_tag() {
    const std::size_t end = std::min(content_.find('<', at_), content_.size());
    const std::string_view text = content_.substr(at_, end - at_);
    const bool blank = text.find_first_not_of(kBlank) == std::string_view::npos;
    if (!blank && open_.empty()) fail("there is text outside of every element");
    if (!blank && file_.elements[open_.back()].text.empty()) file_.elements[open_.back()].text = text;
    at_ = end;
    return at_ < content_.size();
  }

  bool skip_remark() {
    if (take("<?")) return skip_to_end_of("?>"), true;
    if (take("<!--")) return skip_to_end_of("-->"), true;
    if (take("<!")) return skip_to_end_of(">"), true;
    return false;
  }

  std::string_view name() {
    const std::size_t end = std::min(content_.find_first_of(" \t\r\n/>=<\"'", at_), content_.size());
    if (end == at_) fail("a name should be here");
    const std::string_view result = content_.substr(at_, end - at_);
    at_ = end;
    return result;
  }

  void open() {
    take("<");
    if (open_.empty() && !file_.elements.empty()) fail("a second element is beside the first");
    const std::size_t element = file_.elements.size();
    file_.elements.emplace_back().name = name();
    if (!open_.empty()) file_.elements[open_.back()].children.push_back(element);
    for (skip_blank(); !rest().starts_with('/') && !rest().starts_with('>'); skip_blank()) read_attribute(element);
    if (take("/>")) return;
    if (!take(">")) fail("a tag should end here");
    open_.push_back(element);
    if (file_.elements[element].name == kAppendedData) take_appended();
  }

  void read_attribute(std::size_t element) {
    const std::string_view key = name();
    skip_blank();
    if (!take("=")) fail("a = should follow the name of an attribute");
    skip_blank();
    if (!rest().starts_with('"') && !rest().starts_with('\'')) fail("the value of an attribute should be in quotes");
    const std::size_t end = content_.find(content_[at_], at_ + 1);
    if (end == std::string_view::npos) fail("the value of an attribute has no end");
    file_.elements[element].attributes.emplace_back(key, content_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
  }

  void take_appended() {
    const std::size_t end = content_.rfind("</AppendedData");
    if (end == std::string_view::npos || end < at_) fail("the file ends within its data; it is cut off");
    file_.appended = content_.substr(at_, end - at_);
    at_ = end;
  }

  void close() {
    const std::string_view closed = name();
    skip_blank();
    if (!take(">")) fail("a tag should end here");
    if (open_.empty() || file_.elements[open_.back()].name != closed) {
      fail("</" + one_line(closed.substr(0, 40)) + "> closes what is not open");
    }
    open_.pop_back();
  }

  std::string_view content_;
  const std::string& source_;
  std::size_t at_ = 0;
  XmlFile file_;
  std::vector<std::size_t> open_;
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view key) const {
  for (const auto& [name_here, value] : attributes) {
    if (name_here == key) return value;
  }
  return {};
}

const XmlElement* XmlFile::find(const XmlElement& element, std::string_view name) const {
  for (const std::size_t c : element.children) {
    if (elements[c].name == name) return &elements[c];
  }
  return nullptr;
}

XmlFile parse_xml(std::string_view content, const std::string& source) { return XmlReader(content, source).run(); }

std::string unescaped(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  while (!text.empty()) {
    std::size_t length = 1;
    char c = text.front();
    for (const auto& [entity, meaning] : kEntities) {
      if (!text.starts_with(entity)) continue;
      length = entity.size();
      c = meaning;
    }
    result += c;
    text.remove_prefix(length);
  }
  return result;
}

}  // namespace vmesh::io
