// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.hpp"

/// Nodes of ROS 2 that are not ours, in a network that no other test has.
namespace cohort::test {

/// A distribution of ROS 2 whose rclpy tests use.
struct Ros2Distribution {
  std::string name;
  std::string python;  ///< empty if its environment is not there

  std::string missing() const {
    return python.empty() ? "no environment of tools/dev/python-environment --ros2 " + name : std::string();
  }
};

inline const std::vector<Ros2Distribution>& ros2_distributions() {
  static const std::vector<Ros2Distribution> distributions = {{"jazzy", COHORT_ROS2_JAZZY_PYTHON},
                                                              {"kilted", COHORT_ROS2_KILTED_PYTHON}};
  return distributions;
}

/// Why tests with nodes of all distributions cannot run here. Empty if they can.
inline std::string missing_for_ros2() {
  if (run_to_end({"/usr/bin/unshare", "-rnm", "/bin/true"}).exit_code != 0) return "no network namespaces here";
  for (const Ros2Distribution& distribution : ros2_distributions())
    if (!distribution.missing().empty()) return distribution.missing();
  return {};
}

/// Builds interfaces that no wheel has from FOLDER/PACKAGE/{msg,srv}/ (build_interfaces.py). Returns the folder for
/// PYTHONPATH, which is kept for other tests. `name` tells sets of packages apart.
inline std::string build_interfaces(const Ros2Distribution& distribution, const std::string& folder,
                                    const std::string& name, const std::vector<std::string>& packages) {
  const std::string output = COHORT_BUILD_DIR "/ros2_interfaces/" + name + "-" + distribution.name;
  std::vector<std::string> command = {distribution.python, COHORT_SOURCE_DIR "/tests/ros2/build_interfaces.py", folder,
                                      output};
  command.insert(command.end(), packages.begin(), packages.end());
  const Ended ended = run_to_end(command);
  if (ended.exit_code != 0) throw std::runtime_error("interfaces for " + distribution.name + ": " + ended.err);
  return output;
}

/// A network with multicast on its one interface, lo, and with shared memory of its own, which Fast DDS uses. Every
/// domain of DDS in it is free. It ends with this, and so must the processes in it.
class OwnNetwork {
 public:
  OwnNetwork()
      : holder_({"/usr/bin/unshare", "-rnm", "/bin/sh", "-c",
                 "mount -t tmpfs none /dev/shm && ip link set lo up multicast on && "
                 "ip route add 224.0.0.0/4 dev lo && echo ready && exec sleep infinity"}) {
    if (!holder_.wait_for_output("ready")) throw std::runtime_error("no network of its own: " + holder_.output());
  }

  /// The command that runs `command` in this network.
  std::vector<std::string> in(const std::vector<std::string>& command) const {
    std::vector<std::string> result = {
        "/usr/bin/nsenter",      "--target", std::to_string(holder_.pid()), "--user", "--net", "--mount",
        "--preserve-credentials"};
    result.insert(result.end(), command.begin(), command.end());
    return result;
  }

  /// Starts a program in this network.
  std::unique_ptr<Process> start(const std::vector<std::string>& command,
                                 const Process::Environment& environment = {}) const {
    return std::make_unique<Process>(in(command), environment);
  }

  /// Starts a script of tests/ros2 under the rclpy of a distribution.
  std::unique_ptr<Process> start_node(const Ros2Distribution& distribution, const std::string& script,
                                      const std::vector<std::string>& arguments = {},
                                      const Process::Environment& environment = {}) const {
    std::vector<std::string> command = {distribution.python, "-u", COHORT_SOURCE_DIR "/tests/ros2/" + script};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return start(command, environment);
  }

 private:
  Process holder_;
};

}  // namespace cohort::test
