// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "client_sdk/include/cohort/client.hpp"
#include "server/description/experiment.hpp"
#include "tools/bridges/ros2/robots/ros_robot.hpp"
#include "tools/bridges/ros2/ros_program.hpp"
#include "tools/bridges/ros2/simulation_control.hpp"
#include "tools/bridges/ros2/true_poses.hpp"

namespace cohort::ros2 {

/// The robots of one client in the ROS graph. For each frame, publishes it, waits for commands according to each
/// robot's `sync`, and answers. Not thread-safe, except for `stop`.
class RosBridge {
 public:
  struct Options {
    ClientOptions client;
    RosParticipant::Options participant;
    std::optional<GidFormat> gid_format{};                 ///< nullopt: that of the other participants
    std::optional<description::RosSync> sync{};            ///< for all robots; empty: as in the experiment
    std::optional<SimulationControl::Options> services{};  ///< nothing: no services
    std::string command{};                                 ///< shell command of nodes in virtual time; empty: none
    /// Returns the experiment of the run. Called again when an unknown robot appears.
    std::function<std::shared_ptr<const description::Experiment>()> experiment;
    std::function<void(const std::string& text)> tell;
  };
  /// Throws wire::WireError.
  RosBridge(Options options, const std::atomic<bool>& stop);

  /// Runs until the client ends. Throws std::runtime_error if the bridge cannot continue.
  ClientEnd run();

 private:
  void begin(Client& client, const LeaseStart& lease);
  std::vector<std::string> selectors() const;
  void take_entity_changes(Client& client);
  bool is_shown(const DrivenRobot& robot) const;
  RosRobot* show(const DrivenRobot& robot);
  bool is_of_experiment(const std::string& robot) const;
  void add_robot(const DrivenRobot& robot, const description::Model& model);
  const description::Model* model_of(const DrivenRobot& robot) const;
  bool remove_robot(const std::string& name);
  void answer(Client& client, const Frame& frame);
  void wait_for_peers(const Client& client, const Frame& frame);
  void wait_for_commands(const Client& client, const Frame& frame);
  void tell_awaited(const RosRobot& robot, const Frame& frame) const;
  RosRobot* awaited(std::chrono::nanoseconds waited) const;
  void take_messages();
  void note_change();
  void look_at_graph();
  std::optional<GidFormat> gid_format() const;
  void announce();
  void tell(const Frame& frame);
  void start_program(const Client& client, const Frame& frame);
  void let_program_work(const Client& client);
  void wait_until_received(const Client& client) const;
  void end_program();
  std::chrono::nanoseconds end_of(const Frame& frame) const;
  bool is_over(const Client& client) const { return stop_ || client.is_over(); }

  Options options_;
  const std::atomic<bool>& stop_;
  RosInbox inbox_;
  RosParticipant participant_;
  std::atomic<bool> graph_has_changed_{false};
  RosGraph graph_;
  RosWriter clock_;
  std::shared_ptr<const description::Experiment> experiment_;
  std::vector<std::unique_ptr<RosRobot>> robots_;  // sorted by first input
  std::vector<RosRobot*> robot_of_input_;
  std::map<std::uint32_t, RosRobot*> robot_of_id_;
  struct Shown {
    FrameRobot* frame = nullptr;
    RosRobot* robot = nullptr;
  };
  std::vector<Shown> shown_;  // robots of the frame that have topics
  struct Spawned {
    description::ParsedModelPtr model;  // null: a model of the experiment
    bool is_driven = true;
    bool has_lease = false;
  };
  std::map<std::string, Spawned> spawned_;  // by name: robots that services have added
  std::set<std::string> deleted_;           // robots that services have removed from this run
  std::mutex entity_changes_mutex_;
  std::vector<std::variant<SpawnedRobot, std::string>> entity_changes_;  // added robots, and names of removed entities
  std::optional<GidFormat> format_;                                      // nullopt: no participant has shown it yet
  bool is_announced_ = false;
  bool is_first_frame_ = true;  // the next frame is the first of a lease
  bool is_other_run_ = true;
  std::chrono::nanoseconds step_{0};
  std::unique_ptr<RosProgram> program_;
  std::unique_ptr<TruePoses> true_poses_;  // created when first needed
  messages::CdrWriter cdr_;
  std::optional<SimulationControl> services_;
};

}  // namespace cohort::ros2
