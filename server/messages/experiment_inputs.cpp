// SPDX-License-Identifier: Apache-2.0
#include "server/messages/experiment_inputs.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

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

description::KeptFiles kept_files(cohort::ExperimentFiles files) {
  const auto is_absolute = [](const std::string& path) { return path.starts_with('/'); };
  const auto check = [](bool is_right, const std::string& wrong) {
    if (!is_right) throw std::invalid_argument("invalid experiment files: " + wrong);
  };
  check(!files.experiment.empty(), "the path of the experiment is missing");
  check(files.duration.count() > 0, "the duration is not positive");
  check(is_absolute(files.working_folder), "the working folder is not absolute");
  check(std::ranges::all_of(files.folders, is_absolute), "a folder is not absolute");
  check(std::ranges::all_of(files.files, is_absolute, &cohort::ExperimentFile::path), "a file's path is not absolute");
  check(std::ranges::adjacent_find(files.files, std::ranges::greater_equal{}, &cohort::ExperimentFile::path) ==
            files.files.end(),
        "the files are not unique and sorted by path");
  description::KeptFiles kept{.experiment = std::move(files.experiment),
                              .working_folder = std::move(files.working_folder),
                              .model_path = std::move(files.model_path),
                              .last_model_folders = std::move(files.last_model_folders),
                              .settings = std::move(files.settings),
                              .files = {},
                              .folders = std::move(files.folders)};
  kept.files.reserve(files.files.size());
  for (cohort::ExperimentFile& file : files.files)
    kept.files.push_back({std::move(file.path), std::move(file.content)});
  return kept;
}

}  // namespace cohort::messages
