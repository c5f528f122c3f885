// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace cohort::description {

/// A file with the content that it had when it was read.
struct KeptFile {
  std::string path;  ///< absolute
  std::string bytes;
};

/// All files that were read for an experiment. From them it can be read again on another machine with the same result,
/// even if the files no longer exist (`read_experiment` of experiment.hpp).
struct KeptFiles {
  std::string experiment;      ///< its file, as given by the user
  std::string working_folder;  ///< absolute; base of relative paths
  std::string model_path;      ///< the environment variable COHORT_MODEL_PATH
  std::vector<std::string> last_model_folders;
  std::vector<std::string> settings{};  ///< values that replace those of the files, as PATH=VALUE, in order
  std::vector<KeptFile> files;          ///< all files that were read, ascending by path
  std::vector<std::string> folders;     ///< folders that were searched for and found; absolute, ascending
};

}  // namespace cohort::description
