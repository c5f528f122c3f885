// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace cohort::test {

/// Number of values of a command of the s-bot that is shipped with Cohort: tracks, turret, LEDs, loudspeakers and
/// gripper. The tracks come first.
inline constexpr std::size_t sbot_command_size = 32;

}  // namespace cohort::test
