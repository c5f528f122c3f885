#include "server/parsing/files/xml_outline.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

constexpr std::string_view white_space = " \t\r\n";

bool ends_name(char c) { return white_space.find(c) != std::string_view::npos || c == '/' || c == '>' || c == '='; }

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  const auto put_tail = [&](int shift) { put(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | code >> 6), put_tail(0);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12), put_tail(6), put_tail(0);
  } else {
    put(0xf0 | (code >> 18 & 0x07)), put_tail(12), put_tail(6), put_tail(0);
  }
}

// What stands between '&' and ';'. Unknown entities stay as they are, as in libsdformat's parser.
std::string decoded(std::string_view entity) {
  constexpr std::pair<std::string_view, const char*> named[] = {
      {"amp", "&"}, {"lt", "<"}, {"gt", ">"}, {"quot", "\""}, {"apos", "'"}};
  for (const auto& [name, meaning] : named)
    if (entity == name) return meaning;
  std::string as_written = "&" + std::string(entity) + ";";
  if (entity.size() < 2 || entity[0] != '#') return as_written;
  const bool hexadecimal = entity[1] == 'x';
  const char* const end = entity.data() + entity.size();
  std::uint32_t code = 0;
  const auto [stopped, error] =
      std::from_chars(entity.data() + (hexadecimal ? 2 : 1), end, code, hexadecimal ? 16 : 10);
  if (error != std::errc{} || stopped != end) return as_written;
  std::string text;
  append_utf8(text, code);
  return text;
}

std::string without_entities(std::string_view raw) {
  std::string text;
  while (!raw.empty()) {
    const std::size_t start = std::min(raw.find('&'), raw.size());
    text += raw.substr(0, start);
    raw.remove_prefix(start);
    if (raw.empty()) break;
    const std::size_t end = raw.find(';');
    if (end == std::string_view::npos) return text + std::string(raw);
    text += decoded(raw.substr(1, end - 1));
    raw.remove_prefix(end + 1);
  }
  return text;
}

std::string with_entities(std::string_view raw) {
  std::string text;
  for (const char c : raw) {
    switch (c) {
      case '&': text += "&amp;"; break;
      case '<': text += "&lt;"; break;
      case '>': text += "&gt;"; break;
      case '"': text += "&quot;"; break;
      case '\n': text += "&#10;"; break;  // a line is an element
      case '\r': text += "&#13;"; break;
      default: text += c;
    }
  }
  return text;
}

void write(const XmlNode& node, XmlText& written) {
  std::string& text = written.text;
  written.nodes.push_back(&node);
  text += '<' + node.name;
  for (const auto& [name, value] : node.attributes) text += ' ' + name + "=\"" + with_entities(value) + '"';
  text += '>' + with_entities(node.text);
  for (const XmlNode& child : node.children) {
    text += '\n';
    write(child, written);
  }
  text += "</" + node.name + '>';
}

constexpr std::size_t deepest = 64;  // of XML elements; SDF itself needs a dozen

class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  XmlOutline scan();

 private:
  // Each takes its construct from the front of the text; false after an error.
  bool character_data();
  bool section(std::string_view opening, std::string_view closing);
  bool declaration();
  bool opening_tag();
  bool attribute(XmlNode& node);
  bool closing_tag();

  bool fail(int line, std::string message) {
    outline_.error = {line, std::move(message)};
    return false;
  }
  bool at(std::string_view prefix) const { return rest_.starts_with(prefix); }
  std::string_view take(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    line_ += static_cast<int>(std::count(taken.begin(), taken.end(), '\n'));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view take_name() {
    return take(static_cast<std::size_t>(std::find_if(rest_.begin(), rest_.end(), ends_name) - rest_.begin()));
  }
  void skip_space() { take(std::min(rest_.find_first_not_of(white_space), rest_.size())); }
  bool close_element();

  std::string_view rest_;
  int line_ = 1;
  bool has_root_ = false;
  std::vector<XmlNode> open_;  // from the root inwards
  XmlOutline outline_;
};

XmlOutline Scanner::scan() {
  if (at("\xef\xbb\xbf")) take(3);  // byte order mark
  bool well_formed = true;
  while (well_formed && !rest_.empty()) {
    if (rest_[0] != '<')
      well_formed = character_data();
    else if (at("<!--"))
      well_formed = section("<!--", "-->");
    else if (at("<![CDATA["))
      well_formed = section("<![CDATA[", "]]>");
    else if (at("<?"))
      well_formed = section("<?", "?>");
    else if (at("<!"))
      well_formed = declaration();
    else if (at("</"))
      well_formed = closing_tag();
    else
      well_formed = opening_tag();
  }
  if (well_formed && !open_.empty())
    fail(open_.back().line, "<" + open_.back().name + "> is never closed");
  else if (well_formed && !has_root_)
    fail(0, "there is no XML element in this file");
  return std::move(outline_);
}

bool Scanner::character_data() {
  const int line = line_;
  const std::string_view text = trimmed(take(std::min(rest_.find('<'), rest_.size())));
  if (text.empty()) return true;
  if (open_.empty()) return fail(line, "there is text outside of the root element");
  open_.back().text += without_entities(text);
  return true;
}

bool Scanner::section(std::string_view opening, std::string_view closing) {
  const int line = line_;
  take(opening.size());
  const std::size_t end = rest_.find(closing);
  if (end == std::string_view::npos)
    return fail(line, "'" + std::string(opening) + "' has no '" + std::string(closing) + "'");
  const std::string_view content = take(end);
  if (closing == "]]>" && !open_.empty()) open_.back().text += content;
  take(closing.size());
  return true;
}

bool Scanner::declaration() {
  const int line = line_;
  int depth = 0;  // of the brackets of an internal subset
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    if (rest_[i] == '[') ++depth;
    if (rest_[i] == ']') --depth;
    if (rest_[i] == '>' && depth == 0) {
      take(i + 1);
      return true;
    }
  }
  return fail(line, "'<!' has no '>'");
}

bool Scanner::opening_tag() {
  XmlNode node;
  node.line = line_;
  take(1);
  node.name = take_name();
  if (!is_xml_name(node.name)) return fail(node.line, "'<' is not followed by a name; write '&lt;' for the character");
  if (open_.size() >= deepest)
    return fail(node.line, "<" + node.name + "> is nested more than " + std::to_string(deepest) + " levels deep");
  if (open_.empty() && has_root_)
    return fail(node.line, "<" + node.name + "> is a second root element; a file has one");
  has_root_ = true;
  while (true) {
    skip_space();
    if (rest_.empty()) return fail(node.line, "the tag <" + node.name + " has no '>'");
    if (at("/>")) {
      take(2);
      open_.push_back(std::move(node));
      return close_element();
    }
    if (at(">")) {
      take(1);
      open_.push_back(std::move(node));
      return true;
    }
    if (!attribute(node)) return false;
  }
}

bool Scanner::attribute(XmlNode& node) {
  const int line = line_;
  const std::string name(take_name());
  skip_space();
  if (!is_xml_name(name) || !at("=")) return fail(line, "in the tag <" + node.name + ", expected ATTRIBUTE=\"VALUE\"");
  take(1);
  skip_space();
  if (!at("\"") && !at("'"))
    return fail(line, "the value of the attribute '" + name + "' is not between quotation marks");
  if (node.attribute(name) != nullptr) return fail(line, "the attribute '" + name + "' is given twice");
  const char quote = take(1)[0];
  const std::size_t end = rest_.find(quote);
  if (end == std::string_view::npos) return fail(line, "the value of the attribute '" + name + "' never ends");
  node.attributes.emplace_back(name, without_entities(take(end)));
  take(1);
  return true;
}

bool Scanner::closing_tag() {
  const int line = line_;
  take(2);
  const std::string name(take_name());
  skip_space();
  if (!at(">")) return fail(line, "the tag </" + name + " has no '>'");
  take(1);
  if (open_.empty()) return fail(line, "</" + name + "> closes nothing");
  if (open_.back().name != name)
    return fail(line, "</" + name + "> does not close <" + open_.back().name + "> of line " +
                          std::to_string(open_.back().line));
  return close_element();
}

bool Scanner::close_element() {
  XmlNode node = std::move(open_.back());
  open_.pop_back();
  if (open_.empty())
    outline_.root = std::move(node);
  else
    open_.back().children.push_back(std::move(node));
  return true;
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

XmlOutline outline_xml(std::string_view text) { return Scanner(text).scan(); }

XmlText xml_text_of(const XmlNode& node) {
  XmlText written{"", {nullptr}};
  write(node, written);
  return written;
}

}  // namespace cohort::parsing