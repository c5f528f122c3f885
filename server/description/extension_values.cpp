#include "server/description/extension_values.hpp"

#include <array>
#include <cmath>
#include <set>

#include "server/description/text.hpp"

namespace cohort::description {
namespace {

constexpr std::uint64_t most_instances = 1'000'000;

std::string prefixed(std::string_view name) { return std::string(extension_prefix) + ":" + std::string(name); }

bool has_prefix(const sdf::ElementPtr& element) { return element->GetName().starts_with(prefixed("")); }

std::string_view without_prefix(const sdf::ElementPtr& element) {
  return std::string_view(element->GetName()).substr(extension_prefix.size() + 1);
}

const ExtensionKey* find_key(const Extension& extension, const sdf::ElementPtr& element) {
  if (!has_prefix(element)) return nullptr;
  for (const ExtensionKey& key : extension.keys)
    if (key.name == without_prefix(element)) return &key;
  return nullptr;
}

std::string text_of(const sdf::ElementPtr& element) {
  return element->GetValue() ? std::string(trimmed(element->GetValue()->GetAsString())) : std::string();
}

std::string expected(ExtensionValue kind) {
  switch (kind) {
    case ExtensionValue::name: return "a name";
    case ExtensionValue::uri: return "model://NAME or a path";
    case ExtensionValue::real: return "a number";
    case ExtensionValue::non_negative: return "a number >= 0";
    case ExtensionValue::positive: return "a number > 0";
    case ExtensionValue::count: return "a whole number from 1 to " + std::to_string(most_instances);
    case ExtensionValue::whole: return "a whole number >= 0";
    case ExtensionValue::point: return "two numbers 'x y'";
    case ExtensionValue::pose: return "six numbers 'x y z roll pitch yaw'";
    case ExtensionValue::group: return "elements";
  }
  return {};
}

template <std::size_t count>
std::optional<std::array<double, count>> finite_numbers(std::string_view text) {
  const std::vector<std::string_view> parts = words(text);
  std::array<double, count> numbers{};
  if (parts.size() != count) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> number = parse_real(parts[i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

Pose pose_of(const std::array<double, 6>& v) {
  const auto about = [](double angle, const Eigen::Vector3d& axis) { return Eigen::AngleAxisd(angle, axis); };
  return {{v[0], v[1], v[2]},
          Eigen::Quaterniond(about(v[5], Eigen::Vector3d::UnitZ()) * about(v[4], Eigen::Vector3d::UnitY()) *
                             about(v[3], Eigen::Vector3d::UnitX()))};
}

// The names that an element of this parent may have, with their prefix.
std::vector<std::string> names_in(std::string_view parent) {
  std::vector<std::string> names;
  for (const Extension& extension : extensions())
    if (extension.parent == parent) names.push_back(prefixed(extension.name));
  return names;
}

void report_misplaced(const sdf::ElementPtr& element, std::string_view parent, const SdfReport& report) {
  for (const Extension& extension : extensions())
    if (has_prefix(element) && extension.name == without_prefix(element)) {
      const bool in_sdf = extension.parent == "model" || extension.parent == "world";
      const std::string home = in_sdf ? std::string(extension.parent) : prefixed(extension.parent);
      report.problem(element, "<" + element->GetName() + "> belongs in <" + home + ">");
      return;
    }
  report.problem(element, "unknown element" + suggestion(element->GetName(), names_in(parent)));
}

void report_extensions_below(const sdf::ElementPtr& element, const SdfReport& report) {
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (has_prefix(child))
      report_misplaced(child, element->GetName(), report);
    else if (child->GetName() != "plugin")
      report_extensions_below(child, report);
  }
}

}  // namespace

std::optional<ExtensionValues> ExtensionValues::read(const sdf::ElementPtr& element, const Extension& extension,
                                                     const SdfReport& report) {
  ExtensionValues values;
  values.element_ = element;
  const bool name_is_right = values.read_name(extension, report);
  const bool children_are_right = values.read_children(extension, report);
  if (!name_is_right || !children_are_right) return std::nullopt;
  return values;
}

sdf::ElementPtr ExtensionValues::where(std::string_view key) const {
  const sdf::ElementPtr child = element_->FindElement(prefixed(key));
  return child ? child : element_;
}

bool ExtensionValues::read_name(const Extension& extension, const SdfReport& report) {
  bool valid = true;
  for (const sdf::ParamPtr& attribute : element_->GetAttributes()) {
    const std::string& key = attribute->GetKey();
    if (key.find(':') != std::string::npos || (extension.has_name && key == "name")) continue;
    report.problem(element_, "unknown attribute '" + key + "'");
    valid = false;
  }
  if (!extension.has_name) return valid;
  if (element_->HasAttribute("name")) name_ = trimmed(element_->GetAttribute("name")->GetAsString());
  // A slash separates the parts of the names of channels and instances.
  if (name_.empty() || name_.find('/') != std::string::npos) {
    report.problem(element_, "expected an attribute name=\"NAME\", without '/' in it");
    valid = false;
  }
  return valid;
}

bool ExtensionValues::read_children(const Extension& extension, const SdfReport& report) {
  bool valid = true;
  std::vector<std::string> known;
  for (const ExtensionKey& each : extension.keys) known.push_back(prefixed(each.name));
  std::set<std::string> misspelt;
  for (sdf::ElementPtr child = element_->GetFirstElement(); child; child = child->GetNextElement()) {
    const ExtensionKey* const key = find_key(extension, child);
    if (key == nullptr) {
      report.problem(child, "unknown element" + suggestion(child->GetName(), known));
      if (const auto meant = nearest(child->GetName(), known)) misspelt.insert(*meant);
      valid = false;
    } else if (child != element_->FindElement(child->GetName())) {
      report.problem(child, "<" + child->GetName() + "> is given twice");
      valid = false;
    } else {
      valid = read_child(child, *key, report) && valid;
    }
  }
  for (const ExtensionKey& key : extension.keys) {
    if (element_->HasElement(prefixed(key.name))) continue;
    if (misspelt.contains(prefixed(key.name))) continue;  // one mistake, one message
    if (key.required()) {
      report.problem(element_, "missing: " + std::string(key.doc), prefixed(key.name));
      valid = false;
    } else if (key.value != ExtensionValue::group) {
      values_[key.name] = *parse(key.fallback, key.value);
    }
  }
  return valid;
}

bool ExtensionValues::read_child(const sdf::ElementPtr& child, const ExtensionKey& key, const SdfReport& report) {
  if (key.value == ExtensionValue::group) return true;
  if (const sdf::ElementPtr stray = child->GetFirstElement()) {
    report.problem(stray, "unexpected element; <" + child->GetName() + "> holds " + expected(key.value));
    return false;
  }
  const std::string text = text_of(child);
  if (const std::optional<Value> value = parse(text, key.value)) {
    values_[key.name] = *value;
    return true;
  }
  report.problem(child, "expected " + expected(key.value) + (text.empty() ? "" : ", not '" + text + "'"));
  return false;
}

std::optional<ExtensionValues::Value> ExtensionValues::parse(std::string_view text, ExtensionValue kind) {
  switch (kind) {
    case ExtensionValue::name:
    case ExtensionValue::uri:
      if (text.empty()) return std::nullopt;
      return Value(std::string(text));
    case ExtensionValue::real:
    case ExtensionValue::non_negative:
    case ExtensionValue::positive: {
      const std::optional<double> number = parse_real(text);
      if (!number || !std::isfinite(*number) || (kind == ExtensionValue::non_negative && *number < 0.0) ||
          (kind == ExtensionValue::positive && *number <= 0.0))
        return std::nullopt;
      return Value(*number);
    }
    case ExtensionValue::count:
    case ExtensionValue::whole: {
      const std::optional<std::uint64_t> number = parse_whole(text);
      if (!number || (kind == ExtensionValue::count && (*number == 0 || *number > most_instances))) return std::nullopt;
      return Value(*number);
    }
    case ExtensionValue::point: {
      const auto numbers = finite_numbers<2>(text);
      if (!numbers) return std::nullopt;
      return Value(Eigen::Vector2d((*numbers)[0], (*numbers)[1]));
    }
    case ExtensionValue::pose: {
      const auto numbers = finite_numbers<6>(text);
      if (!numbers) return std::nullopt;
      return Value(pose_of(*numbers));
    }
    case ExtensionValue::group: break;
  }
  return std::nullopt;
}

std::vector<std::pair<sdf::ElementPtr, const Extension*>> extensions_in(const sdf::ElementPtr& element,
                                                                        const SdfReport& report) {
  std::vector<std::pair<sdf::ElementPtr, const Extension*>> found;
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!has_prefix(child)) {
      if (child->GetName() != "model") report_extensions_below(child, report);
    } else if (const Extension* const extension = find_extension(without_prefix(child), element->GetName())) {
      found.emplace_back(child, extension);
    } else {
      report_misplaced(child, element->GetName(), report);
    }
  }
  return found;
}

}  // namespace cohort::description
