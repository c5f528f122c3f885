// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/sdf_file.hpp"

namespace cohort::parsing {

/// Reads files in SDF of any version, URDF or YAML as trees of SDF in the newest version. All changes to a file
/// except its includes are made here, in its tree.
class SourceReader {
 public:
  /// Adds problems of a file to `problems`, and ignored features to `warnings`.
  SourceReader(InputFiles& input, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : input_(input), problems_(problems), warnings_(warnings) {}

  /// Sets `tree`, `version` and `is_foreign` of a file from its `path`. Returns false after a problem. `is_included`:
  /// whether another file includes it.
  bool read(SdfFile& file, bool is_included);

 private:
  /// Returns the text; null, with a report, if it cannot be read.
  const std::string* read_text(const SdfFile& file);
  /// Returns the <sdf> element of a file; nothing after a problem.
  std::optional<XmlNode> read_xml(const std::string& text, SdfFile& file);
  std::optional<XmlNode> read_yaml(const std::string& text, const SdfFile& file);
  /// Converts an older version of SDF to the newest. Returns false after a problem.
  bool convert(SdfFile& file);
  /// Returns whether no name contains '::', as required from SDF 1.8 on.
  bool names_are_simple(const XmlNode& node, const std::string& path);
  /// Removes the parts of a file from another source that would only prevent reading it.
  void make_readable(SdfFile& file, bool is_included);
  /// Warns of repeated elements that SDF allows only once; the first is used.
  void warn_of_repeated(const XmlNode& node, const ElementSchema& schema, const std::string& path);

  InputFiles& input_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
};

}  // namespace cohort::parsing
