// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/live_source.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/viewing/check_scene.hpp"
#include "tools/view/sources/control_requests.hpp"

namespace cohort::view {
namespace {

using namespace std::chrono_literals;
using wire::ResultCode;
using wire::SimulationState;

constexpr auto for_a_server = 1s;
constexpr auto for_a_reply = 5s;
constexpr auto status_interval = 250ms;
constexpr auto newcomer_interval = 100ms;
constexpr std::size_t most_requests = 64;
constexpr const char* no_server = "no server responds to control requests";

recording::Bytes copied(std::span<const std::uint8_t> bytes) {
  const auto view = std::as_bytes(bytes);
  return {view.begin(), view.end()};
}

std::optional<wire::Identity> identity_in(const std::string& folder) {
  return folder.empty() ? std::nullopt : std::optional(wire::read_identity(folder));
}

std::chrono::nanoseconds time_of(double seconds) {
  constexpr double longest_run = 9e9;  // [s]; beyond, nanoseconds are no 64 bits
  if (!(std::abs(seconds) <= longest_run)) throw std::invalid_argument("expected a time in seconds, 0 or more");
  return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

// Where the time bar ends: at `now` if the run has no end.
std::int64_t end_of(const wire::SimulationStatus& run, std::int64_t now) {
  return run.duration_ns >= parsing::without_end.count() ? now : run.duration_ns;
}

const Answer no_answer{false, "the server has not answered within 5 s; it may still carry out the request"};

}  // namespace

LiveSource::LiveSource(const LiveOptions& options, Topics& topics)
    : options_(options),
      topics_(topics),
      publisher_(topics),
      drivers_({options.server, options.domain, options.secure_drive}),
      participant_(wire::Participant::client(options.domain, options.server, identity_in(options.secure))),
      descriptions_(participant_,
                    {[this](const wire::SceneDescription& each, const wire::Sender&) { on_scene(each); }, {}}, "view"),
      updates_(participant_, {[this](const wire::SceneUpdate& each, const wire::Sender&) { on_update(each); }, {}},
               "view"),
      histories_([this](const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) {
        return seen_.read(request, is_cancelled);
      }) {
  show_status(status_without_run());
  shower_ = std::thread([this] { show_what_arrives(); });
  steward_ = std::thread([this] { serve_requests(); });
}

LiveSource::~LiveSource() {
  {
    const std::scoped_lock lock(mutex_, requests_mutex_);
    is_stopping_ = true;
  }
  arrived_changed_.notify_all();
  requests_changed_.notify_all();
  shower_.join();
  steward_.join();
}

void LiveSource::on_scene(const wire::SceneDescription& description) {
  const std::lock_guard lock(mutex_);
  arrived_.scene = copied(description.scene);
  arrived_changed_.notify_all();
}

void LiveSource::on_update(const wire::SceneUpdate& update) {
  const std::lock_guard lock(mutex_);
  arrived_.frame = copied(update.frame);
  arrived_.signals = copied(update.signals);
  arrived_.contacts = copied(update.contacts);
  arrived_.robots = copied(update.robots);
  arrived_.has_update = true;
  arrived_changed_.notify_all();
}

void LiveSource::show_what_arrives() {
  while (!is_stopping_) {
    Arrived arrived;
    {
      std::unique_lock lock(mutex_);
      arrived_changed_.wait_for(lock, newcomer_interval, [&] {
        return is_stopping_ || arrived_.scene || arrived_.has_update || arrived_.has_other_watched;
      });
      arrived = std::exchange(arrived_, {});
    }
    try {
      show(arrived);
    } catch (const messages::CdrError& error) {
      ViewStatus status = status_without_run();
      status.note =
          std::string("the server's data cannot be read; the server may have another version: ") + error.what();
      show_status(status);
    }
  }
}

void LiveSource::show(Arrived& arrived) {
  if (arrived.scene) {
    auto scene = messages::decode<messages::Scene>(*arrived.scene);
    if (!scene.end.empty()) {
      arrived.scene.reset();
      show(arrived);  // the last picture may have come with it
      return end({std::move(scene.end), std::move(scene.end_text)});
    }
    links_ = viewing::check_scene(scene);
    revision_ = scene.revision;
    seen_.set_scene(scene);
    publisher_.show_as_it_is(std::move(scene), time_);
    begin();
  }
  if (!arrived.has_update) {
    if (arrived.has_other_watched || arrivals_ != topics_.arrivals()) show_extras();
    return;
  }
  const auto frame = messages::decode<messages::SceneFrame>(arrived.frame);
  if (frame.revision == revision_) viewing::check_frame(frame, links_);
  {
    const std::lock_guard lock(mutex_);
    time_ = std::chrono::nanoseconds(frame.time_ns);
  }
  publisher_.show(frame, time_);
  publisher_.show(messages::decode<messages::SceneSignals>(arrived.signals), time_);
  contacts_ = std::move(arrived.contacts);
  robots_ = std::move(arrived.robots);
  seen_.add(time_, robots_);
  show_extras();
}

void LiveSource::begin() {
  const std::lock_guard lock(mutex_);
  end_.reset();
  has_ended_ = false;
}

// The last picture remains.
void LiveSource::end(End how) {
  {
    const std::lock_guard lock(mutex_);
    end_ = std::move(how);
  }
  show_status(status_without_run());
  has_ended_ = true;
}

void LiveSource::show_extras() {
  arrivals_ = topics_.arrivals();
  if (!contacts_.empty() && publisher_.is_read(Topic::contacts)) topics_.publish(Topic::contacts, time_, contacts_);
  if (!robots_.empty() && publisher_.is_read(Topic::robots)) show_robots();
}

void LiveSource::show_robots() {
  auto robots = messages::decode<messages::SceneRobots>(robots_);
  const std::lock_guard lock(mutex_);
  std::erase_if(robots.robots, [&](const messages::SceneRobot& each) {
    return std::ranges::find(watched_, each.robot) == watched_.end();
  });
  publisher_.publish(Topic::robots, robots, time_);
}

void LiveSource::watch(const std::vector<std::uint32_t>& robots) {
  const std::lock_guard lock(mutex_);
  watched_ = robots;
  arrived_.has_other_watched = true;
  arrived_changed_.notify_all();
}

void LiveSource::ask(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  if (request.operation == "history") return histories_.ask(request, std::move(answer));
  if (!options_.may_control) return answer({false, "this view is read-only: start it with 'cohort view --control'"});
  if (request.operation == "drive") return drive(request, std::move(answer));
  if (request.operation == "release") return answer(drivers_.release(request));
  {
    const std::lock_guard lock(requests_mutex_);
    if (requests_.size() < most_requests) {
      requests_.push_back({request, std::move(answer)});
      requests_changed_.notify_all();
      return;
    }
  }
  answer({false, "too many requests are pending at the server"});
}

void LiveSource::drive(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  if (!options_.secure.empty() && options_.secure_drive.empty())
    return answer(
        {false, "driving this server requires an identity: start the view with 'cohort view --secure-drive DIR'"});
  if (!has_server_) return answer({false, no_server});
  drivers_.drive(request, std::move(answer));
}

void LiveSource::leave(std::uint64_t visitor) {
  histories_.leave(visitor);
  drivers_.leave(visitor);
}

// Asks for one thing after the other, and in between how the run is.
void LiveSource::serve_requests() {
  while (!is_stopping_) {
    try {
      ControlClient client({.server = options_.server,
                            .domain = options_.domain,
                            .secure = options_.secure_control.empty() ? options_.secure : options_.secure_control,
                            .label = "cohort view"});
      history_ = LiveHistory();
      while (!is_stopping_ && !client.server_is_gone()) {
        has_server_ = client.wait_for_server(for_a_server, is_stopping_);
        if (!has_server_) {
          answer_all(no_server);
          show_status(status_without_run());
          continue;
        }
        std::optional<ReceivedRequest> asked;
        {
          std::unique_lock lock(requests_mutex_);
          requests_changed_.wait_for(lock, status_interval, [&] { return is_stopping_ || !requests_.empty(); });
          if (!requests_.empty()) {
            asked = std::move(requests_.front());
            requests_.pop_front();
          }
        }
        if (asked) asked->answer(done(client, asked->request));
        if (!is_stopping_) ask_status(client);
        if (!is_stopping_) ask_history(client);
        if (!is_stopping_) play_if_seen(client);
      }
    } catch (const std::exception& error) {
      has_server_ = false;
      ViewStatus status = status_without_run();
      status.note = error.what();
      show_status(status);
      std::unique_lock lock(requests_mutex_);
      requests_changed_.wait_for(lock, for_a_server, [&] { return is_stopping_.load(); });
    }
  }
  answer_all("the view is closing");
}

Answer LiveSource::done(ControlClient& client, const ViewRequest& asked) {
  try {
    if (asked.operation == "seek") return gone_back(client, time_of(asked.number));
    if (asked.operation == "step" && asked.number < 0.0 && history_.can_go_back())
      return gone_back(client,
                       run_time_ + time_of(std::trunc(asked.number) * 1e-9 * static_cast<double>(run_.step_ns)));
    const auto reply = client.ask(operation_of(asked), for_a_reply, is_stopping_);
    return reply ? Answer{reply->is_done(), reply->error_message} : no_answer;
  } catch (const std::invalid_argument& error) {
    return {false, error.what()};
  }
}

Answer LiveSource::gone_back(ControlClient& client, std::chrono::nanoseconds time) {
  if (time > run_time_) throw std::invalid_argument("the run has not reached that time yet");
  const auto reply = client.ask(wire::GoBack{time.count()}, for_a_reply, is_stopping_);
  if (!reply) return no_answer;
  if (reply->result != ResultCode::ok || reply->state != SimulationState::paused || run_.step_ns <= 0)
    return {reply->result == ResultCode::ok, reply->error_message};
  const auto steps =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.count() - reply->time_ns) / run_.step_ns);
  if (steps == 0) return {true, reply->error_message};
  const auto arrived = client.ask(wire::StepSimulation{steps}, for_a_reply, is_stopping_);
  return arrived ? Answer{arrived->result == ResultCode::ok, arrived->error_message} : no_answer;
}

void LiveSource::ask_history(ControlClient& client) {
  const auto reply = client.ask(history_.question(), for_a_reply, is_stopping_);
  if (!reply || reply->result != ResultCode::ok) return;  // a server of before has none
  if (history_.take(*reply, std::chrono::nanoseconds(run_.step_ns)))
    topics_.publish(Topic::events, std::chrono::nanoseconds(reply->time_ns), messages::encode(history_.events()));
}

void LiveSource::answer_all(const std::string& text) {
  std::deque<ReceivedRequest> asked;
  {
    const std::lock_guard lock(requests_mutex_);
    asked.swap(requests_);
  }
  for (const ReceivedRequest& each : asked) each.answer({false, text});
}

void LiveSource::play_if_seen(ControlClient& client) {
  if (!options_.plays_when_seen || has_played_ || !(plays_unseen_ || publisher_.is_read(Topic::frame))) return;
  const auto reply = client.ask(operation_of({.operation = "play"}), for_a_reply, is_stopping_);
  has_played_ = reply && reply->is_done();
}

// There is none yet, or none any more.
ViewStatus LiveSource::status_without_run() {
  ViewStatus status;
  status.source = "server";
  status.name = options_.server + ", domain " + std::to_string(options_.domain);
  status.may_control = options_.may_control;
  status.phase = "waiting";
  const std::lock_guard lock(mutex_);
  if (had_run_) {
    status.name = run_.experiment;
    status.seed = std::to_string(run_.seed);
    status.time_ns = time_.count();
    status.end_ns = end_of(run_, time_.count());
    if (!has_server_) status.phase = "gone";
  }
  if (end_) {
    status.phase = "ended";
    status.end = end_->how;
    status.end_text = end_->why;
  }
  const bool is_over = status.phase != "waiting";
  has_ended_ = is_over;
  status.to_type = is_over ? options_.again : "cohort run EXPERIMENT --domain " + std::to_string(options_.domain);
  if (is_over) status.recording = options_.recording;
  status.can_run_again = is_over && options_.may_control && options_.run_again != nullptr;
  return status;
}

// Any controller does; this one everybody has.
std::string LiveSource::to_attach(const std::string& robot) const {
  std::string line = "cohort teleop --robots " + robot + " --domain " + std::to_string(options_.domain);
  if (options_.server != LiveOptions().server) line += " --server " + options_.server;
  return line;
}

void LiveSource::ask_status(ControlClient& client) {
  const auto reply = client.ask(wire::GetStatus{}, for_a_reply, is_stopping_);
  ViewStatus status = status_without_run();
  if (const auto* const returned = reply ? reply->get<wire::SimulationStatus>() : nullptr) {
    const wire::SimulationStatus& run = *returned;
    status.name = run.experiment;
    status.seed = std::to_string(run.seed);
    status.phase = run.started ? "running" : "gathering";
    status.is_playing = reply->state == SimulationState::playing;
    status.speed = run.speed;
    status.real_time_factor = run.real_time_factor;
    status.time_ns = reply->time_ns;
    status.end_ns = end_of(run, reply->time_ns);
    status.can_seek = options_.may_control && history_.can_go_back();
    status.loses_what_follows = true;
    status.seekable_from_ns = history_.first_kept().count();
    status.seekable_to_ns = reply->time_ns;
    constexpr auto noticeable = 500ms;
    if (!run.started || std::chrono::nanoseconds(run.waiting_ns) > noticeable) status.awaited = run.awaited;
    status.to_type = run.started || run.awaited.empty() ? "" : to_attach(run.awaited.front());
    run_time_ = std::chrono::nanoseconds(reply->time_ns);
    const std::lock_guard lock(mutex_);
    run_ = run;
    had_run_ = true;
  } else if (status.phase == "waiting") {
    status.note = reply ? "the server has no run" : "the server does not answer";
  }
  show_status(status);
}

void LiveSource::show_status(const ViewStatus& status) {
  topics_.publish(Topic::status, std::chrono::nanoseconds(status.time_ns), messages::encode(status));
}

}  // namespace cohort::view
