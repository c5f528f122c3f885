// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/controlled_run.hpp"

// Returning to the beginning, to a snapshot, and to kept snapshots.
namespace cohort::test {
namespace {

TEST(ControlAtTickBoundariesOnly, AResetGivesTheSameBitsAndAnotherSeedOtherBits) {
  const FieldOfRobots field(4, 5.0);
  const std::string expected = reference(field);
  ControlledRun run(field, {"--speed", "1"});
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 30; }));
  EXPECT_NE(run.done({"reset", "--seed", "77"}).find("run 2 is at tick 0, seed 77"), std::string::npos);
  EXPECT_TRUE(run.comes_to([](const auto& now) { return now["tick"] > 10; }));
  EXPECT_EQ(run.status()["seed"], 77);
  run.done({"reset", "--seed", "1"});
  run.done({"speed", "max"});
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected);
  EXPECT_EQ(summary["ticks"], 500);
  EXPECT_EQ(run.host().wait_for_exit(), 0) << "one process for all: " << run.host().output();
}

TEST(ControlAtTickBoundariesOnly, ASnapshotGivesTheSameBitsInAnyProcess) {
  for (const char* team : {"", ", delay: 2"}) {
    const FieldOfRobots field(4, 5.0, team);
    const std::string expected = reference(field);
    const std::string file = (field / "snapshot").string();
    ControlledRun run(field, {"--paused"});
    run.done({"step", "200"});
    run.done({"save", file});
    const std::string hash = run.status()["state_hash"];
    run.done({"step", "150"});
    EXPECT_NE(run.done({"load", file}).find("run 2 is at tick 200"), std::string::npos);
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

TEST(ControlAtTickBoundariesOnly, AForeignSnapshotIsRejectedAndTheRunContinues) {
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

TEST(ControlAtTickBoundariesOnly, GoesBackToKeptSnapshots) {
  const FieldOfRobots field(4, 5.0);
  ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"});
  run.done({"step", "200"});
  const std::string hash = run.status()["state_hash"];
  run.done({"step", "140"});
  EXPECT_EQ(run.done({"back", "2.3"}), "run 2 is at tick 200, seed 1\n");
  EXPECT_EQ(run.status()["state_hash"], hash);
  EXPECT_EQ(run.status()["state"], "paused") << "as before";
  EXPECT_EQ(run.done({"back", "0.99"}), "run 3 is at tick 50, seed 1\n");
  EXPECT_EQ(run.done({"back", "4"}), "run 4 is at tick 50, seed 1\n") << "what came later has not been yet";
  run.done({"step", "150"});
  EXPECT_EQ(run.status()["state_hash"], hash);
  EXPECT_EQ(run.done({"back", "1"}), "run 5 is at tick 100, seed 1\n") << "kept anew";
  run.done({"reset"});
  EXPECT_EQ(run.done({"back", "1"}), "run 7 is at tick 0, seed 1\n") << "another run, with a past of its own";
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
}

TEST(ControlAtTickBoundariesOnly, GoesBackAfterALoad) {
  const FieldOfRobots field(4, 5.0);
  const ScratchFolder folder;
  const std::string file = folder / "run.snap";
  ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"});
  run.done({"step", "120"});
  run.done({"save", file});
  const std::string hash = run.status()["state_hash"];
  run.done({"load", file});
  EXPECT_EQ(run.done({"back", "2"}), "run 3 is at tick 120, seed 1\n") << "where it was loaded";
  EXPECT_EQ(run.status()["state_hash"], hash);
  run.done({"step", "140"});
  EXPECT_EQ(run.done({"back", "2.3"}), "run 4 is at tick 200, seed 1\n") << "kept since";
  EXPECT_EQ(run.done({"back", "1.3"}), "run 5 is at tick 120, seed 1\n");
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], reference(field));
}

TEST(ControlAtTickBoundariesOnly, ReportsEventsAndTheEarliestKeptSnapshot) {
  const FieldOfRobots field(4, 5.0);
  ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"});
  ControlClient client = client_of(run);
  const wire::SetSpeed faster{2.0};
  run.done({"step", "120"});
  ASSERT_TRUE(client.ask(faster, patience, never));
  run.done({"step", "10"});
  ASSERT_TRUE(client.ask(faster, patience, never));
  const auto history = [&] { return nlohmann::json::parse(run.done({"history", "--json"})); };
  const auto told = history();
  EXPECT_EQ(told["begin_tick"], 0);
  EXPECT_EQ(told["kept"]["first_tick"], 0);
  EXPECT_EQ(told["kept"]["last_tick"], 100);
  EXPECT_EQ(told["kept"]["interval"], 50);
  const auto& events = told["events"];
  EXPECT_TRUE(std::ranges::is_sorted(events, {}, [](const auto& event) { return event["tick"].template get<int>(); }));
  const auto speed = std::ranges::find_if(
      events, [](const auto& event) { return event["text"].template get<std::string>().starts_with("SetSpeed: "); });
  ASSERT_NE(speed, events.end()) << told.dump(2);
  EXPECT_EQ((*speed)["kind"], "control");
  EXPECT_EQ((*speed)["count"], 2);
  EXPECT_EQ((*speed)["tick"], 120);
  EXPECT_EQ((*speed)["last_tick"], 130);
  EXPECT_NE(run.done({"history"}).find("snapshots to go back to: from 0.000 s to 1.000 s"), std::string::npos);
  run.done({"back", "0.7"});
  EXPECT_EQ(history()["begin_tick"], 50);
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, RejectsGoingBackBeforeTheFirstKeptSnapshot) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "10"});
  const Ended refused = run_to_end(run.ctl({"back", "0.05"}));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--keep-snapshots"), std::string::npos) << refused.err;
  EXPECT_EQ(run.tick(), 10u);
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, LargeDataIsSentInPartsAndIsBounded) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  Control control = control_of(run);
  const std::vector<std::byte> nonsense(20'000'000, std::byte{'x'});
  try {
    control.load_snapshot(nonsense);
    ADD_FAILURE() << "it loads anything";
  } catch (const ControlError& error) {
    EXPECT_NE(std::string(error.what()).find("this is not a snapshot"), std::string::npos) << error.what();
  }
  const std::vector<std::byte> too_large(wire::largest_data + 1);
  EXPECT_THROW(control.load_snapshot(too_large), ControlError);
  EXPECT_EQ(run.done({"step"}), "paused at tick 1\n");
  run.done({"shutdown"});
  run.finish();
}

TEST(ControlAtTickBoundariesOnly, SnapshotsOfManyRobotsArriveComplete) {
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

}  // namespace
}  // namespace cohort::test
