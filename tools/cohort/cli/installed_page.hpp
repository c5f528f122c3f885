#pragma once

#include <filesystem>

namespace cohort::tool {

/// The built page of `cohort view` as it lies beside this program, whether it is there or not.
std::filesystem::path installed_page_folder();

}  // namespace cohort::tool
