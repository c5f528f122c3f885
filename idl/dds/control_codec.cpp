#include "idl/dds/codec.hpp"
#include "idl/dds/loans.hpp"

namespace cohort::wire {
namespace {

constexpr int depth = static_cast<int>(requests_under_way);

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

std::vector<char*> lent_all(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.push_back(loaned(text));
  return result;
}

// Each message's fields are listed once, beside those of its sample, and copied one way or the other; sequences of
// texts and structs are not among them.
struct ToSample {
  template <class Field, class Sampled>
  void operator()(const Field& field, Sampled& sampled) const {
    if constexpr (std::is_arithmetic_v<Field>)
      sampled = field;
    else if constexpr (std::is_enum_v<Field>)
      sampled = static_cast<Sampled>(field);
    else if constexpr (std::is_same_v<Field, std::string>)
      sampled = loaned(field);
    else if constexpr (requires { field.size(); })
      loan(field, sampled);
    else
      sampled = encode(field);
  }
};
struct FromSample {
  template <class Field, class Sampled>
  void operator()(Field& field, const Sampled& sampled) const {
    if constexpr (std::is_arithmetic_v<Field>)
      field = sampled;
    else if constexpr (std::is_enum_v<Field>)
      field = static_cast<Field>(sampled);
    else if constexpr (std::is_same_v<Field, std::string>)
      field = to_string(sampled);
    else if constexpr (requires { field.size(); })
      field.assign(to_span(sampled).begin(), to_span(sampled).end());
    else
      field = wire::decode(sampled);
  }
};

constexpr auto copy_controller_status = [](auto& message, auto& sample, auto copy) {
  copy(message.label, sample.label);
  copy(message.client, sample.client);
  copy(message.robots, sample.robots);
  copy(message.alive, sample.alive);
  copy(message.awaited, sample.awaited);
  copy(message.awaited_ns, sample.awaited_ns);
  copy(message.due_tick, sample.due_tick);
  copy(message.answers, sample.answers);
  copy(message.late, sample.late);
  copy(message.rejected, sample.rejected);
  copy(message.resent, sample.resent);
  copy(message.answer_p50_ns, sample.answer_p50_ns);
  copy(message.answer_p99_ns, sample.answer_p99_ns);
};

constexpr auto copy_status = [](auto& message, auto& sample, auto copy) {
  copy(message.experiment, sample.experiment);
  copy(message.seed, sample.seed);
  copy(message.started, sample.started);
  copy(message.step_ns, sample.step_ns);
  copy(message.duration_ns, sample.duration_ns);
  copy(message.speed, sample.speed);
  copy(message.real_time_factor, sample.real_time_factor);
  copy(message.state_hash, sample.state_hash);
  copy(message.robots, sample.robots);
  copy(message.awaited_count, sample.awaited_count);
  copy(message.waiting_ns, sample.waiting_ns);
};

constexpr auto copy_request = [](auto& message, auto& sample, auto copy) {
  copy(message.client, sample.client);
  copy(message.minor, sample.minor);
  copy(message.number, sample.number);
  copy(message.operation, sample.operation);
  copy(message.label, sample.label);
  copy(message.state, sample.state);
  copy(message.scope, sample.scope);
  copy(message.set_seed, sample.set_seed);
  copy(message.seed, sample.seed);
  copy(message.steps, sample.steps);
  copy(message.speed, sample.speed);
  copy(message.filter, sample.filter);
  copy(message.entity, sample.entity);
  copy(message.allow_renaming, sample.allow_renaming);
  copy(message.uri, sample.uri);
  copy(message.resource_string, sample.resource_string);
  copy(message.set_pose, sample.set_pose);
  copy(message.pose, sample.pose);
  copy(message.set_twist, sample.set_twist);
  copy(message.twist, sample.twist);
  copy(message.on, sample.on);
  copy(message.set_intensity, sample.set_intensity);
  copy(message.intensity, sample.intensity);
  copy(message.set_color, sample.set_color);
  copy(message.color, sample.color);
  copy(message.link, sample.link);
  copy(message.force, sample.force);
  copy(message.torque, sample.torque);
  copy(message.duration_ns, sample.duration_ns);
  copy(message.size, sample.size);
  copy(message.offset, sample.offset);
  copy(message.data, sample.data);
};

constexpr auto copy_reply = [](auto& message, auto& sample, auto copy) {
  copy(message.client, sample.client);
  copy(message.number, sample.number);
  copy(message.operation, sample.operation);
  copy(message.result, sample.result);
  copy(message.error_message, sample.error_message);
  copy(message.state, sample.state);
  copy(message.run, sample.run);
  copy(message.tick, sample.tick);
  copy(message.time_ns, sample.time_ns);
  copy(message.entity, sample.entity);
  copy(message.features, sample.features);
  copy(message.size, sample.size);
  copy(message.offset, sample.offset);
  copy(message.data, sample.data);
};

}  // namespace

const Topic Codec<Request>::topic = {.name = "cohort/v1/request", .type = &cohort_v1_Request_desc, .depth = depth};
const Topic Codec<Reply>::topic = {
    .name = "cohort/v1/reply", .type = &cohort_v1_Reply_desc, .transient_local = true, .depth = depth};

void Codec<Request>::lend(const Request& message, Sample& sample) { copy_request(message, sample, ToSample{}); }

Request Codec<Request>::decode(const Sample& sample) {
  Request message;
  copy_request(message, sample, FromSample{});
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
    for (const ControllerStatus& controller : each.controllers)
      copy_controller_status(controller, its_controllers.emplace_back(), ToSample{});
    cohort_v1_SimulationStatus& encoded = status.emplace_back();
    copy_status(each, encoded, ToSample{});
    loan(names_of_awaited, encoded.awaited);
    loan(its_controllers, encoded.controllers);
  }
  copy_reply(message, sample, ToSample{});
  loan(spawn_formats, sample.spawn_formats);
  loan(entities, sample.entities);
  loan(states, sample.states);
  loan(status, sample.status);
}

Reply Codec<Reply>::decode(const Sample& sample) {
  Reply message;
  copy_reply(message, sample, FromSample{});
  message.spawn_formats = to_strings(sample.spawn_formats);
  message.entities = to_strings(sample.entities);
  for (const cohort_v1_EntityState& state : to_span(sample.states))
    message.states.push_back({to_string(state.entity), wire::decode(state.pose), wire::decode(state.twist)});
  for (const cohort_v1_SimulationStatus& sent : to_span(sample.status)) {
    SimulationStatus& each = message.status.emplace_back();
    copy_status(each, sent, FromSample{});
    each.awaited = to_strings(sent.awaited);
    for (const cohort_v1_ControllerStatus& controller : to_span(sent.controllers))
      copy_controller_status(each.controllers.emplace_back(), controller, FromSample{});
  }
  return message;
}

}  // namespace cohort::wire
