// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/container/base.hpp"
#include "tests/support/files.hpp"

namespace cohort::test {

// A Debian 12 that has nothing but its base, in a mount namespace of its own.
class CleanDebian {
 public:
  explicit CleanDebian(const std::filesystem::path& archive) {
    const Ended unpacked = run_for_long({"tar", "-C", root_.path(), "-xf", archive});
    if (unpacked.exit_code != 0) throw std::runtime_error(unpacked.out);
    std::filesystem::copy_file("/etc/resolv.conf", root_ / "etc/resolv.conf",
                               std::filesystem::copy_options::overwrite_existing);
  }

  std::filesystem::path operator/(const std::string& name) const { return root_ / name; }

  Ended run(const std::string& script) const { return run_for_long(command(script), environment); }
  /// Returns the command that runs the script in there, with these variables.
  std::vector<std::string> command(const std::string& script) const {
    return {"unshare", "--mount", "/bin/sh", "-ec",
            // `ip netns exec` requires a root that is a mount point.
            R"(mount --bind "$0" "$0"; mount -t proc proc "$0/proc"; exec chroot "$0" /bin/sh -ec "$1")", root_.path(),
            script};
  }
  static inline const Process::Environment environment = {
      {"DEBIAN_FRONTEND", "noninteractive"}, {"LC_ALL", "C"}, {"COHORT_PLUGIN_PATH", ""}};

 private:
  ScratchFolder root_;
};

/// Returns what prints the state hash of five seconds of the demo, by a Python that has the package.
inline std::string hash_in_python(const std::string& python) {
  return python + " -c \"import cohort; print('%016x' % cohort.run('obstacle_avoidance', duration=5).state_hash)\"";
}

}  // namespace cohort::test
