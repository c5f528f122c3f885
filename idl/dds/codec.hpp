#pragma once

#include <chrono>
#include <vector>

#include "idl/cohort.h"
#include "idl/dds/dds.hpp"
#include "idl/wire/control_messages.hpp"
#include "idl/wire/messages.hpp"

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

/// Of messages whose samples need nothing beside themselves.
template <class Message, class ItsSample>
struct PlainCodec {
  using Sample = ItsSample;
  struct Outgoing {
    explicit Outgoing(const Message& message) { Codec<Message>::lend(message, sample); }
    Sample sample{};
  };
};

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
struct Codec<Observation> : PlainCodec<Observation, cohort_v1_Observation> {
  static const Topic topic;
  static void lend(const Observation& message, Sample& sample);
  static Observation decode(const Sample& sample);
};

template <>
struct Codec<Command> : PlainCodec<Command, cohort_v1_Command> {
  static const Topic topic;
  static void lend(const Command& message, Sample& sample);
  static Command decode(const Sample& sample);
};

template <>
struct Codec<WorldState> : PlainCodec<WorldState, cohort_v1_WorldState> {
  static const Topic topic;
  static void lend(const WorldState& message, Sample& sample);
  static WorldState decode(const Sample& sample);
};

template <>
struct Codec<SceneDescription> : PlainCodec<SceneDescription, cohort_v1_SceneDescription> {
  static const Topic topic;
  static void lend(const SceneDescription& message, Sample& sample);
  static SceneDescription decode(const Sample& sample);
};

template <>
struct Codec<SceneUpdate> : PlainCodec<SceneUpdate, cohort_v1_SceneUpdate> {
  static const Topic topic;
  static void lend(const SceneUpdate& message, Sample& sample);
  static SceneUpdate decode(const Sample& sample);
};

template <>
struct Codec<Report> : PlainCodec<Report, cohort_v1_Report> {
  static const Topic topic;
  static void lend(const Report& message, Sample& sample);
  static Report decode(const Sample& sample);
};

template <>
struct Codec<ControllerState> : PlainCodec<ControllerState, cohort_v1_ControllerState> {
  static const Topic topic;
  static void lend(const ControllerState& message, Sample& sample);
  static ControllerState decode(const Sample& sample);
};

template <>
struct Codec<Request> : PlainCodec<Request, cohort_v1_Request> {
  static const Topic topic;
  static void lend(const Request& message, Sample& sample);
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
