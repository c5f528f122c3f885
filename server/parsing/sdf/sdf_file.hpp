#pragma once

#include <algorithm>
#include <cstddef>
#include <ignition/math/Pose3.hh>
#include <map>
#include <optional>
#include <sdf/Root.hh>
#include <string>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

struct SdfFile;

/// An <include> of a world, or an independent <model> in it, to which nothing else there refers. If there are
/// references, SdfFile::tree has a <frame> of the same name in its place, or, if they name frames inside the model, a
/// <model> with only its frames.
struct Include {
  std::string name;
  const SdfFile* file = nullptr;
  bool is_static = false;
  std::size_t place = 0;                       ///< models and frames before it in the <world> of the tree
  std::optional<ignition::math::Pose3d> X_WM;  ///< if it has no replacement
  bool is_part = false;                        ///< then `file` is loaded by SdfFiles::load_part; alike ones share it
  bool is_quaternion = false;                  ///< for an independent model: notation of the rotation of `X_WM`
};

/// A file in SDF, URDF or YAML, as a tree of SDF and as elements of libsdformat made from it.
struct SdfFile : SourceFile {
  std::string version;                ///< version of SDF in which it is written
  XmlNode tree;                       ///< SDF in the version of libsdformat, with replacements of includes
  std::size_t size = 0;               ///< elements of `tree`
  std::vector<const XmlNode*> nodes;  ///< nodes of `tree`, by the line numbers of their elements
  std::vector<Include> includes;      ///< directly in <world>, in document order
  sdf::Root root;
  bool loaded = false;                          ///< `root` has the elements of the file
  bool sound = false;                           ///< libsdformat reported no error, so frames can be resolved
  bool complete = true;                         ///< every include was found
  std::string within;                           ///< for an independent model: path of its parent, with a slash
  std::map<std::string, const SdfFile*> parts;  ///< by their content

  /// Returns the node; nullptr if there is none.
  const XmlNode* node_at(int line) const {
    const auto place = static_cast<std::size_t>(line);
    return place < nodes.size() ? nodes[place] : nullptr;
  }
  bool is_include(const std::string& name) const {
    return std::ranges::any_of(includes, [&](const Include& include) { return include.name == name; });
  }
};

}  // namespace cohort::parsing
