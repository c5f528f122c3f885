#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// A file that elements are written in.
struct SourceFile {
  std::filesystem::path path;   ///< absolute
  std::filesystem::path shown;  ///< as the user calls it
  bool is_foreign = false;      ///< not written for Cohort: it does not declare our prefix, or is URDF
};

/// An element of an XML file and the line where it starts.
struct XmlNode {
  std::string name;
  int line = 0;
  const SourceFile* file = nullptr;  ///< where it was written, in a tree that is put together from several
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< all text directly inside, without white space at the ends
  std::vector<XmlNode> children;

  /// nullptr if there is none.
  const XmlNode* child(std::string_view child_name) const;
  /// nullptr if there is none.
  const std::string* attribute(std::string_view attribute_name) const;
};

struct XmlSyntaxError {
  int line = 0;
  std::string message;
};

/// The elements of an XML text. libsdformat does not say where an XML file is broken, nor on which line an element
/// stands that is not its own, nor what a file includes before it has gone to look for it; so these are read here.
struct XmlOutline {
  XmlNode root;
  std::optional<XmlSyntaxError> error;  ///< then `root` is not complete
};

XmlOutline outline_xml(std::string_view text);

/// The same of a text that others read though it is no XML: with "--" in comments, or text around the root.
XmlOutline outline_loose_xml(std::string_view text);

/// Whether it can be the name of an element or an attribute.
bool is_xml_name(std::string_view name);

struct XmlText {
  std::string text;
  std::vector<const XmlNode*> nodes;  ///< by line, from 1; in place 0 is nothing
};

/// An element as XML text, each element starting on a line of its own. `node` must outlive the result.
XmlText xml_text_of(const XmlNode& node);

}  // namespace cohort::parsing
