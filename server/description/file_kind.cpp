#include "server/description/file_kind.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include "server/description/input_file.hpp"
#include "server/description/yaml_document.hpp"
#include "server/description/yaml_sdf.hpp"

namespace cohort::description {

bool is_yaml(const std::filesystem::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml"; }

FileKind kind_of_file(const std::filesystem::path& file) {
  for (const char* const extension : {".sdf", ".world", ".urdf"})
    if (file.extension() == extension) return FileKind::sdf;
  if (!is_yaml(file) || why_unreadable(file)) return FileKind::experiment;
  std::ifstream stream(file);
  const YamlDocument document = parse_yaml(std::string(std::istreambuf_iterator<char>(stream), {}));
  return document.root && is_sdf_in_yaml(*document.root) ? FileKind::sdf : FileKind::experiment;
}

}  // namespace cohort::description
