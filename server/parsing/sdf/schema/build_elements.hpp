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

/// Makes elements of libsdformat from trees. It works like the reader of libsdformat, in the same order and with the
/// same errors, with one difference. There, each element gets its own copy of the definitions of all possible children,
/// which takes a thousand times the memory of the text. Here, elements share those definitions, which are never
/// changed.
class ElementBuilder {
 public:
  /// Returns the elements of `tree`, which has the SDF version of libsdformat and no includes, and was written in
  /// `version`. Returns null if an element cannot be read. The line number of an element, and of an error, is the index
  /// of its node in `nodes`, from 1.
  sdf::SDFPtr build(const XmlNode& tree, const std::string& version, const std::filesystem::path& file,
                    std::vector<const XmlNode*>& nodes, sdf::Errors& errors);

  /// Returns a new empty element of this definition.
  sdf::ElementPtr element_of(const sdf::ElementPtr& definition);

 private:
  std::map<sdf::ElementPtr, sdf::ElementPtr> bare_;  // by definition: a copy without definitions of children
};

}  // namespace cohort::parsing
