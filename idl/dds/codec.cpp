#include "idl/dds/codec.hpp"

#include <string>

#include "idl/dds/loans.hpp"

namespace cohort::wire {
namespace {

using namespace std::chrono_literals;

std::vector<cohort_v1_Channel> encode(const std::vector<Channel>& channels) {
  std::vector<cohort_v1_Channel> result;
  result.reserve(channels.size());
  for (const Channel& channel : channels) {
    result.push_back(
        {loaned(channel.name), loaned(channel.unit), channel.size, channel.lower, channel.upper, channel.neutral});
  }
  return result;
}

std::vector<Channel> decode_channels(const dds_sequence_cohort_v1_Channel& channels) {
  std::vector<Channel> result;
  for (const cohort_v1_Channel& channel : to_span(channels)) {
    result.push_back({to_string(channel.name), to_string(channel.unit), channel.size, channel.lower, channel.upper,
                      channel.neutral});
  }
  return result;
}

}  // namespace

const Topic Codec<Join>::topic = {
    .name = "cohort/v1/join", .type = &cohort_v1_Join_desc, .transient_local = true, .depth = 1, .lease = 1s};
const Topic Codec<Admit>::topic = {
    .name = "cohort/v1/admit", .type = &cohort_v1_Admit_desc, .transient_local = true, .depth = 1};
const Topic Codec<RobotDescription>::topic = {.name = "cohort/v1/robot_description",
                                              .type = &cohort_v1_RobotDescription_desc,
                                              .transient_local = true,
                                              .depth = 1};
const Topic Codec<Observation>::topic = {
    .name = "cohort/v1/observation", .type = &cohort_v1_Observation_desc, .reliable = false};
const Topic Codec<Command>::topic = {.name = "cohort/v1/command", .type = &cohort_v1_Command_desc, .reliable = false};
const Topic Codec<WorldState>::topic = {
    .name = "cohort/v1/world_state", .type = &cohort_v1_WorldState_desc, .reliable = false, .depth = 1};
const Topic Codec<SceneDescription>::topic = {.name = "cohort/v1/scene_description",
                                              .type = &cohort_v1_SceneDescription_desc,
                                              .transient_local = true,
                                              .depth = 1};
const Topic Codec<SceneUpdate>::topic = {
    .name = "cohort/v1/scene_update", .type = &cohort_v1_SceneUpdate_desc, .reliable = false, .depth = 1};
const Topic Codec<Report>::topic = {
    .name = "cohort/v1/report", .type = &cohort_v1_Report_desc, .transient_local = true, .depth = 16};

const Topic Codec<ControllerState>::topic = {
    .name = "cohort/v1/controller_state", .type = &cohort_v1_ControllerState_desc, .depth = 4};

Codec<Join>::Outgoing::Outgoing(const Join& message) {
  for (const std::string& robot : message.robots) robots.push_back(loaned(robot));
  sample.client = message.client;
  sample.minor = message.minor;
  sample.controller = loaned(message.controller);
  sample.host = loaned(message.host);
  sample.process = message.process;
  loan(robots, sample.robots);
}

Join Codec<Join>::decode(const Sample& sample) {
  Join message;
  message.client = sample.client;
  message.minor = sample.minor;
  message.controller = to_string(sample.controller);
  message.host = to_string(sample.host);
  message.process = sample.process;
  message.robots = to_strings(sample.robots);
  return message;
}

Codec<Admit>::Outgoing::Outgoing(const Admit& message) {
  // Sequences borrow what the vectors hold, which stays where it is when an outer vector grows.
  for (const Team& team : message.teams) {
    auto& team_parameters = parameters.emplace_back();
    auto& team_values = values.emplace_back();
    for (const Parameter& parameter : team.parameters) {
      auto& texts = team_values.emplace_back();
      for (const std::string& value : parameter.values) texts.push_back(loaned(value));
      team_parameters.push_back({loaned(parameter.name), {}});
      loan(texts, team_parameters.back().values);
    }
    teams.push_back({loaned(team.name), loaned(team.controller), {}});
    loan(team_parameters, teams.back().parameters);
  }
  for (const AdmittedRobot& robot : message.robots) {
    robots.push_back({robot.robot, loaned(robot.name), robot.team, robot.description, robot.seed, robot.period,
                      robot.phase, robot.delay, static_cast<std::uint32_t>(robot.mode)});
  }
  sample.client = message.client;
  sample.status = static_cast<std::uint32_t>(message.status);
  sample.reason = loaned(message.reason);
  sample.run = message.run;
  sample.epoch = message.epoch;
  sample.start_reason = static_cast<std::uint32_t>(message.start_reason);
  sample.tick = message.tick;
  sample.step_ns = message.step_ns;
  loan(teams, sample.teams);
  loan(robots, sample.robots);
}

Admit Codec<Admit>::decode(const Sample& sample) {
  Admit message;
  message.client = sample.client;
  message.status = static_cast<AdmitStatus>(sample.status);
  message.reason = to_string(sample.reason);
  message.run = sample.run;
  message.epoch = sample.epoch;
  message.start_reason = static_cast<StartReason>(sample.start_reason);
  message.tick = sample.tick;
  message.step_ns = sample.step_ns;
  for (const cohort_v1_Team& sent : to_span(sample.teams)) {
    Team& team = message.teams.emplace_back(Team{to_string(sent.name), to_string(sent.controller), {}});
    for (const cohort_v1_Parameter& parameter : to_span(sent.parameters))
      team.parameters.push_back({to_string(parameter.name), to_strings(parameter.values)});
  }
  for (const cohort_v1_AdmittedRobot& robot : to_span(sample.robots)) {
    message.robots.push_back({robot.robot, to_string(robot.name), robot.team, robot.description, robot.seed,
                              robot.period, robot.phase, robot.delay, static_cast<Mode>(robot.mode)});
  }
  return message;
}

Codec<RobotDescription>::Outgoing::Outgoing(const RobotDescription& message)
    : observation(encode(message.observation)), command(encode(message.command)) {
  sample.description = message.description;
  sample.model = loaned(message.model);
  loan(observation, sample.observation);
  loan(command, sample.command);
}

RobotDescription Codec<RobotDescription>::decode(const Sample& sample) {
  return {sample.description, to_string(sample.model), decode_channels(sample.observation),
          decode_channels(sample.command)};
}

void Codec<Observation>::lend(const Observation& message, Sample& sample) {
  sample.client = message.client;
  sample.run = message.run;
  sample.resent = message.resent;
  sample.epoch = message.epoch;
  sample.tick = message.tick;
  sample.time_ns = message.time_ns;
  loan(message.robots, sample.robots);
  loan(message.values, sample.values);
}

Observation Codec<Observation>::decode(const Sample& sample) {
  return {sample.client, sample.run,     sample.resent,          sample.epoch,
          sample.tick,   sample.time_ns, to_span(sample.robots), to_span(sample.values)};
}

void Codec<Command>::lend(const Command& message, Sample& sample) {
  sample.client = message.client;
  sample.run = message.run;
  sample.resent = message.resent;
  sample.epoch = message.epoch;
  sample.tick = message.tick;
  loan(message.robots, sample.robots);
  loan(message.values, sample.values);
}

Command Codec<Command>::decode(const Sample& sample) {
  return {sample.client,          sample.run,   sample.epoch, sample.tick, to_span(sample.robots),
          to_span(sample.values), sample.resent};
}

void Codec<WorldState>::lend(const WorldState& message, Sample& sample) {
  sample.run = message.run;
  sample.tick = message.tick;
  sample.time_ns = message.time_ns;
  sample.state_hash = message.state_hash;
  loan(message.robots, sample.robots);
  loan(message.poses, sample.poses);
}

WorldState Codec<WorldState>::decode(const Sample& sample) {
  return {sample.run, sample.tick, sample.time_ns, sample.state_hash, to_span(sample.robots), to_span(sample.poses)};
}

void Codec<SceneDescription>::lend(const SceneDescription& message, Sample& sample) {
  sample.run = message.run;
  sample.revision = message.revision;
  loan(message.scene, sample.scene);
}

SceneDescription Codec<SceneDescription>::decode(const Sample& sample) {
  return {sample.run, sample.revision, to_span(sample.scene)};
}

void Codec<SceneUpdate>::lend(const SceneUpdate& message, Sample& sample) {
  sample.run = message.run;
  sample.revision = message.revision;
  sample.tick = message.tick;
  loan(message.frame, sample.frame);
  loan(message.signals, sample.signals);
  loan(message.contacts, sample.contacts);
  loan(message.robots, sample.robots);
}

SceneUpdate Codec<SceneUpdate>::decode(const Sample& sample) {
  return {sample.run,
          sample.revision,
          sample.tick,
          to_span(sample.frame),
          to_span(sample.signals),
          to_span(sample.contacts),
          to_span(sample.robots)};
}

void Codec<Report>::lend(const Report& message, Sample& sample) {
  sample.client = message.client;
  sample.run = message.run;
  sample.kind = static_cast<std::uint32_t>(message.kind);
  sample.tick = message.tick;
  sample.reason = loaned(message.reason);
  sample.text = loaned(message.text);
}

Report Codec<Report>::decode(const Sample& sample) {
  return {
      sample.client,         sample.run, static_cast<ReportKind>(sample.kind), sample.tick, to_string(sample.reason),
      to_string(sample.text)};
}

void Codec<ControllerState>::lend(const ControllerState& message, Sample& sample) {
  sample.client = message.client;
  sample.run = message.run;
  sample.kind = static_cast<std::uint32_t>(message.kind);
  sample.epoch = message.epoch;
  sample.tick = message.tick;
  sample.size = message.size;
  sample.offset = message.offset;
  loan(message.data, sample.data);
}

ControllerState Codec<ControllerState>::decode(const Sample& sample) {
  return {sample.client, sample.run,          static_cast<StateKind>(sample.kind),
          sample.epoch,  sample.tick,         sample.size,
          sample.offset, to_span(sample.data)};
}

}  // namespace cohort::wire
