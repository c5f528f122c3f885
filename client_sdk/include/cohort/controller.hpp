#pragma once

#include <chrono>
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

/// The interface for authors of controllers: one class derived from Controller, and COHORT_CONTROLLER(Class). The same
/// source builds as a program and as a plugin (`cohort_add_controller` in CMake makes both). `cohort run --controllers
/// inprocess` and `cohort host` load plugins.
///
/// Values are float64 in SI units. The documentation of each device says what its channels measure or move, and in
/// which frame (docs/reference). Nothing here may be shared between threads. The SDK calls all controllers of a process
/// on one thread, one after the other; with `cohort host --inline`, on one of two threads at a time.
namespace cohort {

/// A channel as described by the server: `size` float64 values in a robot's observation or command.
struct ChannelInfo {
  std::string name;          ///< `device/index/quantity`, such as `proximity/3/reading`
  std::string unit;          ///< SI; `1` if dimensionless
  std::uint32_t offset = 0;  ///< index of its first value among the robot's values
  std::uint32_t size = 1;    ///< number of values
  double lower = 0.0;        ///< lower bound; infinite if there is none
  double upper = 0.0;        ///< upper bound; infinite if there is none
  double neutral = 0.0;      ///< value of a command until it is set
};

/// Handle of an observation channel. It is looked up in `start` and valid until the next `start`, for this robot only.
struct ObservationChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

/// Handle of a command channel. It is looked up in `start` and valid until the next `start`, for this robot only.
struct CommandChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
  double lower = 0.0;
  double upper = 0.0;
};

/// Error: no channel has the given name. The message lists the robot's nearest names.
class ChannelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class StartReason {
  first,     ///< the run begins
  takeover,  ///< another process drove this robot before; the run goes on from `Start::tick`
  reset,     ///< the world was rebuilt
  restored,  ///< the world was restored from a snapshot
  check,     ///< `cohort check --load-controllers` and `cohort run` test the start; no step follows
};

/// The start of a controller, before its first step and after each reset, restore and takeover.
class Start {
 public:
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped name, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< the robot's team in the experiment file
  std::string controller;   ///< the team's controller in the experiment file
  Parameters parameters;    ///< the team's parameters in the experiment file
  StartReason reason = StartReason::first;
  std::uint64_t tick = 0;  ///< tick of the next observation
  std::uint64_t seed =
      0;  ///< for random numbers of the controller; derived from the experiment's seed and the robot's name
  std::chrono::nanoseconds step{0};  ///< simulated time between ticks
  std::uint32_t period = 1;          ///< ticks from one observation to the next
  std::vector<ChannelInfo> observation_channels;
  std::vector<ChannelInfo> command_channels;

  /// Returns the simulated time from one step of the controller to the next [s].
  double seconds_per_step() const { return std::chrono::duration<double>(step).count() * period; }

  /// Returns an observation channel. Throws ChannelError if there is none.
  ObservationChannel observation(std::string_view name) const;
  /// Returns all observation channels that match, in the order of the robot's layout. `*` matches any characters except
  /// `/`. Throws ChannelError if none match.
  std::vector<ObservationChannel> observations(std::string_view pattern) const;
  /// Like `observations(pattern)`; throws ChannelError also if the number of matches is not `count`.
  std::vector<ObservationChannel> observations(std::string_view pattern, std::size_t count) const;
  /// Returns a command channel. Throws ChannelError if there is none.
  CommandChannel command(std::string_view name) const;
  /// Returns all command channels that match, as `observations` does.
  std::vector<CommandChannel> commands(std::string_view pattern) const;
};

/// One robot's sensor readings at one tick. Valid during `step` only. Use channels from `start`; other handles are not
/// checked and give arbitrary values.
class Observation {
 public:
  Observation(std::uint64_t tick, std::chrono::nanoseconds time, std::span<const double> values)
      : tick_(tick), time_(time), values_(values) {}

  std::uint64_t tick() const { return tick_; }
  std::chrono::nanoseconds time() const { return time_; }  ///< simulated time since tick 0
  /// Returns the value of a channel, the first one if it has several.
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

/// One robot's command. Each step starts with the neutral value of every channel, so that the answer does not depend on
/// earlier commands. Valid during `step` only.
class Command {
 public:
  explicit Command(std::span<double> values) : values_(values) {}

  /// Sets value `index` of a channel, clamped to the channel's range. The channel must be from `start` and `index` less
  /// than its size; neither is checked. NaN is passed on, and the server refuses it with the channel's name.
  void set(CommandChannel channel, double value, std::size_t index = 0) {
    if (value < channel.lower) value = channel.lower;
    if (value > channel.upper) value = channel.upper;
    values_[channel.offset + index] = value;
  }

 private:
  std::span<double> values_;
};

/// Drives one robot. Each robot has its own object, made by the default constructor; one thread calls all of them. An
/// exception from the constructor, `start`, `step`, `save` or `load` ends the run with its message. The run waits
/// during a call, as long as the team's `on_late` allows.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Looks up channels and reads parameters; an exception reports an error in the experiment. Called before the first
  /// step and each time that the run restarts. Also called on objects that only serve to find errors early
  /// (StartReason::check), so check the reason before you open a device or a file.
  virtual void start(const Start& start) = 0;
  /// Computes a command from an observation. For lockstep with identical bits, it must be a pure function of the
  /// arguments of `start` and of all steps since. So it uses no clock, no random device and no state that robots share.
  virtual void step(const Observation& observation, Command& command) = 0;

  // These stay last and in this order: a program uses a plugin's `abi` to tell whether they exist.

  /// Writes the state accumulated since `start`, at most `largest_state` bytes. Called between steps, when a snapshot
  /// of the run is taken. A controller without state writes nothing, or derives from StatelessController. A class
  /// without `save` restarts when the run continues from a snapshot, with a warning.
  virtual void save(StateWriter& state) const { state.leave_out(); }
  /// Reads everything that `save` of the same class wrote in another object or process, and continues from there.
  /// Called right after `start`, whose channels, parameters and seed are those of the other object.
  virtual void load(StateReader&) {}
};

/// A controller without state between steps: a run that continues from a snapshot uses a new one, with the same bits.
class StatelessController : public Controller {
 public:
  void save(StateWriter&) const final {}
};

/// The symbol `cohort_plugin` that a plugin exports; COHORT_CONTROLLER defines it. A program loads a plugin if it
/// supports its `abi`; the plugin may come from another build of Cohort.
struct Plugin {
  static constexpr std::uint32_t current_abi = 3;
  static constexpr std::uint32_t oldest_abi = 2;            ///< oldest version that is loaded
  static constexpr std::uint32_t first_abi_with_state = 3;  ///< its controllers have `save` and `load`
  std::uint32_t abi = 0;                   ///< current_abi of the headers that the plugin was built with
  const char* name = nullptr;              ///< name of the class, for messages
  Controller* (*create)() = nullptr;       ///< may throw
  void (*destroy)(Controller*) = nullptr;  ///< destroys what `create` returned
};

/// Runs a controller as its own process: the `main` with `--robots`, `--server`, `--domain`, `--secure` and `--help`.
/// Ends in order on SIGINT and SIGTERM. Returns the exit code: 0 when the run finished, 1 when it or a controller
/// failed, 2 for wrong options or a refused claim, 130 when interrupted. Prints the reason to standard error unless it
/// is 0.
int run_controller(const Plugin& plugin, int argc, char** argv);

}  // namespace cohort

#ifdef COHORT_BUILDS_PLUGIN
#define COHORT_CONTROLLER_MAIN
#else
#define COHORT_CONTROLLER_MAIN \
  int main(int argc, char** argv) { return ::cohort::run_controller(cohort_plugin, argc, argv); }
#endif

/// Defines the plugin and the `main` of a controller. Use it once, at the end of a source file, outside of namespaces
/// and without a semicolon. `Class` derives from Controller and has a default constructor.
#define COHORT_CONTROLLER(Class)                                                                  \
  extern "C" __attribute__((visibility("default"))) const ::cohort::Plugin cohort_plugin = {      \
      ::cohort::Plugin::current_abi, #Class, []() -> ::cohort::Controller* { return new Class; }, \
      [](::cohort::Controller* controller) { delete controller; }};                               \
  COHORT_CONTROLLER_MAIN
