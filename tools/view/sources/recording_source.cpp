// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/recording_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr std::chrono::milliseconds frame_interval{33};
constexpr double greatest_speed = 1e6;
constexpr double longest_recording = 9e9;  // [s]; beyond, nanoseconds are no 64 bits

std::chrono::nanoseconds nanoseconds_of(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(Seconds(seconds));
}

}  // namespace

RecordingSource::RecordingSource(const recording::Recording& recording, Topics& topics, unsigned threads)
    : recording_(recording),
      replay_(recording, threads),
      publisher_(recording, replay_, topics),
      topics_(topics),
      end_(end_of(recording)),
      values_(recording),
      histories_([this](const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) {
        return values_.read(request, is_cancelled);
      }) {
  wanted_.is_playing = true;
  thread_ = std::thread([this] { run(); });
}

RecordingSource::~RecordingSource() {
  is_stopping_ = true;
  {
    const std::lock_guard lock(mutex_);
    ++requests_;
  }
  changed_.notify_all();
  thread_.join();
}

void RecordingSource::ask(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  if (request.operation == "history") return histories_.ask(request, std::move(answer));
  answer(take(request));
}

Answer RecordingSource::take(const ViewRequest& request) {
  const std::lock_guard lock(mutex_);
  const auto done = [&](std::string text) {
    ++requests_;
    changed_.notify_all();
    return Answer{true, std::move(text)};
  };
  if (request.operation == "play") {
    wanted_.is_playing = true;
    wanted_.plays_again = true;
    return done("playing");
  }
  if (request.operation == "pause") {
    wanted_.is_playing = false;
    ++interruptions_;
    return done("paused");
  }
  if (request.operation == "step") {
    constexpr double most_steps = 1e6;
    if (!(std::abs(request.number) <= most_steps)) return {false, "a step has at most a million ticks"};
    wanted_.is_playing = false;
    constexpr auto most_waiting = static_cast<std::int64_t>(most_steps);
    wanted_.steps =
        std::clamp(wanted_.steps + static_cast<std::int64_t>(std::trunc(request.number)), -most_waiting, most_waiting);
    return done("stepped");
  }
  if (request.operation == "speed") {
    if (!(request.number >= 0.0 && request.number <= greatest_speed))
      return {false, "expected a speed from 0 (as fast as possible) to a million"};
    wanted_.speed = request.number;
    return done(request.number > 0.0 ? fmt::format("at {:g} times real time", request.number) : "as fast as possible");
  }
  if (request.operation == "seek") {
    if (!(request.number >= 0.0 && request.number <= longest_recording))
      return {false, "expected a time in seconds, 0 or more"};
    wanted_.seek = nanoseconds_of(request.number);
    ++interruptions_;
    wanted_.steps = 0;
    return done(fmt::format("at {:.3f} s", request.number));
  }
  return {false, fmt::format("'{}': unknown operation; a recording offers play, pause, step, seek, "
                             "speed and history",
                             request.operation)};
}

void RecordingSource::watch(const std::vector<std::uint32_t>& robots) {
  const std::lock_guard lock(mutex_);
  wanted_.watched = robots;
  ++requests_;
  changed_.notify_all();
}

void RecordingSource::run() {
  go_to(Nanoseconds(0));
  if (std::string problem = publish_events(recording_, topics_); !problem.empty()) problem_ = std::move(problem);
  std::uint64_t arrivals = topics_.arrivals();
  while (!is_stopping_) {
    const Clock::time_point next = Clock::now() + frame_interval;
    Wanted wanted;
    {
      const std::lock_guard lock(mutex_);
      wanted = wanted_;
      wanted_.seek.reset();
      wanted_.steps = 0;
      requests_taken_ = requests_;
      interruptions_taken_ = interruptions_;
    }
    const bool has_requests = wanted.seek || wanted.plays_again || wanted.steps != 0 || wanted.watched != watched_;
    watched_ = wanted.watched;
    const bool is_moving = wanted.is_playing && !is_at_end_;
    act(wanted);
    if (has_requests || is_moving || arrivals != topics_.arrivals()) publisher_.show(log_time_, state_hash_, watched_);
    arrivals = topics_.arrivals();
    show_status(wanted);
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, next, [&] { return has_newer_request() && !is_moving; });
  }
}

void RecordingSource::act(const Wanted& wanted) {
  if (wanted.plays_again && is_at_end_) go_to(Nanoseconds(0));
  if (wanted.seek) {
    pace_.reset();
    go_to(*wanted.seek);
  }
  if (wanted.steps != 0) pace_.reset();
  if (wanted.steps < 0) step_back(-wanted.steps);
  for (std::int64_t i = 0; i < wanted.steps && !is_interrupted(); ++i)
    if (!advance()) break;
  if (wanted.is_playing && !is_at_end_)
    play(wanted);
  else
    pace_.reset();
}

// Where a replay can begin that is to come to a time.
RecordingSource::Nanoseconds RecordingSource::start_before(Nanoseconds log_time) const {
  Nanoseconds start = recording_.worlds().front().log_time;
  for (const auto& world : recording_.worlds())
    if (world.log_time <= log_time) start = std::max(start, world.log_time);
  for (const Nanoseconds snapshot : recording_.snapshots())
    if (snapshot <= log_time) start = std::max(start, snapshot);
  return start;
}

// In small steps, so that a newer request takes the place of this one.
void RecordingSource::go_to(Nanoseconds log_time) {
  const Nanoseconds target = std::min(log_time, end_);
  const Nanoseconds start = start_before(target);
  const bool is_ahead = publisher_.has_scene() && log_time_ <= target && start <= log_time_;
  try {
    if (!is_ahead) {
      problem_.clear();
      publisher_.forget_world();
      is_at_end_ = !replay_.seek(start);
      if (is_at_end_) return;
      publisher_.begin_world();
      log_time_ = replay_.recorded().log_time;
      step_ = replay_.experiment().world.step;
      state_hash_ = replay_.simulation().state_hash();
    }
    while (log_time_ < target && !is_interrupted())
      if (!advance()) return;
  } catch (const std::exception& error) {
    problem_ = error.what();
    is_at_end_ = true;
  }
}

// `step_` is zero where the world of a recording cannot be built: then it is tried again where it is.
void RecordingSource::step_back(std::int64_t ticks) { go_to(std::max(Nanoseconds(0), log_time_ - step_ * ticks)); }

void RecordingSource::play(const Wanted& wanted) {
  const Clock::time_point begin = Clock::now();
  if (!pace_ || pace_->speed != wanted.speed) {
    pace_ = {begin, log_time_, wanted.speed};
    measured_at_ = begin;
    real_time_factor_ = wanted.speed;
  }
  const Nanoseconds before = log_time_;
  const double elapsed = Seconds(begin - pace_->wall).count();
  const Nanoseconds target =
      wanted.speed > 0.0 ? pace_->time + nanoseconds_of(elapsed * wanted.speed) : Nanoseconds::max();
  while (log_time_ < target && Clock::now() - begin < frame_interval && !has_newer_request())
    if (!advance()) break;
  // Lost time is not caught up.
  if (wanted.speed > 0.0 && log_time_ < target) pace_ = {Clock::now(), log_time_, wanted.speed};
  constexpr double smoothing = 0.05;
  const double wall = Seconds(begin - std::exchange(measured_at_, begin)).count();
  if (wall > 0.0) real_time_factor_ += smoothing * (Seconds(log_time_ - before).count() / wall - real_time_factor_);
}

bool RecordingSource::advance() {
  if (is_at_end_) return false;
  try {
    is_at_end_ = !replay_.advance();
  } catch (const std::exception& error) {
    publisher_.forget_world();
    problem_ = error.what();
    is_at_end_ = true;
  }
  if (is_at_end_) return false;
  const recording::RecordedTick& recorded = replay_.recorded();
  if (recorded.begins) {
    publisher_.begin_world();
    step_ = replay_.experiment().world.step;
  }
  log_time_ = recorded.log_time;
  state_hash_ = recorded.state_hash.value_or(0);
  return true;
}

void RecordingSource::show_status(const Wanted& wanted) {
  ViewStatus status;
  status.source = "recording";
  status.name = recording_.file().filename().string();
  status.seed = std::to_string(recording_.worlds().front().begins.seed);
  status.may_control = true;
  status.can_seek = true;
  status.is_playing = wanted.is_playing && !is_at_end_;
  status.speed = wanted.speed;
  status.real_time_factor = status.is_playing ? real_time_factor_ : 0.0;
  status.time_ns = log_time_.count();
  status.begin_ns = recording_.worlds().front().log_time.count();
  status.end_ns = end_.count();
  status.seekable_from_ns = status.begin_ns;
  status.seekable_to_ns = status.end_ns;
  status.note = problem_.empty() ? recording_.damage() : problem_;
  topics_.publish(Topic::status, log_time_, messages::encode(status));
}

}  // namespace cohort::view
