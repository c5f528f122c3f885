#pragma once

#include <string>
#include <vector>

namespace cohort::description {

/// A file as it was when it was read.
struct KeptFile {
  std::string path;  ///< absolute
  std::string bytes;
};

/// Everything that reading an experiment took from the machine, so that it can be read again elsewhere, with the same
/// result, when the files are no more (`read_experiment` of experiment.hpp).
struct KeptFiles {
  std::string experiment;      ///< its file, as it was named
  std::string working_folder;  ///< absolute; what a relative path is relative to
  std::string model_path;      ///< the environment variable COHORT_MODEL_PATH
  std::vector<std::string> last_model_folders;
  std::vector<KeptFile> files;       ///< each that was read, once; ascending by path
  std::vector<std::string> folders;  ///< those that were looked for and found; absolute, ascending
};

}  // namespace cohort::description
