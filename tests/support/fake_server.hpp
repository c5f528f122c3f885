// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "idl/dds/transport.hpp"
#include "tests/support/free_domain.hpp"

namespace cohort::test {

/// The server's side of the protocol, one message at a time, for tests of clients. It sends messages on request, and
/// keeps the messages that it receives.
class FakeServer {
 public:
  struct Answer {
    std::uint64_t epoch = 0;
    std::uint64_t tick = 0;
    std::vector<std::uint32_t> robots;
    std::vector<double> values;
    bool operator==(const Answer&) const = default;
  };

  FakeServer() {
    // These are made last, because the readers call back at once.
    joins_.emplace(free_.server,
                   wire::Reader<wire::Join>::Callbacks{[this](const wire::Join& join, const wire::Sender&) {
                                                         const std::lock_guard lock(mutex_);
                                                         heard_join_ = join;
                                                       },
                                                       nullptr});
    commands_.emplace(
        free_.server,
        wire::Reader<wire::Command>::Callbacks{[this](const wire::Command& command, const wire::Sender&) {
                                                 const std::lock_guard lock(mutex_);
                                                 answers_.push_back({command.epoch,
                                                                     command.tick,
                                                                     {command.robots.begin(), command.robots.end()},
                                                                     {command.values.begin(), command.values.end()}});
                                               },
                                               nullptr},
        "", 8);
    reports_.emplace(free_.server,
                     wire::Reader<wire::Report>::Callbacks{[this](const wire::Report& report, const wire::Sender&) {
                                                             const std::lock_guard lock(mutex_);
                                                             heard_report_ = report;
                                                           },
                                                           nullptr});
  }

  std::uint32_t domain() const { return free_.domain; }
  /// Makes it a server that sends trees, of minor version 4. Must be called before `accept`.
  void send_trees() { sends_trees_ = true; }

  /// Waits for the Join of a client, returns it, and makes the writers to this client. Returns nullopt if none arrives.
  std::optional<wire::Join> accept() {
    if (!eventually([&] { return join().has_value(); })) return std::nullopt;
    client_ = join()->client;
    const std::string partition = wire::partition_of(client_);
    admits_.emplace(free_.server, partition);
    frames_.emplace(free_.server, partition, 8);
    own_reports_.emplace(free_.server, partition);
    if (sends_trees_) trees_.emplace(free_.server);
    descriptions_.emplace(free_.server);
    return join();
  }

  /// Disappears without a message. Keeps the domain, so that clients do not find another test's server instead.
  void leave() {
    trees_.reset();
    descriptions_.reset();
    admits_.reset();
    frames_.reset();
    own_reports_.reset();
  }

  void describe(const wire::RobotDescription& description) { descriptions_->write(description); }
  void send(const wire::RobotTree& tree) { trees_->write(tree); }

  void admit(wire::Admit admit) {
    admit.client = client_;
    admits_->write(admit);
  }

  void report(wire::Report report) {
    report.client = client_;
    own_reports_->write(report);
  }

  void send(std::uint64_t tick, std::vector<double> values, std::uint64_t epoch = 1,
            std::vector<std::uint32_t> robots = {0}) {
    frames_->write({.client = client_, .epoch = epoch, .tick = tick, .robots = robots, .values = values});
  }

  /// Sends a frame repeatedly until a new answer arrives, and returns it; nullopt if none arrives.
  std::optional<Answer> ask(std::uint64_t tick, const std::vector<double>& values, std::uint64_t epoch = 1,
                            const std::vector<std::uint32_t>& robots = {0}) {
    const std::size_t before = answers().size();
    for (int attempt = 0; attempt < 50; ++attempt) {
      send(tick, values, epoch, robots);
      if (eventually([&] { return answers().size() > before; }, std::chrono::milliseconds(200)))
        return answers()[before];
    }
    return std::nullopt;
  }

  std::vector<Answer> answers() const {
    const std::lock_guard lock(mutex_);
    return answers_;
  }
  std::optional<wire::Join> join() const {
    const std::lock_guard lock(mutex_);
    return heard_join_;
  }
  std::optional<wire::Report> heard_report() const {
    const std::lock_guard lock(mutex_);
    return heard_report_;
  }

 private:
  FreeDomain free_ = take_free_domain();
  std::uint64_t client_ = 0;
  mutable std::mutex mutex_;
  std::optional<wire::Join> heard_join_;
  std::optional<wire::Report> heard_report_;
  std::vector<Answer> answers_;
  bool sends_trees_ = false;
  std::optional<wire::Writer<wire::RobotTree>> trees_;
  std::optional<wire::Writer<wire::RobotDescription>> descriptions_;
  std::optional<wire::Writer<wire::Admit>> admits_;
  std::optional<wire::Writer<wire::Observation>> frames_;
  std::optional<wire::Writer<wire::Report>> own_reports_;
  std::optional<wire::Reader<wire::Join>> joins_;
  std::optional<wire::Reader<wire::Command>> commands_;
  std::optional<wire::Reader<wire::Report>> reports_;
};

}  // namespace cohort::test
