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
      descriptions_[description->description()] = std::move(*description);
    }
    take_admits();
    try {
      begin_when_described();
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
  join.minor(0);
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
    if (admit->client() != id_) continue;
    if (admit->status() == 1) {
      say("refused: " + admit->reason());
      end_ = End::refused;
      return;
    }
    if (!admitted_ || admit->epoch() > admitted_->epoch()) offered_ = std::move(admit);
  }
}

void Client::begin_when_described() {
  if (!offered_ || end_) return;
  const bool described = std::ranges::all_of(offered_->robots(), [&](const message::AdmittedRobot& robot) {
    return descriptions_.contains(robot.description());
  });
  if (!described) return;
  admitted_ = std::exchange(offered_, std::nullopt);
  say("admitted to " + std::to_string(admitted_->robots().size()) + " robots from tick " +
      std::to_string(admitted_->tick()) + ", reason " + std::to_string(admitted_->start_reason()));
  robots_.start(*admitted_, descriptions_);
  frames_.emplace(*admitted_);
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

void Client::answer_frames() {
  if (!frames_) return;
  while (const auto frame = frames_->next()) {
    const message::Command answer = robots_.answer(*frame);
    frames_->keep(answer);
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
