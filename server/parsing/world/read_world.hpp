#pragma once

#include "server/description/parsed_model.hpp"
#include "server/description/world.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/world/later_object.hpp"

namespace cohort::parsing {

/// Reads a world, in SDF or YAML, with libsdformat and expands its includes and, by `seed`, its `cohort:population`
/// elements. The instances are the models and includes in document order, then the populations in theirs.
/// `model://NAME` is looked for in the folders of the environment variable COHORT_MODEL_PATH, in `robots` and `objects`
/// in the folder of the file and in its parents, four levels up, and in `last_model_folders`; other URIs are paths
/// relative to the file. docs/worlds.md has the details. `later`: instances that are not present at first; they come
/// last. Throws InputError with every problem found. Callable from any thread; calls wait for each other.
World read_world(const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders = {},
                 const std::vector<LaterObject>& later = {});

/// The same from `input`, which goes on keeping what was read.
World read_world(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders = {},
                 const std::vector<LaterObject>& later = {});

/// The same; a file with a model alone is a world with nothing but this model, at the origin. `xacro`: whether `file`
/// itself may be expanded.
World read_world_or_model(const std::filesystem::path& file, std::uint64_t seed,
                          const std::vector<std::filesystem::path>& last_model_folders = {},
                          Xacro xacro = Xacro::refused);

/// The same; a model alone stands on a plane (`stand_on_plane`).
World read_world_or_standing_model(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                                   const std::vector<std::filesystem::path>& last_model_folders);

/// Returns what reads models by their text, with errors that name lines of the text. What a text includes or names,
/// such as a mesh, has to be in `inputs`; null is nothing. `folder`: where relative paths in the text begin.
ModelReader model_reader(std::shared_ptr<const KeptFiles> inputs, std::filesystem::path folder);

}  // namespace cohort::parsing
