// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/periodic_ticks.hpp"
#include "server/description/experiment.hpp"
#include "server/messages/device_messages.hpp"
#include "server/recording/mcap/writing/recording_file.hpp"
#include "server/recording/measurement_times.hpp"
#include "server/recording/ros_channels.hpp"
#include "server/recording/run_messages.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// A recorder of a run. It reads the simulation at boundaries, changes nothing and never waits for the disk. Log times
/// are simulated time; after a reset they continue from the last one. All functions except `error` are for the thread
/// of the run.
class Recorder {
 public:
  /// Creates the file, and writes the input files of `experiment` and the facts of the machine. Throws FileError if the
  /// file cannot be created.
  Recorder(const std::filesystem::path& file, const description::Experiment& experiment);
  /// Records to a store that the caller provides, with `recorded` instead of the experiment's settings.
  Recorder(std::shared_ptr<ByteStore> store, RecordingOptions options, const description::Experiment& experiment,
           description::Recorded recorded);

  /// Starts to record this world, at a boundary that has not been reported to any listener yet. Both arguments must
  /// outlive their recording.
  void begin(const description::Experiment& experiment, const Simulation& simulation, Beginning reason);

  /// Records events and actions of the current boundary.
  void event(std::string_view kind, std::string_view text, std::uint64_t count);
  void miss(const RecordedMiss& miss);
  void action(std::string_view text, std::span<const std::byte> action);
  /// Records the state of this tick, which includes the actions taken at it.
  void boundary();
  /// Records the changed commands of these robots, which act from this boundary on.
  void commands(std::span<const std::uint32_t> robots);

  /// Passes all recorded data to the operating system. Returns when this is done, or `error` says why not.
  void flush() { file_.flush(); }

  /// Closes the file, and returns when it is closed. `end`: how the run ended, as a keyword such as `finished`;
  /// `reason`: a human-readable reason.
  void finish(std::string_view end, std::string_view reason);
  /// Starts `finish` without waiting for it. The world may be destroyed afterwards.
  void begin_finishing(std::string_view end, std::string_view reason);
  bool is_closed() const { return file_.is_closed(); }

  /// Returns why the recording ended before its run, if it did. For any thread.
  std::optional<std::string> error() const { return file_.error(); }
  /// Returns the number of bytes that wait to be written.
  std::size_t queued() const { return file_.queued(); }
  /// Returns the number of poses and observations that were dropped because the disk was too slow.
  std::uint64_t dropped() const;

 private:
  struct Topic {
    ChannelId channel = 0;
    std::uint32_t sequence = 0;
  };
  template <class Act>
  void unless_memory_lacks(const Act& act);
  template <messages::RosMessage Message>
  Topic add_topic(const std::string& topic, bool is_latched = false);
  template <messages::RosMessage Message>
  void write(Topic& topic, const Message& message, Importance importance = Importance::essential);
  void write_bytes(Topic& topic, ByteView bytes, Importance importance);
  void add_observed();
  bool is_static(std::uint32_t object) const;
  void write_commands(std::span<const std::uint32_t> robots);
  void write_roster();
  void write_snapshot(Importance importance);
  void write_poses();
  void write_joints();
  bool is_observed_now(std::uint32_t robot) const;
  void write_observations();
  struct Measured;
  void write_sensors(std::uint32_t robot, std::span<Measured> topics);
  std::string frame_of(std::uint32_t robot, const std::string& part) const;
  std::string frame_of_link(std::uint32_t robot, std::size_t link) const;
  void write_static_places();
  void add_places(std::uint32_t robot, ros::TFMessage& places) const;
  Topic& topic_of_joints(std::uint32_t object);
  void keep_commands();
  bool is_now(const std::optional<PeriodicTicks>& ticks) const { return ticks && ticks->contains(simulation_->tick()); }

  RecordingFile file_;
  description::Recorded recorded_;
  Topic world_, roster_, boundary_, commands_, action_, event_, miss_, snapshot_, clock_, transforms_;
  Topic static_transforms_{};  // created with the first observed robot
  const description::Experiment* experiment_ = nullptr;
  const Simulation* simulation_ = nullptr;
  std::uint32_t run_ = 0;
  std::chrono::nanoseconds log_offset_{0};
  std::chrono::nanoseconds last_log_time_{0};
  // Empty: never.
  std::optional<PeriodicTicks> pose_ticks_;
  std::optional<PeriodicTicks> joint_ticks_;
  std::optional<PeriodicTicks> observation_ticks_;
  std::optional<PeriodicTicks> snapshot_ticks_;
  struct Measured {
    Topic topic;
    MeasurementTimes times;
  };
  struct Observed {
    std::uint32_t robot = 0;
    Topic topic;
    std::vector<Measured> sensors;  // the messages of its kind's sensors
  };
  std::vector<Observed> observed_;
  std::vector<std::vector<messages::DeviceMessage>> sensors_;  // by kind
  std::map<std::string, Topic> joints_;                        // by object
  SchemaId joint_schema_ = 0;
  // Commands at the boundary, robot after robot: an empty battery also changes them.
  std::vector<double> commands_before_;
  std::vector<std::size_t> command_offsets_;  // by robot
  std::uint32_t robots_told_ = 0;             // number of robots in the last roster
  Commands changes_;                          // reused, like the next member
  messages::CdrWriter cdr_;
};

}  // namespace cohort::recording
