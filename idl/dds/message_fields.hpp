// SPDX-License-Identifier: Apache-2.0
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
                                        field(&M::observation, &S::observation), field(&M::command, &S::command),
                                        apart(&M::tree)};
};

template <>
struct OnWire<Vector3> : Between<Vector3, cohort_v1_Vector3> {
  static constexpr std::tuple fields = {field(&M::x, &S::x), field(&M::y, &S::y), field(&M::z, &S::z)};
};

template <>
struct OnWire<Quaternion> : Between<Quaternion, cohort_v1_Quaternion> {
  static constexpr std::tuple fields = {field(&M::x, &S::x), field(&M::y, &S::y), field(&M::z, &S::z),
                                        field(&M::w, &S::w)};
};

template <>
struct OnWire<LinkInfo> : Between<LinkInfo, cohort_v1_Link> {
  static constexpr std::tuple fields = {field(&M::name, &S::name), field(&M::mass, &S::mass),
                                        field(&M::center_of_mass, &S::center_of_mass)};
};

template <>
struct OnWire<AxisInfo> : Between<AxisInfo, cohort_v1_Axis> {
  static constexpr std::tuple fields = {field(&M::direction, &S::direction), field(&M::lower, &S::lower),
                                        field(&M::upper, &S::upper), field(&M::max_velocity, &S::max_velocity),
                                        field(&M::max_effort, &S::max_effort)};
};

template <>
struct OnWire<FramePose> : Between<FramePose, cohort_v1_Pose> {
  static constexpr std::tuple fields = {field(&M::position, &S::position), field(&M::orientation, &S::orientation)};
};

template <>
struct OnWire<JointInfo> : Between<JointInfo, cohort_v1_Joint> {
  static constexpr std::tuple fields = {field(&M::name, &S::name),      field(&M::type, &S::type),
                                        field(&M::parent, &S::parent),  field(&M::child, &S::child),
                                        field(&M::pose, &S::pose),      field(&M::frame, &S::frame),
                                        field(&M::axes, &S::axes),      field(&M::thread_pitch, &S::thread_pitch),
                                        field(&M::devices, &S::devices)};
};

template <>
struct OnWire<SensorInfo> : Between<SensorInfo, cohort_v1_Sensor> {
  static constexpr std::tuple fields = {field(&M::name, &S::name), field(&M::link, &S::link),
                                        field(&M::pose, &S::pose)};
};

template <>
struct OnWire<KinematicTree> : Between<KinematicTree, cohort_v1_KinematicTree> {
  static constexpr std::tuple fields = {field(&M::links, &S::links), field(&M::joints, &S::joints),
                                        field(&M::sensors, &S::sensors)};
};

template <>
struct OnWire<RobotTree> : Between<RobotTree, cohort_v1_RobotTree> {
  static constexpr Topic topic = {
      .name = "cohort/v1/robot_tree", .type = &cohort_v1_RobotTree_desc, .transient_local = true, .depth = 1};
  static constexpr std::tuple fields = {field(&M::description, &S::description), field(&M::tree, &S::tree)};
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
