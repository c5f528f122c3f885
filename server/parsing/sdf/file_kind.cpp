// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/file_kind.hpp"

#include <sstream>
#include <string>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/yaml/yaml_document.hpp"

namespace cohort::parsing {
namespace {

// Guesses the kind of a text that is not valid YAML: a world is below its key, the name of a world file beside it.
bool starts_like_sdf(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("sdf:") || line.starts_with("model:")) return true;
    if (!line.starts_with("world:")) continue;
    const std::string_view rest = trimmed(std::string_view(line).substr(6));
    return rest.empty() || std::string_view("{&#").find(rest[0]) != std::string_view::npos;
  }
  return false;
}

bool has_model_alone(const YamlNode& map) { return map.find("model") != nullptr && map.find("world") == nullptr; }

}  // namespace

bool is_yaml(const std::filesystem::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml"; }

FileKind kind_of_file(const std::filesystem::path& named) {
  const std::filesystem::path file = without_links(named);
  InputFiles disk;
  disk.trust(file);
  return kind_of_file(disk, file);
}

FileKind kind_of_file(InputFiles& input, const std::filesystem::path& file) {
  for (const char* const extension : {".sdf", ".world", ".urdf", ".xacro"})
    if (file.extension() == extension) return FileKind::sdf;
  if (input.why_unreadable(file)) return FileKind::experiment;
  const std::string& text = input.read(file);
  if (!is_yaml(file)) return trimmed(text).starts_with('<') ? FileKind::sdf : FileKind::experiment;
  const YamlDocument document = parse_yaml(text);
  const bool is_sdf = document.root ? is_sdf_in_yaml(*document.root) : starts_like_sdf(text);
  return is_sdf ? FileKind::sdf : FileKind::experiment;
}

bool holds_lone_model(const std::filesystem::path& named) {
  const std::filesystem::path file = without_links(named);
  InputFiles disk;
  disk.trust(file);
  return holds_lone_model(disk, file);
}

bool holds_lone_model(InputFiles& input, const std::filesystem::path& file) {
  const std::string& text = input.read(file);
  if (!is_yaml(file)) {
    const XmlNode root = outline_loose_xml(text).root;
    return root.name == "robot" || (root.child("model") != nullptr && root.child("world") == nullptr);
  }
  const YamlDocument document = parse_yaml(text);
  if (!document.root) return false;
  const YamlNode* const sdf = document.root->find("sdf");
  return has_model_alone(*document.root) || (sdf != nullptr && has_model_alone(*sdf));
}

}  // namespace cohort::parsing
