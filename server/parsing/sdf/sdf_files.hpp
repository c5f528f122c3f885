#pragma once

#include <filesystem>
#include <ignition/math/Pose3.hh>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sdf/Element.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/model_search.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

class ElementSchema;

/// The name of the element, or the one that an <include> gives; empty if there is none.
std::string name_of(const XmlNode& node);

/// The element as a step of a path, such as `model[NAME]`.
std::string step_of(const XmlNode& node);

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

/// A file, in SDF, URDF or YAML, as SDF that libsdformat has read.
struct SdfFile {
  std::filesystem::path path;         ///< absolute
  std::filesystem::path shown;        ///< as the user calls it
  std::string version;                ///< of SDF, that it is written in
  XmlNode tree;                       ///< as SDF of libsdformat's own version, with what stands for includes
  std::size_t size = 0;               ///< elements of `tree`
  std::vector<const XmlNode*> nodes;  ///< of `tree`, by the line that libsdformat knows them by
  std::vector<Include> includes;      ///< directly in <world>, in document order
  sdf::Root root;
  bool is_foreign = false;                      ///< not written for Cohort: it does not declare our prefix, or is URDF
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
  bool is_include(const std::string& name) const;
};

/// Makes libsdformat read by our rules and print nothing. Its settings are global to the process, so only one world is
/// read at a time.
class LibsdformatScope {
 public:
  LibsdformatScope();
  ~LibsdformatScope();
  LibsdformatScope(const LibsdformatScope&) = delete;
  LibsdformatScope& operator=(const LibsdformatScope&) = delete;

  sdf::ParserConfig& config() { return sdf::ParserConfig::GlobalConfig(); }

 private:
  std::scoped_lock<std::mutex> lock_;
  sdf::ParserConfig saved_;
};

/// Where an element stands, for messages.
struct Location {
  std::filesystem::path file;
  int line = 0;
  std::string element;
};

/// The files that one world is made of. Each is read once, by itself: libsdformat would read an included file again for
/// each <include>, and only print what is wrong with it.
class SdfFiles {
 public:
  /// What is wrong with a file goes to `problems`, what is ignored in it to `warnings`. All three must outlive this.
  SdfFiles(InputFiles& input, const std::filesystem::path& world_file,
           const std::vector<std::filesystem::path>& last_model_folders, std::vector<Problem>& problems,
           std::vector<Problem>& warnings);

  const SdfFile& world() { return open(world_file_, world_file_); }

  /// The file of a model that the world file names. Throws std::runtime_error if there is none.
  const SdfFile& model(const std::string& uri) {
    const FoundModel found = search_.find(uri, world_folder_);
    return open(found.file, found.file);
  }

  /// Reads a model that is a part by itself. It costs libsdformat 1000 times its text: so one after the other, and each
  /// is let go when its description is made.
  const SdfFile& load_part(const SdfFile& part);
  void let_go(const SdfFile& part);

  /// The file that the URI in `element` names, such as a mesh; a path is relative to the file that the element stands
  /// in. Throws std::runtime_error if there is none.
  std::filesystem::path find_file(const sdf::ElementPtr& element) const;

  Location locate(const sdf::ElementPtr& element) const;
  /// Whether it stands in a file that was not written for Cohort.
  bool is_foreign(const sdf::ElementPtr& element) const;
  InputFiles& input() const { return input_; }

 private:
  SdfFile& open(const std::filesystem::path& path, const std::filesystem::path& shown);
  /// A file that was not written for Cohort, without what would only stop it.
  void make_readable(SdfFile& file);
  /// Null, and reported, if it cannot be read.
  const std::string* read_text(const SdfFile& file);
  /// The <sdf> element of a file, in whatever format it is written; nothing after a problem.
  std::optional<XmlNode> read_source(const std::string& text, SdfFile& file);
  std::optional<XmlNode> read_xml(const std::string& text, SdfFile& file);
  std::optional<XmlNode> read_yaml(const std::string& text, const SdfFile& file);
  /// An older version of SDF as the newest, with its includes as they are.
  std::optional<XmlNode> converted(XmlNode tree, SdfFile& file);
  /// The same of what has no includes. `aside`: what marks in it stand for.
  std::optional<XmlNode> convert(const XmlNode& tree, const std::vector<XmlNode>& aside, SdfFile& file);
  /// Whether no name has '::' in it, as is the rule from SDF 1.8 on.
  bool names_are_simple(const XmlNode& node, const std::string& path);
  /// Of an element that SDF has once, the first counts.
  void warn_of_repeated(const XmlNode& node, const ElementSchema& schema, const std::string& path);
  void load(SdfFile& file);
  /// Sets `loaded`; what libsdformat finds wrong.
  std::vector<Problem> try_to_load(SdfFile& file);
  const SdfFile* find(const std::string& path) const;
  const XmlNode* node_of(const sdf::ElementPtr& element) const;

  // In sdf_includes.cpp.
  struct Found;
  struct Named;
  /// Puts into the place of each include what stands for it. False if libsdformat would stumble over the rest.
  bool replace_includes(XmlNode& node, const std::string& path, SdfFile& file);
  /// Nothing if there is nothing to be put into its place.
  std::optional<Found> follow(const XmlNode& include, const std::string& path, SdfFile& file);
  /// In a world of others, where another model has its name.
  void rename_include(XmlNode& include, const std::string& path, const std::set<std::string>& taken, Found& found);
  static void replace_in_model(const XmlNode& include, const Found& found, bool merges, std::vector<XmlNode>& children);
  /// False as `fits`.
  bool replace_in_world(const XmlNode& include, const std::string& path, const Found& found, const Named& named,
                        std::vector<XmlNode>& children, SdfFile& file);
  bool fits(const XmlNode& include, const std::string& path, const SdfFile& included, SdfFile& file);
  /// False if others refer to the model.
  bool set_apart(XmlNode& model, const Named& named, std::size_t place, SdfFile& file);

  LibsdformatScope libsdformat_;
  InputFiles& input_;
  std::filesystem::path world_file_;
  std::filesystem::path world_folder_;
  ModelSearch search_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
  std::map<std::filesystem::path, std::unique_ptr<SdfFile>> files_;    // by absolute path
  std::vector<std::filesystem::path> opening_;                         // from the world inwards
  std::pair<std::set<std::string>, sdf::ElementPtr> last_definition_;  // of SDF with nothing but these names
};

}  // namespace cohort::parsing
