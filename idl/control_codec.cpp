#include <array>
#include <utility>

#include "idl/codec.hpp"
#include "idl/loans.hpp"

namespace cohort::wire {
namespace {

constexpr int depth = static_cast<int>(requests_under_way);

constexpr std::array<std::pair<Operation, const char*>, 23> names = {{
    {Operation::get_simulator_features, "GetSimulatorFeatures"},
    {Operation::get_simulation_state, "GetSimulationState"},
    {Operation::set_simulation_state, "SetSimulationState"},
    {Operation::step_simulation, "StepSimulation"},
    {Operation::reset_simulation, "ResetSimulation"},
    {Operation::get_entities, "GetEntities"},
    {Operation::get_entity_state, "GetEntityState"},
    {Operation::set_entity_state, "SetEntityState"},
    {Operation::spawn_entity, "SpawnEntity"},
    {Operation::delete_entity, "DeleteEntity"},
    {Operation::get_status, "GetStatus"},
    {Operation::set_speed, "SetSpeed"},
    {Operation::set_light, "SetLight"},
    {Operation::apply_force, "ApplyForce"},
    {Operation::save_snapshot, "SaveSnapshot"},
    {Operation::get_data, "GetData"},
    {Operation::put_data, "PutData"},
    {Operation::load_snapshot, "LoadSnapshot"},
    {Operation::start_recording, "StartRecording"},
    {Operation::get_recording, "GetRecording"},
    {Operation::stop_recording, "StopRecording"},
    {Operation::go_back, "GoBack"},
    {Operation::get_history, "GetHistory"},
}};

cohort_v1_Vector3 encode(const Vector3& v) { return {v.x, v.y, v.z}; }
Vector3 decode(const cohort_v1_Vector3& v) { return {v.x, v.y, v.z}; }
cohort_v1_Pose encode(const Pose& pose) {
  const Quaternion& q = pose.orientation;
  return {encode(pose.position), {q.x, q.y, q.z, q.w}};
}
Pose decode(const cohort_v1_Pose& pose) {
  const cohort_v1_Quaternion& q = pose.orientation;
  return {decode(pose.position), {q.x, q.y, q.z, q.w}};
}
cohort_v1_Twist encode(const Twist& twist) { return {encode(twist.linear), encode(twist.angular)}; }
Twist decode(const cohort_v1_Twist& twist) { return {decode(twist.linear), decode(twist.angular)}; }

template <class Element, class Sequence>
std::vector<Element> to_vector(const Sequence& sequence) {
  const auto span = to_span(sequence);
  return {span.begin(), span.end()};
}

std::vector<char*> lent_all(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.push_back(loaned(text));
  return result;
}

cohort_v1_ControllerStatus encode(const ControllerStatus& status) {
  cohort_v1_ControllerStatus sample{};
  sample.label = loaned(status.label);
  sample.client = status.client;
  loan(status.robots, sample.robots);
  sample.alive = status.alive;
  sample.awaited = status.awaited;
  sample.awaited_ns = status.awaited_ns;
  sample.due_tick = status.due_tick;
  sample.answers = status.answers;
  sample.late = status.late;
  sample.rejected = status.rejected;
  sample.resent = status.resent;
  sample.answer_p50_ns = status.answer_p50_ns;
  sample.answer_p99_ns = status.answer_p99_ns;
  return sample;
}

ControllerStatus decode(const cohort_v1_ControllerStatus& sample) {
  return {to_string(sample.label),
          sample.client,
          to_vector<std::uint32_t>(sample.robots),
          sample.alive,
          sample.awaited,
          sample.awaited_ns,
          sample.due_tick,
          sample.answers,
          sample.late,
          sample.rejected,
          sample.resent,
          sample.answer_p50_ns,
          sample.answer_p99_ns};
}

// But for its sequences.
cohort_v1_SimulationStatus encode(const SimulationStatus& status) {
  cohort_v1_SimulationStatus sample{};
  sample.experiment = loaned(status.experiment);
  sample.seed = status.seed;
  sample.started = status.started;
  sample.step_ns = status.step_ns;
  sample.duration_ns = status.duration_ns;
  sample.speed = status.speed;
  sample.real_time_factor = status.real_time_factor;
  sample.state_hash = status.state_hash;
  sample.robots = status.robots;
  sample.awaited_count = status.awaited_count;
  sample.waiting_ns = status.waiting_ns;
  return sample;
}

SimulationStatus decode(const cohort_v1_SimulationStatus& sample) {
  SimulationStatus status;
  status.experiment = to_string(sample.experiment);
  status.seed = sample.seed;
  status.started = sample.started;
  status.step_ns = sample.step_ns;
  status.duration_ns = sample.duration_ns;
  status.speed = sample.speed;
  status.real_time_factor = sample.real_time_factor;
  status.state_hash = sample.state_hash;
  status.robots = sample.robots;
  status.awaited_count = sample.awaited_count;
  status.awaited = to_strings(sample.awaited);
  status.waiting_ns = sample.waiting_ns;
  for (const cohort_v1_ControllerStatus& each : to_span(sample.controllers)) status.controllers.push_back(decode(each));
  return status;
}

}  // namespace

std::string name_of(Operation operation) {
  for (const auto& [each, name] : names)
    if (each == operation) return name;
  return {};
}

bool is_query(Operation operation) {
  switch (operation) {
    case Operation::get_simulator_features:
    case Operation::get_simulation_state:
    case Operation::get_entities:
    case Operation::get_entity_state:
    case Operation::get_status:
    case Operation::get_data:
    case Operation::put_data:
    case Operation::get_recording:
    case Operation::stop_recording:
    case Operation::get_history: return true;
    default: return false;
  }
}

bool is_looking_on(Operation operation) {
  if (operation == Operation::put_data) return false;
  return is_query(operation) || operation == Operation::save_snapshot || operation == Operation::start_recording;
}

const Topic Codec<Request>::topic = {.name = "cohort/v1/request", .type = &cohort_v1_Request_desc, .depth = depth};
const Topic Codec<Reply>::topic = {
    .name = "cohort/v1/reply", .type = &cohort_v1_Reply_desc, .transient_local = true, .depth = depth};

Codec<Request>::Outgoing::Outgoing(const Request& message) {
  sample.client = message.client;
  sample.minor = message.minor;
  sample.number = message.number;
  sample.operation = static_cast<std::uint32_t>(message.operation);
  sample.label = loaned(message.label);
  sample.state = static_cast<std::uint32_t>(message.state);
  sample.scope = message.scope;
  sample.set_seed = message.set_seed;
  sample.seed = message.seed;
  sample.steps = message.steps;
  sample.speed = message.speed;
  sample.filter = loaned(message.filter);
  sample.entity = loaned(message.entity);
  sample.allow_renaming = message.allow_renaming;
  sample.uri = loaned(message.uri);
  sample.resource_string = loaned(message.resource_string);
  sample.set_pose = message.set_pose;
  sample.pose = encode(message.pose);
  sample.set_twist = message.set_twist;
  sample.twist = encode(message.twist);
  sample.on = message.on;
  sample.set_intensity = message.set_intensity;
  sample.intensity = message.intensity;
  sample.set_color = message.set_color;
  sample.color = encode(message.color);
  sample.link = loaned(message.link);
  sample.force = encode(message.force);
  sample.torque = encode(message.torque);
  sample.duration_ns = message.duration_ns;
  sample.size = message.size;
  sample.offset = message.offset;
  loan(message.data, sample.data);
}

Request Codec<Request>::decode(const Sample& sample) {
  Request message;
  message.client = sample.client;
  message.minor = sample.minor;
  message.number = sample.number;
  message.operation = static_cast<Operation>(sample.operation);
  message.label = to_string(sample.label);
  message.state = static_cast<SimulationState>(sample.state);
  message.scope = sample.scope;
  message.set_seed = sample.set_seed;
  message.seed = sample.seed;
  message.steps = sample.steps;
  message.speed = sample.speed;
  message.filter = to_string(sample.filter);
  message.entity = to_string(sample.entity);
  message.allow_renaming = sample.allow_renaming;
  message.uri = to_string(sample.uri);
  message.resource_string = to_string(sample.resource_string);
  message.set_pose = sample.set_pose;
  message.pose = wire::decode(sample.pose);
  message.set_twist = sample.set_twist;
  message.twist = wire::decode(sample.twist);
  message.on = sample.on;
  message.set_intensity = sample.set_intensity;
  message.intensity = sample.intensity;
  message.set_color = sample.set_color;
  message.color = wire::decode(sample.color);
  message.link = to_string(sample.link);
  message.force = wire::decode(sample.force);
  message.torque = wire::decode(sample.torque);
  message.duration_ns = sample.duration_ns;
  message.size = sample.size;
  message.offset = sample.offset;
  message.data = to_vector<std::uint8_t>(sample.data);
  return message;
}

Codec<Reply>::Outgoing::Outgoing(const Reply& message)
    : spawn_formats(lent_all(message.spawn_formats)), entities(lent_all(message.entities)) {
  states.reserve(message.states.size());
  for (const EntityState& state : message.states)
    states.push_back({loaned(state.entity), encode(state.pose), encode(state.twist)});
  for (const SimulationStatus& each : message.status) {
    auto& names_of_awaited = awaited.emplace_back(lent_all(each.awaited));
    auto& its_controllers = controllers.emplace_back();
    its_controllers.reserve(each.controllers.size());
    for (const ControllerStatus& controller : each.controllers) its_controllers.push_back(encode(controller));
    cohort_v1_SimulationStatus& encoded = status.emplace_back(encode(each));
    loan(names_of_awaited, encoded.awaited);
    loan(its_controllers, encoded.controllers);
  }
  sample.client = message.client;
  sample.number = message.number;
  sample.operation = static_cast<std::uint32_t>(message.operation);
  sample.result = static_cast<std::uint32_t>(message.result);
  sample.error_message = loaned(message.error_message);
  sample.state = static_cast<std::uint32_t>(message.state);
  sample.run = message.run;
  sample.tick = message.tick;
  sample.time_ns = message.time_ns;
  sample.entity = loaned(message.entity);
  loan(message.features, sample.features);
  loan(spawn_formats, sample.spawn_formats);
  loan(entities, sample.entities);
  loan(states, sample.states);
  loan(status, sample.status);
  sample.size = message.size;
  sample.offset = message.offset;
  loan(message.data, sample.data);
}

Reply Codec<Reply>::decode(const Sample& sample) {
  Reply message;
  message.client = sample.client;
  message.number = sample.number;
  message.operation = static_cast<Operation>(sample.operation);
  message.result = static_cast<ResultCode>(sample.result);
  message.error_message = to_string(sample.error_message);
  message.state = static_cast<SimulationState>(sample.state);
  message.run = sample.run;
  message.tick = sample.tick;
  message.time_ns = sample.time_ns;
  message.entity = to_string(sample.entity);
  message.features = to_vector<std::uint32_t>(sample.features);
  message.spawn_formats = to_strings(sample.spawn_formats);
  message.entities = to_strings(sample.entities);
  for (const cohort_v1_EntityState& state : to_span(sample.states))
    message.states.push_back({to_string(state.entity), wire::decode(state.pose), wire::decode(state.twist)});
  for (const cohort_v1_SimulationStatus& each : to_span(sample.status)) message.status.push_back(wire::decode(each));
  message.size = sample.size;
  message.offset = sample.offset;
  message.data = to_vector<std::uint8_t>(sample.data);
  return message;
}

}  // namespace cohort::wire
