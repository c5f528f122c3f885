#include "server/parsing/sdf/unknown_names.hpp"

#include <algorithm>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/sdf/sdf_schema.hpp"

namespace cohort::parsing {
namespace {

bool has_any_prefix(const std::string& name) { return name.find(':') != std::string::npos; }

std::string meant_by(const std::string& name, const std::vector<std::string>& known) {
  const auto meant = nearest(name, known);
  return meant ? "; did you mean '" + *meant + "'?" : "";
}

class UnknownInSdf {
 public:
  void take_out_of(XmlNode& node, const ElementSchema& schema, const std::string& path);
  const UnknownNames& found() const { return found_; }

 private:
  void note(const XmlNode& where, const std::string& path, const std::string& message) {
    found_.add({where.file->shown, where.line, path, ""}, message);
  }

  UnknownNames found_;
};

void UnknownInSdf::take_out_of(XmlNode& node, const ElementSchema& schema, const std::string& path) {
  std::erase_if(node.attributes, [&](const auto& attribute) {
    if (has_any_prefix(attribute.first) || schema.knows_attribute(attribute.first)) return false;
    note(node, path,
         "unknown attribute '" + attribute.first + "', which is ignored" +
             meant_by(attribute.first, schema.attributes()));
    return true;
  });
  std::erase_if(node.children, [&](XmlNode& child) {
    if (has_any_prefix(child.name)) return false;
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (!schema.knows_child(child.name)) {
      note(child, child_path,
           "unknown element <" + child.name + ">, which is ignored" + meant_by(child.name, schema.children()));
      return true;
    }
    if (const ElementSchema of_child = schema.child(child.name); !of_child.takes_anything())
      take_out_of(child, of_child, child_path);
    return false;
  });
}

}  // namespace

void UnknownNames::add(const Problem& place, const std::string& message) {
  const auto [known, is_new] = places_.emplace(message, told_.size());
  if (is_new) {
    told_.push_back({place, 0});
    told_.back().first.message = message;
  }
  ++told_[known->second].count;
}

void UnknownNames::tell(std::vector<Problem>& warnings) const {
  for (const auto& [first, count] : told_) {
    warnings.push_back(first);
    if (count > 1) warnings.back().message += "; it stands " + std::to_string(count) + " times in this file";
  }
}

void pass_over_unknown(XmlNode& tree, std::vector<Problem>& warnings) {
  UnknownInSdf unknown;
  unknown.take_out_of(tree, ElementSchema::root(), "");
  unknown.found().tell(warnings);
}

}  // namespace cohort::parsing
