#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>

#include "tests/support/controlled_run.hpp"

// Whoever controls a run does it between ticks, and the ticks keep their bits.
namespace cohort::testing {
namespace {

using wire::Operation;
using wire::ResultCode;

const std::atomic<bool> never = false;

std::string reference(const FieldOfRobots& field, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"--controllers", "inprocess"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_experiment(field.file(), arguments)["state_hash"];
}

ControlClient client_of(const ControlledRun& run) { return ControlClient({.domain = run.domain().number()}); }

wire::Request of(Operation operation) {
  wire::Request request;
  request.operation = operation;
  return request;
}

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

TEST(ControlAtTickBoundariesOnly, AResetGivesTheBitsOfTheFirstRunAndAnotherSeedThoseOfAnother) {
  const FieldOfRobots field(4, 5.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--speed", "10"});
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 30; }));
  EXPECT_NE(run.done({"reset", "--seed", "77"}).find("run 2 stands at tick 0, with seed 77"), std::string::npos);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 10; }));
  EXPECT_EQ(run.status()["seed"], 77);
  run.done({"reset", "--seed", "1"});
  run.done({"speed", "max"});
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected);
  EXPECT_EQ(summary["ticks"], 500);
  EXPECT_EQ(run.host().wait_for_exit(), 0) << "one process for all: " << run.host().output();
}

TEST(ControlAtTickBoundariesOnly, ASnapshotGoesOnWithTheSameBitsHereAndElsewhere) {
  for (const char* team : {"", ", delay: 2"}) {
    const FieldOfRobots field(4, 5.0, team);
    const std::string expected = reference(field);
    const std::string file = (field / "snapshot").string();
    ControlledRun run(field, {"--paused"});
    run.done({"step", "200"});
    run.done({"save", file});
    const std::string hash = run.status()["state_hash"];
    run.done({"step", "150"});
    EXPECT_NE(run.done({"load", file}).find("run 2 stands at tick 200"), std::string::npos);
    EXPECT_EQ(run.status()["state_hash"], hash);
    EXPECT_EQ(run.status()["state"], "paused") << "as before";
    run.done({"resume"});
    const auto summary = run.finish();
    EXPECT_EQ(summary["state_hash"], expected) << team;
    EXPECT_EQ(summary["ticks"], 500) << "the duration counts from the beginning of the world";
    EXPECT_EQ(reference(field, {"--from", file}), expected) << "in one process" << team;
    EXPECT_EQ(run_experiment(field.file(), {"--from", file})["state_hash"], expected) << "over DDS" << team;
  }
}

TEST(ControlAtTickBoundariesOnly, ASnapshotOfSomethingElseIsRefusedAndTheRunGoesOn) {
  const FieldOfRobots field(2, 1e4), other(3, 1e4);
  const std::string file = (field / "snapshot").string();
  {
    ControlledRun run(other, {"--paused"});
    run.done({"step", "3"});
    run.done({"save", file});
    run.done({"shutdown"});
    run.finish();
  }
  ControlledRun run(field, {"--paused"});
  run.done({"step", "3"});
  const auto refusal = [&] {
    const Ended refused = run_to_end(run.ctl({"load", file}));
    EXPECT_EQ(refused.exit_code, 1);
    return refused.err;
  };
  const std::string of_another = refusal();
  EXPECT_NE(of_another.find("the snapshot"), std::string::npos) << of_another;
  std::string bytes = read_file(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_file(file, bytes);
  const std::string damaged = refusal();
  EXPECT_NE(damaged.find("damaged"), std::string::npos) << damaged;
  EXPECT_EQ(run.done({"step", "3"}), "paused at tick 6\n");
  const Ended from = run_to_end({cohort_program(), "run", field.file(), "--from", file});
  EXPECT_EQ(from.exit_code, 2);
  EXPECT_NE(from.err.find(file + ": the snapshot is damaged"), std::string::npos) << from.err;
  run.done({"shutdown"});
  run.finish();
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

wire::EntityState state_of(ControlClient& client, const std::string& name) {
  wire::Request request = of(Operation::get_entity_state);
  request.entity = name;
  const auto reply = client.ask(request, patience, never);
  EXPECT_TRUE(reply && reply->states.size() == 1) << name;
  return reply && !reply->states.empty() ? reply->states[0] : wire::EntityState{};
}

constexpr const char* box = R"(<sdf version="1.9"><model name="box"><link name="body">
  <inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
  <collision name="hull"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link></model></sdf>)";

TEST(ControlAtTickBoundariesOnly, ActionsChangeTheWorldAndAreTheSameTwice) {
  const FieldOfRobots field(2, 1e4);
  const std::string model = (field / "box.sdf").string();
  const std::string file = (field / "snapshot").string();
  write_file(model, box);
  const auto act = [&](const std::string& threads) {
    ControlledRun run(field, {"--paused", "--threads", threads});
    ControlClient client = client_of(run);
    run.done({"step", "10"});
    run.done({"spawn", model, "--name", "crate", "--pose", "-2 0 1 0 0 1.5"});
    EXPECT_EQ(run.done({"entities", "crate"}), "crate\n");
    EXPECT_EQ(state_of(client, "crate").pose.position.x, -2.0);
    EXPECT_NEAR(state_of(client, "crate").pose.orientation.z, std::sin(0.75), 1e-12);
    run.done({"step", "10"});
    EXPECT_LT(state_of(client, "crate").twist.linear.z, -0.9) << "it falls";
    run.done({"set-pose", "crate", "--pose", "2 -2 3"});
    run.done({"set-velocity", "crate", "--linear", "1 0 -0.5", "--angular", "0 0 2"});
    const wire::EntityState thrown = state_of(client, "crate");
    EXPECT_EQ(thrown.pose.position, (wire::Vector3{2, -2, 3}));
    EXPECT_NEAR(thrown.twist.linear.x, 1.0, 1e-12);
    EXPECT_NEAR(thrown.twist.angular.z, 2.0, 1e-12);
    run.done({"apply-force", "crate", "--force", "0 0 30", "--duration", "0.1"});
    run.done({"step", "5"});
    run.done({"save", file});
    run.done({"step", "15"});
    EXPECT_GT(state_of(client, "crate").twist.linear.z, 0.3) << "0.1 s of 30 N against 9.81 N and 0.5 m/s";
    const std::string hash = run.status()["state_hash"];
    run.done({"load", file});
    run.done({"step", "15"});
    EXPECT_EQ(run.status()["state_hash"], hash) << "with what was spawned, and the push that was under way";
    run.done({"remove", "crate"});
    EXPECT_EQ(run.done({"entities", "crate"}), "");
    run.done({"step", "5"});
    run.done({"shutdown"});
    return run.finish();
  };
  const auto first = act("1");
  EXPECT_EQ(act("4")["state_hash"], first["state_hash"]);
  EXPECT_EQ(first["ticks"], 45);
  EXPECT_GE(events_of(first, "control").size(), 4u) << first["events"].dump(1);
}

TEST(ControlAtTickBoundariesOnly, ActionsThatCannotBeAreRefusedWithTheReasonAndChangeNothing) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  ControlClient client = client_of(run);
  const std::string hash = run.status()["state_hash"];
  wire::Request spawn = of(Operation::spawn_entity);
  spawn.entity = "crate";
  const auto result_of = [&](const wire::Request& request) {
    const auto reply = client.ask(request, patience, never);
    EXPECT_TRUE(reply && !reply->error_message.empty());
    return reply ? reply->result : ResultCode::ok;
  };
  EXPECT_EQ(result_of(spawn), ResultCode::no_resource);
  spawn.resource_string = "<sdf version='1.9'><model name='box'><link";
  EXPECT_EQ(result_of(spawn), ResultCode::operation_failed);
  spawn.resource_string = box;
  spawn.pose.orientation = {0, 0, 0, 0};
  EXPECT_EQ(result_of(spawn), ResultCode::invalid_spawn_pose);
  spawn.pose.orientation = {0, 0, 0, 1};
  spawn.entity = "swarm/sbot_0";
  EXPECT_EQ(result_of(spawn), ResultCode::name_not_unique);
  for (const Operation operation : {Operation::delete_entity, Operation::apply_force, Operation::set_entity_state}) {
    wire::Request request = of(operation);
    request.entity = "swarm/nobody";
    request.set_pose = true;
    request.force = {1, 0, 0};
    EXPECT_EQ(result_of(request), ResultCode::not_found) << wire::name_of(operation);
  }
  wire::Request push = of(Operation::set_entity_state);
  push.entity = "ground";
  push.set_twist = true;
  push.twist.linear.x = 1;
  EXPECT_EQ(result_of(push), ResultCode::operation_failed) << "it is static";
  wire::Request light = of(Operation::set_light);
  light.entity = "ground";
  EXPECT_EQ(result_of(light), ResultCode::operation_failed);
  EXPECT_EQ(run.status()["state_hash"], hash);

  // Another name where that is allowed, and the reply says which.
  spawn.allow_renaming = true;
  spawn.pose.position = {2, 2, 1};
  const auto renamed = client.ask(spawn, patience, never);
  ASSERT_TRUE(renamed);
  EXPECT_EQ(renamed->result, ResultCode::ok) << renamed->error_message;
  EXPECT_NE(renamed->entity, "swarm/sbot_0");
  EXPECT_EQ(state_of(client, renamed->entity).pose.position.x, 2.0);
  EXPECT_NE(run.status()["state_hash"], hash);
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
    const auto until = std::chrono::steady_clock::now() + patience;
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        if (received_.size() >= at_least || std::chrono::steady_clock::now() > until) return received_;
      }
      std::this_thread::sleep_for(1ms);
    }
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

TEST(ControlAtTickBoundariesOnly, DataOfManyMegabytesGoesInPartsAndIsBounded) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  ControlClient client = client_of(run);
  const std::vector<std::byte> nonsense(20'000'000, std::byte{'x'});
  try {
    client.load(nonsense, patience, never);
    ADD_FAILURE() << "it loads anything";
  } catch (const ControlError& error) {
    EXPECT_NE(std::string(error.what()).find("this is no snapshot"), std::string::npos) << error.what();
  }
  const std::vector<std::byte> too_large(wire::largest_data + 1);
  EXPECT_THROW(client.load(too_large, patience, never), ControlError);
  EXPECT_EQ(run.done({"step"}), "paused at tick 1\n");
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, SnapshotsOfManyRobotsComeWhole) {
  const FieldOfRobots field(400, 1e4);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "2"});
  const std::string file = (field / "snapshot").string();
  run.done({"save", file});
  const std::string hash = run.status()["state_hash"];
  EXPECT_GT(std::filesystem::file_size(file), 2 * wire::largest_part);
  run.done({"step", "2"});
  run.done({"load", file});
  EXPECT_EQ(run.status()["state_hash"], hash);
  run.done({"shutdown"});
  run.finish();
}

// As fast as it can, from two processes' worth of participants: what makes sense, what does not, and another's name.
TEST(ControlAtTickBoundariesOnly, FloodsOfRequestsNeverStopARun) {
  const FieldOfRobots field(4, 60.0);
  const std::string expected = reference(field);
  ControlledRun run(field);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 0; }));
  Stranger first(run.domain(), 0x1111), second(run.domain(), 0x2222);
  std::atomic<bool> enough = false;
  const auto flood = [&](Stranger& stranger) {
    std::uint64_t number = 1;
    while (!enough) {
      stranger.send(of(Operation::get_status), ++number);
      stranger.send(of(Operation::save_snapshot), ++number);
      ++number;
      stranger.send(of(static_cast<Operation>(number)), number);
      stranger.send(of(Operation::set_entity_state), 3);
      wire::Request large = of(Operation::put_data);
      large.size = wire::largest_data;
      large.data.assign(1000, 7);
      stranger.send(large, ++number);
    }
  };
  std::thread one(flood, std::ref(first)), two(flood, std::ref(second));
  const auto summary = run.finish();
  enough = true;
  one.join();
  two.join();
  EXPECT_EQ(summary["state_hash"], expected);
  bool is_named = false;
  for (const auto& event : events_of(summary, "rejected"))
    is_named = is_named || event["text"].get<std::string>().starts_with("flood");
  EXPECT_TRUE(is_named) << summary["events"].dump(1);
}

TEST(ControlAtTickBoundariesOnly, WithoutAServerItSaysWhatToLookFor) {
  const ReservedDomain domain;
  const Ended ended = run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--timeout", "0.3", "status"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("cohort doctor"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("domain " + domain.text()), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::testing
