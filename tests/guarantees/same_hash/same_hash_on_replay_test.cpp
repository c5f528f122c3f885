// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <memory>

#include "server/recording/mcap/writing/mcap_writer.hpp"
#include "server/recording/replay.hpp"
#include "tests/guarantees/same_hash/names_of_experiments.hpp"
#include "tests/support/controlled_run.hpp"
#include "tests/support/free_domain.hpp"

namespace cohort::test {
namespace {

using recording::Commands;
using recording::Recording;
using recording::Verification;

Verification verified(const std::filesystem::path& file, double from = 0.0, double to = 1e9, unsigned threads = 2) {
  const Recording recorded(file);
  EXPECT_EQ(recorded.damage(), "");
  recording::Replay replay(recorded, threads);
  const auto time = [](double seconds) { return std::chrono::nanoseconds(std::llround(seconds * 1e9)); };
  return recording::verify(replay, time(from), time(to), [](std::chrono::nanoseconds) { return true; });
}

void expect_identical(const Verification& found, std::uint64_t boundaries) {
  EXPECT_EQ(found.problem, "");
  EXPECT_FALSE(found.difference) << "at tick " << found.difference->tick;
  EXPECT_EQ(found.boundaries, boundaries);
}

// All but the one whose robot is driven by a person.
std::vector<std::string> replayed_experiments() {
  std::vector<std::string> names = names_of_experiments();
  std::erase(names, "teleop");
  return names;
}

class SameHashOnReplay : public ::testing::TestWithParam<std::string> {};

TEST_P(SameHashOnReplay, OfAShippedExperiment) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "run.mcap";
  const auto summary = run_experiment(COHORT_SOURCE_DIR "/worlds/experiments/" + GetParam() + ".yaml",
                                      {"--controllers", "inprocess", "--duration", "12", "--record", file,
                                       "--record-snapshots", "5", "--record-observations", "10"});
  const std::uint64_t ticks = summary["ticks"];
  expect_identical(verified(file), ticks + 1);
  const std::chrono::nanoseconds time(summary["sim_time_ns"].get<std::int64_t>());
  const std::chrono::nanoseconds step = time / static_cast<std::int64_t>(ticks);
  if (time > std::chrono::seconds(8))  // from the snapshot at 5 s
    expect_identical(verified(file, 7.0, 8.0, 1), static_cast<std::uint64_t>(std::chrono::seconds(1) / step) + 1);
}

INSTANTIATE_TEST_SUITE_P(Experiments, SameHashOnReplay, ::testing::ValuesIn(replayed_experiments()),
                         [](const auto& each) { return each.param; });

TEST(SameHashOnReplayOf, ARunWithDeletedFiles) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder / "run.mcap";
  std::uint64_t ticks = 0;
  {
    const FieldOfRobots field(4, 3.0);
    ticks = run_experiment(field.file(), {"--controllers", "per-robot", "--record", file})["ticks"];
  }
  expect_identical(verified(file), ticks + 1);
}

// Robots without a controller, late joins, kills, and a controller that returns.
TEST(SameHashOnReplayOf, ARunWithLateJoinsAndCrashes) {
  const FieldOfRobots field(4, 10.0, ", required: false");
  const ReservedDomain domain;
  const std::filesystem::path file = field / "run.mcap";
  Process server(field.serve(domain, {"--paused", "--record", file}), {{"COHORT_LOG", "info"}});
  control(domain, {"step", "100"});
  Process early(FieldOfRobots::host(domain, "0..1"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_0")) << server.output();
  control(domain, {"step", "100"});
  Process late(FieldOfRobots::host(domain, "2"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_2")) << server.output();
  control(domain, {"step", "100"});
  early.signal(SIGKILL);
  ASSERT_TRUE(server.wait_for_output("the controller of swarm/sbot_0 and 1 more, is gone")) << server.output();
  control(domain, {"step", "100"});
  Process again(FieldOfRobots::host(domain, "1"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_1")) << server.output();
  control(domain, {"resume"});
  ASSERT_EQ(server.wait_for_exit(), 0) << server.output();
  expect_identical(verified(file), 1001);
}

// Every operation of `cohort ctl` on a world, a reset with another seed, and a return to a snapshot.
TEST(SameHashOnReplayOf, ARunWithControlRequests) {
  const FieldOfRobots field(4, 6.0);
  const std::filesystem::path file = field / "run.mcap";
  const std::string saved = field / "saved";
  const std::string box = field / "box.sdf";
  write_file(box,
             "<sdf version='1.9'><model name='box'><link name='body'><collision name='c'><geometry><box><size>0.1 0.1 "
             "0.1</size></box></geometry></collision></link></model></sdf>");
  ControlledRun run(field, {"--paused", "--record", file, "--record-snapshots", "1"});
  run.done({"step", "100"});
  run.done({"set-pose", "swarm/sbot_1", "--pose", "2 2 0.1 0 0 1"});
  run.done({"set-velocity", "swarm/sbot_2", "--linear", "0.3 0 0"});
  run.done({"step", "50"});
  run.done({"spawn", box, "--name", "crate", "--pose", "1.5 0 0.5"});
  run.done({"save", saved});
  run.done({"apply-force", "crate", "--force", "0 2 20", "--duration", "0.2"});
  run.done({"step", "70"});
  run.done({"load", saved});
  run.done({"step", "30"});
  run.done({"remove", "crate"});
  run.done({"step", "20"});
  run.done({"reset", "--seed", "9"});
  run.done({"step", "10"});
  run.done({"apply-force", "swarm/sbot_0", "--force", "0 5 0", "--duration", "0.1"});
  run.done({"resume"});
  run.finish();

  const Recording recorded(file);
  ASSERT_EQ(recorded.worlds().size(), 3u);
  EXPECT_EQ(recorded.worlds()[1].begins.tick, 150u);
  EXPECT_EQ(recorded.worlds()[2].begins.seed, 9u);
  expect_identical(verified(file), 221 + 51 + 601);
  // The second world begins at 2.21 s of the recording, so this is its tick 170.
  expect_identical(verified(file, 2.41, 2.42), 2);
}

// Answers that miss their deadlines, under each policy that continues the run.
TEST(SameHashOnReplayOf, ARunWithMissedDeadlines) {
  for (const char* on_late : {"hold", "zero", "detach"}) {
    const FieldOfRobots field(3, 20.0, ", delay: 1, deadline: 0.05, on_late: " + std::string(on_late));
    const ReservedDomain domain;
    const std::filesystem::path file = field / "run.mcap";
    Process server(field.serve(domain, {"--paused", "--speed", "4", "--record", file}), {{"COHORT_LOG", "info"}});
    Process all(FieldOfRobots::host(domain, "0..1"));
    Process stopped(FieldOfRobots::host(domain, "2"));
    control(domain, {"step", "100"});
    stopped.signal(SIGSTOP);
    control(domain, {"resume"});
    ASSERT_TRUE(server.wait_for_output("missed: swarm/sbot_2")) << server.output();
    stopped.signal(SIGCONT);
    ASSERT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_GT(field.summary()["late"], 0);
    expect_identical(verified(file), 2001);
  }
}

// Copies a recording and changes one bit of one command of a tick.
void plant_a_change(const std::filesystem::path& from, const std::filesystem::path& to, std::uint64_t tick) {
  const recording::McapReader reader(from);
  std::ofstream file(to, std::ios::binary);
  recording::McapWriter writer([&](recording::ByteView bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  });
  for (const auto& [id, schema] : reader.schemas()) writer.add(schema);
  for (const auto& [id, channel] : reader.channels()) writer.add(channel);
  for (const auto& index : reader.attachments()) writer.add_attachment(reader.attachment(index));
  for (const auto& index : reader.metadata()) writer.add_metadata(reader.metadata(index));
  const recording::ChannelId commands = reader.channel(Commands::topic)->id;
  bool is_planted = false;
  for (auto stream = reader.messages({.order = recording::Order::file}); const auto message = stream.next();) {
    recording::Bytes bytes(message->data.begin(), message->data.end());
    if (message->channel == commands) {
      auto decoded = messages::decode<Commands>(bytes);
      if (decoded.tick == tick) {
        double& value = decoded.values.front();
        value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1U);
        bytes = messages::encode(decoded);
        is_planted = true;
      }
    }
    writer.write_message(message->channel, message->sequence, message->log_time, message->publish_time, bytes);
  }
  writer.close();
  ASSERT_TRUE(is_planted) << "no command changes at tick " << tick;
}

TEST(SameHashOnReplayOf, ARecordingDetectsOneChangedBitOfACommand) {
  const ScratchFolder folder;
  run_demo({"--controllers", "inprocess", "--duration", "3", "--record", folder / "run.mcap"});
  std::uint64_t tick = 0;  // one whose commands changed
  {
    const Recording recorded(folder / "run.mcap");
    auto ticks = recorded.ticks(std::chrono::milliseconds(1500));
    while (const auto each = ticks.next()) {
      tick = each->tick;
      if (!each->commands.robots.empty()) break;
    }
  }
  plant_a_change(folder / "run.mcap", folder / "changed.mcap", tick);
  const Verification found = verified(folder / "changed.mcap");
  ASSERT_TRUE(found.difference) << found.problem;
  EXPECT_EQ(found.difference->tick, tick + 1) << "the boundary that the command led to";
  EXPECT_EQ(found.boundaries, tick + 1);

  const auto ended = run_to_end({cohort_program(), "replay", folder / "changed.mcap", "--verify"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.out.find("differs at tick " + std::to_string(tick + 1)), std::string::npos) << ended.out;
  const auto whole = run_to_end({cohort_program(), "replay", folder / "run.mcap", "--verify"});
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_EQ(whole.out, "identical, 301 ticks\n");
}

// Counts the boundaries of a recording that is being written.
std::uint64_t boundaries_on_disk(const std::filesystem::path& file) {
  try {
    const Recording so_far(file);
    auto ticks = so_far.ticks();
    std::uint64_t count = 0;
    while (ticks.next()) ++count;
    return count;
  } catch (const std::exception&) {
    return 0;  // its beginning is not yet there
  }
}

// The recording of a killed server can be replayed.
TEST(SameHashOnReplayOf, AKilledServer) {
  const FieldOfRobots field(4, 100.0);
  const ReservedDomain domain;
  const std::filesystem::path file = field / "run.mcap";
  Process server(field.serve(domain, {"--speed", "2", "--record", file}));
  Process controllers(FieldOfRobots::host(domain, "all"));
  ASSERT_TRUE(server.wait_for_output("simulated")) << server.output();
  ASSERT_TRUE(test::eventually([&] { return boundaries_on_disk(file) > 200; })) << server.output();
  server.signal(SIGKILL);
  server.wait_for_exit();
  const Recording recorded(file);
  EXPECT_NE(recorded.damage(), "");
  recording::Replay replay(recorded, 2);
  const Verification found =
      recording::verify(replay, {}, std::chrono::nanoseconds::max(), [](std::chrono::nanoseconds) { return true; });
  EXPECT_EQ(found.problem, "");
  EXPECT_FALSE(found.difference);
  EXPECT_GT(found.boundaries, 100u);
}

}  // namespace
}  // namespace cohort::test
