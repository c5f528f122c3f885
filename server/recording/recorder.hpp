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

#include "idl/messages/device_messages.hpp"
#include "server/description/experiment.hpp"
#include "server/recording/mcap/writing/recording_file.hpp"
#include "server/recording/ros_channels.hpp"
#include "server/recording/run_messages.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::recording {

/// Records a run: an observer, which reads the simulation at its boundaries, changes nothing and never waits for the
/// disk. Log times are simulated time; where a world begins anew they go on from the last one. The thread that runs
/// calls everything but `error`.
class Recorder {
 public:
  /// Makes the file, and writes down what `experiment` was read from and where it runs. Throws FileError if the file
  /// cannot be made.
  Recorder(const std::filesystem::path& file, const description::Experiment& experiment);
  /// To a store of the caller's, with `recorded` in place of what the experiment says of recordings.
  Recorder(std::shared_ptr<ByteStore> store, RecordingOptions options, const description::Experiment& experiment,
           description::Recorded recorded);

  /// From now on it is about this world, which stands at a boundary of which no one has been told yet. Both must
  /// outlive what is recorded of them.
  void begin(const description::Experiment& experiment, const Simulation& simulation, Beginning reason);

  /// These happened at the present boundary.
  void event(std::string_view kind, std::string_view text, std::uint64_t count);
  void miss(const RecordedMiss& miss);
  void action(std::string_view text, std::span<const std::byte> action);
  /// The state of this tick is complete, with the actions taken at it.
  void boundary();
  /// The commands of these robots have changed and act from this boundary on.
  void commands(std::span<const std::uint32_t> robots);

  /// Closes the file, and returns when it is closed. `end`: how the run ended, in a word, and why.
  void finish(std::string_view end, std::string_view reason);
  /// The same without waiting for it. From here on the world may go.
  void begin_finishing(std::string_view end, std::string_view reason);
  bool is_closed() const { return file_.is_closed(); }

  /// Why the recording has ended before its run, if it has. Any thread.
  std::optional<std::string> error() const { return file_.error(); }
  /// Bytes that wait to be written.
  std::size_t queued() const { return file_.queued(); }
  /// Poses and observations that were dropped since the disk was too slow.
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
  void write_observations();
  void write_sensors(std::uint32_t robot, std::span<Topic> topics, ros::TFMessage& places);
  Topic& topic_of_joints(std::uint32_t object);
  void keep_commands();
  bool is_now(std::uint64_t interval) const { return interval != 0 && simulation_->tick() % interval == 0; }

  RecordingFile file_;
  description::Recorded recorded_;
  Topic world_, roster_, boundary_, commands_, action_, event_, miss_, snapshot_, clock_, transforms_;
  const description::Experiment* experiment_ = nullptr;
  const Simulation* simulation_ = nullptr;
  std::uint32_t run_ = 0;
  std::chrono::nanoseconds log_offset_{0};
  std::chrono::nanoseconds last_log_time_{0};
  // In ticks; 0: never.
  std::uint64_t pose_interval_ = 0;
  std::uint64_t joint_interval_ = 0;
  std::uint64_t observation_interval_ = 0;
  std::uint64_t snapshot_interval_ = 0;
  struct Observed {
    std::uint32_t robot = 0;
    Topic topic;
    std::vector<Topic> sensors;  // as those of its kind
  };
  std::vector<Observed> observed_;
  std::vector<std::vector<messages::DeviceMessage>> sensors_;  // by kind
  std::map<std::string, Topic> joints_;                        // by object
  SchemaId joint_schema_ = 0;
  // As they stand at the boundary, robot after robot: an empty battery changes them too.
  std::vector<double> commands_before_;
  std::vector<std::size_t> command_offsets_;  // by robot
  std::uint32_t robots_told_ = 0;             // in the last roster
  Commands changes_;                          // reused, like the next
  messages::CdrWriter cdr_;
};

}  // namespace cohort::recording
