#pragma once

#include <chrono>
#include <vector>

#include "idl/cohort.h"
#include "idl/control_messages.hpp"
#include "idl/dds.hpp"
#include "idl/messages.hpp"

/// From the messages to the structs that idlc generates from cohort.idl, and back. Hot messages (Observation, Command,
/// WorldState) are neither copied nor allocated for.
namespace cohort::wire {

/// How a message travels: docs/protocol.md, "Topics".
struct Topic {
  const char* name = nullptr;
  const dds_topic_descriptor_t* type = nullptr;
  /// Observations and commands are not: the protocol itself repairs losses, and sooner. Reliable, what is sent again
  /// would be held back until DDS had repaired what nobody needs any more.
  bool reliable = true;
  bool transient_local = false;
  int depth = 0;                       ///< 0: the endpoint chooses
  std::chrono::milliseconds lease{0};  ///< 0: no lease but the participant's
};

/// For each message: `topic`; `Sample`, the generated struct; `Outgoing`, a sample that borrows from the message it is
/// made of; and `decode`, whose spans, if any, borrow from the sample.
template <class Message>
struct Codec;

template <>
struct Codec<Join> {
  using Sample = cohort_v1_Join;
  struct Outgoing {
    explicit Outgoing(const Join& message);
    Sample sample{};
    std::vector<char*> robots;
  };
  static const Topic topic;
  static Join decode(const Sample& sample);
};

template <>
struct Codec<Admit> {
  using Sample = cohort_v1_Admit;
  struct Outgoing {
    explicit Outgoing(const Admit& message);
    Sample sample{};
    std::vector<cohort_v1_Team> teams;
    std::vector<std::vector<cohort_v1_Parameter>> parameters;  // of each team
    std::vector<std::vector<std::vector<char*>>> values;       // of each of them
    std::vector<cohort_v1_AdmittedRobot> robots;
  };
  static const Topic topic;
  static Admit decode(const Sample& sample);
};

template <>
struct Codec<RobotDescription> {
  using Sample = cohort_v1_RobotDescription;
  struct Outgoing {
    explicit Outgoing(const RobotDescription& message);
    Sample sample{};
    std::vector<cohort_v1_Channel> observation;
    std::vector<cohort_v1_Channel> command;
  };
  static const Topic topic;
  static RobotDescription decode(const Sample& sample);
};

template <>
struct Codec<Observation> {
  using Sample = cohort_v1_Observation;
  struct Outgoing {
    explicit Outgoing(const Observation& message);
    Sample sample{};
  };
  static const Topic topic;
  static Observation decode(const Sample& sample);
};

template <>
struct Codec<Command> {
  using Sample = cohort_v1_Command;
  struct Outgoing {
    explicit Outgoing(const Command& message);
    Sample sample{};
  };
  static const Topic topic;
  static Command decode(const Sample& sample);
};

template <>
struct Codec<WorldState> {
  using Sample = cohort_v1_WorldState;
  struct Outgoing {
    explicit Outgoing(const WorldState& message);
    Sample sample{};
  };
  static const Topic topic;
  static WorldState decode(const Sample& sample);
};

template <>
struct Codec<SceneDescription> {
  using Sample = cohort_v1_SceneDescription;
  struct Outgoing {
    explicit Outgoing(const SceneDescription& message);
    Sample sample{};
  };
  static const Topic topic;
  static SceneDescription decode(const Sample& sample);
};

template <>
struct Codec<SceneUpdate> {
  using Sample = cohort_v1_SceneUpdate;
  struct Outgoing {
    explicit Outgoing(const SceneUpdate& message);
    Sample sample{};
  };
  static const Topic topic;
  static SceneUpdate decode(const Sample& sample);
};

template <>
struct Codec<Report> {
  using Sample = cohort_v1_Report;
  struct Outgoing {
    explicit Outgoing(const Report& message);
    Sample sample{};
  };
  static const Topic topic;
  static Report decode(const Sample& sample);
};

template <>
struct Codec<Request> {
  using Sample = cohort_v1_Request;
  struct Outgoing {
    explicit Outgoing(const Request& message);
    Sample sample{};
  };
  static const Topic topic;
  static Request decode(const Sample& sample);
};

template <>
struct Codec<Reply> {
  using Sample = cohort_v1_Reply;
  struct Outgoing {
    explicit Outgoing(const Reply& message);
    Sample sample{};
    std::vector<char*> spawn_formats;
    std::vector<char*> entities;
    std::vector<cohort_v1_EntityState> states;
    std::vector<cohort_v1_SimulationStatus> status;
    std::vector<std::vector<char*>> awaited;                           // of each status
    std::vector<std::vector<cohort_v1_ControllerStatus>> controllers;  // the same
  };
  static const Topic topic;
  static Reply decode(const Sample& sample);
};

}  // namespace cohort::wire
