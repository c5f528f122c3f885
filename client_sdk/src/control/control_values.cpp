// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/control/control_values.hpp"

namespace cohort {
namespace {

ControllerStatus from_wire(const wire::ControllerStatus& status) {
  return {status.label,
          status.client,
          status.robots,
          status.alive,
          status.awaited,
          std::chrono::nanoseconds(status.awaited_ns),
          status.due_tick,
          status.answers,
          status.late,
          status.rejected,
          status.resent,
          std::chrono::nanoseconds(status.answer_p50_ns),
          std::chrono::nanoseconds(status.answer_p99_ns)};
}

}  // namespace

ControlReply reply_from_wire(const wire::Reply& reply) {
  return {reply.state,         reply.run,
          reply.tick,          std::chrono::nanoseconds(reply.time_ns),
          reply.error_message, reply.result == wire::ResultCode::already_in_target_state};
}

SimulationStatus status_from_wire(const wire::Reply& reply, const wire::SimulationStatus& status) {
  SimulationStatus all{.state = reply.state,
                       .run = reply.run,
                       .tick = reply.tick,
                       .time = std::chrono::nanoseconds(reply.time_ns),
                       .experiment = status.experiment,
                       .seed = status.seed,
                       .started = status.started,
                       .step = std::chrono::nanoseconds(status.step_ns),
                       .duration = std::chrono::nanoseconds(status.duration_ns),
                       .speed = status.speed,
                       .real_time_factor = status.real_time_factor,
                       .state_hash = status.state_hash,
                       .robots = status.robots,
                       .awaited_count = status.awaited_count,
                       .awaited = status.awaited,
                       .waiting = std::chrono::nanoseconds(status.waiting_ns),
                       .controllers = {}};
  for (const wire::ControllerStatus& controller : status.controllers) all.controllers.push_back(from_wire(controller));
  return all;
}

ControlResult from_wire(wire::ResultCode result, wire::OperationCode operation) {
  using wire::ResultCode;
  const bool spawns = operation == wire::OperationCode::spawn_entity;
  switch (result) {
    case ResultCode::feature_unsupported: return ControlResult::feature_unsupported;
    case ResultCode::not_found: return ControlResult::not_found;
    case ResultCode::incorrect_state: return ControlResult::incorrect_state;
    case ResultCode::name_not_unique:  // 101
      if (spawns) return ControlResult::name_not_unique;
      return operation == wire::OperationCode::set_entity_state ? ControlResult::invalid_pose
                                                                : ControlResult::incorrect_state;
    case ResultCode::name_invalid: return ControlResult::name_invalid;
    case ResultCode::no_resource: return ControlResult::no_resource;
    case ResultCode::invalid_spawn_pose: return ControlResult::invalid_pose;
    case ResultCode::resource_parse_error: return ControlResult::invalid_model;
    case ResultCode::missing_assets: return ControlResult::missing_file;
    case ResultCode::unsupported_assets: return ControlResult::unsupported_model;
    case ResultCode::malformed: return ControlResult::malformed;
    case ResultCode::not_permitted: return ControlResult::not_permitted;
    case ResultCode::forgotten: return ControlResult::forgotten;
    case ResultCode::too_many_requests: return ControlResult::too_many_requests;
    case ResultCode::cancelled: return ControlResult::cancelled;
    case ResultCode::not_paused: return ControlResult::not_paused;
    case ResultCode::time_not_held: return ControlResult::time_not_held;
    case ResultCode::unknown_model: return ControlResult::unknown_model;
    case ResultCode::invalid_team: return ControlResult::invalid_team;
    case ResultCode::too_many_objects: return ControlResult::too_many_objects;
    case ResultCode::link_not_found: return ControlResult::link_not_found;
    case ResultCode::light_not_found: return ControlResult::light_not_found;
    case ResultCode::immovable: return ControlResult::immovable;
    case ResultCode::quarantined: return ControlResult::quarantined;
    case ResultCode::too_large: return ControlResult::too_large;
    case ResultCode::invalid_snapshot: return ControlResult::invalid_snapshot;
    case ResultCode::not_saved: return ControlResult::not_saved;
    case ResultCode::already_recording: return ControlResult::already_recording;
    case ResultCode::too_many_recordings: return ControlResult::too_many_recordings;
    case ResultCode::invalid_selection: return ControlResult::invalid_selection;
    case ResultCode::ok:
    case ResultCode::operation_failed: break;
  }
  return ControlResult::operation_failed;  // also for a code of a newer server
}

}  // namespace cohort
