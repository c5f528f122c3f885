// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "idl/dds/transport.hpp"
#include "tests/support/worlds/field_of_robots.hpp"
#include "tests/support/worlds/sbot_layout.hpp"

namespace cohort::test {
namespace {

constexpr std::uint64_t own_id = 0xabcdef;  // for a client that these tests implement themselves

// Returns how often commands were rejected, by reason.
std::map<std::string, std::uint64_t> rejections(const nlohmann::json& summary) {
  std::map<std::string, std::uint64_t> counts;
  for (const auto& event : summary["events"]) {
    const std::string text = event["text"];
    if (event["kind"] == "rejected")
      counts[text.substr(0, text.find_first_of(" :"))] += event["count"].get<std::uint64_t>();
  }
  return counts;
}

// A client written from docs/protocol.md alone, which claims robots and answers each frame as the test chooses.
class HandWrittenClient {
 public:
  using Answer = std::function<void(wire::Writer<wire::Command>&, const wire::Observation&)>;

  HandWrittenClient(std::uint32_t domain, const std::string& robots, const Answer& answer)
      : participant_(wire::Participant::client(domain)),
        commands_(participant_),
        join_(participant_),
        observations_(
            participant_,
            {[this, answer](const wire::Observation& frame, const wire::Sender&) { answer(commands_, frame); }, {}},
            wire::partition_of(own_id)),
        reports_(participant_,
                 {[this](const wire::Report& report, const wire::Sender&) {
                    if (report.reason == "detached") is_detached_ = true;
                    if (report.kind == wire::ReportKind::rejected) rejected_tick_ = report.tick;
                  },
                  {}},
                 wire::partition_of(own_id)) {
    wire::Join join;
    join.client = own_id;
    join.controller = "hand-written";
    join.host = "here";
    join.robots = {robots};
    join_.write(join);
  }
  /// Returns true after the report.
  bool is_detached() const { return is_detached_; }
  /// Returns the tick of the answer that was last reported as rejected; -1 before any.
  std::int64_t rejected_tick() const { return rejected_tick_; }

 private:
  std::atomic<bool> is_detached_ = false;
  std::atomic<std::int64_t> rejected_tick_ = -1;
  wire::Participant participant_;
  wire::Writer<wire::Command> commands_;
  wire::Writer<wire::Join> join_;
  wire::Reader<wire::Observation> observations_;
  wire::Reader<wire::Report> reports_;
};

TEST(StrangersNeverCount, MalformedStaleForeignAndNanCommandsOfAStrangerKeepTheBits) {
  const ReservedDomain domain;
  const ScratchFolder folder;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "10", "--speed", "5", "--domain",
                  domain.text(), "--summary", (folder / "summary.json").string()});
  Process stranger({COHORT_BUILD_DIR "/bin/send_bad_commands", domain.text(), "4660"});
  ASSERT_TRUE(stranger.wait_for_output("sending")) << stranger.output();
  Process controllers({cohort_program(), "host", "obstacle_avoidance", "--robots", "all", "--domain", domain.text()});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();

  const auto summary = read_json(folder / "summary.json");
  EXPECT_EQ(summary["state_hash"], reference_hash(10));
  EXPECT_GT(rejections(summary)["foreign"], 1000u) << summary.dump(1);
  EXPECT_NE(server.output().find("rejected: foreign"), std::string::npos) << "it is named: " << server.output();
}

TEST(StrangersNeverCount, CommandsWithTheIdOfAnotherClientKeepTheBits) {
  const auto run = [](bool forged) {
    const ReservedDomain domain;
    const ScratchFolder folder;
    Process server({cohort_program(), "serve", demo_experiment(), "--duration", "5", "--domain", domain.text(),
                    "--summary", (folder / "summary.json").string()});
    Process controllers(
        {cohort_program(), "host", "obstacle_avoidance", "--robots", "1..15", "--domain", domain.text()});
    // Holds back its answer to tick 300 until the forger has tried to send it a thousand times.
    std::vector<double> drive(sbot_command_size, 0.0);
    drive[0] = 0.1;
    drive[1] = 0.15;
    std::atomic<bool> answers = true;
    std::atomic<bool> holds_back = false;
    if (forged) answers = false;
    HandWrittenClient client(domain.number(), "0", [&](auto& commands, const wire::Observation& frame) {
      if (frame.tick >= 300 && !answers) {
        holds_back = true;
        return;
      }
      commands.write({own_id, frame.run, frame.epoch, frame.tick, frame.robots, drive});
    });
    std::unique_ptr<Process> forger;
    if (forged) {
      EXPECT_TRUE(server.wait_for_output("waiting for explorers/sbot_0: hand-written")) << server.output();
      EXPECT_TRUE(holds_back);
      forger = std::make_unique<Process>(
          std::vector<std::string>{COHORT_BUILD_DIR "/bin/send_bad_commands", domain.text(), std::to_string(own_id)});
      EXPECT_TRUE(forger->wait_for_output("sent a thousand")) << forger->output();
      answers = true;
    }
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    return read_json(folder / "summary.json");
  };
  const auto quiet = run(false);
  const auto disturbed = run(true);
  EXPECT_EQ(disturbed["state_hash"], quiet["state_hash"]);
  EXPECT_EQ(rejections(quiet)["foreign"], 0u);
  EXPECT_GT(rejections(disturbed)["foreign"], 900u) << disturbed.dump(1);
}

TEST(StrangersNeverCount, EarlyAndMalformedCommandsOfAHolderAreNamedAndStaleOrRepeatedOnesCounted) {
  const ReservedDomain domain;
  const ScratchFolder folder;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "2", "--domain", domain.text(),
                  "--summary", (folder / "summary.json").string()});
  Process controllers({cohort_program(), "host", "obstacle_avoidance", "--robots", "1..15", "--domain", domain.text()});
  const std::vector<std::uint32_t> own = {0}, others = {0, 1};
  const std::vector<double> still(sbot_command_size, 0.0);
  HandWrittenClient client(domain.number(), "0", [&](auto& commands, const wire::Observation& frame) {
    const auto send = [&](std::uint64_t tick, std::uint64_t epoch, std::span<const std::uint32_t> robots) {
      commands.write({own_id, frame.run, epoch, tick, robots, still});
    };
    if (frame.tick > 0) send(frame.tick - 1, frame.epoch, own);  // stale
    send(frame.tick + 5, frame.epoch, own);                      // early
    send(frame.tick, frame.epoch + 1, own);                      // another lease
    send(frame.tick, frame.epoch, others);                       // for a robot that it does not hold
    send(frame.tick, frame.epoch, own);                          // right
    send(frame.tick, frame.epoch, own);                          // repeated
  });
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  const auto summary = read_json(folder / "summary.json");
  EXPECT_EQ(summary["ticks"], 200);
  auto counts = rejections(summary);
  for (const char* reason : {"early", "malformed"}) EXPECT_GT(counts[reason], 50u) << summary.dump(1);
  EXPECT_GT(summary["repeated"], 300u) << summary.dump(1);
  for (const char* reason : {"stale", "repeated"}) EXPECT_EQ(counts[reason], 0u) << summary.dump(1);
}

class FaultyHolder : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(FaultyHolder, StopsTheRunUnderWaitWithTheChannelAndTheReason) {
  const auto [reason, value] = GetParam();
  const ReservedDomain domain;
  const ScratchFolder folder;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "2", "--domain", domain.text(),
                  "--summary", (folder / "summary.json").string()});
  std::vector<double> values(16 * sbot_command_size, 0.0);
  values[sbot_command_size * 5 + 1] = value;  // right track of robot 5
  HandWrittenClient client(domain.number(), "all", [&](auto& commands, const wire::Observation& frame) {
    commands.write({own_id, frame.run, frame.epoch, frame.tick, frame.robots, values});
  });
  EXPECT_EQ(server.wait_for_exit(), 1) << server.output();
  EXPECT_NE(server.output().find("explorers/sbot_5: treel/right/velocity is"), std::string::npos) << server.output();
  const auto summary = read_json(folder / "summary.json");
  EXPECT_EQ(summary["ticks"], 0);
  EXPECT_EQ(rejections(summary)[reason], 1u) << summary.dump(1);
  EXPECT_EQ(summary["misses"].size(), 1u) << "as where controllers are in the server's process: " << summary.dump(1);
}

INSTANTIATE_TEST_SUITE_P(All, FaultyHolder,
                         ::testing::Values(std::pair{"not_finite", std::nan("")},
                                           std::pair{"not_finite", std::numeric_limits<double>::infinity()},
                                           std::pair{"out_of_range", 0.3}),
                         [](const auto& fault) { return fault.param.first + std::to_string(fault.index); });

class FaultyHolderOf : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultyHolderOf, AHeldOrZeroedRobotMissesWithEachInvalidAnswer) {
  const FieldOfRobots field(1, 0.05, ", deadline: 60, on_late: " + std::string(GetParam()));
  const ReservedDomain domain;
  Process server(field.serve(domain));
  const std::vector<double> values(sbot_command_size, std::nan(""));
  HandWrittenClient client(domain.number(), "all", [&](auto& commands, const wire::Observation& frame) {
    commands.write({own_id, frame.run, frame.epoch, frame.tick, frame.robots, values});
  });
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  const auto summary = field.summary();
  EXPECT_EQ(summary["late"], 5) << summary.dump(1);
  ASSERT_EQ(summary["misses"].size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(summary["misses"][i]["tick"], i) << "the tick that it is of";
  EXPECT_EQ(rejections(summary)["not_finite"], 5u);
}

INSTANTIATE_TEST_SUITE_P(All, FaultyHolderOf, ::testing::Values("hold", "zero"));

// The frame of tick 1 is sent before the answer to tick 0.
TEST(FaultyHolderUnderHold, ReceivesTheTickOfTheRejectedAnswer) {
  const FieldOfRobots field(1, 0.05, ", delay: 1, deadline: 60, on_late: hold");
  const ReservedDomain domain;
  Process server(field.serve(domain));
  const std::vector<std::uint32_t> robots = {0};
  const std::vector<double> faulty(sbot_command_size, std::nan(""));
  const std::vector<double> still(sbot_command_size, 0.0);
  std::atomic<bool> has_answered_first = false;
  HandWrittenClient client(domain.number(), "all", [&](auto& commands, const wire::Observation& frame) {
    const auto answer = [&](std::uint64_t tick, const std::vector<double>& values) {
      commands.write({own_id, frame.run, frame.epoch, tick, robots, values});
    };
    if (frame.tick == 0) return;
    if (!has_answered_first.exchange(true)) answer(0, faulty);
    answer(frame.tick, still);
  });
  EXPECT_TRUE(eventually([&] { return client.rejected_tick() == 0; })) << client.rejected_tick();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
}

// Its other robot is free for another client at once, at the tick that waits for it.
TEST(FaultyHolderUnderDetach, LosesItsLeaseLikeALateOne) {
  const FieldOfRobots field(2, 1.0, ", deadline: 60, on_late: detach");
  const ReservedDomain domain;
  Process server(field.serve(domain));
  HandWrittenClient client(domain.number(), "all", [&](auto& commands, const wire::Observation& frame) {
    std::vector<double> values(frame.robots.size() * sbot_command_size, 0.0);
    values[0] = std::nan("");
    commands.write({own_id, frame.run, frame.epoch, frame.tick, frame.robots, values});
  });
  EXPECT_TRUE(eventually([&] { return client.is_detached(); })) << server.output();
  Process controllers(FieldOfRobots::host(domain, "1"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  const auto summary = field.summary();
  ASSERT_EQ(summary["misses"].size(), 1u) << summary.dump(1);
  EXPECT_EQ(summary["misses"][0]["robot"], "swarm/sbot_0");
  EXPECT_EQ(summary["misses"][0]["on_late"], "detach");
}

}  // namespace
}  // namespace cohort::test
