// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/client.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <random>
#include <set>
#include <utility>

namespace cohort::conformance {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto longest_sleep = 100ms;
constexpr auto server_may_be_away = 2s;
constexpr auto join_interval = 1s;
constexpr std::size_t most_early_frames = 64;

std::uint64_t random_id() {
  std::random_device device;
  const std::uint64_t high = device();
  return std::max<std::uint64_t>(1, high << 32 | device());
}

void say(const std::string& text) {
  std::puts(text.c_str());
  std::fflush(stdout);
}

}  // namespace

Client::Client(Options options)
    : options_(std::move(options)), id_(random_id()), wire_(options_.domain, id_), robots_(options_.plugin) {}

End Client::run() {
  while (!end_) {
    join_every_second();
    wire_.wait_for_news(longest_sleep);
    take_reports();
    if (end_) break;
    while (auto description = wire_.take_description()) {
      descriptions_[description->from][description->message.description()] = std::move(description->message);
    }
    take_admits();
    try {
      begin_when_described();
      take_states();
      take_frames();
      if (!end_) answer_frames();
    } catch (const std::exception& error) {
      fail(error.what());
    }
    look_for_server();
  }
  say("answered in all " + std::to_string(answers_given_) + ", again " + std::to_string(answers_repeated_));
  return *end_;
}

void Client::join_every_second() {
  if (joined_at_ && Clock::now() - *joined_at_ < join_interval) return;
  if (!joined_at_) say("looking for a server");
  joined_at_ = Clock::now();
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  message::Join join;
  join.client(id_);
  join.minor(1);
  join.controller("Fast DDS");
  join.host(host.data());
  join.process(static_cast<std::uint32_t>(::getpid()));
  join.robots(options_.robots);
  wire_.write(std::move(join));
}

void Client::take_reports() {
  while (const auto report = wire_.take_report()) {
    if (report->client() != id_) continue;
    say("report " + std::to_string(report->kind()) + " (" + report->reason() + "): " + report->text());
    switch (report->kind()) {
      case 0: end_ = End::finished; break;
      case 2: end_ = End::superseded; break;
      case 3: end_ = End::failed; break;
      default: break;  // a rejected answer, or a kind of a later minor version
    }
  }
}

void Client::take_admits() {
  while (auto admit = wire_.take_admit()) {
    if (admit->message.client() != id_) continue;
    if (admit->message.status() == 1) {
      say("refused: " + admit->message.reason());
      end_ = End::refused;
      return;
    }
    const bool is_another_server = admit->from != server_;
    if (!admitted_ || is_another_server || admit->message.epoch() > admitted_->epoch()) offered_ = std::move(admit);
  }
}

void Client::begin_when_described() {
  if (!offered_ || end_) return;
  const auto& descriptions = descriptions_[offered_->from];
  const bool described = std::ranges::all_of(offered_->message.robots(), [&](const message::AdmittedRobot& robot) {
    return descriptions.contains(robot.description());
  });
  if (!described) return;
  if (std::exchange(server_, offered_->from) != offered_->from) early_.clear();
  admitted_ = std::move(offered_->message);
  offered_.reset();
  say("admitted to " + std::to_string(admitted_->robots().size()) + " robots from tick " +
      std::to_string(admitted_->tick()) + ", reason " + std::to_string(admitted_->start_reason()));
  robots_.start(*admitted_, descriptions);
  frames_.emplace(*admitted_);
  answered_up_to_ = admitted_->tick();
  saved_tick_.reset();
  fetched_.reset();
  if (admitted_->start_reason() == 4) fetched_.emplace(*admitted_);
  for (message::Observation& frame : std::exchange(early_, {})) take_frame(std::move(frame));
}

void Client::take_frames() {
  while (auto frame = wire_.take_observation()) {
    if (frame->client() != id_) continue;
    if (options_.loses_every != 0 && frame->resent() == 0 && ++frames_seen_ % options_.loses_every == 0) continue;
    take_frame(std::move(*frame));
  }
}

void Client::take_frame(message::Observation frame) {
  if (!frames_ || frames_->kind_of(frame) == Frames::Kind::of_a_later_one) {
    if (early_.size() < most_early_frames) early_.push_back(std::move(frame));
  } else if (frames_->kind_of(frame) == Frames::Kind::of_the_lease) {
    const std::uint32_t copy = frame.resent();
    if (const message::Command* kept = frames_->arrive(std::move(frame)); kept != nullptr) {
      ++answers_repeated_;
      message::Command answer = *kept;
      answer.resent(copy);
      wire_.write(answer);
    }
  }
}

// Sends state that the server requests for a snapshot, and fetches the state of a snapshot.
void Client::take_states() {
  while (const auto state = wire_.take_state()) {
    if (state->client() != id_ || !admitted_) continue;
    if (state->kind() == 1 && fetched_) fetched_->take(*state);
    const bool is_mine = state->run() == admitted_->run() && state->epoch() == admitted_->epoch();
    if (state->kind() != 0 || !is_mine || fetched_ || answered_up_to_ > state->tick()) continue;
    if (saved_tick_ != state->tick()) saved_ = pack(robots_.save());
    saved_tick_ = state->tick();
    wire_.write(part_of(saved_, *state));
    say("gave state of tick " + std::to_string(state->tick()) + " from " + std::to_string(state->offset()) + " on");
  }
  if (!fetched_) return;
  if (fetched_->is_complete()) {
    robots_.load(unpack(fetched_->bytes()));
    say("loaded " + std::to_string(fetched_->bytes().size()) + " bytes of state");
    fetched_.reset();
  } else if (auto question = fetched_->question(Clock::now())) {
    wire_.write(std::move(*question));
  }
}

void Client::answer_frames() {
  if (!frames_ || fetched_) return;
  while (const auto frame = frames_->next()) {
    const message::Command answer = robots_.answer(*frame);
    frames_->keep(answer);
    answered_up_to_ = frame->tick() + 1;
    if (++answers_given_ % 100 == 0) say("answered " + std::to_string(answers_given_) + " frames");
    const bool lost = options_.loses_every != 0 && (answers_given_ + 3) % options_.loses_every == 0;
    if (!lost) wire_.write(answer);
  }
}

void Client::look_for_server() {
  if (!admitted_ || wire_.sees_server()) {
    without_server_since_.reset();
  } else if (!without_server_since_) {
    without_server_since_ = Clock::now();
  } else if (!end_ && Clock::now() - *without_server_since_ > server_may_be_away) {
    say("the server is gone");
    end_ = End::server_lost;
  }
}

void Client::fail(const std::string& why) {
  say("failed: " + why);
  message::Report report;
  report.client(id_);
  report.run(admitted_ ? admitted_->run() : 0);
  report.kind(3);
  report.tick(admitted_ ? admitted_->tick() : 0);
  report.reason("exception");
  report.text(why);
  wire_.write(std::move(report));
  wire_.wait_for_reports_to_arrive();
  end_ = End::failed;
}

}  // namespace cohort::conformance
