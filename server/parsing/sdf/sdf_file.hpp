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

/// An <include> of a world, or a <model> in it that nothing else there refers to, which is a part by itself. Where
/// others refer to it, or it to them, a <frame> of the same name stands for it in SdfFile::tree, or, where frames
/// inside of the model are named, a <model> with nothing but its frames.
struct Include {
  std::string name;
  const SdfFile* file = nullptr;
  bool is_static = false;
  std::size_t place = 0;                       ///< models and frames before it in the <world> of the tree
  std::optional<ignition::math::Pose3d> X_WM;  ///< if nothing stands for it
  bool is_part = false;                        ///< then `file` is loaded by SdfFiles::load_part; alike ones share it
  bool is_quaternion = false;                  ///< of a part: how the rotation of `X_WM` is written
};

/// A file, in SDF, URDF or YAML, as a tree of SDF and as libsdformat's elements made of it.
struct SdfFile : SourceFile {
  std::string version;                ///< of SDF, that it is written in
  XmlNode tree;                       ///< as SDF of libsdformat's own version, with what stands for includes
  std::size_t size = 0;               ///< elements of `tree`
  std::vector<const XmlNode*> nodes;  ///< of `tree`, by the line numbers of the elements made of them
  std::vector<Include> includes;      ///< directly in <world>, in document order
  sdf::Root root;
  bool loaded = false;                          ///< `root` has the elements of the file
  bool sound = false;                           ///< libsdformat has nothing to say against them, so that frames resolve
  bool complete = true;                         ///< every include was found
  std::string within;                           ///< of a part: the path of what it stands in, with a slash
  std::map<std::string, const SdfFile*> parts;  ///< by their content

  /// nullptr if there is none.
  const XmlNode* node_at(int line) const {
    const auto place = static_cast<std::size_t>(line);
    return place < nodes.size() ? nodes[place] : nullptr;
  }
  bool is_include(const std::string& name) const {
    return std::ranges::any_of(includes, [&](const Include& include) { return include.name == name; });
  }
};

}  // namespace cohort::parsing
