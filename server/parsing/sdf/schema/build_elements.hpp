#pragma once

#include <filesystem>
#include <map>
#include <sdf/Element.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/Types.hh>
#include <string>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Makes libsdformat's elements of trees. It does what libsdformat's reader does with a text, in the same order and
/// with the same errors. One thing differs: there, each element gets its own copy of the definitions of all that it
/// could hold, which takes a thousand times the memory of the text. Here, elements share those definitions, which
/// nobody changes.
class ElementBuilder {
 public:
  /// Returns the elements of `tree`, which is SDF of libsdformat's own version without includes and was written in
  /// `version`. Returns null if an element cannot be read. The line number of an element, and of an error, is the place
  /// of its node in `nodes`, from 1 on.
  sdf::SDFPtr build(const XmlNode& tree, const std::string& version, const std::filesystem::path& file,
                    std::vector<const XmlNode*>& nodes, sdf::Errors& errors);

  /// Returns a new element of this definition that holds nothing.
  sdf::ElementPtr element_of(const sdf::ElementPtr& definition);

 private:
  std::map<sdf::ElementPtr, sdf::ElementPtr> bare_;  // by definition: a copy without definitions of children
};

}  // namespace cohort::parsing
