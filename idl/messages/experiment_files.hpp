#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "idl/messages/cdr.hpp"
#include "server/description/kept_files.hpp"

/// The files of a run's experiment, for clients that read it too: docs/protocol.md, "Control", GetExperiment.
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
  std::vector<std::string> folders;   ///< folders that were searched and exist
  std::vector<ExperimentFile> files;  ///< in ascending order of paths
  bool operator==(const ExperimentFiles&) const = default;
  static constexpr const char* type = "cohort_msgs/msg/ExperimentFiles";
  static constexpr auto fields = std::tuple(
      field("seed", &ExperimentFiles::seed), field("duration_ns", &ExperimentFiles::duration_ns),
      field("experiment", &ExperimentFiles::experiment), field("working_folder", &ExperimentFiles::working_folder),
      field("model_path", &ExperimentFiles::model_path),
      field("last_model_folders", &ExperimentFiles::last_model_folders), field("folders", &ExperimentFiles::folders),
      field("files", &ExperimentFiles::files));
};

/// Returns the message with the files, the seed and the duration of a run.
inline ExperimentFiles experiment_files(const description::KeptFiles& kept, std::uint64_t seed,
                                        std::chrono::nanoseconds duration) {
  ExperimentFiles message{.seed = seed,
                          .duration_ns = duration.count(),
                          .experiment = kept.experiment,
                          .working_folder = kept.working_folder,
                          .model_path = kept.model_path,
                          .last_model_folders = kept.last_model_folders,
                          .folders = kept.folders,
                          .files = {}};
  message.files.reserve(kept.files.size());
  for (const description::KeptFile& file : kept.files)
    message.files.push_back({file.path, {file.bytes.begin(), file.bytes.end()}});
  return message;
}

/// Returns the files in a message, for `parsing::read_experiment`. Throws CdrError if the message has no experiment, a
/// path that is not absolute, or unsorted files.
inline description::KeptFiles kept_files(const ExperimentFiles& message) {
  const auto is_absolute = [](const std::string& path) { return path.starts_with('/'); };
  const auto check = [](bool is_right, const std::string& wrong) {
    if (!is_right) throw CdrError("invalid experiment files: " + wrong);
  };
  check(!message.experiment.empty(), "the path of the experiment is missing");
  check(message.duration_ns > 0, "the duration is not positive");
  check(is_absolute(message.working_folder), "the working folder is not absolute");
  check(std::ranges::all_of(message.folders, is_absolute), "a folder is not absolute");
  check(std::ranges::all_of(message.files, is_absolute, &ExperimentFile::path), "a file's path is not absolute");
  check(std::ranges::adjacent_find(message.files, std::ranges::greater_equal{}, &ExperimentFile::path) ==
            message.files.end(),
        "the files are not unique and sorted by path");
  description::KeptFiles kept{.experiment = message.experiment,
                              .working_folder = message.working_folder,
                              .model_path = message.model_path,
                              .last_model_folders = message.last_model_folders,
                              .files = {},
                              .folders = message.folders};
  kept.files.reserve(message.files.size());
  for (const ExperimentFile& file : message.files)
    kept.files.push_back({file.path, {file.data.begin(), file.data.end()}});
  return kept;
}

}  // namespace cohort::messages
