#pragma once

#include <tuple>

#include "idl/dds/fields.hpp"
#include "idl/dds/topic.hpp"
#include "idl/wire/messages.hpp"

/// Fields of the messages in cohort.idl, except those of control.
namespace cohort::wire {

template <>
struct OnWire<Channel> : Between<Channel, cohort_v1_Channel> {
  static constexpr std::tuple fields = {field(&M::name, &S::name),   field(&M::unit, &S::unit),
                                        field(&M::size, &S::size),   field(&M::lower, &S::lower),
                                        field(&M::upper, &S::upper), field(&M::neutral, &S::neutral)};
};

template <>
struct OnWire<Join> : Between<Join, cohort_v1_Join> {
  static constexpr Topic topic = {.name = "cohort/v1/join",
                                  .type = &cohort_v1_Join_desc,
                                  .transient_local = true,
                                  .depth = 1,
                                  .lease = std::chrono::seconds(1)};
  static constexpr std::tuple fields = {field(&M::client, &S::client),         field(&M::minor, &S::minor),
                                        field(&M::controller, &S::controller), field(&M::host, &S::host),
                                        field(&M::process, &S::process),       field(&M::robots, &S::robots)};
};

template <>
struct OnWire<Parameter> : Between<Parameter, cohort_v1_Parameter> {
  static constexpr std::tuple fields = {field(&M::name, &S::name), field(&M::values, &S::values)};
};

template <>
struct OnWire<Team> : Between<Team, cohort_v1_Team> {
  static constexpr std::tuple fields = {field(&M::name, &S::name), field(&M::controller, &S::controller),
                                        field(&M::parameters, &S::parameters)};
};

template <>
struct OnWire<AdmittedRobot> : Between<AdmittedRobot, cohort_v1_AdmittedRobot> {
  static constexpr std::tuple fields = {field(&M::robot, &S::robot), field(&M::name, &S::name),
                                        field(&M::team, &S::team),   field(&M::description, &S::description),
                                        field(&M::seed, &S::seed),   field(&M::period, &S::period),
                                        field(&M::phase, &S::phase), field(&M::delay, &S::delay),
                                        field(&M::mode, &S::mode)};
};

template <>
struct OnWire<Admit> : Between<Admit, cohort_v1_Admit> {
  static constexpr Topic topic = {
      .name = "cohort/v1/admit", .type = &cohort_v1_Admit_desc, .transient_local = true, .depth = 1};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::status, &S::status),
                                        field(&M::reason, &S::reason), field(&M::run, &S::run),
                                        field(&M::epoch, &S::epoch),   field(&M::start_reason, &S::start_reason),
                                        field(&M::tick, &S::tick),     field(&M::step_ns, &S::step_ns),
                                        field(&M::teams, &S::teams),   field(&M::robots, &S::robots)};
};

template <>
struct OnWire<RobotDescription> : Between<RobotDescription, cohort_v1_RobotDescription> {
  static constexpr Topic topic = {.name = "cohort/v1/robot_description",
                                  .type = &cohort_v1_RobotDescription_desc,
                                  .transient_local = true,
                                  .depth = 1};
  static constexpr std::tuple fields = {field(&M::description, &S::description), field(&M::model, &S::model),
                                        field(&M::observation, &S::observation), field(&M::command, &S::command)};
};

template <>
struct OnWire<Observation> : Between<Observation, cohort_v1_Observation> {
  static constexpr Topic topic = {
      .name = "cohort/v1/observation", .type = &cohort_v1_Observation_desc, .reliable = false};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::run, &S::run),
                                        field(&M::resent, &S::resent), field(&M::epoch, &S::epoch),
                                        field(&M::tick, &S::tick),     field(&M::time_ns, &S::time_ns),
                                        field(&M::robots, &S::robots), field(&M::values, &S::values)};
};

template <>
struct OnWire<Command> : Between<Command, cohort_v1_Command> {
  static constexpr Topic topic = {.name = "cohort/v1/command", .type = &cohort_v1_Command_desc, .reliable = false};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::run, &S::run),
                                        field(&M::epoch, &S::epoch),   field(&M::tick, &S::tick),
                                        field(&M::robots, &S::robots), field(&M::values, &S::values),
                                        field(&M::resent, &S::resent)};
};

template <>
struct OnWire<WorldState> : Between<WorldState, cohort_v1_WorldState> {
  static constexpr Topic topic = {
      .name = "cohort/v1/world_state", .type = &cohort_v1_WorldState_desc, .reliable = false, .depth = 1};
  static constexpr std::tuple fields = {zero(&S::world),
                                        field(&M::run, &S::run),
                                        field(&M::tick, &S::tick),
                                        field(&M::time_ns, &S::time_ns),
                                        field(&M::state_hash, &S::state_hash),
                                        field(&M::robots, &S::robots),
                                        field(&M::poses, &S::poses)};
};

template <>
struct OnWire<SceneDescription> : Between<SceneDescription, cohort_v1_SceneDescription> {
  static constexpr Topic topic = {.name = "cohort/v1/scene_description",
                                  .type = &cohort_v1_SceneDescription_desc,
                                  .transient_local = true,
                                  .depth = 1};
  static constexpr std::tuple fields = {zero(&S::world), field(&M::run, &S::run), field(&M::revision, &S::revision),
                                        field(&M::scene, &S::scene)};
};

template <>
struct OnWire<SceneUpdate> : Between<SceneUpdate, cohort_v1_SceneUpdate> {
  static constexpr Topic topic = {
      .name = "cohort/v1/scene_update", .type = &cohort_v1_SceneUpdate_desc, .reliable = false, .depth = 1};
  static constexpr std::tuple fields = {zero(&S::world),
                                        field(&M::run, &S::run),
                                        field(&M::revision, &S::revision),
                                        field(&M::tick, &S::tick),
                                        field(&M::frame, &S::frame),
                                        field(&M::signals, &S::signals),
                                        field(&M::contacts, &S::contacts),
                                        field(&M::robots, &S::robots)};
};

template <>
struct OnWire<Report> : Between<Report, cohort_v1_Report> {
  static constexpr Topic topic = {
      .name = "cohort/v1/report", .type = &cohort_v1_Report_desc, .transient_local = true, .depth = 16};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::run, &S::run),
                                        field(&M::kind, &S::kind),     field(&M::tick, &S::tick),
                                        field(&M::reason, &S::reason), field(&M::text, &S::text)};
};

template <>
struct OnWire<ControllerState> : Between<ControllerState, cohort_v1_ControllerState> {
  static constexpr Topic topic = {
      .name = "cohort/v1/controller_state", .type = &cohort_v1_ControllerState_desc, .depth = 4};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::run, &S::run),
                                        field(&M::kind, &S::kind),     field(&M::epoch, &S::epoch),
                                        field(&M::tick, &S::tick),     field(&M::size, &S::size),
                                        field(&M::offset, &S::offset), field(&M::data, &S::data)};
};

}  // namespace cohort::wire
