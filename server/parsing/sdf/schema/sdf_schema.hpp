// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"

namespace cohort::parsing {

/// The allowed content of an element, from the rules of SDF or the table of extensions. A value; cheap to copy. For
/// elements that neither defines (below <plugin>, or with the prefix of another simulator) it is `free`: anything is
/// allowed.
class ElementSchema {
 public:
  /// Returns the schema of <sdf>.
  static ElementSchema root();

  /// Returns the schema of a child; `free` if it is not known here.
  ElementSchema child(const std::string& name) const;

  bool is_free() const { return rule_ == nullptr && extension_ == nullptr && key_ == nullptr; }
  /// Returns whether this is an extension, a part of one, or an unknown element with its prefix.
  bool is_extension() const { return extension_ != nullptr || key_ != nullptr || unknown_extension_; }
  /// Returns whether children of any name are allowed.
  bool takes_anything() const;
  bool has_child(const std::string& name) const;
  bool has_attribute(const std::string& name) const;
  /// Returns the same for elements of SDF itself, in less time; true for all others.
  bool knows_child(const std::string& name) const;
  bool knows_attribute(const std::string& name) const;
  /// Returns whether SDF allows it at most once in its parent.
  bool is_single() const;
  bool has_value() const;
  /// Returns whether SDF allows this text as its value. Checks only what does not depend on attributes.
  bool can_have(const std::string& text) const;
  /// Returns whether its value is several numbers.
  bool is_vector() const;

  /// Returns the names of the allowed children, extensions with their prefix.
  std::vector<std::string> children() const;
  std::vector<std::string> attributes() const;

 private:
  std::string name_;
  const ElementRule* rule_ = nullptr;
  Presence presence_ = Presence::any;
  const Extension* extension_ = nullptr;
  const ExtensionKey* key_ = nullptr;
  bool unknown_extension_ = false;
};

}  // namespace cohort::parsing
