// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

#include "tools/bridges/ros2/service_host.hpp"

namespace cohort::ros2 {

/// The services of simulation_interfaces in the ROS graph, with one client that controls the run.
class SimulationControl {
 public:
  struct Options {
    ControlOptions control;
    EntityServices::MakeExperiment experiment;
    EntityListener listener{};
    InterfaceVersion version = InterfaceVersion::v1;
    ServiceHelper::Options helper;
  };
  /// Setting `stop` ends all waits. Throws ControlError or wire::WireError.
  SimulationControl(RosParticipant& participant, RosGraph& graph, const Options& options, const std::atomic<bool>& stop)
      : stop_(stop),
        services_(options.control, options.experiment, options.listener, options.version, end_),
        host_(participant, graph, services_.all(), options.helper, stop) {}
  /// Waits until the present request is answered, which may be the one that has ended the run, unless `stop` is set.
  ~SimulationControl() {
    if (!stop_) host_.wait_for_request(std::chrono::seconds(3));
    end_ = true;
  }
  SimulationControl(const SimulationControl&) = delete;
  SimulationControl& operator=(const SimulationControl&) = delete;

  /// Announces the helper's node to other participants. Any thread.
  void announce(GidFormat format) { host_.announce(format); }

 private:
  const std::atomic<bool>& stop_;
  std::atomic<bool> end_{false};
  SimulationServices services_;
  ServiceHost host_;
};

}  // namespace cohort::ros2
