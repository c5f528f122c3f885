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

/// What the author of a controller writes against: one class derived from Controller, and COHORT_CONTROLLER(Class).
/// The same source builds as a program (`cohort_add_controller` in CMake makes both) and as a plugin that
/// `cohort run --controllers inprocess` and `cohort host` load.
///
/// Values are float64 in SI units; what a channel measures or moves, and in which frame, is said where its device is
/// (docs/worlds.md). Nothing here is safe to share between threads, and nothing needs to be: the SDK calls all
/// controllers of a process on one thread, one after the other (with `cohort host --inline` on one of two at a time).
namespace cohort {

/// A channel as the server describes it: `size` float64 values in a robot's observation or command.
struct ChannelInfo {
  std::string name;          ///< `device/index/quantity`, such as `proximity/3/reading`
  std::string unit;          ///< SI; `1` if dimensionless
  std::uint32_t offset = 0;  ///< of its first value among the robot's
  std::uint32_t size = 1;    ///< how many values
  double lower = 0.0;        ///< least value, infinite if there is none
  double upper = 0.0;        ///< greatest value, infinite if there is none
  double neutral = 0.0;      ///< of a command: what each value is until it is set
};

/// Handle of an observation channel, looked up in `start` and good until the next `start`, for this robot only.
struct ObservationChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

/// Handle of a command channel, looked up in `start` and good until the next `start`, for this robot only.
struct CommandChannel {
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
  double lower = 0.0;
  double upper = 0.0;
};

/// No channel of that name: the message lists the robot's nearest ones.
class ChannelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class StartReason {
  first,     ///< the run begins
  takeover,  ///< another process drove this robot before; the run goes on from `Start::tick`
  reset,     ///< the world was built anew
  restored,  ///< the world was restored from a snapshot
  check,     ///< `cohort check --load-controllers` and `cohort run` look for mistakes first: no step will follow
};

/// What a controller is told before its first step, and again after each reset, restore and takeover.
class Start {
 public:
  std::uint32_t robot = 0;  ///< id in this run
  std::string name;         ///< scoped name, such as `explorers/sbot_7`
  std::string model;        ///< such as `sbot`
  std::string team;         ///< the robot's, in the experiment file
  std::string controller;   ///< that the experiment file names for the team
  Parameters parameters;    ///< that it gives the team
  StartReason reason = StartReason::first;
  std::uint64_t tick = 0;  ///< of the first observation to come
  std::uint64_t seed = 0;  ///< for the controller's own random numbers: fixed by experiment seed and robot name
  std::chrono::nanoseconds step{0};  ///< simulated time between ticks
  std::uint32_t period = 1;          ///< ticks from one observation to the next
  std::vector<ChannelInfo> observation_channels;
  std::vector<ChannelInfo> command_channels;

  /// Simulated, from one step of the controller to the next [s].
  double seconds_per_step() const { return std::chrono::duration<double>(step).count() * period; }

  /// Throws ChannelError if there is no such channel.
  ObservationChannel observation(std::string_view name) const;
  /// All channels that match, in the order of the robot's layout; `*` stands for any run of characters but `/`. Throws
  /// ChannelError if none.
  std::vector<ObservationChannel> observations(std::string_view pattern) const;
  /// As above; throws ChannelError also if there are more or fewer than `count`.
  std::vector<ObservationChannel> observations(std::string_view pattern, std::size_t count) const;
  /// Throws ChannelError if there is no such channel.
  CommandChannel command(std::string_view name) const;
  /// As `observations`.
  std::vector<CommandChannel> commands(std::string_view pattern) const;
};

/// One robot's sensor readings at one tick. Valid during `step` only. Channels are those that `start` found; others are
/// not noticed and read anything.
class Observation {
 public:
  Observation(std::uint64_t tick, std::chrono::nanoseconds time, std::span<const double> values)
      : tick_(tick), time_(time), values_(values) {}

  std::uint64_t tick() const { return tick_; }
  std::chrono::nanoseconds time() const { return time_; }  ///< simulated, since tick 0
  /// The value of a channel, the first one if it has several.
  double operator[](ObservationChannel channel) const { return values_[channel.offset]; }
  /// All values of a channel.
  std::span<const double> values(ObservationChannel channel) const {
    return values_.subspan(channel.offset, channel.size);
  }

 private:
  std::uint64_t tick_;
  std::chrono::nanoseconds time_;
  std::span<const double> values_;
};

/// One robot's command. Every channel begins each step at its neutral value, so that the answer depends on nothing that
/// an earlier step left behind. Valid during `step` only.
class Command {
 public:
  explicit Command(std::span<double> values) : values_(values) {}

  /// Sets value `index` of a channel, which is less than its size, brought into the channel's range. The channel is one
  /// that `start` found; neither is checked. NaN is passed on as it is, and refused by the server by name.
  void set(CommandChannel channel, double value, std::size_t index = 0) {
    if (value < channel.lower) value = channel.lower;
    if (value > channel.upper) value = channel.upper;
    values_[channel.offset + index] = value;
  }

 private:
  std::span<double> values_;
};

/// Drives one robot. An object of its own for each robot, made by its default constructor; all are called on one
/// thread. An exception from constructor, `start`, `step`, `save` or `load` ends the run with its message. The run
/// waits while a call lasts, as long as the team's `on_late` has patience.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Looks channels up and asks for parameters; whatever it throws says what is wrong with the experiment. Called
  /// before the first step, and again whenever the world begins anew. Also called on objects that only serve to find
  /// mistakes early (StartReason::check): what opens a device or a file looks at the reason first.
  virtual void start(const Start& start) = 0;
  /// From one observation to one command. For lockstep with identical bits, a pure function of what `start` and the
  /// steps since gave: no clock, no random device, no state shared between robots.
  virtual void step(const Observation& observation, Command& command) = 0;

  // In this place, and in this order: a program tells by a plugin's `abi` whether it has what follows.

  /// Writes what it remembers of the steps since `start`, at most `largest_state`: between steps, when a snapshot of
  /// the run is taken. Whoever remembers nothing writes nothing. A class that leaves this out is started anew by
  /// whoever goes on from a snapshot, who is told so.
  virtual void save(StateWriter& state) const { state.leave_out(); }
  /// Reads, to the last byte, what `save` of the same class wrote in another object or process, and goes on from there:
  /// right after `start`, whose channels, parameters and seed are those that the other one had.
  virtual void load(StateReader&) {}
};

/// What a plugin exports as `cohort_plugin`; COHORT_CONTROLLER fills it in. A plugin is loaded if its `abi` is one that
/// the program knows; it may come from another build of Cohort.
struct Plugin {
  static constexpr std::uint32_t current_abi = 3;
  static constexpr std::uint32_t oldest_abi = 2;            ///< that is loaded
  static constexpr std::uint32_t first_abi_with_state = 3;  ///< its controllers have `save` and `load`
  std::uint32_t abi = 0;                                    ///< current_abi of the headers that it was built with
  const char* name = nullptr;                               ///< of the class, for messages
  Controller* (*create)() = nullptr;                        ///< may throw
  void (*destroy)(Controller*) = nullptr;                   ///< of what `create` gave
};

/// The `main` of a controller that runs as a process of its own: `--robots`, `--server`, `--domain`, `--help`. Ends in
/// order on SIGINT and SIGTERM. Returns the process's exit code: 0 when the run finished, 1 when it or a controller
/// failed, 2 for a mistake in the options or a refused claim, 130 when interrupted; but for 0, standard error says why.
int run_controller(const Plugin& plugin, int argc, char** argv);

}  // namespace cohort

#ifdef COHORT_BUILDS_PLUGIN
#define COHORT_CONTROLLER_MAIN
#else
#define COHORT_CONTROLLER_MAIN \
  int main(int argc, char** argv) { return ::cohort::run_controller(cohort_plugin, argc, argv); }
#endif

/// Once in a controller, at the end of a source file and in no namespace, without a semicolon. `Class` derives from
/// Controller and has a default constructor.
#define COHORT_CONTROLLER(Class)                                                                  \
  extern "C" __attribute__((visibility("default"))) const ::cohort::Plugin cohort_plugin = {      \
      ::cohort::Plugin::current_abi, #Class, []() -> ::cohort::Controller* { return new Class; }, \
      [](::cohort::Controller* controller) { delete controller; }};                               \
  COHORT_CONTROLLER_MAIN
