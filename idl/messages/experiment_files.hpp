// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"

/// The files of a run's experiment, for clients that read the experiment themselves: docs/protocol.md, "Control",
/// GetExperiment.
namespace cohort::messages {

struct ExperimentFile {
  std::string path;                ///< absolute, on the server's machine
  std::vector<std::uint8_t> data;  ///< content of the file
  bool operator==(const ExperimentFile&) const = default;
  static constexpr const char* type = "cohort_msgs/msg/ExperimentFile";
  static constexpr auto fields = std::tuple(field("path", &ExperimentFile::path), field("data", &ExperimentFile::data));
};

struct ExperimentFiles {
  std::uint64_t seed = 0;        ///< seed of the run
  std::int64_t duration_ns = 0;  ///< simulated duration of the experiment
  std::string experiment;        ///< path of the experiment, as given to the server
  std::string working_folder;    ///< absolute; base of relative paths
  std::string model_path;        ///< COHORT_MODEL_PATH of the server
  std::vector<std::string> last_model_folders;
  std::vector<std::string> folders;     ///< folders that were searched and exist
  std::vector<ExperimentFile> files;    ///< in ascending order of paths
  std::vector<std::string> settings{};  ///< values that replace those of the files, as PATH=VALUE
  bool operator==(const ExperimentFiles&) const = default;
  static constexpr const char* type = "cohort_msgs/msg/ExperimentFiles";
  static constexpr std::size_t least_fields = 8;  // protocol 1.3
  static constexpr auto fields = std::tuple(
      field("seed", &ExperimentFiles::seed), field("duration_ns", &ExperimentFiles::duration_ns),
      field("experiment", &ExperimentFiles::experiment), field("working_folder", &ExperimentFiles::working_folder),
      field("model_path", &ExperimentFiles::model_path),
      field("last_model_folders", &ExperimentFiles::last_model_folders), field("folders", &ExperimentFiles::folders),
      field("files", &ExperimentFiles::files), field("settings", &ExperimentFiles::settings));
};

}  // namespace cohort::messages
