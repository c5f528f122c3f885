#include "server/serving/control/control_queries.hpp"

#include <algorithm>
#include <chrono>

#include "idl/messages/run_history.hpp"
#include "server/serving/control/entity_filter.hpp"

namespace cohort::session {
namespace {

using wire::Operation;
using wire::Reply;
using wire::Request;
using wire::ResultCode;

constexpr std::chrono::milliseconds sample_interval{500};

// Of simulation_interfaces/msg/SimulatorFeatures.
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

void put(std::span<const std::byte> bytes, Reply& reply) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  reply.data.assign(begin, begin + bytes.size());
}

wire::Vector3 on_wire(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

void ControlQueries::begin(const ControlledRun& run) {
  run_ = &run;
  older_ = newer_ = {Clock::now(), run.simulation.time()};
}

void ControlQueries::note_progress(Clock::time_point now) {
  if (now - newer_.wall < sample_interval) return;
  older_ = newer_;
  newer_ = {now, run_->simulation.time()};
}

void ControlQueries::answer(Reply& reply, const Request& request) {
  try {
    switch (request.operation) {
      case Operation::get_simulator_features: fill_features(reply); break;
      case Operation::get_entities: fill_entities(reply, request); break;
      case Operation::get_entity_state: fill_entity_state(reply, request); break;
      case Operation::get_status: fill_status(reply); break;
      case Operation::get_data: fill_data(reply, request); break;
      case Operation::put_data: take_data(reply, request); break;
      case Operation::get_recording: fill_recording(reply, request); break;
      case Operation::stop_recording: stop_recording(reply, request); break;
      case Operation::get_history: fill_history(reply, request); break;
      default: break;  // every reply has the state
    }
  } catch (const std::exception& error) {
    reply.result = ResultCode::malformed;
    reply.error_message = error.what();
  }
}

void ControlQueries::fill_features(Reply& reply) const {
  reply.features = {spawning,
                    deleting,
                    spawning_resource_string,
                    entity_state_getting,
                    entity_state_setting,
                    simulation_state_getting,
                    simulation_state_setting,
                    simulation_state_pause,
                    step_simulation_single,
                    step_simulation_multiple};
  reply.spawn_formats = {"sdf", "urdf", "yaml"};
  if (run_->monitor.options().prepare) reply.features.push_back(simulation_reset);
  std::ranges::sort(reply.features);
}

void ControlQueries::fill_entities(Reply& reply, const Request& request) const {
  const EntityFilter filter(request.filter);
  const Objects& objects = run_->simulation.objects();
  for (std::uint32_t object = 0; object < objects.size(); ++object)
    if (objects.is_present(object) && filter.matches(objects.name(object)))
      reply.entities.push_back(objects.name(object));
}

std::optional<std::uint32_t> ControlQueries::find_entity(Reply& reply, const std::string& name) const {
  const Objects& objects = run_->simulation.objects();
  const auto found = objects.find(name);
  if (found && objects.is_present(*found)) return found;
  reply.result = ResultCode::not_found;
  reply.error_message = found ? "'" + name + "' is not in the world now" : "there is no '" + name + "' in the world";
  return std::nullopt;
}

void ControlQueries::fill_entity_state(Reply& reply, const Request& request) const {
  const auto object = find_entity(reply, request.entity);
  if (!object) return;
  const Pose X_WL = run_->simulation.object_pose(*object);
  const auto& q = X_WL.orientation;
  const physics::Twist twist = run_->simulation.world().link_twist(*object, 0);
  reply.entity = request.entity;
  reply.states.push_back({request.entity,
                          {on_wire(X_WL.position), {q.x(), q.y(), q.z(), q.w()}},
                          {on_wire(twist.linear_W), on_wire(twist.angular_W)}});
}

void ControlQueries::fill_status(Reply& reply) {
  wire::SimulationStatus& status = reply.status.emplace_back();
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

void ControlQueries::fill_data(Reply& reply, const Request& request) const {
  const auto part = ledger_.part(request.client, request.offset);
  if (!part) {
    reply.result = ResultCode::not_found;
    const std::string why = ledger_.why_dropped(request.client, KeptForClient::Kind::saved_snapshot);
    reply.error_message = why.empty() ? "there is no data for this client: it has saved nothing" : why;
    return;
  }
  reply.size = part->size;
  reply.offset = request.offset;
  put(part->bytes, reply);
}

void ControlQueries::fill_recording(Reply& reply, const Request& request) {
  std::optional<LiveRecordings::Part> part;
  try {
    part = recordings_.fetch(request.client, request.offset);
  } catch (const std::runtime_error& dropped) {
    reply.result = ResultCode::not_found;
    reply.error_message = dropped.what();
    return;
  }
  if (!part) {
    reply.result = ResultCode::not_found;
    reply.error_message = "this client records nothing, or has fetched beyond byte " + std::to_string(request.offset);
    return;
  }
  reply.size = part->bytes.size.value_or(0);
  reply.offset = request.offset;
  put(part->bytes.bytes, reply);
  reply.error_message = part->problem;
}

void ControlQueries::stop_recording(Reply& reply, const Request& request) {
  recordings_.stop(request.client);
  reply.error_message = "recorded up to tick " + std::to_string(run_->simulation.tick());
}

void ControlQueries::fill_history(Reply& reply, const Request& request) const {
  constexpr std::size_t most_events = 250;
  messages::RunHistory history;
  const RunMonitor& monitor = run_->monitor;
  if (monitor.options().from) history.begin_tick = monitor.options().from->tick;
  history.keep_interval = kept_.interval();
  if (kept_.size() > 0) {
    history.first_kept_tick = kept_.first_tick();
    history.last_kept_tick = kept_.last_tick();
  }
  std::uint64_t revision = request.offset;
  const std::vector<RunEvent> events = monitor.events().changed_since(revision, most_events);
  history.events.reserve(events.size());
  for (const RunEvent& event : events)
    history.events.push_back({event.tick, event.last_tick, event.count, event.kind, event.text});
  put(messages::encode(history), reply);
  reply.offset = revision;
  reply.size = monitor.events().revision();
}

void ControlQueries::take_data(Reply& reply, const Request& request) {
  reply.size = request.size;
  reply.offset = request.offset;
  const auto wrong =
      ledger_.take_part(request.client, request.size, request.offset, request.data, Clock::now().time_since_epoch());
  if (!wrong) return;
  reply.result = ResultCode::malformed;
  reply.error_message = *wrong;
}

}  // namespace cohort::session
