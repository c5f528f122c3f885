#pragma once

#include <filesystem>
#include <vector>

namespace cohort::tool {

/// The folders of models that come with Cohort, whether they exist or not: `robots` and `objects` in
/// `../share/cohort/worlds` as seen from the folder of the running program, in a build tree as in an installation.
/// Empty if the system does not tell where the program is.
std::vector<std::filesystem::path> installed_model_folders();

}  // namespace cohort::tool
