// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cohort/kinematic_tree.hpp>
#include <cohort/parameters.hpp>
#include <cohort/state.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// The interface for authors of controllers: derive one class from Controller, and end the file with
/// COHORT_CONTROLLER(Class). The same source builds as a program and as a plugin (`cohort_add_controller` in CMake
/// builds both). `cohort run --controllers inprocess` and `cohort host` load plugins.
///
/// Values are float64 in SI units. The documentation of each device (docs/reference) defines the quantities and the
/// frames of its channels. Objects of this header may not be shared between threads. The SDK calls all controllers of a
/// process on one thread, one after the other; with `cohort host --inline`, on one of two threads at a time.
namespace cohort {

/// The description of a channel: `size` float64 values in a robot's observation or command.
struct ChannelInfo {
  std::string name;          ///< `device/index/quantity`, such as `proximity/3/reading`
  std::string unit;          ///< SI; `1` if dimensionless
  std::uint32_t offset = 0;  ///< index of its first value in the observation or command
  std::uint32_t size = 1;    ///< number of values
  double lower = 0.0;        ///< lower bound; infinite if there is none
  double upper = 0.0;        ///< upper bound; infinite if there is none
  double neutral = 0.0;      ///< value of a command until it is set
};

/// A handle of an observation channel. Look it up in `start`; it is valid until the next `start`, for this robot only.
struct ObservationChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

/// A handle of a command channel. Look it up in `start`; it is valid until the next `start`, for this robot only.
struct CommandChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
  double lower = 0.0;
  double upper = 0.0;
};

/// The error thrown if no channel has the given name, or if the number of matching channels is zero or wrong. The
/// message lists similar names of the robot's channels.
class ChannelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class StartReason {
  first,     ///< the run begins
  takeover,  ///< another process drove this robot before; the run continues from `Start::tick`
  reset,     ///< the world was rebuilt
  restored,  ///< the world was restored from a snapshot
  going_on,  ///< the client has claimed more robots; for this one, nothing has changed (only in <cohort/client.hpp>)
  check,     ///< `cohort check --load-controllers` and `cohort run` test the start; no step follows
};

/// The information that a controller receives at its start: before its first step, and after each reset, restore and
/// takeover.
class Start {
 public:
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped name, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< name of the robot's team in the experiment file
  std::string controller;   ///< name of the team's controller in the experiment file
  Parameters parameters;    ///< the team's parameters in the experiment file
  StartReason reason = StartReason::first;
  std::uint64_t tick = 0;  ///< tick of the next observation
  std::uint64_t seed =
      0;  ///< seed for the controller's random numbers; derived from the experiment's seed and the robot's name
  std::chrono::nanoseconds step{0};  ///< simulated time between ticks
  std::uint32_t period = 1;          ///< number of ticks from one observation to the next
  std::vector<ChannelInfo> observation_channels;
  std::vector<ChannelInfo> command_channels;
  /// The robot's links, joints and sensors. Empty if the server supports only version 1.3 of the protocol or older
  /// ones, or if the client's identity was made by such a version.
  KinematicTree tree;

  /// Returns the simulated time from one step of the controller to the next [s].
  double seconds_per_step() const { return std::chrono::duration<double>(step).count() * period; }

  /// Returns the observation channel with this name. Throws ChannelError if there is none.
  ObservationChannel observation(std::string_view name) const;
  /// Returns all observation channels whose names match `pattern`, in the order of their values. `*` matches any
  /// characters except `/`. Throws ChannelError if none match.
  std::vector<ObservationChannel> observations(std::string_view pattern) const;
  /// Acts like `observations(pattern)`; also throws ChannelError if the number of matches is not `count`.
  std::vector<ObservationChannel> observations(std::string_view pattern, std::size_t count) const;
  /// Returns the command channel with this name. Throws ChannelError if there is none.
  CommandChannel command(std::string_view name) const;
  /// Returns all command channels whose names match `pattern`, like `observations`.
  std::vector<CommandChannel> commands(std::string_view pattern) const;
};

/// One robot's sensor readings at one tick. Valid during `step` only. Use only channels that were looked up in this
/// robot's `start`; handles are not checked, and other handles give arbitrary values.
class Observation {
 public:
  Observation(std::uint64_t tick, std::chrono::nanoseconds time, std::span<const double> values)
      : tick_(tick), time_(time), values_(values) {}

  std::uint64_t tick() const { return tick_; }
  std::chrono::nanoseconds time() const { return time_; }  ///< simulated time since tick 0
  /// Returns the value of a channel, or the first value if it has several.
  double operator[](ObservationChannel channel) const { return values_[channel.offset]; }
  /// Returns all values of a channel.
  std::span<const double> values(ObservationChannel channel) const {
    return values_.subspan(channel.offset, channel.size);
  }

 private:
  std::uint64_t tick_;
  std::chrono::nanoseconds time_;
  std::span<const double> values_;
};

/// One robot's command. At the start of each step, every channel has its neutral value, so that a command does not
/// depend on earlier ones. Valid during `step` only.
class Command {
 public:
  explicit Command(std::span<double> values) : values_(values) {}

  /// Sets value `index` of a channel, clamped to the channel's range. The channel must have been looked up in this
  /// robot's `start`, and `index` must be less than its size; neither is checked. The server rejects NaN and reports
  /// the name of the channel.
  void set(CommandChannel channel, double value, std::size_t index = 0) {
    if (value < channel.lower) value = channel.lower;
    if (value > channel.upper) value = channel.upper;
    values_[channel.offset + index] = value;
  }

 private:
  std::span<double> values_;
};

/// A controller of one robot, the base class of controllers. Each robot has its own object, created by the default
/// constructor; one thread calls all of them. An exception from the constructor, `start`, `step`, `save` or `load` ends
/// the run with its message. During a call, the run waits as long as the team's `on_late` allows.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Looks up channels and reads parameters; an exception reports an error in the experiment. Called before the first
  /// step and each time the run restarts. Also called on objects that are created only to find errors early
  /// (StartReason::check): check the reason before you open a device or a file.
  virtual void start(const Start& start) = 0;
  /// Computes a command from an observation. For bit-identical runs, the command must depend only on the arguments of
  /// the last `start` and of all steps since. So do not use a clock, a random device, or state that robots share.
  virtual void step(const Observation& observation, Command& command) = 0;

  // Keep these last and in this order: a program detects from a plugin's `abi` whether they exist.

  /// Writes the state accumulated since `start`, at most `largest_state` bytes. Called between steps, when a snapshot
  /// of the run is taken. A controller without state writes nothing, or derives from StatelessController. A controller
  /// that does not override `save` restarts, with a warning, when the run continues from a snapshot.
  virtual void save(StateWriter& state) const { state.leave_out(); }
  /// Reads everything that `save` of the same class wrote in another object or process, and continues from that state.
  /// Called immediately after `start`, with the same channels, parameters and seed as that object.
  virtual void load(StateReader&) {}
};

/// A controller without state between steps. A run that continues from a snapshot creates a new object, with the same
/// results.
class StatelessController : public Controller {
 public:
  void save(StateWriter&) const final {}
};

/// The symbol `cohort_plugin` that a plugin exports; COHORT_CONTROLLER defines it. A program loads every plugin whose
/// `abi` it supports, even if it was compiled with another build of Cohort.
struct Plugin {
  static constexpr std::uint32_t current_abi = 4;
  static constexpr std::uint32_t oldest_abi = 2;            ///< oldest version that is loaded
  static constexpr std::uint32_t first_abi_with_state = 3;  ///< first version whose controllers have `save` and `load`
  std::uint32_t abi = 0;                   ///< current_abi of the headers with which the plugin was built
  const char* name = nullptr;              ///< name of the class, for messages
  Controller* (*create)() = nullptr;       ///< may throw
  void (*destroy)(Controller*) = nullptr;  ///< destroys what `create` returned
};

/// Runs a controller as a program with the options `--robots`, `--server`, `--domain`, `--secure` and `--help`; its
/// `main` calls this. Shuts down cleanly on SIGINT and SIGTERM. Returns the exit code: 0 if the run finished, 1 if the
/// run or a controller failed, 2 for invalid options or a refused claim, 130 if interrupted. Prints the reason to
/// standard error unless the code is 0.
int run_controller(const Plugin& plugin, int argc, char** argv);

}  // namespace cohort

#ifdef COHORT_BUILDS_PLUGIN
#define COHORT_CONTROLLER_MAIN
#else
#define COHORT_CONTROLLER_MAIN \
  int main(int argc, char** argv) { return ::cohort::run_controller(cohort_plugin, argc, argv); }
#endif

/// Defines the plugin symbol and the `main` function of a controller. Use this macro once, at the end of a source file,
/// outside namespaces and without a semicolon. `Class` must derive from Controller and have a default constructor.
#define COHORT_CONTROLLER(Class)                                                                  \
  extern "C" __attribute__((visibility("default"))) const ::cohort::Plugin cohort_plugin = {      \
      ::cohort::Plugin::current_abi, #Class, []() -> ::cohort::Controller* { return new Class; }, \
      [](::cohort::Controller* controller) { delete controller; }};                               \
  COHORT_CONTROLLER_MAIN
