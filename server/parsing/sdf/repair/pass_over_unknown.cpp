// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/pass_over_unknown.hpp"

#include <algorithm>
#include <string>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/tree/counted_warnings.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

std::string meant_by(const std::string& name, const std::vector<std::string>& known) {
  const auto meant = nearest(name, known);
  return meant ? "; did you mean '" + *meant + "'?" : "";
}

class UnknownInSdf {
 public:
  void take_out_of(XmlNode& node, const ElementSchema& schema, const std::string& path);
  const CountedWarnings& found() const { return found_; }

 private:
  void note(const XmlNode& where, const std::string& path, const std::string& message) {
    found_.add({where.file->shown, where.line, path, ""}, message);
  }

  CountedWarnings found_;
};

void UnknownInSdf::take_out_of(XmlNode& node, const ElementSchema& schema, const std::string& path) {
  std::erase_if(node.attributes, [&](const auto& attribute) {
    if (has_any_prefix(attribute.first) || schema.knows_attribute(attribute.first)) return false;
    note(node, path,
         "ignored the unknown attribute '" + attribute.first + "'" + meant_by(attribute.first, schema.attributes()));
    return true;
  });
  std::erase_if(node.children, [&](XmlNode& child) {
    if (has_any_prefix(child.name)) return false;
    const std::string child_path = path_below(path, child);
    if (!schema.knows_child(child.name)) {
      note(child, child_path,
           "ignored the unknown element <" + child.name + ">" + meant_by(child.name, schema.children()));
      return true;
    }
    if (const ElementSchema of_child = schema.child(child.name); !of_child.takes_anything())
      take_out_of(child, of_child, child_path);
    return false;
  });
}

}  // namespace

void pass_over_unknown(XmlNode& tree, std::vector<Problem>& warnings) {
  UnknownInSdf unknown;
  unknown.take_out_of(tree, ElementSchema::root(), "");
  unknown.found().tell(warnings);
}

}  // namespace cohort::parsing
