// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/bridges/autopilots/autopilot_outputs.hpp"
#include "tools/bridges/common/bridge_program.hpp"

namespace cohort::autopilots {

/// The options of bridges to autopilots, in addition to those of all bridges: where autopilots connect, which channel
/// each of their outputs drives, and the reaction to a silent autopilot.
class AutopilotProgram {
 public:
  /// `port` is the first robot's port; each further robot's port is `port_step` higher. `kind` is `udp` or `tcp`.
  AutopilotProgram(bridges::BridgeProgram& program, std::string kind, unsigned port, unsigned port_step);
  AutopilotProgram(const AutopilotProgram&) = delete;
  AutopilotProgram& operator=(const AutopilotProgram&) = delete;

  /// Returns a robot's link in the format of `open_link`. Throws UsageError.
  std::string link_of(std::size_t robot) const;

  /// Filled when the command line has been read.
  const std::vector<Output>& outputs() const { return outputs_; }

 private:
  std::string kind_;
  unsigned port_;
  unsigned port_step_;
  std::string address_ = "127.0.0.1";
  std::vector<Output> outputs_;
};

}  // namespace cohort::autopilots
