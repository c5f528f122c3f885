// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/core/pose.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/element.hpp"
#include "server/parsing/sdf/frames.hpp"

namespace cohort::parsing {

struct SdfFile;

/// An <include> of a world, or an independent <model> in it, to which nothing else there refers. If there are
/// references, SdfFile::tree has a <frame> of the same name in its place, or, if they name frames inside the model, a
/// <model> with only its frames.
struct Include {
  std::string name;
  const SdfFile* file = nullptr;
  bool is_static = false;
  std::size_t place = 0;     ///< number of models and frames before it in the <world> of the tree
  std::optional<Pose> X_WM;  ///< if it has no replacement
  bool is_part = false;      ///< then `file` is loaded by SdfFiles::load_part; alike ones share it
};

/// A file in SDF, URDF or YAML, as a tree of SDF and its elements.
struct SdfFile : SourceFile {
  std::string version;                          ///< version of SDF in which it is written
  XmlNode tree;                                 ///< SDF in the newest version, with replacements of includes
  std::size_t size = 0;                         ///< elements of `tree`
  std::vector<Include> includes;                ///< directly in <world>, in document order
  std::unique_ptr<ElementTree> elements;        ///< those of `tree`; null if the file cannot be read
  std::unique_ptr<Frames> frames;               ///< those of its world; null if it has none
  std::unique_ptr<Frames> model_frames;         ///< those of its model; null if it has none
  bool sound = false;                           ///< no problem was found, so frames can be resolved
  bool complete = true;                         ///< every include was found
  std::map<std::string, const SdfFile*> parts;  ///< by their content

  /// Returns the first element of this kind below the root; nullptr if there is none.
  const Element* first(std::string_view kind) const { return elements ? elements->root().child(kind) : nullptr; }
  const Element* model() const { return first("model"); }
};

}  // namespace cohort::parsing
