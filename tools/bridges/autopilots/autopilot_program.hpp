#pragma once

#include <string>
#include <vector>

#include "tools/bridges/autopilots/autopilot_outputs.hpp"
#include "tools/bridges/common/bridge_program.hpp"

namespace cohort::autopilots {

/// The options that bridges of autopilots have besides those of all bridges: where autopilots are awaited, which of
/// their outputs drives what, and what happens while one is silent.
class AutopilotProgram {
 public:
  /// `port`: of the first robot; those of the others follow at a distance of `port_step`. `kind`: `udp` or `tcp`.
  AutopilotProgram(bridges::BridgeProgram& program, std::string kind, unsigned port, unsigned port_step);
  AutopilotProgram(const AutopilotProgram&) = delete;
  AutopilotProgram& operator=(const AutopilotProgram&) = delete;

  /// As `open_link` takes it. Throws UsageError.
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
