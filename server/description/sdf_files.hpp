#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sdf/Element.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/model_search.hpp"
#include "server/description/xml_outline.hpp"

namespace cohort::description {

/// The name of the element, or the one that an <include> gives; empty if there is none.
std::string name_of(const XmlNode& node);

/// The element as a step of a path, such as `model[NAME]`.
std::string step_of(const XmlNode& node);

struct SdfFile;

/// An <include> of a world.
struct Include {
  int line = 0;
  std::string uri;
  const SdfFile* file = nullptr;
};

/// An SDF file as libsdformat has read it.
struct SdfFile {
  std::filesystem::path path;   ///< absolute
  std::filesystem::path shown;  ///< as the user calls it
  XmlNode xml;
  std::vector<int> source_lines;  ///< by line of `xml`, of a file that is not XML itself; empty if they are the same
  std::vector<Include> includes;  ///< directly in <world>, those that libsdformat has followed, in document order
  sdf::Root root;
  bool loaded = false;  ///< `root` has the elements of the file
  bool sound = false;   ///< libsdformat has nothing to say against them, so that frames resolve

  /// The line of the file as it is written.
  int source_line(int line) const {
    const auto place = static_cast<std::size_t>(line);
    return place < source_lines.size() ? source_lines[place] : line;
  }
};

/// Makes libsdformat read by our rules and print nothing. Its settings are global to the process (an included file is
/// read with the global ParserConfig, whatever the including one was read with), so only one world is read at a time.
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

/// The files that one world is made of. Every file is also read by itself, because what libsdformat finds wrong in an
/// included file it only prints.
class SdfFiles {
 public:
  /// What is wrong with a file goes to `problems`, which must outlive this.
  SdfFiles(const std::filesystem::path& world_file, const std::vector<std::filesystem::path>& last_model_folders,
           std::vector<Problem>& problems);

  const SdfFile& world() { return open(world_file_, world_file_); }

  /// The file of a model. Throws std::runtime_error if there is none.
  const SdfFile& model(const std::string& uri) {
    const FoundModel found = search_.find(uri);
    return open(found.file, found.file);
  }

  /// The file that the URI in `element` names, such as a mesh; a path is relative to the file that the element stands
  /// in. Throws std::runtime_error if there is none.
  std::filesystem::path find_file(const sdf::ElementPtr& element) const;

  Location locate(const sdf::ElementPtr& element) const;

 private:
  SdfFile& open(const std::filesystem::path& path, const std::filesystem::path& shown);
  std::optional<std::string> read_text(const SdfFile& file);
  /// The text as SDF; nothing after a problem.
  std::optional<std::string> read_outline(std::string text, SdfFile& file);
  std::optional<std::string> read_yaml(const std::string& text, SdfFile& file);
  /// False if libsdformat would stumble over it.
  bool follow_includes(const XmlNode& node, const std::string& path, SdfFile& file);
  bool follow_include(const XmlNode& include, const std::string& path, bool in_world, SdfFile& file);
  void load(const std::string& text, SdfFile& file);
  const SdfFile* find(const std::string& path) const;
  int line_of(const sdf::ElementPtr& element) const;

  LibsdformatScope libsdformat_;
  std::filesystem::path world_file_;
  ModelSearch search_;
  std::vector<Problem>& problems_;
  std::map<std::filesystem::path, std::unique_ptr<SdfFile>> files_;  // by absolute path
  std::vector<std::filesystem::path> opening_;                       // from the world inwards
};

}  // namespace cohort::description
