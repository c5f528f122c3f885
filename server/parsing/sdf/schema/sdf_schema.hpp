#pragma once

#include <cstddef>
#include <sdf/Element.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/keys/extensions.hpp"

namespace cohort::parsing {

/// What SDFormat's own schema, or the table of extensions, says an element may hold. A value; cheap to copy. Of what
/// neither knows (below <plugin>, or with the prefix of another simulator) it is `free`: anything goes.
class ElementSchema {
 public:
  /// Of <sdf>.
  static ElementSchema root();

  /// Of a child; `free` if it is not known here.
  ElementSchema child(const std::string& name) const;

  bool is_free() const { return !element_ && extension_ == nullptr && key_ == nullptr; }
  /// An extension, a part of one, or an unknown element with its prefix.
  bool is_extension() const { return extension_ != nullptr || key_ != nullptr || unknown_extension_; }
  /// Children of any name may stand in it.
  bool takes_anything() const;
  bool has_child(const std::string& name) const;
  bool has_attribute(const std::string& name) const;
  /// The same of what SDF itself says, in less time; of anything else it is true.
  bool knows_child(const std::string& name) const;
  bool knows_attribute(const std::string& name) const;
  /// SDF has it at most once in its parent.
  bool is_single() const;
  bool has_value() const;
  /// Whether SDF can have this text as its value. Only what depends on no attribute is looked at.
  bool can_have(const std::string& text) const;
  std::string default_text() const;
  /// Its value is several numbers.
  bool is_vector() const;

  /// Those that it may have, extensions with their prefix.
  std::vector<std::string> children() const;
  std::vector<std::string> attributes() const;

 private:
  std::string name_;
  sdf::ElementPtr element_;
  const Extension* extension_ = nullptr;
  const ExtensionKey* key_ = nullptr;
  bool unknown_extension_ = false;
};

/// SDFormat's description of <sdf>. It is shared, and nobody changes it.
const sdf::ElementPtr& sdf_definition();

}  // namespace cohort::parsing
