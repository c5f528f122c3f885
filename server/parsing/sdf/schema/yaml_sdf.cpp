// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/yaml_sdf.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* name_space = "https://cohort-sim.org/sdf/1";

struct Entry {
  std::string key;
  int line;
  YamlPtr value;
};

// Returns whether the name of an element may be omitted. It is then that of the element, with a number from the second
// on, and `default` for a world.
bool may_lack_name(std::string_view element) {
  return element == "world" || element == "link" || element == "collision" || element == "visual";
}

bool is_list_of_scalars(const YamlNode& node) {
  return node.is_list() &&
         std::all_of(node.items.begin(), node.items.end(), [](const YamlPtr& item) { return item->is_scalar(); });
}

// Returns whether a list has the numbers of one vector, rather than vectors as texts.
bool is_vector(const YamlNode& node) {
  return is_list_of_scalars(node) && std::all_of(node.items.begin(), node.items.end(), [](const YamlPtr& item) {
           return item->text.find(' ') == std::string::npos;
         });
}

// Infinity is spelled differently in YAML and SDF.
std::string scalar_text(const YamlNode& node) {
  std::string text = node.text;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (node.is_plain && (text == ".inf" || text == "+.inf")) return "inf";
  if (node.is_plain && text == "-.inf") return "-inf";
  return node.text;
}

std::string joined(const YamlNode& list) {
  std::string text;
  for (const YamlPtr& item : list.items) text += (text.empty() ? "" : " ") + scalar_text(*item);
  return text;
}

class Converter {
 public:
  Converter(const std::filesystem::path& file, std::vector<Problem>& problems) : file_(file), problems_(problems) {}

  XmlNode convert(const YamlNode& document);

 private:
  void problem(int line, const std::string& element, std::string message) {
    problems_.push_back({file_, line, element, std::move(message)});
  }
  /// Returns the keys of a map, each once; those that `<<` merges into it come last.
  std::vector<Entry> entries(const YamlNode& map, const std::string& path);
  void merge(const YamlNode& from, int line, const std::string& path, std::set<std::string>& seen,
             std::vector<Entry>& found);
  void fill(XmlNode& node, const YamlNode& value, const ElementSchema& schema, const std::string& path);
  void fill_from_map(XmlNode& node, const YamlNode& map, const ElementSchema& schema, const std::string& path);
  void add_entry(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path);
  void add_attribute(XmlNode& node, const std::string& name, const Entry& entry, const std::string& path);
  void add_children(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path);
  void add_child(XmlNode& node, const std::string& name, int line, const YamlNode& value, const ElementSchema& schema,
                 const std::string& path);
  void add_in_order(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path);
  void set_value(XmlNode& node, const Entry& entry, const std::string& path);
  /// Returns the key as it was probably meant, or an empty text; reports problems.
  std::string known_key(const Entry& entry, const std::vector<Entry>& all, const ElementSchema& schema,
                        const std::string& path);
  void check_top(const XmlNode& sdf);

  const std::filesystem::path& file_;
  std::vector<Problem>& problems_;
};

std::string extended(const std::string& path, const std::string& step) {
  return path.empty() ? step : path + "/" + step;
}

// Returns `model[NAME]`, with the name of the element after reading.
std::string step_to(const std::string& element, const YamlNode& value) {
  if (element == "world" || !value.is_map()) return element;
  for (const auto& [key, name] : value.pairs)
    if (key->is_scalar() && key->text == "name" && name->is_scalar()) return element + "[" + name->text + "]";
  return element;
}

void Converter::merge(const YamlNode& from, int line, const std::string& path, std::set<std::string>& seen,
                      std::vector<Entry>& found) {
  if (from.is_list()) {
    for (const YamlPtr& item : from.items) merge(*item, line, path, seen, found);
  } else if (from.is_map()) {
    for (Entry& entry : entries(from, path))
      if (seen.insert(entry.key).second) found.push_back(std::move(entry));
  } else {
    problem(line, path, "expected a map to merge with '<<', not " + shown(from));
  }
}

std::vector<Entry> Converter::entries(const YamlNode& map, const std::string& path) {
  std::vector<Entry> found;
  std::set<std::string> seen;
  for (const auto& [key, value] : map.pairs) {
    if (key->is_scalar() && key->is_plain && key->text == "<<") continue;
    if (!key->is_scalar())
      problem(key->line, path, "expected the name of an element as a key, not " + shown(*key));
    else if (!seen.insert(key->text).second)
      problem(key->line, extended(path, key->text), "the key is given twice; write several values as a list, '- …'");
    else
      found.push_back({key->text, key->line, value});
  }
  for (const auto& [key, value] : map.pairs)
    if (key->is_scalar() && key->is_plain && key->text == "<<") merge(*value, key->line, path, seen, found);
  return found;
}

void Converter::fill(XmlNode& node, const YamlNode& value, const ElementSchema& schema, const std::string& path) {
  switch (value.kind) {
    case YamlNode::Kind::nothing: break;
    case YamlNode::Kind::map: fill_from_map(node, value, schema, path); break;
    case YamlNode::Kind::scalar:
      if (schema.is_free() || schema.is_extension() || schema.has_value())
        node.text = trimmed(scalar_text(value));
      else if (!trimmed(value.text).empty())
        problem(value.line, path, "expected 'KEY: VALUE' lines, not " + shown(value));
      break;
    case YamlNode::Kind::list:
      if (is_list_of_scalars(value))
        node.text = joined(value);
      else
        problem(value.line, path, "unexpected nested list; expected values");
  }
}

void Converter::fill_from_map(XmlNode& node, const YamlNode& map, const ElementSchema& schema,
                              const std::string& path) {
  const std::vector<Entry> all = entries(map, path);
  for (const Entry& entry : all) {
    const std::string key = known_key(entry, all, schema, path);
    if (!key.empty()) add_entry(node, {key, entry.line, entry.value}, schema, path);
  }
}

std::string Converter::known_key(const Entry& entry, const std::vector<Entry>& all, const ElementSchema& schema,
                                 const std::string& path) {
  const std::string& key = entry.key;
  const bool has_reserved_mark = key.starts_with("@") || key.starts_with("=");
  const std::string name = has_reserved_mark ? key.substr(1) : key;
  if (!is_xml_name(name)) {
    problem(entry.line, path, "'" + key + "' cannot be the name of an element");
    return {};
  }
  // `cohort:` keys are checked later, in files of any kind.
  if (schema.takes_anything() || schema.is_extension() || has_reserved_mark || key.find(':') != std::string::npos)
    return key;
  std::vector<std::string> known = schema.attributes();
  for (std::string& child : schema.children()) known.push_back(std::move(child));
  if (schema.has_value()) known.emplace_back("value");
  if (key == "elements" || std::find(known.begin(), known.end(), key) != known.end()) return key;
  problem(entry.line, extended(path, key), "unknown key" + suggestion(key, known));
  // A typing error of one letter is corrected, so that one mistake gives one message.
  const auto meant = nearest(key, known);
  if (!meant || edit_distance(key, *meant) > 1 ||
      std::any_of(all.begin(), all.end(), [&](const Entry& other) { return other.key == *meant; }))
    return {};
  return *meant;
}

void Converter::add_entry(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path) {
  const std::string& key = entry.key;
  const bool is_known = !schema.is_free();
  if (key.starts_with("@") || key.starts_with("xmlns:"))
    add_attribute(node, key.starts_with("@") ? key.substr(1) : key, entry, path);
  else if (schema.has_attribute(key))
    add_attribute(node, key, entry, path);
  else if (key == "=value" || (is_known && key == "value" && !schema.has_child(key) && !schema.takes_anything()))
    set_value(node, entry, path);
  else if (key == "=elements" || (is_known && key == "elements" && !schema.takes_anything()))
    add_in_order(node, entry, schema, path);
  else
    add_children(node, {key.starts_with("=") ? key.substr(1) : key, entry.line, entry.value}, schema, path);
}

void Converter::add_attribute(XmlNode& node, const std::string& name, const Entry& entry, const std::string& path) {
  if (entry.value->is_scalar())
    node.attributes.emplace_back(name, scalar_text(*entry.value));
  else
    problem(entry.line, path, "expected a value for '" + name + "', not " + shown(*entry.value));
}

void Converter::set_value(XmlNode& node, const Entry& entry, const std::string& path) {
  if (entry.value->is_scalar())
    node.text = trimmed(scalar_text(*entry.value));
  else if (is_list_of_scalars(*entry.value))
    node.text = joined(*entry.value);
  else
    problem(entry.line, path, "expected a value, not " + shown(*entry.value));
}

void Converter::add_in_order(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path) {
  const auto is_single = [](const YamlPtr& item) { return item->is_map() && item->pairs.size() == 1; };
  if (!entry.value->is_list() || !std::all_of(entry.value->items.begin(), entry.value->items.end(), is_single)) {
    problem(entry.line, path, "expected a list of elements, each '- NAME: CONTENT'");
    return;
  }
  for (const YamlPtr& item : entry.value->items) fill_from_map(node, *item, schema, path);
}

void Converter::add_children(XmlNode& node, const Entry& entry, const ElementSchema& schema, const std::string& path) {
  std::string name = entry.key;
  if (schema.is_extension() && name.find(':') == std::string::npos) name = prefixed(name);
  const ElementSchema child = schema.child(name);
  const YamlNode& value = *entry.value;
  if (!value.is_list() || (child.is_vector() && is_vector(value))) {
    add_child(node, name, entry.line, value, child, path);
    return;
  }
  for (const YamlPtr& item : value.items) {
    if (item->is_list() && !child.is_vector())
      problem(item->line, extended(path, name), "unexpected nested list; expected the content of one <" + name + ">");
    else
      add_child(node, name, item->line, *item, child, path);
  }
}

void Converter::add_child(XmlNode& node, const std::string& name, int line, const YamlNode& value,
                          const ElementSchema& schema, const std::string& path) {
  XmlNode child;
  child.name = name;
  child.line = line;
  fill(child, value, schema, extended(path, step_to(name, value)));
  if (may_lack_name(name) && schema.has_attribute("name") && child.attribute("name") == nullptr) {
    const auto before = std::count_if(node.children.begin(), node.children.end(),
                                      [&](const XmlNode& other) { return other.name == name; });
    const std::string first = name == "world" ? "default" : name;  // "world" is reserved
    child.attributes.emplace_back("name", before == 0 ? first : first + "_" + std::to_string(before));
  }
  node.children.push_back(std::move(child));
}

void Converter::check_top(const XmlNode& sdf) {
  const std::string* const version = sdf.attribute("version");
  if (version != nullptr && *version != converted_version)
    problem(sdf.line, "sdf",
            "expected version " + std::string(converted_version) + ", the only version supported in YAML, not '" +
                *version + "'");
}

XmlNode Converter::convert(const YamlNode& document) {
  XmlNode sdf;
  sdf.name = "sdf";
  sdf.line = document.line;
  const YamlNode* content = &document;
  if (document.is_map())
    for (const auto& [key, value] : document.pairs)
      if (key->is_scalar() && key->text == "sdf") {
        sdf.line = key->line;
        content = value.get();
        if (document.pairs.size() > 1) problem(document.line, "", "'sdf:' must be the only key at the top level");
      }
  if (content->is_map())
    fill(sdf, *content, ElementSchema::root(), "");
  else
    problem(sdf.line, "", "expected 'world:' or 'model:' with the elements below it, not " + shown(*content));
  check_top(sdf);
  if (sdf.attribute("version") == nullptr) sdf.attributes.emplace_back("version", converted_version);
  if (sdf.attribute("xmlns:cohort") == nullptr) sdf.attributes.emplace_back("xmlns:cohort", name_space);
  return sdf;
}

}  // namespace

XmlNode sdf_of_yaml(const YamlNode& document, const std::filesystem::path& file, std::vector<Problem>& problems) {
  return Converter(file, problems).convert(document);
}

bool is_sdf_in_yaml(const YamlNode& document) {
  if (!document.is_map()) return false;
  return std::any_of(document.pairs.begin(), document.pairs.end(), [](const auto& pair) {
    const std::string& key = pair.first->text;
    return key == "sdf" || key == "model" || (key == "world" && (pair.second->is_map() || pair.second->is_list()));
  });
}

}  // namespace cohort::parsing
