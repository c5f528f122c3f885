#pragma once

#include <filesystem>
#include <vector>

/// What lies in `../share/cohort` as seen from the folder of the running program, in a build tree as in an
/// installation, whether it is there or not. Empty if the system does not tell where the program is.
namespace cohort::tool {

/// The models that come with Cohort: `robots` and `objects` in `worlds`.
std::vector<std::filesystem::path> installed_model_folders();

/// The built page of `cohort view`.
std::filesystem::path installed_page_folder();

}  // namespace cohort::tool
