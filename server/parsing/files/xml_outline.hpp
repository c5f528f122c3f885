// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// A file that contains elements.
struct SourceFile {
  std::filesystem::path path;   ///< absolute
  std::filesystem::path shown;  ///< path for messages, as the user writes it
  bool is_foreign = false;      ///< from another source: without the prefix of Cohort, or in URDF
};

/// An element of an XML file and the line where it starts.
struct XmlNode {
  std::string name;
  int line = 0;
  const SourceFile* file = nullptr;  ///< source file, in a tree that is made from several files
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< all text directly inside, without white space at the ends
  std::vector<XmlNode> children;
  /// The path of the element in its source file, if the element was renamed or moved; otherwise empty. For a part of a
  /// link from a URDF, the path starts below the model; otherwise it starts with the world.
  std::string written = {};

  /// Returns the child of this name; nullptr if there is none.
  const XmlNode* child(std::string_view child_name) const;
  /// Returns the value of the attribute; nullptr if there is none.
  const std::string* attribute(std::string_view attribute_name) const;
};

struct XmlSyntaxError {
  int line = 0;
  std::string message;
};

/// The elements of an XML text.
struct XmlOutline {
  XmlNode root;
  std::optional<XmlSyntaxError> error;  ///< then `root` is not complete
};

XmlOutline outline_xml(std::string_view text);

/// Does the same for invalid XML that other programs accept: with "--" in comments, text around the root, a bare "&",
/// or the encoding "ASCII".
XmlOutline outline_loose_xml(std::string_view text);

/// Returns whether the text can be the name of an element or an attribute.
bool is_xml_name(std::string_view name);

}  // namespace cohort::parsing
