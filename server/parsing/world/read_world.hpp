// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/parsed_model.hpp"
#include "server/description/world.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/world/later_object.hpp"

namespace cohort::parsing {

/// Reads a world in SDF or YAML, and expands its includes and, by `seed`, its `cohort:population`
/// elements. The instances are the models and includes in document order, then the populations in theirs.
/// `model://NAME` is searched for in the folders of COHORT_MODEL_PATH (an environment variable), in `robots` and
/// `objects` beside the file and in up to four parents, and in `last_model_folders`. Other URIs are paths relative to
/// the file; docs/sdf.md has the details. `later`: instances that are not present initially; they come last. Throws
/// InputError with all problems. Callable from any thread.
World read_world(const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders = {},
                 const std::vector<LaterObject>& later = {});

/// Does the same with files from `input`, which keeps what is read.
World read_world(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders = {},
                 const std::vector<LaterObject>& later = {});

/// Does the same; a file with only a model becomes a world with this model at the origin. `xacro`: whether `file`
/// itself may be expanded.
World read_world_or_model(const std::filesystem::path& file, std::uint64_t seed,
                          const std::vector<std::filesystem::path>& last_model_folders = {},
                          Xacro xacro = Xacro::refused);

/// Does the same; a single model is placed on a plane (`stand_on_plane`).
World read_world_or_standing_model(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                                   const std::vector<std::filesystem::path>& last_model_folders);

/// Returns a reader of models from text, whose errors name lines of the text. Files that a text includes or names, such
/// as a mesh, must be in `inputs`; null means no files. `folder`: base of relative paths in the text.
ModelReader model_reader(std::shared_ptr<const KeptFiles> inputs, std::filesystem::path folder);

}  // namespace cohort::parsing
