#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>

#include "tests/support/controlled_run.hpp"

// Whoever controls a run does it between ticks, and the ticks keep their bits.
namespace cohort::test {
namespace {

using wire::Operation;
using wire::ResultCode;

TEST(ControlAtTickBoundariesOnly, PausesAndChangesOfSpeedLeaveTheRunItsBits) {
  const FieldOfRobots field(4, 20.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused", "--speed", "20"});
  for (const char* speed : {"5", "10", "8"}) {
    run.done({"speed", speed});
    const auto status = run.status();
    EXPECT_EQ(status["speed"], std::stod(speed));
    EXPECT_EQ(status["state"], "paused");
    run.done({"resume"});
    EXPECT_TRUE(run.comes_to([&](const auto& now) { return now["tick"] > status["tick"]; }));
    const std::string paused = run.done({"pause"});
    EXPECT_EQ(paused, "paused at tick " + std::to_string(run.tick()) + "\n") << "and it stands";
  }
  run.done({"resume"});
  run.done({"speed", "max"});
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected);
  EXPECT_GE(events_of(summary, "control").size(), 8u) << summary["events"].dump(1);
}

TEST(ControlAtTickBoundariesOnly, StepsAreCountedExactly) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  EXPECT_EQ(run.done({"step", "7"}), "paused at tick 7\n");
  EXPECT_EQ(run.done({"step"}), "paused at tick 8\n");
  EXPECT_EQ(run.tick(), 8u);
  run.done({"resume"});
  const Ended refused = run_to_end(run.ctl({"step", "3"}));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("is not paused"), std::string::npos) << refused.err;
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, TwoWhoStepAtOnceGetTheStepsOfBoth) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  std::atomic<int> failures = 0;
  const auto step_ten_times = [&] {
    ControlClient client = client_of(run);
    wire::Request request = of(Operation::step_simulation);
    request.steps = 5;
    for (int i = 0; i < 10; ++i) {
      const auto reply = client.ask(request, patience, never);
      if (!reply || reply->result != ResultCode::ok) ++failures;
    }
  };
  std::thread other(step_ten_times);
  step_ten_times();
  other.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(run.tick(), 100u);
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, StatusNamesTheControllerThatTheRunWaitsForAndAPauseWaitsToo) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 10; }));
  run.host().signal(SIGSTOP);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["awaited_count"] == 2; }));
  const auto status = run.status();
  EXPECT_EQ(status["awaited"][0], "swarm/sbot_0");
  ASSERT_EQ(status["controllers"].size(), 1u);
  EXPECT_TRUE(status["controllers"][0]["awaited"]);
  EXPECT_NE(status["controllers"][0]["label"].get<std::string>().find("process " + std::to_string(run.host().pid())),
            std::string::npos)
      << status.dump(1);
  EXPECT_EQ(status["controllers"][0]["due_tick"], status["tick"]);
  EXPECT_EQ(status["controllers"][0]["robots"], nlohmann::json({0, 1}));
  EXPECT_GT(status["controllers"][0]["answer_us"]["p50"], 0.0);
  const std::string table = run.done({"status"});
  EXPECT_NE(table.find("waiting for swarm/sbot_0 and 1 more"), std::string::npos) << table;

  const Ended late = run_to_end(run.ctl({"--timeout", "0.3", "pause"}));
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_NE(late.err.find("the run waits for swarm/sbot_0 and 1 more: "), std::string::npos) << late.err;
  EXPECT_EQ(run.status()["state"], "playing");
  run.host().signal(SIGCONT);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["state"] == "paused"; })) << "at the next boundary";
  run.host().signal(SIGSTOP);
  run.done({"resume"});
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["awaited_count"] == 2; }));
  run.done({"shutdown"});
  EXPECT_EQ(run.server().wait_for_exit(), 0) << "whoever is awaited: " << run.server().output();
  run.host().signal(SIGCONT);
}

TEST(ControlAtTickBoundariesOnly, StatusIsWatchedUntilTheServerGoes) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Process watching(run.ctl({"status", "--watch", "--json"}));
  EXPECT_TRUE(watching.wait_for_output("\"tick\":0")) << watching.output();
  run.done({"step", "123"});
  EXPECT_TRUE(watching.wait_for_output("\"tick\":123")) << watching.output();
  Process reader(run.ctl({"status", "--watch"}));
  EXPECT_TRUE(reader.wait_for_output("p50 us")) << reader.output();
  reader.signal(SIGINT);
  EXPECT_EQ(reader.wait_for_exit(), 130);
  run.done({"shutdown"});
  run.finish();
  EXPECT_EQ(watching.wait_for_exit(), 0) << watching.output();
}

TEST(ControlAtTickBoundariesOnly, AnswersBeforeAnyControllerIsThere) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {}, false);
  const auto status = run.status();
  EXPECT_EQ(status["started"], false);
  EXPECT_EQ(status["awaited"], nlohmann::json({"swarm/sbot_0", "swarm/sbot_1"}));
  EXPECT_NE(run.done({"entities", "sbot_1$"}).find("swarm/sbot_1\n"), std::string::npos);
  run.done({"pause"});
  run.done({"shutdown"});
  EXPECT_EQ(run.finish()["ticks"], 0);
}

TEST(ControlAtTickBoundariesOnly, ControllersComeAndGoWhileItIsPaused) {
  const FieldOfRobots field(2, 5.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "100"});
  run.host().signal(SIGKILL);
  run.host().wait_for_exit();
  run.attach();
  EXPECT_TRUE(run.comes_to([&](const auto& now) {
    return now["controllers"].size() == 1 && now["controllers"][0]["label"].template get<std::string>().find(
                                                 std::to_string(run.host(1).pid())) != std::string::npos;
  }));
  EXPECT_EQ(run.tick(), 100u);
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], expected);
}

TEST(ControlAtTickBoundariesOnly, AClientThatDiesLeavesWhatItAskedFor) {
  const FieldOfRobots field(2, 1e5);
  ControlledRun run(field, {"--paused"});
  Process stepping(run.ctl({"step", "100000000"}));
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 0; }));
  stepping.signal(SIGKILL);
  stepping.wait_for_exit();
  const std::uint64_t tick = run.tick();
  EXPECT_TRUE(run.comes_to([&](const auto& now) { return now["tick"] > tick; })) << "it goes on";
  run.done({"pause"});
  EXPECT_EQ(run.status()["state"], "paused");
  run.done({"shutdown"});
  run.finish();
}

// What the C++ client never does: it speaks the protocol by itself.
class Stranger {
 public:
  explicit Stranger(const ReservedDomain& domain, std::uint64_t id)
      : id_(id),
        participant_(wire::Participant::client(domain.number())),
        replies_(participant_,
                 {[this](const wire::Reply& reply, const wire::Sender&) {
                    const std::lock_guard lock(mutex_);
                    received_.push_back(reply);
                  },
                  {}},
                 wire::partition_of(id), 16),
        requests_(participant_) {
    while (requests_.matched() == 0) std::this_thread::sleep_for(1ms);
  }
  void send(wire::Request request, std::uint64_t number) {
    request.client = id_;
    request.number = number;
    requests_.write(request);
  }
  std::vector<wire::Reply> received(std::size_t at_least) {
    const auto replies = [&] {
      const std::lock_guard lock(mutex_);
      return received_;
    };
    eventually([&] { return replies().size() >= at_least; });
    return replies();
  }

 private:
  const std::uint64_t id_;
  std::mutex mutex_;
  std::vector<wire::Reply> received_;
  wire::Participant participant_;
  wire::Reader<wire::Reply> replies_;
  wire::Writer<wire::Request> requests_;
};

TEST(ControlAtTickBoundariesOnly, ARequestThatComesAgainIsAnsweredAgainAndDoneOnce) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Stranger stranger(run.domain(), 0x77);
  wire::Request step = of(Operation::step_simulation);
  step.steps = 4;
  // The first may be lost, as between any two who have just met.
  std::size_t received = 0;
  for (int i = 0; i < 5; ++i) {
    stranger.send(step, 1);
    received = stranger.received(received + 1).size();
  }
  ASSERT_GE(received, 5u);
  for (const wire::Reply& reply : stranger.received(0)) {
    EXPECT_EQ(reply.number, 1u);
    EXPECT_EQ(reply.result, ResultCode::ok) << reply.error_message;
    EXPECT_EQ(reply.tick, 4u);
  }
  EXPECT_EQ(run.tick(), 4u);
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, WhatCannotBeIsRefusedWithASentence) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  ControlClient client = client_of(run);
  std::vector<wire::Request> bad;
  bad.push_back(of(static_cast<Operation>(4711)));
  bad.push_back(of(Operation::step_simulation));  // none
  bad.push_back(of(Operation::step_simulation));
  bad.back().steps = ~std::uint64_t{0};
  bad.push_back(of(Operation::set_speed));
  bad.back().speed = -1.0;
  bad.push_back(of(Operation::set_speed));
  bad.back().speed = std::numeric_limits<double>::quiet_NaN();
  bad.push_back(of(Operation::set_simulation_state));
  bad.back().state = static_cast<wire::SimulationState>(9);
  bad.push_back(of(Operation::reset_simulation));
  bad.back().scope = 2;
  bad.push_back(of(Operation::get_entity_state));
  bad.back().entity = "swarm/nobody";
  bad.push_back(of(Operation::get_entities));
  bad.back().filter = "((a*)*";
  bad.push_back(of(Operation::get_entities));
  bad.back().filter = "a{1,30000}";
  bad.push_back(of(Operation::get_data));
  bad.push_back(of(Operation::load_snapshot));
  bad.push_back(of(Operation::put_data));
  bad.back().size = ~std::uint64_t{0};
  bad.push_back(of(Operation::set_entity_state));
  bad.back().pose.position.x = std::numeric_limits<double>::infinity();
  for (const wire::Request& request : bad) {
    const auto reply = client.ask(request, patience, never);
    const std::string what = wire::name_of(request.operation);
    ASSERT_TRUE(reply) << what;
    EXPECT_NE(reply->result, ResultCode::ok) << what;
    EXPECT_FALSE(reply->error_message.empty()) << what;
  }
  EXPECT_EQ(run.tick(), 0u);
  const auto state = client.ask(
      [] {
        auto request = of(Operation::get_entity_state);
        request.entity = "swarm/sbot_1";
        return request;
      }(),
      patience, never);
  ASSERT_TRUE(state && state->states.size() == 1);
  EXPECT_EQ(state->states[0].pose.position.z, 0.0);
  run.done({"shutdown"});
  run.finish();
}

// As fast as it can, from two processes' worth of participants: what makes sense, what does not, and another's name.
TEST(ControlAtTickBoundariesOnly, FloodsOfRequestsNeverStopARun) {
  const FieldOfRobots field(4, 2.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused"});
  EXPECT_EQ(run.done({"step"}), "paused at tick 1\n");
  Stranger first(run.domain(), 0x1111), second(run.domain(), 0x2222);
  const auto flood = [](const std::stop_token& enough, Stranger& stranger) {
    std::uint64_t number = 1;
    while (!enough.stop_requested()) {
      stranger.send(of(Operation::get_status), ++number);
      stranger.send(of(Operation::save_snapshot), ++number);
      const auto any = static_cast<Operation>(++number % 128);
      if (any != Operation::reset_simulation && any != Operation::set_simulation_state)  // which end this run
        stranger.send(of(any), number);
      stranger.send(of(Operation::set_entity_state), 3);
      wire::Request large = of(Operation::put_data);
      large.size = wire::largest_data;
      large.data.assign(1000, 7);
      stranger.send(large, ++number);
    }
  };
  std::jthread one(flood, std::ref(first)), two(flood, std::ref(second));
  run.done({"resume"});
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected);
  bool is_named = false;
  for (const auto& event : events_of(summary, "rejected"))
    is_named = is_named || event["text"].get<std::string>().starts_with("flood");
  EXPECT_TRUE(is_named) << summary["events"].dump(1);
}

TEST(ControlAtTickBoundariesOnly, AFloodOfResetsLeavesTheSameRun) {
  const FieldOfRobots field(4, 2.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused"});
  {
    Stranger stranger(run.domain(), 0x1111);
    std::jthread flood([&](const std::stop_token& enough) {
      for (std::uint64_t number = 2; !enough.stop_requested(); ++number)
        stranger.send(of(Operation::reset_simulation), number);
    });
    EXPECT_TRUE(run.comes_to([](const auto& status) { return status["run"] >= 5; }));
  }
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], expected);
}

TEST(ControlAtTickBoundariesOnly, WithoutAServerItSaysWhatToLookFor) {
  const ReservedDomain domain;
  const Ended ended = run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--timeout", "0.3", "status"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("cohort doctor"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("domain " + domain.text()), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::test
