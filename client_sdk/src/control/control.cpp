// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/include/cohort/control.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "client_sdk/src/control/control_client.hpp"
#include "client_sdk/src/control/control_values.hpp"
#include "client_sdk/src/control/experiment_query.hpp"
#include "client_sdk/src/control/run_history_query.hpp"

namespace cohort {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds usual_limit{30'000};
constexpr milliseconds no_limit = std::chrono::hours(24 * 365);
constexpr milliseconds fetches_again_after{50};
constexpr milliseconds for_last_word{1'000};

enum class Takes { a_moment, as_long_as_the_run };

}  // namespace

struct Control::State {
  explicit State(const ControlOptions& options) : client(attach(options)), time_limit(options.time_limit) {}

  const std::atomic<bool>& flag() const { return stop != nullptr ? *stop : never; }

  ControlError no_reply(milliseconds limit) const {
    if (flag()) return ControlError("interrupted", ControlResult::interrupted);
    if (client.server_is_gone()) return ControlError("the server is gone", ControlResult::server_gone);
    std::ostringstream seconds;
    seconds << 1e-3 * static_cast<double>(limit.count());
    const char* const why = client.sees_server() ? "" : ": no controllable server found";
    return ControlError("the request was not completed within " + seconds.str() + " s" + why, ControlResult::no_answer);
  }

  // Sends a request and returns its reply. Throws unless it was done.
  wire::Reply request(const wire::Operation& operation, Takes takes = Takes::a_moment) {
    const milliseconds limit = time_limit.value_or(takes == Takes::a_moment ? usual_limit : no_limit);
    auto reply = client.ask(operation, limit, flag());
    const wire::OperationCode code = wire::code_of(operation);
    if (!reply) throw no_reply(limit);
    if (!reply->is_done()) throw ControlError(reply->error_message, from_wire(reply->result, code));
    last = reply_from_wire(*reply);
    return std::move(*reply);
  }

  ControlReply perform(const wire::Operation& operation, Takes takes = Takes::a_moment) {
    request(operation, takes);
    return last;
  }

  // Returns the result of the operation.
  template <class One>
  typename One::Returned get(const One& operation) {
    wire::Reply reply = request(operation);
    if (auto* const returned = std::get_if<typename One::Returned>(&reply.returned)) return std::move(*returned);
    throw ControlError("the server's reply to " + wire::name_of(One::code) + " lacks the requested data",
                       ControlResult::bad_reply);
  }

  ControlClient client;
  std::optional<milliseconds> time_limit;
  const std::atomic<bool> never{false};
  const std::atomic<bool>* stop = nullptr;
  ControlReply last;
};

Control::Control(const ControlOptions& options) : state_(std::make_unique<State>(options)) {}
Control::~Control() = default;

void Control::stop_on(const std::atomic<bool>* stop) { state_->stop = stop; }
void Control::set_time_limit(std::optional<milliseconds> time_limit) { state_->time_limit = time_limit; }
bool Control::wait_for_server(milliseconds at_most) { return state_->client.wait_for_server(at_most, state_->flag()); }
bool Control::server_is_gone() const { return state_->client.server_is_gone(); }
const ControlReply& Control::last_reply() const { return state_->last; }

SimulatorFeatures Control::features() {
  wire::SimulatorFeatures features = state_->get(wire::GetSimulatorFeatures{});
  return {std::move(features.features), std::move(features.spawn_formats)};
}

SimulationState Control::state() { return state_->perform(wire::GetSimulationState{}).state; }

SimulationStatus Control::status() {
  const wire::Reply reply = state_->request(wire::GetStatus{});
  if (const auto* const status = reply.get<wire::SimulationStatus>()) return status_from_wire(reply, *status);
  throw ControlError("the server's reply lacks the status of the run", ControlResult::bad_reply);
}

ControlReply Control::play() { return state_->perform(wire::SetSimulationState{SimulationState::playing}); }
ControlReply Control::pause() { return state_->perform(wire::SetSimulationState{SimulationState::paused}); }
ControlReply Control::stop() {
  return state_->perform(wire::SetSimulationState{SimulationState::stopped}, Takes::as_long_as_the_run);
}

ControlReply Control::quit() {
  try {
    return state_->perform(wire::SetSimulationState{SimulationState::quitting});
  } catch (const ControlError& error) {
    if (error.result != ControlResult::server_gone) throw;
    state_->last = {};
    state_->last.state = SimulationState::quitting;
    state_->last.message = "the server has ended";
    return state_->last;
  }
}

ControlReply Control::step(std::uint64_t steps) {
  return state_->perform(wire::StepSimulation{steps}, Takes::as_long_as_the_run);
}

ControlReply Control::reset(std::optional<std::uint64_t> seed, ResetScope scope) {
  return state_->perform(wire::ResetSimulation{static_cast<std::uint32_t>(scope), seed}, Takes::as_long_as_the_run);
}

ControlReply Control::back(std::chrono::nanoseconds time) {
  return state_->perform(wire::GoBack{time.count()}, Takes::as_long_as_the_run);
}

ControlReply Control::hold_time() { return state_->perform(wire::AdvanceTime{}); }
ControlReply Control::advance_time(std::uint64_t steps) {
  if (steps == 0) throw ControlError("steps is 0, expected at least 1", ControlResult::malformed);
  return state_->perform(wire::AdvanceTime{.steps = steps}, Takes::as_long_as_the_run);
}
ControlReply Control::release_time() { return state_->perform(wire::AdvanceTime{.release = true}); }

ControlReply Control::set_speed(double speed) { return state_->perform(wire::SetSpeed{speed}); }

std::vector<std::string> Control::entities(const std::string& filter) {
  return state_->get(wire::GetEntities{filter}).entities;
}

EntityState Control::entity_state(const std::string& entity) {
  wire::EntityState state = state_->get(wire::GetEntityState{entity});
  return {std::move(state.entity), state.pose, state.twist};
}

ControlReply Control::set_pose(const std::string& entity, const WorldPose& pose) {
  return state_->perform(wire::SetEntityState{entity, pose, {}});
}

ControlReply Control::set_twist(const std::string& entity, const Twist& twist) {
  return state_->perform(wire::SetEntityState{entity, {}, twist});
}

ControlReply Control::set_entity_state(const EntityState& state) {
  return state_->perform(wire::SetEntityState{state.entity, state.pose, state.twist});
}

std::string Control::spawn(const Spawn& what) {
  return state_
      ->get(wire::SpawnEntity{.entity = what.name,
                              .allow_renaming = what.allow_renaming,
                              .uri = what.model,
                              .resource_string = what.text,
                              .pose = what.pose,
                              .team = what.team})
      .entity;
}

ControlReply Control::remove(const std::string& entity) { return state_->perform(wire::DeleteEntity{entity}); }

ControlReply Control::set_light(const std::string& light, const LightSetting& setting) {
  wire::SetLight set{.entity = light, .on = setting.on, .intensity = setting.intensity, .color = {}};
  if (setting.color) set.color = wire::Vector3{setting.color->red, setting.color->green, setting.color->blue};
  return state_->perform(set);
}

ControlReply Control::apply_force(const std::string& entity, const AppliedForce& force) {
  return state_->perform(wire::ApplyForce{.entity = entity,
                                          .link = force.link,
                                          .force = force.force,
                                          .torque = force.torque,
                                          .duration_ns = force.duration.count()});
}

std::vector<std::byte> Control::save_snapshot() {
  const std::uint64_t size = state_->get(wire::SaveSnapshot{}).size;
  const ControlReply saved = state_->last;
  if (size > wire::largest_data)
    throw ControlError("the server announced a snapshot that is too large", ControlResult::bad_reply);
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  while (bytes.size() < size) {
    const wire::DataPart part = state_->get(wire::GetData{bytes.size()});
    if (part.offset != bytes.size() || part.size != size || part.data.empty() || part.data.size() > size - bytes.size())
      throw ControlError("the server sent the wrong part of the snapshot", ControlResult::bad_reply);
    const auto data = std::as_bytes(std::span(part.data));
    bytes.insert(bytes.end(), data.begin(), data.end());
  }
  state_->last = saved;
  return bytes;
}

ControlReply Control::load_snapshot(std::span<const std::byte> snapshot) {
  for (std::uint64_t offset = 0; offset < snapshot.size(); offset += wire::largest_part) {
    const auto part = snapshot.subspan(offset, std::min<std::size_t>(wire::largest_part, snapshot.size() - offset));
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(part.data());
    state_->request(wire::PutData{.size = snapshot.size(), .offset = offset, .data = {begin, begin + part.size()}});
  }
  return state_->perform(wire::LoadSnapshot{}, Takes::as_long_as_the_run);
}

ControlReply Control::start_recording(const std::string& recorded) {
  return state_->perform(wire::StartRecording{recorded});
}

ControlReply Control::stop_recording() { return state_->perform(wire::StopRecording{}); }

RecordingPart Control::fetch_recording(std::uint64_t offset) {
  const wire::DataPart data = state_->get(wire::GetRecording{offset});
  const auto bytes = std::as_bytes(std::span(data.data));
  const std::uint64_t end = offset + bytes.size();
  if (data.offset != offset || (data.size != 0 && data.size < end))
    throw ControlError("the server sent the wrong part of the recording", ControlResult::bad_reply);
  return {{bytes.begin(), bytes.end()}, data.size != 0 && data.size == end, state_->last.message};
}

std::string Control::save_recording(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  std::uint64_t size = 0;
  for (;;) {
    const RecordingPart part = fetch_recording(size);
    out.write(reinterpret_cast<const char*>(part.bytes.data()), static_cast<std::streamsize>(part.bytes.size()));
    if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
    size += part.bytes.size();
    if (part.bytes.empty() && !part.is_last) std::this_thread::sleep_for(fetches_again_after);
    if (!part.is_last) continue;
    // The server may exit once it knows that everything has arrived; it may already have exited.
    state_->client.ask(wire::GetRecording{size}, for_last_word, state_->flag());
    return part.problem;
  }
}

RunHistory Control::history(std::uint64_t since) {
  return query_history(since, [&](const wire::GetHistory& question) { return state_->request(question); });
}

ExperimentFiles Control::experiment_files() {
  return query_experiment([&](const wire::GetExperiment& question) { return state_->request(question); });
}

}  // namespace cohort
