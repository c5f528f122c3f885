#pragma once

#include <filesystem>

#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

enum class FileKind {
  experiment,  ///< also whatever is none of the others
  sdf          ///< a world or a model, in SDF, URDF or YAML
};

/// What a file that a user names is: by its extension, and otherwise by its content, since an experiment names its
/// world and a world's file holds it.
FileKind kind_of_file(const std::filesystem::path& file);
FileKind kind_of_file(InputFiles& input, const std::filesystem::path& file);

bool is_yaml(const std::filesystem::path& file);

}  // namespace cohort::parsing
