// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/model_search.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/element.hpp"
#include "server/parsing/sdf/read_source.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// The position of an element, for messages.
struct Location {
  std::filesystem::path file;
  int line = 0;
  std::string element;
};

/// The files of one world. Each is read once, separately, and used for every <include> of it.
class SdfFiles {
 public:
  /// Adds problems of a file to `problems`, and ignored features to `warnings`. All three must outlive this.
  SdfFiles(InputFiles& input, const std::filesystem::path& world_file,
           const std::vector<std::filesystem::path>& last_model_folders, std::vector<Problem>& problems,
           std::vector<Problem>& warnings);

  const SdfFile& world() { return open(world_file_, world_file_); }

  /// Returns the file of a model that the world file names. Throws std::runtime_error if there is none.
  const SdfFile& model(const std::string& uri) {
    const FoundModel found = search_.find(uri, world_folder_);
    return open(found.file, found.file);
  }

  /// Makes the elements of an independent model. Models are loaded one after the other and released when their
  /// descriptions are made, since elements need more memory than descriptions.
  const SdfFile& load_part(const SdfFile& part);
  void let_go(const SdfFile& part);

  /// Returns the file that the URI in `element` names, such as a mesh; a path is relative to the file of the element.
  /// Throws std::runtime_error if there is none.
  std::filesystem::path find_file(const Element* element) const;
  /// Does the same for a URI in another file, such as a mesh; a path is relative to `folder`.
  std::filesystem::path find_file(const std::string& uri, const std::filesystem::path& folder) const {
    return search_.find_file(uri, folder);
  }

  static Location locate(const Element* element);
  InputFiles& input() const { return input_; }

 private:
  SdfFile& open(const std::filesystem::path& path, const std::filesystem::path& shown);
  /// Makes elements from the tree of a file; reports problems.
  void load(SdfFile& file);

  // Defined in sdf_includes.cpp.
  struct Found;
  struct Named;
  /// Replaces each include. Returns false if the rest cannot be used.
  bool replace_includes(XmlNode& node, const std::string& path, SdfFile& file);
  bool replace_in_children_of_world(XmlNode& world, const std::string& path, SdfFile& file);
  /// Returns the replacement of an include; nothing if there is none.
  std::optional<Found> follow(const XmlNode& include, const std::string& path, SdfFile& file);
  /// Renames an include in a world from another source if another model has its name.
  void rename_include(XmlNode& include, const std::string& path, const std::set<std::string>& taken, Found& found);
  static void replace_in_model(const XmlNode& include, const Found& found, std::vector<XmlNode>& children);
  /// Replaces each include of a world that merges a model by the parts of this model. Returns false if `fits` does.
  bool merge_in_world(XmlNode& world, const std::string& path, SdfFile& file);
  /// Replaces an include of a world. Returns false if `fits` does.
  bool replace_in_world(const XmlNode& include, const std::string& path, const Found& found, const Named& named,
                        std::vector<XmlNode>& children, SdfFile& file);
  /// Counts the elements of an included file; returns false, with a report, if the including file then has too many.
  bool fits(const XmlNode& include, const std::string& path, const SdfFile& included, SdfFile& file);
  /// Moves a model of a world into a separate part of the file. Returns false if it must stay, because other elements
  /// refer to it or its name or pose is not usual.
  bool set_apart(XmlNode& model, const Named& named, std::size_t place, SdfFile& file);

  InputFiles& input_;
  std::filesystem::path world_file_;
  std::filesystem::path world_folder_;
  ModelSearch search_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
  std::map<std::filesystem::path, std::unique_ptr<SdfFile>> files_;  // by absolute path
  std::vector<std::filesystem::path> opening_;                       // from the world inwards
  SourceReader reader_;
};

}  // namespace cohort::parsing
