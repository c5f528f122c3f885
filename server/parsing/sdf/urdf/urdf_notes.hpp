#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/tree/unknown_names.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {

/// Returns an element as a step of a path, such as `link[NAME]`.
inline std::string urdf_step(const XmlNode& node) { return path_step(node.name, value_of(node, "name")); }

/// Notes about changes in a URDF, for its author. A note about many elements is reported once.
class UrdfNotes {
 public:
  UrdfNotes(const std::filesystem::path& file, std::vector<Problem>& warnings) : file_(file), warnings_(warnings) {}

  void warn(const XmlNode& node, const std::string& path, const std::string& message) {
    warnings_.push_back({file_, node.line, path, message});
  }
  void pass_over(const XmlNode& node, const std::string& path, const std::string& message) {
    unknown_.add({file_, node.line, path, ""}, message);
  }
  void tell() const { unknown_.tell(warnings_); }

 private:
  const std::filesystem::path& file_;
  std::vector<Problem>& warnings_;
  UnknownNames unknown_;
};

}  // namespace cohort::parsing
