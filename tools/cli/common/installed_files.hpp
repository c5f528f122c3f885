// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Paths in `../share/cohort`, relative to the folder of the running program, both in a build tree and in an
/// installation. They need not exist. They are empty if the system does not report the program's path.
namespace cohort::tool {

/// Returns the folders of the models that are installed with Cohort: `robots` and `objects` in `worlds`.
std::vector<std::filesystem::path> installed_model_folders();

/// Returns `worlds`, the folder of the experiments that are installed with Cohort, and of all files that they need.
std::filesystem::path installed_worlds_folder();

/// Returns the names of the experiments that are installed with Cohort, in alphabetical order.
std::vector<std::string> installed_experiments();
/// Returns the names of the models that are installed with Cohort, in alphabetical order.
std::vector<std::string> installed_models();
/// Returns the file of the model of this name that is installed with Cohort, or nothing.
std::optional<std::filesystem::path> installed_model(const std::string& name);
/// Returns the names of the robots that are installed with Cohort, in alphabetical order.
std::vector<std::string> installed_robots();
/// Returns the file of an experiment or a model that is installed with Cohort if `name` names one and no file has this
/// name. Returns any other path unchanged. Throws std::invalid_argument for a plain name that is unknown.
std::filesystem::path experiment_called(const std::filesystem::path& name);

/// Returns the file of a model that is installed with Cohort if `name` names one and no file has this name. Returns any
/// other path unchanged. Throws std::invalid_argument for a plain name that is neither.
std::filesystem::path model_called(const std::filesystem::path& name);

/// Returns the folder of the built page of `cohort view`.
std::filesystem::path installed_page_folder();

}  // namespace cohort::tool
