// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/parse_schema.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace cohort::messages {
namespace {

using FieldId = RosFieldType;

const std::map<std::string_view, int> basic_types = {
    {"bool", FieldId::boolean},    {"byte", FieldId::byte},     {"char", FieldId::uint8},
    {"int8", FieldId::int8},       {"uint8", FieldId::uint8},   {"int16", FieldId::int16},
    {"uint16", FieldId::uint16},   {"int32", FieldId::int32},   {"uint32", FieldId::uint32},
    {"int64", FieldId::int64},     {"uint64", FieldId::uint64}, {"float32", FieldId::float32},
    {"float64", FieldId::float64}, {"string", FieldId::string},
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Removes the text before `end`, and `end`, from the beginning and returns it; the whole text if there is no `end`.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return taken;
}

bool is_word(std::string_view text) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return !text.empty() && text.find_first_not_of(letters) == std::string_view::npos;
}

std::size_t length_in(std::string_view digits) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw SchemaError("'" + std::string(digits) + "' is not a length");
  return value;
}

// Returns `package/msg/Name` for `Name`, `package/Name` or itself. `package` is that of the enclosing message.
std::string full_type(std::string_view name, std::string_view package) {
  std::vector<std::string_view> parts;
  for (std::string_view rest = name; !rest.empty();) parts.push_back(take_until(rest, '/'));
  const bool has_package = parts.size() > 1 || !package.empty();
  if (parts.empty() || parts.size() > 3 || !has_package || !std::ranges::all_of(parts, is_word))
    throw SchemaError("'" + std::string(name) + "' is not a type name");
  if (parts.size() == 1) return std::string(package) + "/msg/" + std::string(name);
  if (parts.size() == 2) return std::string(parts[0]) + "/msg/" + std::string(parts[1]);
  return std::string(name);
}

// Reads a type such as `float64[9]`, `string<=10`, `Pose[<=3]`.
RosFieldType field_type(std::string_view text, std::string_view package) {
  RosFieldType type;
  int several = 0;
  if (const std::size_t bracket = text.find('['); bracket != std::string_view::npos) {
    if (text.back() != ']') throw SchemaError("'" + std::string(text) + "' has no closing ']'");
    std::string_view length = text.substr(bracket + 1, text.size() - bracket - 2);
    several = length.empty()             ? RosFieldType::unbounded_sequence
              : length.starts_with("<=") ? RosFieldType::bounded_sequence
                                         : RosFieldType::array;
    if (length.starts_with("<=")) length.remove_prefix(2);
    if (!length.empty()) type.capacity = length_in(length);
    text = text.substr(0, bracket);
  }
  if (constexpr std::string_view bounded = "string<="; text.starts_with(bounded)) {
    type.id = RosFieldType::bounded_string;
    type.string_capacity = length_in(text.substr(bounded.size()));
  } else if (const auto basic = basic_types.find(text); basic != basic_types.end()) {
    type.id = basic->second;
  } else if (text == "wstring" || text == "wchar") {
    throw SchemaError("fields of the type " + std::string(text) + " are not supported");
  } else {
    type.id = RosFieldType::nested;
    type.nested_type = full_type(text, package);
  }
  type.id += several;
  return type;
}

// Returns the field of a line; nothing if the line has none.
std::optional<RosField> parsed_field(std::string_view line, std::string_view package) {
  line = trimmed(line.substr(0, line.find('#')));
  if (line.empty()) return {};
  const std::size_t end = line.find_first_of(" \t");
  if (end == std::string_view::npos) throw SchemaError("'" + std::string(line) + "' has no field name");
  const std::string_view type = line.substr(0, end);
  const std::string_view rest = trimmed(line.substr(end));
  const std::size_t name_end = std::min(rest.find_first_of(" \t="), rest.size());
  const std::string_view name = rest.substr(0, name_end);
  if (trimmed(rest.substr(name_end)).starts_with('=')) return {};  // a constant
  if (!is_word(name)) throw SchemaError("'" + std::string(name) + "' is not a field name");
  return RosField{std::string(name), field_type(type, package)};
}

// Returns a definition without its fields.
RosDefinition without_fields(std::string type) {
  std::string name = short_type(type);
  return {std::move(name), "", {}, std::move(type), {}};
}

void check_parts(const RosDefinition& definition, const std::set<std::string>& known) {
  for (const RosField& each : definition.fields)
    if (!each.type.nested_type.empty() && !known.contains(each.type.nested_type))
      throw SchemaError("the schema of " + definition.type + " does not define " + each.type.nested_type);
}

}  // namespace

RosDefinition parse_schema(std::string_view type, std::string_view text) {
  RosDefinition result = without_fields(full_type(type, ""));
  RosDefinition* current = &result;
  std::set<std::string> known;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = take_until(rest, '\n');
    if (constexpr std::string_view begin = "MSG: "; line.starts_with(begin)) {
      current = &result.parts.emplace_back(without_fields(full_type(trimmed(line.substr(begin.size())), "")));
      known.insert(current->type);
    } else if (!line.starts_with("====")) {
      const std::string package = current->type.substr(0, current->type.find('/'));
      if (auto added = parsed_field(line, package)) {
        current->text += std::string(line) + "\n";
        current->fields.push_back(*std::move(added));
      }
    }
  }
  check_parts(result, known);
  for (const RosDefinition& part : result.parts) check_parts(part, known);
  return result;
}

}  // namespace cohort::messages
