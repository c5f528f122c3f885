// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/control_queries.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "idl/messages/run_history.hpp"
#include "server/messages/experiment_inputs.hpp"
#include "server/serving/control/entity_filter.hpp"

namespace cohort::session {
namespace {

using wire::Reply;
using wire::Request;
using wire::ResultCode;

constexpr std::chrono::milliseconds sample_interval{500};

// Numbers of simulation_interfaces/msg/SimulatorFeatures.
enum Feature : std::uint32_t {
  spawning = 0,
  deleting = 1,
  spawning_resource_string = 9,
  entity_state_getting = 10,
  entity_state_setting = 11,
  simulation_reset = 20,
  simulation_state_getting = 24,
  simulation_state_setting = 25,
  simulation_state_pause = 26,
  step_simulation_single = 31,
  step_simulation_multiple = 32,
};

std::vector<std::uint8_t> on_wire(std::span<const std::byte> bytes) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return {begin, begin + bytes.size()};
}

wire::Vector3 on_wire(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void ControlQueries::begin(const ControlledRun& run) {
  run_ = &run;
  experiment_ = {};
  older_ = newer_ = {Clock::now(), run.simulation.time()};
}

void ControlQueries::note_progress(Clock::time_point now) {
  if (now - newer_.wall < sample_interval) return;
  older_ = newer_;
  newer_ = {now, run_->simulation.time()};
}

void ControlQueries::answer(Reply& reply, const Request& request) {
  try {
    std::visit(
        [&](const auto& operation) {
          if constexpr (requires { fill(reply, request, operation); }) fill(reply, request, operation);
        },
        request.operation);  // every reply has the state
  } catch (const std::exception& error) {
    reply.result = ResultCode::malformed;
    reply.error_message = error.what();
  }
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetSimulatorFeatures&) const {
  wire::SimulatorFeatures has;
  has.features = {spawning,
                  deleting,
                  spawning_resource_string,
                  entity_state_getting,
                  entity_state_setting,
                  simulation_state_getting,
                  simulation_state_setting,
                  simulation_state_pause,
                  step_simulation_single,
                  step_simulation_multiple};
  has.spawn_formats = {"sdf", "urdf", "yaml"};
  if (run_->monitor.options().prepare) has.features.push_back(simulation_reset);
  std::ranges::sort(has.features);
  reply.returned = std::move(has);
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetEntities& operation) const {
  const EntityFilter filter(operation.filter);
  const Objects& objects = run_->simulation.objects();
  wire::EntityNames found;
  for (std::uint32_t object = 0; object < objects.size(); ++object)
    if (objects.is_present(object) && filter.matches(objects.name(object)))
      found.entities.push_back(objects.name(object));
  reply.returned = std::move(found);
}

std::optional<std::uint32_t> ControlQueries::find_entity(Reply& reply, const std::string& name) const {
  const Objects& objects = run_->simulation.objects();
  const auto found = objects.find(name);
  if (found && objects.is_present(*found)) return found;
  reply.result = ResultCode::not_found;
  reply.error_message = found ? "'" + name + "' is not in the world now" : "there is no '" + name + "' in the world";
  return std::nullopt;
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetEntityState& operation) const {
  const auto object = find_entity(reply, operation.entity);
  if (!object) return;
  const Pose X_WL = run_->simulation.object_pose(*object);
  const auto& q = X_WL.orientation;
  const physics::Twist twist = run_->simulation.world().link_twist(BodyId{*object}, LinkId{0});
  reply.returned = wire::EntityState{operation.entity,
                                     {on_wire(X_WL.position), {q.x(), q.y(), q.z(), q.w()}},
                                     {on_wire(twist.linear_W), on_wire(twist.angular_W)}};
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetStatus&) {
  auto& status = reply.returned.emplace<wire::SimulationStatus>();
  status.experiment = run_->experiment.name;
  status.seed = run_->experiment.seed;
  status.step_ns = run_->experiment.world.step.count();
  status.duration_ns = run_->monitor.duration().count();
  status.speed = run_->monitor.speed();
  status.state_hash = run_->simulation.state_hash();
  status.robots = run_->simulation.robot_count();
  const auto now = Clock::now();
  note_progress(now);
  const std::chrono::duration<double> wall = now - older_.wall;
  const std::chrono::duration<double> simulated = run_->simulation.time() - older_.time;
  if (wall.count() > 0.0) status.real_time_factor = simulated / wall;
  run_->fill_status(status);
}

void ControlQueries::fill(Reply& reply, const Request& request, const wire::GetData& operation) const {
  const auto part = ledger_.part(request.client, operation.offset);
  if (!part) {
    reply.result = ResultCode::not_found;
    const std::string why = ledger_.why_dropped(request.client, KeptForClient::Kind::saved_snapshot);
    reply.error_message = why.empty() ? "there is no data for this client: it has not saved a snapshot" : why;
    return;
  }
  reply.returned = wire::DataPart{part->size, operation.offset, on_wire(part->bytes)};
}

void ControlQueries::fill(Reply& reply, const Request& request, const wire::GetRecording& operation) {
  std::optional<LiveRecordings::Part> part;
  try {
    part = recordings_.fetch(request.client, operation.offset);
  } catch (const std::runtime_error& dropped) {
    reply.result = ResultCode::not_found;
    reply.error_message = dropped.what();
    return;
  }
  if (!part) {
    reply.result = ResultCode::not_found;
    reply.error_message =
        "this client is not recording, or has already fetched data beyond byte " + std::to_string(operation.offset);
    return;
  }
  reply.returned = wire::DataPart{part->bytes.size.value_or(0), operation.offset, on_wire(part->bytes.bytes)};
  reply.error_message = part->problem;
}

void ControlQueries::fill(Reply& reply, const Request& request, const wire::StopRecording&) {
  recordings_.stop(request.client);
  reply.error_message = "recorded up to tick " + std::to_string(run_->simulation.tick());
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetHistory& operation) const {
  constexpr std::size_t most_events = 250;
  messages::RunHistory history;
  const RunMonitor& monitor = run_->monitor;
  if (monitor.options().from) history.begin_tick = monitor.options().from->tick;
  history.keep_interval = kept_.interval();
  if (kept_.size() > 0) {
    history.first_kept_tick = kept_.first_tick();
    history.last_kept_tick = kept_.last_tick();
  }
  std::uint64_t revision = operation.revision;
  const std::vector<RunEvent> events = monitor.events().changed_since(revision, most_events);
  history.events.reserve(events.size());
  for (const RunEvent& event : events)
    history.events.push_back({event.tick, event.last_tick, event.count, event.kind, event.text});
  reply.returned = wire::HistoryPart{revision, monitor.events().revision(), on_wire(messages::encode(history))};
}

void ControlQueries::fill(Reply& reply, const Request&, const wire::GetExperiment& operation) {
  const description::Experiment& experiment = run_->experiment;
  const auto refuse = [&](ResultCode result, std::string why) {
    reply.result = result;
    reply.error_message = std::move(why);
  };
  if (!experiment.inputs)
    return refuse(ResultCode::not_found, "the experiment was built by a program, not read from files");
  if (experiment_.empty())
    experiment_ =
        messages::encode(messages::experiment_files(*experiment.inputs, experiment.seed, experiment.duration));
  const std::uint64_t size = experiment_.size();
  if (size > wire::largest_data)
    return refuse(ResultCode::too_large, "the experiment's files have " + std::to_string(size) +
                                             " bytes; the maximum that can be sent is " +
                                             std::to_string(wire::largest_data));
  if (operation.offset > size)
    return refuse(ResultCode::malformed, "offset " + std::to_string(operation.offset) + " is beyond the " +
                                             std::to_string(size) + " bytes of the experiment's files");
  const std::size_t count = std::min<std::uint64_t>(size - operation.offset, wire::largest_part);
  reply.returned =
      wire::DataPart{size, operation.offset, on_wire(std::span(experiment_).subspan(operation.offset, count))};
}

void ControlQueries::fill(Reply& reply, const Request& request, const wire::PutData& part) {
  reply.returned = wire::DataPart{part.size, part.offset, {}};
  const auto wrong =
      ledger_.take_part(request.client, part.size, part.offset, part.data, Clock::now().time_since_epoch());
  if (!wrong) return;
  reply.result = ResultCode::malformed;
  reply.error_message = *wrong;
}

}  // namespace cohort::session
