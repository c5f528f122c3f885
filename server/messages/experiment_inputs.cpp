// SPDX-License-Identifier: Apache-2.0
#include "server/messages/experiment_inputs.hpp"

#include <algorithm>
#include <functional>
#include <string>

namespace cohort::messages {

ExperimentFiles experiment_files(const description::KeptFiles& kept, std::uint64_t seed,
                                 std::chrono::nanoseconds duration) {
  ExperimentFiles message{.seed = seed,
                          .duration_ns = duration.count(),
                          .experiment = kept.experiment,
                          .working_folder = kept.working_folder,
                          .model_path = kept.model_path,
                          .last_model_folders = kept.last_model_folders,
                          .folders = kept.folders,
                          .files = {},
                          .settings = kept.settings};
  message.files.reserve(kept.files.size());
  for (const description::KeptFile& file : kept.files)
    message.files.push_back({file.path, {file.bytes.begin(), file.bytes.end()}});
  return message;
}

description::KeptFiles kept_files(const ExperimentFiles& message) {
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
                              .settings = message.settings,
                              .files = {},
                              .folders = message.folders};
  kept.files.reserve(message.files.size());
  for (const ExperimentFile& file : message.files)
    kept.files.push_back({file.path, {file.data.begin(), file.data.end()}});
  return kept;
}

}  // namespace cohort::messages
