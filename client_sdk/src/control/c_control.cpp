// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/include/cohort/control.hpp"
#include "client_sdk/src/c_options.hpp"

// The handle, with the results of the last calls.
struct CohortControl {
  explicit CohortControl(const cohort::ControlOptions& options) : control(options) { control.stop_on(&cancelled); }

  std::atomic<bool> cancelled{false};
  cohort::Control control;
  CohortResult result = cohort_result_ok;
  cohort::SimulationStatus status{};
  std::vector<std::string> entities{};
  std::string name{};
  std::vector<std::byte> bytes{};
  std::vector<CohortRunEvent> events{};
};

namespace cohort {
namespace {

CohortResult result_in_c(ControlResult result) {
  switch (result) {
    case ControlResult::feature_unsupported: return cohort_result_feature_unsupported;
    case ControlResult::not_found: return cohort_result_not_found;
    case ControlResult::incorrect_state: return cohort_result_incorrect_state;
    case ControlResult::name_not_unique: return cohort_result_name_not_unique;
    case ControlResult::name_invalid: return cohort_result_name_invalid;
    case ControlResult::no_resource: return cohort_result_no_resource;
    case ControlResult::invalid_pose: return cohort_result_invalid_pose;
    case ControlResult::malformed: return cohort_result_malformed;
    case ControlResult::not_permitted: return cohort_result_not_permitted;
    case ControlResult::forgotten: return cohort_result_forgotten;
    case ControlResult::no_answer: return cohort_result_no_answer;
    case ControlResult::server_gone: return cohort_result_server_gone;
    case ControlResult::interrupted: return cohort_result_interrupted;
    case ControlResult::bad_reply: return cohort_result_bad_reply;
    case ControlResult::too_many_requests: return cohort_result_too_many_requests;
    case ControlResult::cancelled: return cohort_result_cancelled;
    case ControlResult::not_paused: return cohort_result_not_paused;
    case ControlResult::time_not_held: return cohort_result_time_not_held;
    case ControlResult::link_not_found: return cohort_result_link_not_found;
    case ControlResult::light_not_found: return cohort_result_light_not_found;
    case ControlResult::immovable: return cohort_result_immovable;
    case ControlResult::quarantined: return cohort_result_quarantined;
    case ControlResult::unknown_model: return cohort_result_unknown_model;
    case ControlResult::invalid_model: return cohort_result_invalid_model;
    case ControlResult::missing_file: return cohort_result_missing_file;
    case ControlResult::unsupported_model: return cohort_result_unsupported_model;
    case ControlResult::invalid_team: return cohort_result_invalid_team;
    case ControlResult::too_many_objects: return cohort_result_too_many_objects;
    case ControlResult::too_large: return cohort_result_too_large;
    case ControlResult::invalid_snapshot: return cohort_result_invalid_snapshot;
    case ControlResult::not_saved: return cohort_result_not_saved;
    case ControlResult::already_recording: return cohort_result_already_recording;
    case ControlResult::too_many_recordings: return cohort_result_too_many_recordings;
    case ControlResult::invalid_selection: return cohort_result_invalid_selection;
    case ControlResult::operation_failed:
    case ControlResult::no_attachment: break;
  }
  return cohort_result_failed;
}

// Calls `ask` with the handle. Returns 0, or -1 with the last error.
template <class Ask>
int attempt(CohortControl* handle, const Ask& ask) {
  handle->result = cohort_result_ok;
  try {
    ask(*handle);
    return 0;
  } catch (const ControlError& error) {
    handle->result = result_in_c(error.result);
    last_error() = error.what();
  } catch (const std::exception& error) {
    handle->result = cohort_result_failed;
    last_error() = error.what();
  }
  return -1;
}

std::string text_or_none(const char* text) { return text == nullptr ? std::string() : text; }

Vector3 vector_from_c(const double* numbers) {
  return numbers == nullptr ? Vector3{} : Vector3{numbers[0], numbers[1], numbers[2]};
}

WorldPose pose_from_c(const CohortPose* pose) {
  if (pose == nullptr) return {};
  const double* const q = pose->orientation;
  return {vector_from_c(pose->position), {q[0], q[1], q[2], q[3]}};
}

Twist twist_from_c(const CohortTwist& twist) { return {vector_from_c(twist.linear), vector_from_c(twist.angular)}; }

const char* spawn_in_c(CohortControl* handle, const Spawn& what) {
  const int result = attempt(handle, [&](CohortControl& it) { it.name = it.control.spawn(what); });
  return result == 0 ? handle->name.c_str() : nullptr;
}

}  // namespace
}  // namespace cohort

using cohort::attempt;

CohortControl* cohort_control_connect(const CohortOptions* options) {
  return cohort::make_handle<CohortControl, cohort::ControlOptions>(options, "client");
}
void cohort_control_close(CohortControl* control) { delete control; }
void cohort_control_set_time_limit(CohortControl* control, int64_t milliseconds) {
  if (milliseconds < 0)
    control->control.set_time_limit(std::nullopt);
  else
    control->control.set_time_limit(std::chrono::milliseconds(milliseconds));
}
void cohort_control_cancel(CohortControl* control) { control->cancelled = true; }
CohortResult cohort_control_result(const CohortControl* control) { return control->result; }

CohortSimulationState cohort_control_state(const CohortControl* control) {
  return static_cast<CohortSimulationState>(control->control.last_reply().state);
}
uint32_t cohort_control_run(const CohortControl* control) { return control->control.last_reply().run; }
uint64_t cohort_control_tick(const CohortControl* control) { return control->control.last_reply().tick; }
int64_t cohort_control_time_ns(const CohortControl* control) { return control->control.last_reply().time.count(); }
const char* cohort_control_message(const CohortControl* control) {
  return control->control.last_reply().message.c_str();
}

int cohort_control_ask_state(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.state(); });
}
int cohort_control_play(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.play(); });
}
int cohort_control_pause(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.pause(); });
}
int cohort_control_stop(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.stop(); });
}
int cohort_control_quit(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.quit(); });
}
int cohort_control_step(CohortControl* control, uint64_t steps) {
  return attempt(control, [&](CohortControl& it) { it.control.step(steps); });
}
int cohort_control_reset(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.reset(); });
}
int cohort_control_reset_seed(CohortControl* control, uint64_t seed) {
  return attempt(control, [&](CohortControl& it) { it.control.reset(seed); });
}
int cohort_control_back(CohortControl* control, int64_t time_ns) {
  return attempt(control, [&](CohortControl& it) { it.control.back(std::chrono::nanoseconds(time_ns)); });
}
int cohort_control_set_speed(CohortControl* control, double speed) {
  return attempt(control, [&](CohortControl& it) { it.control.set_speed(speed); });
}

int cohort_control_ask_status(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.status = it.control.status(); });
}
const char* cohort_control_experiment(const CohortControl* control) { return control->status.experiment.c_str(); }
uint64_t cohort_control_seed(const CohortControl* control) { return control->status.seed; }
uint64_t cohort_control_state_hash(const CohortControl* control) { return control->status.state_hash; }
bool cohort_control_started(const CohortControl* control) { return control->status.started; }
int64_t cohort_control_step_ns(const CohortControl* control) { return control->status.step.count(); }
int64_t cohort_control_duration_ns(const CohortControl* control) { return control->status.duration.count(); }
double cohort_control_speed(const CohortControl* control) { return control->status.speed; }
double cohort_control_real_time_factor(const CohortControl* control) { return control->status.real_time_factor; }
uint32_t cohort_control_robots(const CohortControl* control) { return control->status.robots; }
uint32_t cohort_control_awaited(const CohortControl* control) { return control->status.awaited_count; }
size_t cohort_control_controllers(const CohortControl* control) { return control->status.controllers.size(); }
const char* cohort_control_controller(const CohortControl* control, size_t index) {
  const auto* const controller = cohort::at(control->status.controllers, index);
  return controller == nullptr ? nullptr : controller->label.c_str();
}

int cohort_control_has_feature(CohortControl* control, uint32_t feature) {
  int has = 0;
  const int result = attempt(control, [&](CohortControl& it) {
    const std::vector<std::uint32_t> features = it.control.features().features;
    has = std::ranges::find(features, feature) != features.end() ? 1 : 0;
  });
  return result == 0 ? has : -1;
}

int64_t cohort_control_ask_entities(CohortControl* control, const char* filter) {
  const int result =
      attempt(control, [&](CohortControl& it) { it.entities = it.control.entities(cohort::text_or_none(filter)); });
  return result == 0 ? static_cast<int64_t>(control->entities.size()) : -1;
}
const char* cohort_control_entity(const CohortControl* control, size_t index) {
  const std::string* const entity = cohort::at(control->entities, index);
  return entity == nullptr ? nullptr : entity->c_str();
}

int cohort_control_entity_state(CohortControl* control, const char* entity, CohortEntityState* state) {
  return attempt(control, [&](CohortControl& it) {
    const auto [name, pose, twist] = it.control.entity_state(entity);
    const auto& [linear, angular] = twist;
    *state = {cohort::pose_in_c(pose), {{linear.x, linear.y, linear.z}, {angular.x, angular.y, angular.z}}};
  });
}
int cohort_control_set_entity_state(CohortControl* control, const char* entity, const CohortPose* pose,
                                    const CohortTwist* twist) {
  return attempt(control, [&](CohortControl& it) {
    if (pose != nullptr && twist != nullptr)
      it.control.set_entity_state({entity, cohort::pose_from_c(pose), cohort::twist_from_c(*twist)});
    else if (twist != nullptr)
      it.control.set_twist(entity, cohort::twist_from_c(*twist));
    else if (pose != nullptr)
      it.control.set_pose(entity, cohort::pose_from_c(pose));
    else
      throw cohort::ControlError("expected a pose, a twist or both", cohort::ControlResult::malformed);
  });
}

const char* cohort_control_spawn(CohortControl* control, const char* name, const char* model, const CohortPose* pose,
                                 const char* team, bool allow_renaming) {
  return cohort::spawn_in_c(control, {.name = name,
                                      .allow_renaming = allow_renaming,
                                      .model = model,
                                      .pose = cohort::pose_from_c(pose),
                                      .team = cohort::text_or_none(team)});
}
const char* cohort_control_spawn_text(CohortControl* control, const char* name, const char* text,
                                      const CohortPose* pose, const char* team, bool allow_renaming) {
  return cohort::spawn_in_c(control, {.name = name,
                                      .allow_renaming = allow_renaming,
                                      .text = text,
                                      .pose = cohort::pose_from_c(pose),
                                      .team = cohort::text_or_none(team)});
}
int cohort_control_remove(CohortControl* control, const char* entity) {
  return attempt(control, [&](CohortControl& it) { it.control.remove(entity); });
}
int cohort_control_set_light(CohortControl* control, const char* light, bool on, const double* intensity,
                             const double color[3]) {
  return attempt(control, [&](CohortControl& it) {
    cohort::LightSetting setting{.on = on};
    if (intensity != nullptr) setting.intensity = *intensity;
    if (color != nullptr) setting.color = cohort::Color{color[0], color[1], color[2]};
    it.control.set_light(light, setting);
  });
}
int cohort_control_apply_force(CohortControl* control, const char* entity, const char* link, const double force[3],
                               const double torque[3], int64_t duration_ns) {
  return attempt(control, [&](CohortControl& it) {
    it.control.apply_force(entity, {cohort::vector_from_c(force), cohort::vector_from_c(torque),
                                    std::chrono::nanoseconds(duration_ns), cohort::text_or_none(link)});
  });
}

int cohort_control_save(CohortControl* control, const void** bytes, size_t* size) {
  return attempt(control, [&](CohortControl& it) {
    it.bytes = it.control.save_snapshot();
    *bytes = it.bytes.data();
    *size = it.bytes.size();
  });
}
int cohort_control_load(CohortControl* control, const void* bytes, size_t size) {
  return attempt(control, [&](CohortControl& it) {
    it.control.load_snapshot({static_cast<const std::byte*>(bytes), size});
  });
}

int cohort_control_start_recording(CohortControl* control, const char* recorded) {
  return attempt(control, [&](CohortControl& it) { it.control.start_recording(cohort::text_or_none(recorded)); });
}
int cohort_control_stop_recording(CohortControl* control) {
  return attempt(control, [](CohortControl& it) { it.control.stop_recording(); });
}
int cohort_control_fetch_recording(CohortControl* control, uint64_t offset, const void** bytes, size_t* size) {
  bool is_last = false;
  const int result = attempt(control, [&](CohortControl& it) {
    cohort::RecordingPart part = it.control.fetch_recording(offset);
    is_last = part.is_last;
    it.bytes = std::move(part.bytes);
    *bytes = it.bytes.data();
    *size = it.bytes.size();
  });
  return result != 0 ? -1 : is_last ? 0 : 1;
}
int cohort_control_save_recording(CohortControl* control, const char* file) {
  return attempt(control, [&](CohortControl& it) {
    if (const std::string problem = it.control.save_recording(file); !problem.empty())
      throw cohort::ControlError(problem);
  });
}

int64_t cohort_control_ask_history(CohortControl* control, uint64_t* revision) {
  const int result = attempt(control, [&](CohortControl& it) {
    cohort::RunHistory history = it.control.history(*revision);
    *revision = history.revision;
    it.events.clear();
    for (cohort::RunEvent& event : history.events) it.events.push_back({std::move(event)});
  });
  return result == 0 ? static_cast<int64_t>(control->events.size()) : -1;
}
const CohortRunEvent* cohort_control_event(const CohortControl* control, size_t index) {
  return cohort::at(control->events, index);
}

uint64_t cohort_run_event_tick(const CohortRunEvent* event) { return event->event.tick; }
uint64_t cohort_run_event_last_tick(const CohortRunEvent* event) { return event->event.last_tick; }
uint64_t cohort_run_event_count(const CohortRunEvent* event) { return event->event.count; }
const char* cohort_run_event_kind(const CohortRunEvent* event) { return event->event.kind.c_str(); }
const char* cohort_run_event_text(const CohortRunEvent* event) { return event->event.text.c_str(); }
