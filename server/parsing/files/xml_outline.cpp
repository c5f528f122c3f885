// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/xml_outline.hpp"

#include <expat.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

constexpr std::size_t most_elements_deep = 64;  // nested XML elements; SDF needs a dozen

/// Builds the tree from the events of expat. Entities that a file declares are not expanded in text; in attributes, the
/// limits of expat apply. Nothing is downloaded.
class OutlineBuilder {
 public:
  explicit OutlineBuilder(std::string_view text);

  XmlOutline build();

 private:
  static OutlineBuilder& of(void* self) { return *static_cast<OutlineBuilder*>(self); }
  int line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser_.get())); }
  void open(const char* name, const char** attributes);
  void close();
  XmlSyntaxError error() const;

  std::string_view text_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_{XML_ParserCreate(nullptr), XML_ParserFree};
  std::vector<XmlNode> open_;  // from the root inwards
  XmlOutline outline_;
};

OutlineBuilder::OutlineBuilder(std::string_view text) : text_(text) {
  const XML_Parser parser = parser_.get();
  XML_SetUserData(parser, this);
  XML_SetElementHandler(
      parser, [](void* self, const char* name, const char** attributes) { of(self).open(name, attributes); },
      [](void* self, const char*) { of(self).close(); });
  XML_SetCharacterDataHandler(parser, [](void* self, const char* characters, int count) {
    of(self).open_.back().text.append(characters, static_cast<std::size_t>(count));
  });
  XML_SetDefaultHandler(parser, nullptr);  // so that entities are skipped, not expanded
  XML_SetSkippedEntityHandler(parser, [](void* self, const char* name, int) {
    if (!of(self).open_.empty()) of(self).open_.back().text += std::string("&") + name + ";";
  });
}

XmlOutline OutlineBuilder::build() {
  if (text_.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    outline_.error = {0, "is larger than 2 GB"};
  else if (XML_Parse(parser_.get(), text_.data(), static_cast<int>(text_.size()), XML_TRUE) == XML_STATUS_ERROR &&
           !outline_.error)
    outline_.error = error();
  return std::move(outline_);
}

void OutlineBuilder::open(const char* name, const char** attributes) {
  if (open_.size() >= most_elements_deep) {
    outline_.error = {line(), std::string("<") + name + "> is nested more than " + std::to_string(most_elements_deep) +
                                  " levels deep"};
    XML_StopParser(parser_.get(), XML_FALSE);
    return;
  }
  XmlNode& node = open_.emplace_back();
  node.name = name;
  node.line = line();
  for (; *attributes != nullptr; attributes += 2) node.attributes.emplace_back(attributes[0], attributes[1]);
}

void OutlineBuilder::close() {
  if (outline_.error) return;  // a stopped parser still ends an empty element
  XmlNode node = std::move(open_.back());
  open_.pop_back();
  node.text = trimmed(node.text);
  (open_.empty() ? outline_.root : open_.back().children.emplace_back()) = std::move(node);
}

// Returns the position of the first character that is neither white space nor in a comment.
std::size_t after_comments(std::string_view text, std::size_t from) {
  for (;;) {
    from = std::min(text.find_first_not_of(" \t\r\n", from), text.size());
    if (!text.substr(from).starts_with("<!--")) return from;
    const std::size_t end = text.find("-->", from);
    if (end == std::string_view::npos) return text.size();
    from = end + 3;
  }
}

// Returns the error at which expat stopped, with a message made from the context.
XmlSyntaxError OutlineBuilder::error() const {
  const auto place = static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()));
  const std::string_view rest = text_.substr(std::min(place, text_.size()));
  const auto up_to = [&](const char* ends) { return std::string(rest.substr(0, rest.find_first_of(ends))); };
  const XML_Error code = XML_GetErrorCode(parser_.get());
  switch (code) {
    case XML_ERROR_NO_ELEMENTS:
      if (open_.empty()) return {0, "there is no XML element in this file"};
      return {open_.back().line, "<" + open_.back().name + "> is not closed"};
    case XML_ERROR_TAG_MISMATCH:
      return {line(), "</" + up_to(" \t\r\n>") + "> does not close <" + open_.back().name + "> of line " +
                          std::to_string(open_.back().line)};
    case XML_ERROR_DUPLICATE_ATTRIBUTE: return {line(), "the attribute '" + up_to(" \t\r\n=") + "' is given twice"};
    case XML_ERROR_UNDEFINED_ENTITY:
      return {line(), "'" + up_to(";") + ";' is not defined; write '&amp;' for the character '&'"};
    case XML_ERROR_UNCLOSED_TOKEN:
    case XML_ERROR_UNCLOSED_CDATA_SECTION: return {line(), "'" + up_to(" \t\r\n") + "' is not terminated"};
    case XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
      if (rest.starts_with('<')) return {line(), "unexpected second root element"};
      [[fallthrough]];
    case XML_ERROR_SYNTAX:
    case XML_ERROR_INVALID_TOKEN:
      if (!open_.empty()) break;
      return {line(), "unexpected text outside of the root element"};
    default: return {line(), std::string("not XML: ") + XML_ErrorString(code)};
  }
  return {line(), "invalid XML at column " + std::to_string(XML_GetCurrentColumnNumber(parser_.get()) + 1) +
                      ": expected UTF-8, ATTRIBUTE=\"VALUE\" in tags, and '&lt;' and '&amp;' for the characters '<' "
                      "and '&'"};
}

}  // namespace

const XmlNode* XmlNode::child(std::string_view child_name) const {
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const XmlNode& c) { return c.name == child_name; });
  return found == children.end() ? nullptr : &*found;
}

const std::string* XmlNode::attribute(std::string_view attribute_name) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.first == attribute_name; });
  return found == attributes.end() ? nullptr : &found->second;
}

bool is_xml_name(std::string_view name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
           static_cast<unsigned char>(c) > 127;
  };
  return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
  });
}

// Blank lines and comments before the declaration are common but not valid XML. Then the declaration, which is not
// needed here, is blanked too; so is a byte order mark.
XmlOutline outline_xml(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t first = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  const std::size_t start = after_comments(text, first);
  const bool is_declared = start < text.size() && text.substr(start).starts_with("<?xml ");
  if (first == 0 && (start == 0 || !is_declared)) return OutlineBuilder(text).build();
  std::string without(text);
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (without[i] != '\n') without[i] = ' ';
  };
  blank(0, first);
  if (is_declared) blank(start, std::min(without.find("?>", start), without.size() - 2) + 2);
  return OutlineBuilder(without).build();
}

// Returns whether a text begins like `&amp;` or `&#38;`.
static bool is_reference(std::string_view text) {
  const std::size_t end = text.find(';');
  const std::string_view name = end == std::string_view::npos ? "" : text.substr(1, end - 1);
  return name.starts_with('#') || is_xml_name(name);
}

XmlOutline outline_loose_xml(std::string_view text) {
  std::string without(text);
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < std::min(to, without.size()); ++i)
      if (without[i] != '\n') without[i] = ' ';
  };
  blank(0, without.find('<'));
  for (std::size_t at = 0; (at = std::min(without.find("<!--", at), without.find("<![CDATA[", at))) < without.size();) {
    const bool is_comment = without.compare(at, 4, "<!--") == 0;
    const std::size_t end = without.find(is_comment ? "-->" : "]]>", at);
    if (end == std::string::npos) break;
    if (is_comment) blank(at, end + 3);
    at = end + 3;
  }
  if (const std::size_t end = without.find("?>"); without.starts_with("<?xml ") && end != std::string::npos)
    blank(0, end + 2);
  for (std::size_t at = without.find('&'); at != std::string::npos; at = without.find('&', at + 1))
    if (!is_reference(std::string_view(without).substr(at))) without.insert(at + 1, "amp;");
  if (const std::size_t root = without.find('<'); root != std::string::npos) {
    const std::string name = without.substr(root + 1, without.find_first_of(" \t\r\n/>", root) - root - 1);
    const std::size_t end = without.rfind("</" + name + ">");
    if (end != std::string::npos) blank(end + name.size() + 3, without.size());
  }
  return outline_xml(without);
}

}  // namespace cohort::parsing
