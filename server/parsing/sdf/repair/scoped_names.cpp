// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/scoped_names.hpp"

#include <set>
#include <string>
#include <string_view>

#include "server/parsing/sdf/tree/counted_warnings.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

constexpr std::string_view between = "::";

std::string joined(std::string name) {
  for (std::size_t at = name.find(between); at != std::string::npos; at = name.find(between, at))
    name.replace(at, between.size(), ".");
  return name;
}

/// The scoped names of one model, and their replacements.
class ScopedNames {
 public:
  ScopedNames(const std::filesystem::path& file, CountedWarnings& told) : file_(file), told_(told) {}

  void collect(const XmlNode& node, const std::string& path);
  void join_in(XmlNode& node) const;

 private:
  void join(std::string& text) const;

  const std::filesystem::path& file_;
  CountedWarnings& told_;
  std::set<std::string> names_;
};

void ScopedNames::collect(const XmlNode& node, const std::string& path) {
  if (node.name == "plugin" || node.name.find(':') != std::string::npos) return;
  if (const std::string name = name_of(node); name.find(between) != std::string::npos && names_.insert(name).second)
    told_.add({file_, node.line, path, ""}, "a name cannot contain '::'; it is replaced by '.'");
  for (const XmlNode& child : node.children) collect(child, path + "/" + step_of(child));
}

// Replaces a name, also at the front of a longer scoped name.
void ScopedNames::join(std::string& text) const {
  if (text.find(between) == std::string::npos) return;
  for (std::size_t end = text.size(); end != std::string::npos && end > 0; end = text.rfind(between, end - 1)) {
    const std::string name = text.substr(0, end);
    if (!names_.contains(name)) continue;
    text.replace(0, end, joined(name));
    return;
  }
}

void ScopedNames::join_in(XmlNode& node) const {
  join(node.text);
  for (auto& [name, value] : node.attributes) join(value);
  for (XmlNode& child : node.children) join_in(child);
}

void join_in_parts(XmlNode& node, const std::string& path, const std::filesystem::path& file, CountedWarnings& told) {
  for (XmlNode& child : node.children) {
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (child.name == "world") {
      join_in_parts(child, child_path, file, told);
      continue;
    }
    ScopedNames names(file, told);
    names.collect(child, child_path);
    names.join_in(child);
  }
}

}  // namespace

void join_scoped_names(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>* warnings) {
  CountedWarnings told;
  join_in_parts(sdf, "", file, told);
  if (warnings != nullptr) told.tell(*warnings);
}

}  // namespace cohort::parsing
