// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "idl/dds/fields.hpp"
#include "idl/dds/message_fields.hpp"
#include "idl/dds/topic.hpp"
#include "idl/wire/control_messages.hpp"

/// Fields of the control messages in cohort.idl. A Request has the fields of all operations, and a Reply those of all
/// results. Each operation uses some; the others are zero, empty or false.
namespace cohort::wire {

template <>
struct OnWire<Pose> : Between<Pose, cohort_v1_Pose> {
  static constexpr std::tuple fields = {field(&M::position, &S::position), field(&M::orientation, &S::orientation)};
};

template <>
struct OnWire<Twist> : Between<Twist, cohort_v1_Twist> {
  static constexpr std::tuple fields = {field(&M::linear, &S::linear), field(&M::angular, &S::angular)};
};

template <>
struct OnWire<EntityState> : Between<EntityState, cohort_v1_EntityState> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity), field(&M::pose, &S::pose),
                                        field(&M::twist, &S::twist)};
};

template <>
struct OnWire<ControllerStatus> : Between<ControllerStatus, cohort_v1_ControllerStatus> {
  static constexpr std::tuple fields = {field(&M::label, &S::label),
                                        field(&M::client, &S::client),
                                        field(&M::robots, &S::robots),
                                        field(&M::alive, &S::alive),
                                        field(&M::awaited, &S::awaited),
                                        field(&M::awaited_ns, &S::awaited_ns),
                                        field(&M::due_tick, &S::due_tick),
                                        field(&M::answers, &S::answers),
                                        field(&M::late, &S::late),
                                        field(&M::rejected, &S::rejected),
                                        field(&M::resent, &S::resent),
                                        field(&M::answer_p50_ns, &S::answer_p50_ns),
                                        field(&M::answer_p99_ns, &S::answer_p99_ns)};
};

template <>
struct OnWire<SimulationStatus> : Between<SimulationStatus, cohort_v1_SimulationStatus> {
  static constexpr std::tuple fields = {field(&M::experiment, &S::experiment),
                                        field(&M::seed, &S::seed),
                                        field(&M::started, &S::started),
                                        field(&M::step_ns, &S::step_ns),
                                        field(&M::duration_ns, &S::duration_ns),
                                        field(&M::speed, &S::speed),
                                        field(&M::real_time_factor, &S::real_time_factor),
                                        field(&M::state_hash, &S::state_hash),
                                        field(&M::robots, &S::robots),
                                        field(&M::awaited_count, &S::awaited_count),
                                        field(&M::awaited, &S::awaited),
                                        field(&M::waiting_ns, &S::waiting_ns),
                                        field(&M::controllers, &S::controllers)};
};

// Operations

template <>
struct OnWire<UnknownOperation> : Between<UnknownOperation, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::number, &S::operation)};
};

template <>
struct OnWire<SetSimulationState> : Between<SetSimulationState, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::state, &S::state)};
};

template <>
struct OnWire<StepSimulation> : Between<StepSimulation, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::steps, &S::steps)};
};

template <>
struct OnWire<AdvanceTime> : Between<AdvanceTime, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::steps, &S::steps), field(&M::release, &S::on)};
};

template <>
struct OnWire<ResetSimulation> : Between<ResetSimulation, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::scope, &S::scope), optional_field(&M::seed, &S::set_seed, &S::seed)};
};

template <>
struct OnWire<GetEntities> : Between<GetEntities, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::filter, &S::filter)};
};

template <>
struct OnWire<GetEntityState> : Between<GetEntityState, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity)};
};

template <>
struct OnWire<SetEntityState> : Between<SetEntityState, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity), optional_field(&M::pose, &S::set_pose, &S::pose),
                                        optional_field(&M::twist, &S::set_twist, &S::twist)};
};

template <>
struct OnWire<SpawnEntity> : Between<SpawnEntity, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity), field(&M::allow_renaming, &S::allow_renaming),
                                        field(&M::uri, &S::uri),       field(&M::resource_string, &S::resource_string),
                                        field(&M::pose, &S::pose),     field(&M::team, &S::filter)};
};

template <>
struct OnWire<DeleteEntity> : Between<DeleteEntity, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity)};
};

template <>
struct OnWire<SetSpeed> : Between<SetSpeed, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::speed, &S::speed)};
};

template <>
struct OnWire<SetLight> : Between<SetLight, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity), field(&M::on, &S::on),
                                        optional_field(&M::intensity, &S::set_intensity, &S::intensity),
                                        optional_field(&M::color, &S::set_color, &S::color)};
};

template <>
struct OnWire<ApplyForce> : Between<ApplyForce, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity), field(&M::link, &S::link),
                                        field(&M::force, &S::force), field(&M::torque, &S::torque),
                                        field(&M::duration_ns, &S::duration_ns)};
};

template <>
struct OnWire<GetData> : Between<GetData, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::offset, &S::offset)};
};

template <>
struct OnWire<PutData> : Between<PutData, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::size, &S::size), field(&M::offset, &S::offset),
                                        field(&M::data, &S::data)};
};

template <>
struct OnWire<StartRecording> : Between<StartRecording, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::recorded, &S::resource_string)};
};

template <>
struct OnWire<GetRecording> : Between<GetRecording, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::offset, &S::offset)};
};

template <>
struct OnWire<GoBack> : Between<GoBack, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::duration_ns, &S::duration_ns)};
};

template <>
struct OnWire<GetHistory> : Between<GetHistory, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::revision, &S::offset)};
};

template <>
struct OnWire<GetExperiment> : Between<GetExperiment, cohort_v1_Request> {
  static constexpr std::tuple fields = {field(&M::offset, &S::offset)};
};

// Results

template <>
struct OnWire<SimulatorFeatures> : Between<SimulatorFeatures, cohort_v1_Reply> {
  static constexpr std::tuple fields = {field(&M::features, &S::features), field(&M::spawn_formats, &S::spawn_formats)};
};

template <>
struct OnWire<EntityNames> : Between<EntityNames, cohort_v1_Reply> {
  static constexpr std::tuple fields = {field(&M::entities, &S::entities)};
};

template <>
struct OnWire<EntityName> : Between<EntityName, cohort_v1_Reply> {
  static constexpr std::tuple fields = {field(&M::entity, &S::entity)};
};

template <>
struct OnWire<DataPart> : Between<DataPart, cohort_v1_Reply> {
  static constexpr std::tuple fields = {field(&M::size, &S::size), field(&M::offset, &S::offset),
                                        field(&M::data, &S::data)};
};

template <>
struct OnWire<HistoryPart> : Between<HistoryPart, cohort_v1_Reply> {
  static constexpr std::tuple fields = {field(&M::revision, &S::offset), field(&M::newest, &S::size),
                                        field(&M::data, &S::data)};
};

/// The fields of a value that an operation returned, in a Reply.
template <class Value>
struct InReply {
  static constexpr const auto& fields = OnWire<Value>::fields;
};

/// An optional value as a sequence of one element, or none.
template <class Value, class Sequence>
struct OnlyElement {
  Sequence cohort_v1_Reply::*sampled;

  void lend(const Value& value, cohort_v1_Reply& sample, Room& room) const {
    using Element = std::remove_pointer_t<decltype((sample.*sampled)._buffer)>;
    const std::span<Element> elements = room.array<Element>(1);
    lend_value(value, elements.front(), room);
    loan(elements, sample.*sampled);
  }
  void read(const cohort_v1_Reply& sample, Value& value) const {
    if (is_there(sample)) read_value(to_span(sample.*sampled).front(), value);
  }
  bool is_there(const cohort_v1_Reply& sample) const { return !to_span(sample.*sampled).empty(); }
  constexpr auto samples() const { return std::tuple(sampled); }
};

template <>
struct InReply<EntityState> {
  static constexpr std::tuple fields = {
      field(&EntityState::entity, &cohort_v1_Reply::entity),
      OnlyElement<EntityState, dds_sequence_cohort_v1_EntityState>{&cohort_v1_Reply::states}};
};
template <>
struct InReply<SimulationStatus> {
  static constexpr std::tuple fields = {
      OnlyElement<SimulationStatus, dds_sequence_cohort_v1_SimulationStatus>{&cohort_v1_Reply::status}};
};

/// Calls `visit` with the type of each operation that has a number.
template <class Visit>
void for_each_operation(const Visit& visit) {
  const auto visit_one = [&]<class One>(std::type_identity<One> type) {
    if constexpr (requires { One::code; }) visit(type);
  };
  [&]<class... One>(std::type_identity<std::variant<One...>>) {
    (visit_one(std::type_identity<One>{}), ...);
  }(std::type_identity<Operation>{});
}

template <class... One>
constexpr bool lists_all_members_of_each(std::type_identity<std::variant<One...>>) {
  return (lists_all_members<One>() && ...);
}

/// The operation of a Request: its number and its fields.
struct OperationField {
  using Sample = cohort_v1_Request;
  static_assert(lists_all_members_of_each(std::type_identity<Operation>{}));
  static constexpr bool needs_room = false;

  void lend(const Request& request, Sample& sample, NoRoom& room) const {
    sample.operation = static_cast<std::uint32_t>(request.code());
    std::visit([&](const auto& operation) { lend_fields(operation, sample, room); }, request.operation);
  }
  void read(const Sample& sample, Request& request) const {
    request.operation = UnknownOperation{sample.operation};
    for_each_operation([&]<class One>(std::type_identity<One>) {
      if (One::code == static_cast<OperationCode>(sample.operation))
        read_fields(sample, request.operation.emplace<One>());
    });
  }
  constexpr auto members() const { return std::tuple(&Request::operation); }
  constexpr auto samples() const {
    return []<class... One>(std::type_identity<std::variant<One...>>) {
      return std::tuple_cat(samples_in(OnWire<One>::fields)...);
    }(std::type_identity<Operation>{});
  }
};

/// The result of the operation in a Reply. The number of the operation must be read first.
struct ReturnedField {
  using Sample = cohort_v1_Reply;
  static_assert(lists_all_members_of_each(std::type_identity<Returned>{}));
  static constexpr bool needs_room = true;

  void lend(const Reply& reply, Sample& sample, Room& room) const {
    std::visit(
        [&]<class Value>(const Value& value) {
          std::apply([&](const auto&... each) { (each.lend(value, sample, room), ...); }, InReply<Value>::fields);
        },
        reply.returned);
  }
  void read(const Sample& sample, Reply& reply) const {
    for_each_operation([&]<class One>(std::type_identity<One>) {
      using Value = typename One::Returned;
      if (One::code == reply.operation && is_there<Value>(sample)) {
        Value& value = reply.returned.emplace<Value>();
        std::apply([&](const auto&... each) { (each.read(sample, value), ...); }, InReply<Value>::fields);
      }
    });
  }
  constexpr auto members() const { return std::tuple(&Reply::returned); }
  constexpr auto samples() const {
    return []<class... One>(std::type_identity<std::variant<One...>>) {
      return std::tuple_cat(samples_in(InReply<One>::fields)...);
    }(std::type_identity<Returned>{});
  }

 private:
  template <class Value>
  static bool is_there(const Sample& sample) {
    const auto has = [&](const auto& each) {
      if constexpr (requires { each.is_there(sample); }) return each.is_there(sample);
      return true;
    };
    return std::apply([&](const auto&... each) { return (has(each) && ...); }, InReply<Value>::fields);
  }
};

template <>
struct OnWire<Request> : Between<Request, cohort_v1_Request> {
  static constexpr Topic topic = {
      .name = "cohort/v1/request", .type = &cohort_v1_Request_desc, .depth = static_cast<int>(requests_under_way)};
  static constexpr std::tuple fields = {field(&M::client, &S::client), field(&M::minor, &S::minor),
                                        field(&M::number, &S::number), field(&M::label, &S::label), OperationField{}};
};

template <>
struct OnWire<Reply> : Between<Reply, cohort_v1_Reply> {
  static constexpr Topic topic = {.name = "cohort/v1/reply",
                                  .type = &cohort_v1_Reply_desc,
                                  .transient_local = true,
                                  .depth = static_cast<int>(requests_under_way)};
  static constexpr std::tuple fields = {field(&M::client, &S::client),
                                        field(&M::number, &S::number),
                                        field(&M::operation, &S::operation),
                                        field(&M::result, &S::result),
                                        field(&M::error_message, &S::error_message),
                                        field(&M::state, &S::state),
                                        field(&M::run, &S::run),
                                        field(&M::tick, &S::tick),
                                        field(&M::time_ns, &S::time_ns),
                                        ReturnedField{}};
};

}  // namespace cohort::wire
