#pragma once

#include <optional>
#include <sdf/ParserConfig.hh>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// Reads files in SDF of any version, URDF or YAML as trees of SDF of libsdformat's own version. All that is changed in
/// a file is changed here, in its tree, but for its includes.
class SourceReader {
 public:
  /// What is wrong with a file goes to `problems`, what is ignored in it to `warnings`.
  SourceReader(InputFiles& input, const sdf::ParserConfig& config, std::vector<Problem>& problems,
               std::vector<Problem>& warnings)
      : input_(input), config_(config), problems_(problems), warnings_(warnings) {}

  /// Sets `tree`, `version` and `is_foreign` of a file by its `path`. Returns false after a problem. `is_included`: by
  /// another file.
  bool read(SdfFile& file, bool is_included);

 private:
  /// Null, and reported, if it cannot be read.
  const std::string* read_text(const SdfFile& file);
  /// The <sdf> element of a file; nothing after a problem.
  std::optional<XmlNode> read_xml(const std::string& text, SdfFile& file);
  std::optional<XmlNode> read_yaml(const std::string& text, const SdfFile& file);
  /// Makes an older version of SDF the newest. Returns false after a problem.
  bool convert(SdfFile& file);
  /// Whether no name has '::' in it, as is the rule from SDF 1.8 on.
  bool names_are_simple(const XmlNode& node, const std::string& path);
  /// Takes out of a file that was not written for Cohort what would only stop it.
  void make_readable(SdfFile& file, bool is_included);
  /// Of an element that SDF has once, the first counts.
  void warn_of_repeated(const XmlNode& node, const ElementSchema& schema, const std::string& path);

  InputFiles& input_;
  const sdf::ParserConfig& config_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
};

}  // namespace cohort::parsing
