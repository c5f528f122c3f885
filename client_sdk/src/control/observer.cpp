// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/include/cohort/observer.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "client_sdk/src/control/control_client.hpp"
#include "client_sdk/src/control/control_values.hpp"
#include "client_sdk/src/control/run_history_query.hpp"
#include "client_sdk/src/event_descriptor.hpp"
#include "idl/messages/scene_messages.hpp"
#include "idl/text/printable.hpp"

namespace cohort {
namespace {

using std::chrono::milliseconds;

constexpr const char* view_partition = "view";
constexpr std::size_t numbers_of_a_pose = 7;
constexpr milliseconds asks_for_robots_for{1'000};
constexpr milliseconds until_readers_are_missed{500};

// Returns the options. Throws ControlError if they do not allow to observe.
ControlOptions checked(const ObserverOptions& options) {
  try {
    if (!options.secure.empty() && wire::read_identity(options.secure).role != wire::Role::observer)
      throw wire::WireError("the identity in " + options.secure +
                            " is not an observer's. Use the identity 'observer' from 'cohort security init'");
  } catch (const wire::WireError& error) {
    throw ControlError(error.what(), ControlResult::no_attachment);
  }
  return {options.server, options.domain, options.secure, options.label, {}};
}

bool is_whole(const wire::WorldState& state) { return state.poses.size() == numbers_of_a_pose * state.robots.size(); }

WorldState from_wire(const wire::WorldState& state) {
  WorldState copy{state.run, state.tick, std::chrono::nanoseconds(state.time_ns), state.state_hash, {}};
  copy.robots.reserve(state.robots.size());
  for (std::size_t i = 0; i < state.robots.size(); ++i) {
    const auto p = state.poses.subspan(i * numbers_of_a_pose, numbers_of_a_pose);
    copy.robots.push_back({state.robots[i], {{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}}});
  }
  return copy;
}

std::vector<ObservedRobot> robots_of(const messages::Scene& scene) {
  std::vector<ObservedRobot> robots;
  for (const messages::SceneEntity& entity : scene.entities) {
    if (entity.robot == messages::none) continue;
    const bool has_model = entity.model < scene.models.size();
    robots.push_back({entity.robot, printable(entity.name), has_model ? printable(scene.models[entity.model].name) : "",
                      printable(entity.team)});
  }
  std::ranges::sort(robots, {}, &ObservedRobot::robot);
  return robots;
}

}  // namespace

struct Observer::State {
  explicit State(const ObserverOptions& options)
      : client(attach(checked(options))),
        states(client.participant(),
               {[this](const wire::WorldState& state, const wire::Sender&) { receive(state); },
                [this](const wire::Sender& sender, bool alive) { note_server(sender.writer, alive); }},
               view_partition),
        scenes(client.participant(),
               {[this](const wire::SceneDescription& scene, const wire::Sender&) { receive(scene); }, {}},
               view_partition) {}

  // Called on DDS threads.

  void receive(const wire::WorldState& state) {
    if (!is_whole(state)) return;
    WorldState copy = from_wire(state);
    const std::lock_guard lock(mutex);
    end.reset();
    if (waiting.size() == most_waiting) waiting.pop_front();
    waiting.push_back(copy);
    newest = std::move(copy);
    notify();
  }

  void receive(const wire::SceneDescription& description) {
    try {
      const auto scene = messages::decode<messages::Scene>(std::as_bytes(description.scene));
      std::vector<ObservedRobot> robots = robots_of(scene);
      const std::lock_guard lock(mutex);
      if (scene.end.empty()) {
        described = {scene.revision, std::move(robots)};
      } else {
        end = ObserverEnded{ObserverEnd::run_ended, printable(scene.end), printable(scene.end_text)};
      }
      notify();
    } catch (const messages::CdrError&) {  // from a server of another version: names are missing
    }
  }

  void receive(const wire::SceneUpdate& update) {
    const std::lock_guard lock(mutex);
    revision = update.revision;
    notify();
  }

  void note_server(std::uint64_t writer, bool alive) {
    const std::lock_guard lock(mutex);
    if (alive)
      servers.insert(writer);
    else
      servers.erase(writer);
    had_server = had_server || alive;
    notify();
  }

  // Called with the lock held.

  void notify() {
    descriptor.set_readable(!waiting.empty() || is_over());
    changed.notify_all();
  }
  bool is_over() const { return end.has_value() || (had_server && servers.empty()); }

  // The server describes its scene when a new reader of updates appears. It counts these readers from time to time, so
  // while the run is paused it may not notice one that replaces another.
  std::optional<std::vector<ObservedRobot>> ask_for_robots(milliseconds at_most) {
    {
      const std::lock_guard lock(mutex);
      revision.reset();
    }
    const wire::Reader<wire::SceneUpdate> updates(
        client.participant(), {[this](const wire::SceneUpdate& update, const wire::Sender&) { receive(update); }, {}},
        view_partition);
    std::unique_lock lock(mutex);  // destroyed before the reader, which waits for its callback
    const auto is_described = [&] { return revision && described && described->revision == *revision; };
    changed.wait_for(lock, at_most, [&] { return is_described() || is_over(); });
    if (!is_described()) return std::nullopt;
    return described->robots;
  }

  struct Described {
    std::uint32_t revision = 0;
    std::vector<ObservedRobot> robots;
  };

  EventDescriptor descriptor;
  mutable std::mutex mutex;  // guards the following members up to the client
  std::condition_variable changed;
  std::deque<WorldState> waiting;
  std::optional<WorldState> newest;
  std::optional<ObserverEnded> end;  // as reported by the server
  std::set<std::uint64_t> servers;   // live writers of world states
  bool had_server = false;
  std::optional<Described> described;
  std::optional<std::uint32_t> revision;  // that of the last update, during a request for robots

  const std::atomic<bool> never{false};
  RunHistory known;  // revision and run of the last result
  ControlClient client;
  wire::Reader<wire::WorldState> states;
  wire::Reader<wire::SceneDescription> scenes;
};

Observer::Observer(const ObserverOptions& options) : state_(std::make_unique<State>(options)) {}
Observer::~Observer() = default;

std::optional<WorldState> Observer::next(milliseconds at_most) {
  State& state = *state_;
  std::unique_lock lock(state.mutex);
  state.changed.wait_for(lock, at_most, [&] { return !state.waiting.empty() || state.is_over(); });
  if (state.waiting.empty()) return std::nullopt;
  WorldState oldest = std::move(state.waiting.front());
  state.waiting.pop_front();
  state.descriptor.set_readable(!state.waiting.empty() || state.is_over());
  return oldest;
}

std::optional<WorldState> Observer::latest() const {
  const std::lock_guard lock(state_->mutex);
  return state_->newest;
}

int Observer::descriptor() const { return state_->descriptor.get(); }

std::optional<ObserverEnded> Observer::ended() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->end) return state_->end;
  if (!state_->is_over()) return std::nullopt;
  return ObserverEnded{ObserverEnd::server_gone, "", "the server is gone"};
}

std::optional<std::vector<ObservedRobot>> Observer::robots(milliseconds at_most) {
  const auto until = std::chrono::steady_clock::now() + at_most;
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(until - std::chrono::steady_clock::now());
    if (auto robots = state_->ask_for_robots(std::min(left, asks_for_robots_for))) return robots;
    const auto again_at = std::chrono::steady_clock::now() + until_readers_are_missed;
    if (again_at >= until || ended()) return std::nullopt;
    std::this_thread::sleep_until(again_at);
  }
}

std::optional<RunHistory> Observer::events(milliseconds at_most) {
  State& state = *state_;
  struct NoReply {};
  const auto ask = [&](const wire::GetHistory& question) {
    auto reply = state.client.ask(question, at_most, state.never);
    if (!reply) throw NoReply{};
    if (!reply->is_done())
      throw ControlError(reply->error_message, from_wire(reply->result, wire::OperationCode::get_history));
    return std::move(*reply);
  };
  try {
    RunHistory history = query_history(state.known.revision, ask);
    if (history.run != state.known.run && state.known.revision != 0) history = query_history(0, ask);
    state.known = history;
    return history;
  } catch (const NoReply&) {
    return std::nullopt;
  }
}

}  // namespace cohort
