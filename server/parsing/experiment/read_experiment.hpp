// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/experiment.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Duration of a world or a model without an experiment.
inline constexpr std::chrono::nanoseconds duration_without_experiment = std::chrono::seconds(10);

/// Duration of a run that only its user ends: 285 years.
inline constexpr std::chrono::nanoseconds without_end = std::chrono::seconds(9'000'000'000);

/// Reads an experiment (YAML) and its world. A world or a model becomes an experiment without controllers: its robots
/// are in one team that needs none, and a model is placed on a plane. `seed` and `duration`, if given, replace those of
/// the file; `last_model_folders` are those of `read_world`. `xacro`: whether `file` itself may be expanded.
/// `settings`: values that replace those of the experiment or its world, as PATH=VALUE (yaml/setting.hpp). Throws
/// InputError with all problems, and std::invalid_argument for a setting of another form.
Experiment read_experiment(const std::filesystem::path& file, std::optional<std::uint64_t> seed = {},
                           std::optional<std::chrono::nanoseconds> duration = {},
                           const std::vector<std::filesystem::path>& last_model_folders = {},
                           Xacro xacro = Xacro::refused, const std::vector<std::string>& settings = {});

/// Reads a file with only a model like `read_experiment`, but with a position motor on each joint
/// (`text_with_joint_motors`). Reads any other file like `read_experiment`.
Experiment read_experiment_with_joint_motors(const std::filesystem::path& file, std::optional<std::uint64_t> seed = {},
                                             std::optional<std::chrono::nanoseconds> duration = {},
                                             const std::vector<std::filesystem::path>& last_model_folders = {},
                                             Xacro xacro = Xacro::refused,
                                             const std::vector<std::string>& settings = {});

/// Reads an experiment from the first of `texts`, and the files to which it refers from the others. The paths of the
/// texts need not exist; they appear in messages, and relative paths start at their folders. Otherwise like
/// `read_experiment`.
Experiment read_experiment_texts(const std::vector<KeptFile>& texts, std::optional<std::uint64_t> seed = {},
                                 std::optional<std::chrono::nanoseconds> duration = {},
                                 const std::vector<std::filesystem::path>& last_model_folders = {});

/// Reads an experiment again from the files that were kept when it was first read, on any machine and without access to
/// other files. The result is identical if `seed` and `duration` are the same.
Experiment read_experiment(std::shared_ptr<const KeptFiles> kept, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration);

/// Reads the contents of a recording of the experiment from YAML, with the keys of `record` in an experiment. Absent
/// keys keep the values of the experiment. Throws InputError.
Recorded read_recorded(const std::string& text, const Experiment& experiment);

}  // namespace cohort::parsing
