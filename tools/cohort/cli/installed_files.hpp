#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// What lies in `../share/cohort` as seen from the folder of the running program, in a build tree as in an
/// installation, whether it is there or not. Empty if the system does not tell where the program is.
namespace cohort::tool {

/// The models that come with Cohort: `robots` and `objects` in `worlds`.
std::vector<std::filesystem::path> installed_model_folders();

/// The experiments that come with Cohort, and all that they need: `worlds`.
std::filesystem::path installed_worlds_folder();

/// Names of the experiments that come with Cohort, in alphabetical order.
std::vector<std::string> installed_experiments();
/// The file of what a person calls an experiment: the name of one that comes with Cohort, unless there is a file of
/// this name; anything else as it is. Throws std::invalid_argument for a name that is neither.
std::filesystem::path experiment_called(const std::filesystem::path& name);

/// The file of what a person calls a model: the name of one that comes with Cohort, unless there is a file of this
/// name; anything else as it is. Throws std::invalid_argument for a name that is neither.
std::filesystem::path model_called(const std::filesystem::path& name);

/// The built page of `cohort view`.
std::filesystem::path installed_page_folder();

}  // namespace cohort::tool
