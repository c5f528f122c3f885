// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>

#include "tests/support/controlled_run.hpp"

// Clients control a run between ticks, and the ticks keep their bits.
namespace cohort::test {
namespace {

using wire::ResultCode;

TEST(ControlAtTickBoundariesOnly, PausesAndChangesOfSpeedKeepTheBits) {
  const FieldOfRobots field(4, 20.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused", "--speed", "20"});
  for (const char* speed : {"0.5", "1", "0.25"}) {  // so slow that the run cannot end between two commands
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

TEST(ControlAtTickBoundariesOnly, StepsOfTwoClientsAddUp) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  std::atomic<int> failures = 0;
  const auto step_ten_times = [&] {
    ControlClient client = client_of(run);
    for (int i = 0; i < 10; ++i) {
      const auto reply = client.ask(wire::StepSimulation{5}, patience, never);
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

TEST(ControlAtTickBoundariesOnly, StatusNamesTheAwaitedControllerAlsoDuringAPause) {
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

TEST(ControlAtTickBoundariesOnly, StatusIsWatchedUntilTheServerEnds) {
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

TEST(ControlAtTickBoundariesOnly, AnswersBeforeAnyControllerJoins) {
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

TEST(ControlAtTickBoundariesOnly, ControllersJoinAndLeaveDuringAPause) {
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

TEST(ControlAtTickBoundariesOnly, RequestsOfADeadClientStayInEffect) {
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

// A client that speaks the protocol itself, to do what the C++ client never does.
class Stranger {
 public:
  explicit Stranger(const ReservedDomain& domain, std::uint64_t id, std::uint32_t minor = wire::minor_version)
      : id_(id),
        minor_(minor),
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
  void send(const wire::Operation& operation, std::uint64_t number) {
    requests_.write({.client = id_, .minor = minor_, .number = number, .operation = operation});
  }
  /// Sends a request until its reply arrives.
  wire::Reply ask(const wire::Operation& operation) {
    const std::uint64_t number = ++last_number_;
    wire::Reply reply;
    EXPECT_TRUE(eventually([&] {
      send(operation, number);
      const std::lock_guard lock(mutex_);
      const auto found = std::ranges::find(received_, number, &wire::Reply::number);
      if (found != received_.end()) reply = *found;
      return reply.number == number;
    })) << wire::name_of(wire::code_of(operation));
    return reply;
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
  const std::uint32_t minor_;
  std::uint64_t last_number_ = 0;
  std::mutex mutex_;
  std::vector<wire::Reply> received_;
  wire::Participant participant_;
  wire::Reader<wire::Reply> replies_;
  wire::Writer<wire::Request> requests_;
};

TEST(ControlAtTickBoundariesOnly, ARepeatedRequestIsAnsweredAgainButCarriedOutOnce) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Stranger stranger(run.domain(), 0x77);
  // The first may be lost, as between any two participants that have just discovered each other.
  std::size_t received = 0;
  for (int i = 0; i < 5; ++i) {
    stranger.send(wire::StepSimulation{4}, 1);
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

TEST(ControlAtTickBoundariesOnly, InvalidRequestsAreRejectedWithASentence) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  ControlClient client = client_of(run);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::string long_name(2000, 'x');
  const std::vector<std::pair<wire::Operation, ResultCode>> bad = {
      {wire::UnknownOperation{4711}, ResultCode::feature_unsupported},
      {wire::StepSimulation{0}, ResultCode::malformed},
      {wire::StepSimulation{~std::uint64_t{0}}, ResultCode::malformed},
      {wire::SetSpeed{-1.0}, ResultCode::malformed},
      {wire::SetSpeed{std::numeric_limits<double>::quiet_NaN()}, ResultCode::malformed},
      {wire::SetSimulationState{static_cast<wire::SimulationState>(9)}, ResultCode::malformed},
      {wire::ResetSimulation{.scope = 2}, ResultCode::feature_unsupported},
      {wire::GetEntityState{"swarm/nobody"}, ResultCode::not_found},
      {wire::GetEntityState{long_name}, ResultCode::malformed},
      {wire::GetEntities{"((a*)*"}, ResultCode::malformed},
      {wire::GetEntities{"a{1,30000}"}, ResultCode::malformed},
      {wire::GetData{}, ResultCode::not_found},
      {wire::GetExperiment{~std::uint64_t{0}}, ResultCode::malformed},
      {wire::LoadSnapshot{}, ResultCode::incorrect_state},
      {wire::PutData{.size = ~std::uint64_t{0}}, ResultCode::malformed},
      {wire::SetEntityState{.entity = "swarm/sbot_1"}, ResultCode::malformed},
      {wire::SetEntityState{.entity = "swarm/sbot_1", .pose = wire::Pose{{infinite, 0, 0}, {}}}, ResultCode::malformed},
      {wire::SetEntityState{.entity = "swarm/sbot_1", .twist = wire::Twist{{}, {0, 0, infinite}}},
       ResultCode::malformed},
      {wire::SpawnEntity{.entity = "new", .uri = "sbot", .pose = {{0, infinite, 0}, {}}}, ResultCode::malformed},
      {wire::SpawnEntity{.entity = "new", .uri = "sbot", .team = long_name}, ResultCode::malformed},
      {wire::SetLight{.entity = "lamp", .intensity = infinite}, ResultCode::malformed},
      {wire::SetLight{.entity = "lamp", .color = wire::Vector3{infinite, 0, 0}}, ResultCode::malformed},
      {wire::ApplyForce{.entity = "swarm/sbot_1", .torque = {0, infinite, 0}}, ResultCode::malformed},
  };
  for (const auto& [operation, result] : bad) {
    const auto reply = client.ask(operation, patience, never);
    const std::string what = wire::name_of(wire::code_of(operation));
    ASSERT_TRUE(reply) << what;
    EXPECT_EQ(reply->result, result) << what << ": " << reply->error_message;
    EXPECT_FALSE(reply->error_message.empty()) << what;
  }
  EXPECT_EQ(run.tick(), 0u);
  const auto state = client.ask(wire::GetEntityState{"swarm/sbot_1"}, patience, never);
  ASSERT_TRUE(state && state->get<wire::EntityState>() != nullptr);
  EXPECT_EQ(state->get<wire::EntityState>()->pose.position.z, 0.0);
  run.done({"shutdown"});
  run.finish();
}

constexpr const char* including_another_file =
    "<sdf version='1.9'><model name='m'><include><uri>model://nothing</uri></include></model></sdf>";

TEST(ControlAtTickBoundariesOnly, EachReasonOfARefusalHasAResultAndOldClientsGetOneThatTheyKnow) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Stranger now(run.domain(), 0x44);
  Stranger before(run.domain(), 0x33, wire::first_minor_with_reasons - 1);
  const auto spawn = [](const std::string& uri, const std::string& text, const std::string& team = "") {
    return wire::SpawnEntity{
        .entity = "new", .uri = uri, .resource_string = text, .pose = {{2, 2, 1}, {}}, .team = team};
  };
  const std::string robot = "swarm/sbot_0";
  const std::vector<std::pair<wire::Operation, ResultCode>> refused = {
      {wire::AdvanceTime{.steps = 1}, ResultCode::time_not_held},
      {spawn("sbit", ""), ResultCode::unknown_model},
      {spawn("sbot", "", "nobody"), ResultCode::invalid_team},
      {spawn("", "<sdf version='1.9'><model name='m'><link"), ResultCode::resource_parse_error},
      {spawn("", including_another_file), ResultCode::missing_assets},
      {wire::ApplyForce{.entity = robot, .link = "tail", .force = {1, 0, 0}}, ResultCode::link_not_found},
      {wire::SetLight{.entity = "ground"}, ResultCode::light_not_found},
      {wire::SetLight{.entity = "swarm/nobody"}, ResultCode::light_not_found},
      {wire::SetEntityState{.entity = "ground", .twist = wire::Twist{{1, 0, 0}, {}}}, ResultCode::immovable},
      {wire::StartRecording{"{posse: 1}"}, ResultCode::invalid_selection},
  };
  const auto expect_refusal = [&](const wire::Operation& operation, ResultCode result) {
    const std::string what = wire::name_of(wire::code_of(operation));
    const wire::Reply reply = now.ask(operation);
    EXPECT_EQ(reply.result, result) << what << ": " << reply.error_message;
    const wire::Reply old = before.ask(operation);
    EXPECT_EQ(old.result,
              result == ResultCode::time_not_held ? ResultCode::incorrect_state : ResultCode::operation_failed)
        << what << ": " << old.error_message;
    EXPECT_EQ(old.error_message, reply.error_message);
  };
  for (const auto& [operation, result] : refused) expect_refusal(operation, result);

  for (Stranger* const each : {&now, &before}) {
    EXPECT_EQ(each->ask(wire::StartRecording{}).result, ResultCode::ok);
    EXPECT_EQ(each->ask(wire::PutData{.size = 1, .data = {7}}).result, ResultCode::ok);
  }
  expect_refusal(wire::StartRecording{}, ResultCode::already_recording);
  expect_refusal(wire::LoadSnapshot{}, ResultCode::invalid_snapshot);
  Stranger third(run.domain(), 0x55), fourth(run.domain(), 0x66), fifth(run.domain(), 0x88);
  EXPECT_EQ(third.ask(wire::StartRecording{}).result, ResultCode::ok);
  EXPECT_EQ(fourth.ask(wire::StartRecording{}).result, ResultCode::ok);
  EXPECT_EQ(fifth.ask(wire::StartRecording{}).result, ResultCode::too_many_recordings);

  EXPECT_EQ(now.ask(wire::SetEntityState{.entity = robot, .twist = wire::Twist{{1e9, 0, 0}, {}}}).result,
            ResultCode::ok);
  run.done({"step", "2"});
  expect_refusal(wire::SetEntityState{.entity = robot, .pose = wire::Pose{{0, 0, 1}, {}}}, ResultCode::quarantined);
  run.done({"resume"});
  expect_refusal(wire::StepSimulation{1}, ResultCode::not_paused);
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, WaitingStepsAreLimitedAndAreCancelledByAChangeOfState) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"}, false);  // steps wait for controllers
  Stranger stranger(run.domain(), 0x77);
  const auto has = [&](ResultCode result) {
    const std::vector<wire::Reply> replies = stranger.received(0);
    return std::ranges::find(replies, result, &wire::Reply::result) != replies.end();
  };
  std::uint64_t number = 0;
  EXPECT_TRUE(eventually([&] {  // the server reads at most 16 requests at a time
    stranger.send(wire::StepSimulation{1}, number++ % (wire::requests_under_way + 1) + 1);
    return has(ResultCode::too_many_requests);
  }));
  EXPECT_FALSE(has(ResultCode::cancelled));
  run.done({"pause"});
  EXPECT_TRUE(eventually([&] { return has(ResultCode::cancelled); }));
  run.done({"shutdown"});
  run.finish();
}

// Requests at full speed, from two processes with many participants: valid, invalid, and with another client's id.
TEST(ControlAtTickBoundariesOnly, FloodsOfRequestsNeverStopARun) {
  const FieldOfRobots field(4, 2.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused"});
  EXPECT_EQ(run.done({"step"}), "paused at tick 1\n");
  Stranger first(run.domain(), 0x1111), second(run.domain(), 0x2222);
  const auto flood = [](const std::stop_token& enough, Stranger& stranger) {
    std::uint64_t number = 1;
    while (!enough.stop_requested()) {
      stranger.send(wire::GetStatus{}, ++number);
      stranger.send(wire::SaveSnapshot{}, ++number);
      const auto any = static_cast<wire::OperationCode>(++number % 128);
      if (any != wire::OperationCode::reset_simulation &&
          any != wire::OperationCode::set_simulation_state)  // which end this run
        stranger.send(wire::UnknownOperation{static_cast<std::uint32_t>(any)}, number);
      stranger.send(wire::SetEntityState{}, 3);
      stranger.send(wire::PutData{.size = wire::largest_data, .data = std::vector<std::uint8_t>(1000, 7)}, ++number);
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

TEST(ControlAtTickBoundariesOnly, AFloodOfResetsKeepsTheBits) {
  const FieldOfRobots field(4, 2.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--paused"});
  {
    Stranger stranger(run.domain(), 0x1111);
    std::jthread flood([&](const std::stop_token& enough) {
      for (std::uint64_t number = 2; !enough.stop_requested(); ++number) stranger.send(wire::ResetSimulation{}, number);
    });
    EXPECT_TRUE(run.comes_to([](const auto& status) { return status["run"] >= 5; }));
  }
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], expected);
}

TEST(ControlAtTickBoundariesOnly, WithoutAServerTheErrorSaysWhatToCheck) {
  const ReservedDomain domain;
  const Ended ended = run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--timeout", "0.3", "status"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("cohort doctor"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("domain " + domain.text()), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::test
