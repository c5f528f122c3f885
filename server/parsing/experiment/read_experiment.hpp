#pragma once

#include "server/description/experiment.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// How long a world or a model without an experiment runs.
inline constexpr std::chrono::nanoseconds duration_without_experiment = std::chrono::seconds(10);

/// Reads an experiment (YAML) and its world. Of a world or a model, an experiment without controllers: its robots are
/// in one team, which needs none, and a model stands on a plane. `seed` and `duration`, if given, stand in for the
/// file's; `last_model_folders` are those of `read_world`. `xacro`: whether `file` itself may be expanded. Throws
/// InputError with every problem found.
Experiment read_experiment(const std::filesystem::path& file, std::optional<std::uint64_t> seed = {},
                           std::optional<std::chrono::nanoseconds> duration = {},
                           const std::vector<std::filesystem::path>& last_model_folders = {},
                           Xacro xacro = Xacro::refused);

/// Reads an experiment from the first of `texts`, and what it names of the others, as if they were files of these
/// paths, which need not be there: messages name them, and paths are relative to their folders. Otherwise as the
/// function above.
Experiment read_experiment_texts(const std::vector<KeptFile>& texts, std::optional<std::uint64_t> seed = {},
                                 std::optional<std::chrono::nanoseconds> duration = {},
                                 const std::vector<std::filesystem::path>& last_model_folders = {});

/// Reads an experiment again from what was kept when it was read first, on whatever machine and without looking at any
/// file: the same experiment bit for bit, if `seed` and `duration` are those that it had.
Experiment read_experiment(std::shared_ptr<const KeptFiles> kept, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration);

/// What a recording of the experiment is to hold, in YAML, as the experiment itself would say it after its key
/// `record`. What is not said is as the experiment has it. Throws InputError.
Recorded read_recorded(const std::string& text, const Experiment& experiment);

}  // namespace cohort::parsing
