// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "idl/include/cohort/kinematic_tree.hpp"

/// The messages of cohort.idl as C++ values. Messages with spans are views: received ones are valid only during the
/// callback, and sent ones must stay valid until `write` returns.
namespace cohort::wire {

inline constexpr std::uint32_t minor_version = 4;
inline constexpr std::uint32_t first_minor_with_state = 1;  ///< the first version with ControllerState
inline constexpr std::uint32_t first_minor_with_growing_leases =
    3;                                                        ///< the first version with StartReason::more_robots
inline constexpr std::uint32_t first_minor_with_reasons = 4;  ///< the first version in which each refusal has a code

struct Channel {
  std::string name{};
  std::string unit{};
  std::uint32_t size = 1;
  double lower = 0.0;
  double upper = 0.0;
  double neutral = 0.0;
  bool operator==(const Channel&) const = default;
};

struct Join {
  std::uint64_t client = 0;
  std::uint32_t minor = minor_version;
  std::string controller{};
  std::string host{};
  std::uint32_t process = 0;
  std::vector<std::string> robots{};
  bool operator==(const Join&) const = default;
};

struct Parameter {
  std::string name{};
  std::vector<std::string> values{};
  bool operator==(const Parameter&) const = default;
};

struct Team {
  std::string name{};
  std::string controller{};
  std::vector<Parameter> parameters{};
  bool operator==(const Team&) const = default;
};

enum class Mode : std::uint32_t { lockstep = 0, free = 1 };

struct AdmittedRobot {
  std::uint32_t robot = 0;
  std::string name{};
  std::uint32_t team = 0;
  std::uint32_t description = 0;
  std::uint64_t seed = 0;
  std::uint32_t period = 1;
  std::uint32_t phase = 0;
  std::uint32_t delay = 0;
  Mode mode = Mode::lockstep;
  bool operator==(const AdmittedRobot&) const = default;
};

/// The answer to a Join: docs/protocol.md, "Joining". All but `admitted` are reasons of a refusal.
enum class AdmitStatus : std::uint32_t {
  admitted = 0,
  refused = 1,
  unknown_robot = 2,
  not_permitted = 3,
  robot_taken = 4,
  failed_in_start = 5,
  too_many_selectors = 6,
};
/// Returns the status for a client with this minor version.
constexpr AdmitStatus known_to(std::uint32_t minor, AdmitStatus status) {
  return minor < first_minor_with_reasons && status != AdmitStatus::admitted ? AdmitStatus::refused : status;
}
enum class StartReason : std::uint32_t {
  first = 0,
  takeover = 1,
  reset = 2,
  restored = 3,
  restored_with_state = 4,
  more_robots = 5,
};

struct Admit {
  std::uint64_t client = 0;
  AdmitStatus status = AdmitStatus::admitted;
  std::string reason{};
  std::uint32_t run = 0;
  std::uint64_t epoch = 0;
  StartReason start_reason = StartReason::first;
  std::uint64_t tick = 0;
  std::int64_t step_ns = 0;
  std::vector<Team> teams{};
  std::vector<AdmittedRobot> robots{};
  bool operator==(const Admit&) const = default;
};

struct RobotDescription {
  std::uint32_t description = 0;
  std::string model{};
  std::vector<Channel> observation{};
  std::vector<Channel> command{};
  KinematicTree tree{};  ///< is sent as a RobotTree
  bool operator==(const RobotDescription&) const = default;
};

/// The tree of the robots with this description.
struct RobotTree {
  std::uint32_t description = 0;
  KinematicTree tree{};
  bool operator==(const RobotTree&) const = default;
};

struct Observation {
  std::uint64_t client = 0;
  std::uint32_t run = 0;
  std::uint32_t resent = 0;
  std::uint64_t epoch = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::span<const std::uint32_t> robots{};
  std::span<const double> values{};
};

struct Command {
  std::uint64_t client = 0;
  std::uint32_t run = 0;
  std::uint64_t epoch = 0;
  std::uint64_t tick = 0;
  std::span<const std::uint32_t> robots{};
  std::span<const double> values{};
  std::uint32_t resent = 0;
};

struct WorldState {
  std::uint32_t run = 0;
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::uint64_t state_hash = 0;
  std::span<const std::uint32_t> robots{};
  std::span<const double> poses{};
};

struct SceneDescription {
  std::uint32_t run = 0;
  std::uint32_t revision = 0;
  std::span<const std::uint8_t> scene{};
};

struct SceneUpdate {
  std::uint32_t run = 0;
  std::uint32_t revision = 0;
  std::uint64_t tick = 0;
  std::span<const std::uint8_t> frame{};
  std::span<const std::uint8_t> signals{};
  std::span<const std::uint8_t> contacts{};
  std::span<const std::uint8_t> robots{};
};

enum class ReportKind : std::uint32_t { finished = 0, rejected = 1, superseded = 2, failed = 3 };

struct Report {
  std::uint64_t client = 0;
  std::uint32_t run = 0;
  ReportKind kind = ReportKind::finished;
  std::uint64_t tick = 0;
  std::string reason{};
  std::string text{};
  bool operator==(const Report&) const = default;
};

/// The `reason` of a client's report that its controllers failed before their first answer.
inline constexpr const char* failed_in_start = "start";

/// `unsaved`: the controllers cannot save; the data contains the reason.
enum class StateKind : std::uint32_t { wanted = 0, here = 1, unsaved = 2 };
/// Maximum size of the data in one ControllerState [bytes].
inline constexpr std::size_t largest_state_part = std::size_t{256} << 10;

struct ControllerState {
  std::uint64_t client = 0;
  std::uint32_t run = 0;
  StateKind kind = StateKind::wanted;
  std::uint64_t epoch = 0;
  std::uint64_t tick = 0;
  std::uint64_t size = 0;
  std::uint64_t offset = 0;
  std::span<const std::uint8_t> data{};
};

}  // namespace cohort::wire
