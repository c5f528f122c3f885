// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tests/ros2/nodes.hpp"

namespace cohort::test {

/// The program on Fast DDS by which the bridge offers its services.
inline const std::string helper_program = COHORT_BUILD_DIR "/bin/cohort-ros2-services";

/// Returns why there can be no clients of services here, or nothing.
inline std::string missing_for_services() {
  if (!std::filesystem::exists(helper_program)) return "no cohort-ros2-services: libfastrtps-dev is not installed";
  return missing_for_ros2();
}

}  // namespace cohort::test
