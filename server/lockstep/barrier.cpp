// SPDX-License-Identifier: Apache-2.0
#include "server/lockstep/barrier.hpp"

#include <algorithm>
#include <cassert>

namespace cohort::lockstep {

using description::OnLate;

void Barrier::add(const description::Policy& policy, std::size_t command_size, std::uint64_t tick) {
  Robot& robot = robots_.emplace_back();
  robot.policy = policy;
  robot.answers.resize(policy.delay + 1);
  for (Answer& answer : robot.answers) answer.values.resize(command_size);
  robot.first_tick = tick;
  robot.heard_at = opened_at_;
  if (is_fresh_) answer_of(robot, tick_).asked = is_asked(robot, tick_);
}

void Barrier::set_driven(std::uint32_t robot, bool driven) {
  Robot& r = robots_[robot];
  if (r.driven == driven) return;
  r.driven = driven;
  if (driven) {
    // Frames for the previous driver are forgotten.
    for (Answer& answer : r.answers) answer = {Answer::State::none, false, std::move(answer.values)};
    r.driven_since = is_fresh_ ? tick_ : tick_ + 1;
    r.answered.reset();
    r.silent = false;
    r.heard_at = opened_at_;
  } else {
    settle(r);
  }
}

void Barrier::open(std::uint64_t tick, Time now) {
  assert(tick >= tick_);
  if (is_fresh_)
    for (Robot& robot : robots_) robot.heard_at = now;
  is_fresh_ = false;
  tick_ = tick;
  opened_at_ = now;
  awaited_count_ = 0;
  for (Robot& robot : robots_) {
    Answer& answer = answer_of(robot, tick);  // to the frame that is sent now
    answer.state = Answer::State::none;
    answer.asked = robot.present && robot.driven && is_asked(robot, tick);
    const auto frame = acting_frame(robot);
    robot.awaited = frame && answer_of(robot, *frame).state == Answer::State::none;
    if (robot.awaited) ++awaited_count_;
  }
}

bool Barrier::is_due(std::uint32_t robot, std::uint64_t tick) const {
  const Robot& r = robots_[robot];
  if (r.detached || !r.driven) return false;
  return is_under_way(r, tick) ? answer_of(r, tick).asked : is_asked(r, tick);
}

Barrier::Asked Barrier::was_asked(std::uint32_t robot, std::uint64_t frame_tick) const {
  const Robot& r = robots_[robot];
  if (!is_asked(r, frame_tick)) return Asked::no;
  if (r.detached || !r.driven || frame_tick < r.driven_since || !is_under_way(r, frame_tick)) return Asked::unknown;
  return answer_of(r, frame_tick).asked ? Asked::yes : Asked::no;
}

std::optional<std::uint64_t> Barrier::acting_frame(const Robot& robot) const {
  if (tick_ < robot.policy.delay || is_free(robot)) return std::nullopt;
  const std::uint64_t frame = tick_ - robot.policy.delay;
  if (!is_due(static_cast<std::uint32_t>(&robot - robots_.data()), frame)) return std::nullopt;
  return frame;
}

Barrier::Verdict Barrier::judge(std::uint32_t robot, std::uint64_t frame_tick) const {
  const Robot& r = robots_[robot];
  if (frame_tick > tick_) return Verdict::early;
  if (!r.driven || frame_tick < r.driven_since) return Verdict::stale;
  if (is_free(r)) {
    if (r.detached || (r.answered && frame_tick < *r.answered)) return Verdict::stale;
    if (r.answered == frame_tick) return Verdict::repeated;
    return is_due(robot, frame_tick) ? Verdict::accepted : Verdict::early;
  }
  if (frame_tick + r.policy.delay < tick_ || r.detached) return Verdict::stale;
  if (!is_due(robot, frame_tick)) return Verdict::early;
  switch (answer_of(r, frame_tick).state) {
    case Answer::State::none: return Verdict::accepted;
    case Answer::State::missed: return Verdict::stale;
    default: return Verdict::repeated;
  }
}

void Barrier::answer(std::uint32_t robot, std::uint64_t frame_tick, std::span<const double> values, Time now) {
  assert(judge(robot, frame_tick) == Verdict::accepted);
  assert(values.size() == robots_[robot].answers.front().values.size());
  if (Robot& r = robots_[robot]; is_free(r)) {
    std::ranges::copy(values, r.answers.front().values.begin());
    r.answered = frame_tick;
    r.heard_at = now;
    r.silent = false;
    return;
  }
  Answer& slot = answer_of(robots_[robot], frame_tick);
  slot.state = Answer::State::given;
  std::ranges::copy(values, slot.values.begin());
  if (acting_frame(robots_[robot]) == frame_tick) settle(robots_[robot]);
}

void Barrier::refuse(std::uint32_t robot, std::uint64_t frame_tick, Time now) {
  Robot& r = robots_[robot];
  if (!is_free(r) || !r.silent) refused_.push_back({robot, frame_tick, r.policy.on_late, now - opened_at_, true});
  if (is_free(r))
    r.silent = true;
  else
    answer_of(r, frame_tick).state = Answer::State::refused;
  if (acting_frame(r) == frame_tick) settle(r);
  if (r.policy.on_late == OnLate::detach) {
    settle(r);
    r.detached = true;
  }
}

void Barrier::settle(Robot& robot) {
  if (!robot.awaited) return;
  assert(awaited_count_ > 0);
  robot.awaited = false;
  --awaited_count_;
}

std::vector<std::uint32_t> Barrier::awaited() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t robot = 0; robot < robots_.size(); ++robot)
    if (robots_[robot].awaited) result.push_back(robot);
  assert(result.size() == awaited_count_);
  return result;
}

std::vector<std::uint64_t> Barrier::unanswered(std::uint32_t robot) const {
  std::vector<std::uint64_t> frames;
  const std::uint64_t delay = robots_[robot].policy.delay;
  for (std::uint64_t frame = tick_ > delay ? tick_ - delay : 0; frame <= tick_; ++frame)
    if (is_due(robot, frame) && answer_of(robots_[robot], frame).state == Answer::State::none) frames.push_back(frame);
  return frames;
}

std::optional<Time> Barrier::next_deadline() const {
  std::optional<Time> next;
  for (const Robot& robot : robots_) {
    if (!robot.awaited || robot.policy.on_late == OnLate::wait) continue;
    const Time deadline = opened_at_ + robot.policy.deadline;
    if (!next || deadline < *next) next = deadline;
  }
  return next;
}

bool Barrier::is_too_late(const Robot& robot, Time now) const {
  return robot.awaited && robot.policy.on_late != OnLate::wait && now >= opened_at_ + robot.policy.deadline;
}

bool Barrier::is_too_silent(const Robot& robot, Time now) {
  const bool is_told = robot.silent || robot.detached || !robot.driven || !robot.present;
  return !is_told && robot.policy.deadline.count() != 0 && now >= robot.heard_at + robot.policy.deadline;
}

std::vector<Barrier::Miss> Barrier::expire(Time now) {
  std::vector<Miss> misses;
  for (std::uint32_t id = 0; id < robots_.size(); ++id) {
    Robot& robot = robots_[id];
    if (is_free(robot) ? !is_too_silent(robot, now) : !is_too_late(robot, now)) continue;
    const std::uint64_t frame = acting_frame(robot).value_or(tick_);
    if (is_free(robot))
      robot.silent = true;
    else
      answer_of(robot, frame).state = Answer::State::missed;
    settle(robot);
    robot.detached = robot.policy.on_late == OnLate::detach;
    const Time since = is_free(robot) ? robot.heard_at : opened_at_;
    misses.push_back({id, frame, robot.policy.on_late, now - since, false});
  }
  return misses;
}

Barrier::Outcome Barrier::outcome(std::uint32_t robot) const {
  const Robot& r = robots_[robot];
  assert(!r.awaited);
  if (r.detached || !r.driven) return {Outcome::Kind::neutral, {}};
  if (is_free(r)) {
    if (r.silent && r.policy.on_late != OnLate::hold) return {Outcome::Kind::neutral, {}};
    if (!r.answered) return {};
    return {Outcome::Kind::command, r.answers.front().values};
  }
  const auto frame = acting_frame(r);
  if (!frame) return {};
  const Answer& answer = answer_of(r, *frame);
  if (answer.state == Answer::State::given) return {Outcome::Kind::command, answer.values};
  const bool hold = r.policy.on_late == OnLate::hold || r.policy.on_late == OnLate::wait;
  return {hold ? Outcome::Kind::keep : Outcome::Kind::neutral, {}};
}

void Barrier::save(SnapshotWriter& writer) const {
  writer.add(tick_);
  writer.add_count(robots_.size());
  for (const Robot& robot : robots_) {
    for (const bool flag : {robot.present, robot.driven, robot.detached, robot.silent, robot.answered.has_value()})
      writer.add(flag);
    writer.add(robot.first_tick);
    writer.add(robot.answered.value_or(0));
    writer.add_count(robot.answers.size());
    for (const Answer& answer : robot.answers) {
      writer.add(answer.state);
      writer.add(answer.asked);
      writer.add_count(answer.values.size());
      writer.add_all(answer.values.data(), answer.values.size());
    }
  }
}

void Barrier::restore(SnapshotReader& reader) {
  reader.read(tick_);
  reader.expect_count(robots_.size(), "robots at the barrier");
  awaited_count_ = 0;
  for (Robot& robot : robots_) {
    for (bool Robot::*const flag : {&Robot::present, &Robot::driven, &Robot::detached, &Robot::silent})
      reader.read(robot.*flag);
    robot.awaited = false;
    bool has_answered = false;
    reader.read(has_answered);
    reader.read(robot.first_tick);
    std::uint64_t answered = 0;
    reader.read(answered);
    robot.answered = has_answered ? std::optional(answered) : std::nullopt;
    reader.expect_count(robot.answers.size(), "pending answers");
    for (Answer& answer : robot.answers) {
      reader.read(answer.state);
      if (answer.state > Answer::State::refused) throw SnapshotError("snapshot: invalid answer state");
      reader.read(answer.asked);
      reader.expect_count(answer.values.size(), "values in an answer");
      reader.read_all(answer.values.data(), answer.values.size());
    }
  }
}

}  // namespace cohort::lockstep
