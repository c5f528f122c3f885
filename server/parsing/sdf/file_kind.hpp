// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

enum class FileKind {
  experiment,  ///< also for anything else
  sdf          ///< a world or a model, in SDF, URDF or YAML
};

/// Returns the kind of a file that the user names: by its extension, or else by its content, since an experiment names
/// its world and a world file contains it.
FileKind kind_of_file(const std::filesystem::path& file);
FileKind kind_of_file(InputFiles& input, const std::filesystem::path& file);

/// Returns true if the file, of the kind `sdf`, holds a model and no world. Throws std::runtime_error if it cannot be
/// read.
bool holds_lone_model(const std::filesystem::path& file);
bool holds_lone_model(InputFiles& input, const std::filesystem::path& file);

bool is_yaml(const std::filesystem::path& file);

}  // namespace cohort::parsing
