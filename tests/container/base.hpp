// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <optional>
#include <string>

#include "tests/support/process.hpp"

namespace cohort::test {

/// Runs to its end, however long that takes: ctest has a limit. All that it writes is in `out`.
inline Ended run_for_long(std::vector<std::string> command, const Process::Environment& environment = {}) {
  command.insert(command.begin(), "/usr/bin/env");
  Process process(command, environment);
  while (process.running()) process.wait_for_exit();
  return {process.wait_for_exit(), process.output(), ""};
}

/// Makes the archives of a clean Debian 12 in the folder; why it cannot be done here, or nothing.
inline std::optional<std::string> make_base(const std::filesystem::path& folder) {
  if (geteuid() != 0) return "Debian can be unpacked by root only";
  if (!is_installed("debootstrap"))
    return "there is no debootstrap: tools/dev/install-packages tools/dev/packages-container.txt";
  const Ended made = run_for_long({COHORT_SOURCE_DIR "/tests/container/make_base", folder});
  if (made.exit_code != 0) return "no Debian can be unpacked here: " + made.out;
  return std::nullopt;
}

}  // namespace cohort::test
