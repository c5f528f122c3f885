// SPDX-License-Identifier: Apache-2.0
#include "server/run/exchange.hpp"

#include <algorithm>
#include <cassert>

namespace cohort::session {
namespace {

std::string reason_word(CommandFault::Reason reason) {
  switch (reason) {
    case CommandFault::Reason::wrong_size: return "wrong_size";
    case CommandFault::Reason::not_finite: return "not_finite";
    case CommandFault::Reason::out_of_range: return "out_of_range";
  }
  return "malformed";
}

}  // namespace

Exchange::Exchange(Simulation& simulation) : simulation_(simulation) { add_robots(0); }

void Exchange::add_newcomers() { add_robots(simulation_.tick()); }

void Exchange::add_robots(std::uint64_t first_tick) {
  for (auto robot = static_cast<std::uint32_t>(history_.size()); robot < simulation_.robot_count(); ++robot) {
    const description::Policy& policy = simulation_.policy(robot);
    const RobotKind& kind = simulation_.kinds()[simulation_.kind_of(robot)];
    barrier_.add(policy, kind.command_size, first_tick);
    history_.emplace_back(policy.delay == 0 ? 0 : kind.observation_size * (policy.delay + 1));
  }
}

void Exchange::open(lockstep::Time now) {
  const std::uint64_t tick = simulation_.tick();
  for (std::uint32_t robot = 0; robot < simulation_.robot_count(); ++robot)
    barrier_.set_present(robot, simulation_.is_present(robot));
  barrier_.open(tick, now);
  for (std::uint32_t robot = 0; robot < history_.size(); ++robot) {
    if (history_[robot].empty() || !barrier_.is_due(robot, tick)) continue;
    const auto values = kept(robot, tick);
    std::ranges::copy(simulation_.observation(robot),
                      history_[robot].begin() + (values.data() - history_[robot].data()));
  }
}

std::span<const double> Exchange::kept(std::uint32_t robot, std::uint64_t tick) const {
  if (history_[robot].empty()) return simulation_.observation(robot);
  assert(tick <= simulation_.tick() && simulation_.tick() - tick <= simulation_.policy(robot).delay);
  const std::size_t slots = simulation_.policy(robot).delay + 1;
  const std::size_t size = history_[robot].size() / slots;
  return {history_[robot].data() + size * (tick % slots), size};
}

void Exchange::fill_frame(Frame& frame, std::span<const std::uint32_t> robots, std::uint64_t tick) const {
  assert(std::ranges::is_sorted(robots));
  frame.robots.clear();
  frame.values = {};
  bool in_a_row = true;
  for (const std::uint32_t robot : robots) {
    if (!barrier_.is_due(robot, tick)) continue;
    const std::span<const double> values = kept(robot, tick);
    if (frame.robots.empty()) frame.values = values.first(0);
    in_a_row = in_a_row && frame.values.data() + frame.values.size() == values.data();
    if (in_a_row) frame.values = {frame.values.data(), frame.values.size() + values.size()};
    frame.robots.push_back(robot);
  }
  if (in_a_row) return;
  frame.gathered.clear();
  for (const std::uint32_t robot : frame.robots) {
    const std::span<const double> values = kept(robot, tick);
    frame.gathered.insert(frame.gathered.end(), values.begin(), values.end());
  }
  frame.values = frame.gathered;
}

// Returns true if an answer can have these robots: those of its frame, as far as that is known. Robots come and go, so
// the frames that robots had long ago are unknown; answers to them are stale, or come from free robots.
bool Exchange::are_of_frame(std::span<const std::uint32_t> robots, std::span<const std::uint32_t> held,
                            std::uint64_t frame_tick) const {
  using Asked = lockstep::Barrier::Asked;
  auto next = robots.begin();
  for (const std::uint32_t robot : held) {
    const bool is_answered = next != robots.end() && *next == robot;
    if (is_answered) ++next;
    if (barrier_.was_asked(robot, frame_tick) == (is_answered ? Asked::no : Asked::yes)) return false;
  }
  return next == robots.end() && !robots.empty();
}

Exchange::Taken Exchange::take(std::span<const std::uint32_t> held, std::uint64_t frame_tick,
                               std::span<const std::uint32_t> robots, std::span<const double> values,
                               lockstep::Time now) {
  Taken taken;
  const auto reject = [&](std::string reason, std::string text) {
    if (!taken.rejection) taken.rejection = Rejection{std::move(reason), std::move(text)};
  };
  const auto frame_text = [&] { return "the answer to tick " + std::to_string(frame_tick); };
  if (frame_tick > barrier_.tick()) {
    reject("early", frame_text() + " arrived at tick " + std::to_string(barrier_.tick()));
    return taken;
  }
  if (!are_of_frame(robots, held, frame_tick)) {
    reject("malformed", frame_text() + " does not have the robots of its frame");
    return taken;
  }
  std::size_t expected_size = 0;
  for (const std::uint32_t robot : robots)
    expected_size += simulation_.kinds()[simulation_.kind_of(robot)].command_size;
  const bool sizes_fit = values.size() == expected_size;
  for (const std::uint32_t robot : robots) {
    const std::size_t size = simulation_.kinds()[simulation_.kind_of(robot)].command_size;
    switch (barrier_.judge(robot, frame_tick)) {
      case lockstep::Barrier::Verdict::accepted: {
        std::optional<CommandFault> fault;
        if (!sizes_fit) {
          fault = CommandFault{CommandFault::Reason::wrong_size, "",
                               frame_text() + " has " + std::to_string(values.size()) + " values, expected " +
                                   std::to_string(expected_size)};
        } else {
          fault = simulation_.check_command(robot, values.first(size));
        }
        if (fault) {
          reject(reason_word(fault->reason), fault->text);
          taken.is_fault = true;
          const description::OnLate on_late = simulation_.policy(robot).on_late;
          taken.ends_run |= on_late == description::OnLate::wait || on_late == description::OnLate::stop;
          barrier_.refuse(robot, frame_tick, now);
        } else {
          barrier_.answer(robot, frame_tick, values.first(size), now);
          ++taken.accepted;
        }
        break;
      }
      case lockstep::Barrier::Verdict::repeated: reject("repeated", frame_text() + " arrived twice"); break;
      case lockstep::Barrier::Verdict::early:
        reject("early", frame_text() + " arrived before its frame was sent");
        break;
      case lockstep::Barrier::Verdict::stale:
        reject("stale", frame_text() + " arrived at tick " + std::to_string(barrier_.tick()));
        break;
    }
    if (sizes_fit) values = values.subspan(size);
  }
  return taken;
}

void Exchange::save(SnapshotWriter& writer) const {
  barrier_.save(writer);
  for (const std::vector<double>& observations : history_) {
    writer.add_count(observations.size());
    writer.add_all(observations.data(), observations.size());
  }
}

void Exchange::restore(SnapshotReader& reader) {
  barrier_.restore(reader);
  if (barrier_.tick() > simulation_.tick() || barrier_.tick() + 1 < simulation_.tick())
    throw SnapshotError("snapshot: the world is at tick " + std::to_string(simulation_.tick()) +
                        ", but the barrier is at tick " + std::to_string(barrier_.tick()));
  barrier_.for_each_answer([&](std::uint32_t robot, std::span<const double> values) {
    if (const auto fault = simulation_.check_command(robot, values))
      throw SnapshotError("snapshot: invalid answer: " + fault->text);
  });
  for (std::vector<double>& observations : history_) {
    reader.expect_count(observations.size(), "observed values of pending frames");
    reader.read_all(observations.data(), observations.size());
  }
}

std::span<const std::uint32_t> Exchange::apply() {
  using Kind = lockstep::Barrier::Outcome::Kind;
  changed_.clear();
  for (std::uint32_t robot = 0; robot < simulation_.robot_count(); ++robot) {
    const lockstep::Barrier::Outcome outcome = barrier_.outcome(robot);
    if (outcome.kind == Kind::keep) continue;
    const bool changes = outcome.kind == Kind::command ? simulation_.set_command(robot, outcome.values)
                                                       : simulation_.set_neutral_command(robot);
    if (changes) changed_.push_back(robot);
  }
  return changed_;
}

}  // namespace cohort::session
