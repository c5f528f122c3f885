// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "server/lockstep/answer_times.hpp"
#include "server/run/exchange.hpp"
#include "server/run/playback.hpp"
#include "server/run/session_snapshot.hpp"
#include "server/serving/control/requests/request_ledger.hpp"
#include "tests/support/robots.hpp"

namespace cohort::session {
namespace {

using namespace std::chrono_literals;
using namespace test;
using Receipt = RequestLedger::Receipt;

TEST(Playback, CarriesOutStepsOfSeveralClientsInSequence) {
  Playback playback(PlaybackState::paused);
  EXPECT_TRUE(playback.holds());
  playback.step(7, 3, 0xa, 1);
  playback.step(7, 2, 0xb, 5);
  EXPECT_EQ(playback.state(), PlaybackState::playing);
  EXPECT_TRUE(playback.reached(9).empty());
  const auto first = playback.reached(10);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].client, 0xau);
  EXPECT_FALSE(playback.holds());
  const auto second = playback.reached(12);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].number, 5u);
  EXPECT_EQ(playback.state(), PlaybackState::paused);
  EXPECT_TRUE(playback.holds());
}

TEST(Playback, CancelsRemainingStepsWhenPausedOrResumed) {
  Playback playback(PlaybackState::paused);
  playback.step(0, 100, 0xa, 1);
  const auto given_up = playback.set(PlaybackState::playing);
  ASSERT_EQ(given_up.size(), 1u);
  EXPECT_EQ(given_up[0].until, 100u);
  EXPECT_FALSE(playback.holds());
  EXPECT_TRUE(playback.reached(100).empty());
}

wire::Reply reply_to(std::uint64_t client, std::uint64_t number, const std::string& text) {
  wire::Reply reply;
  reply.client = client;
  reply.number = number;
  reply.error_message = text;
  return reply;
}

TEST(RequestLedger, CarriesOutNoRequestTwiceAndRemembersItsReply) {
  RequestLedger ledger;
  ASSERT_TRUE(ledger.is_in_own_name(1, 0xaa));
  EXPECT_EQ(ledger.receive(1, 1), Receipt::fresh);
  EXPECT_EQ(ledger.receive(1, 1), Receipt::under_way);
  ledger.keep(reply_to(1, 1, "done"));
  EXPECT_EQ(ledger.receive(1, 1), Receipt::answered);
  EXPECT_EQ(ledger.remembered(1, 1).error_message, "done");
  // The one before is lost, and comes after its successor.
  EXPECT_EQ(ledger.receive(1, 3), Receipt::fresh);
  EXPECT_EQ(ledger.receive(1, 2), Receipt::fresh);
}

TEST(RequestLedger, ForgetsOnlyRepliesThatCannotBeRequestedAgain) {
  RequestLedger ledger;
  ASSERT_TRUE(ledger.is_in_own_name(1, 0xaa));
  for (std::uint64_t number = 1; number <= 40; ++number) {
    ASSERT_EQ(ledger.receive(1, number), Receipt::fresh) << number;
    ledger.keep(reply_to(1, number, std::to_string(number)));
  }
  EXPECT_EQ(ledger.receive(1, 24), Receipt::forgotten);
  EXPECT_EQ(ledger.receive(1, 1), Receipt::forgotten) << "and is not done again";
  EXPECT_EQ(ledger.receive(1, 25), Receipt::answered);
}

TEST(RequestLedger, BoundsTheRequestsInProgressOfOneClient) {
  RequestLedger ledger;
  ASSERT_TRUE(ledger.is_in_own_name(1, 0xaa));
  for (std::uint64_t number = 1; number <= wire::requests_under_way; ++number)
    ASSERT_EQ(ledger.receive(1, number), Receipt::fresh);
  EXPECT_EQ(ledger.receive(1, 17), Receipt::too_many);
  ledger.keep(reply_to(1, 1, "done"));
  EXPECT_EQ(ledger.receive(1, 17), Receipt::fresh);
}

TEST(RequestLedger, AcceptsAClientIdFromOneParticipantOnly) {
  RequestLedger ledger;
  EXPECT_TRUE(ledger.is_in_own_name(1, 0xaa));
  EXPECT_FALSE(ledger.is_in_own_name(1, 0xbb)) << "another's name";
  EXPECT_FALSE(ledger.is_in_own_name(2, 0xaa)) << "a second name";
  for (std::uint64_t client = 10; client < 10'000; ++client) ledger.is_in_own_name(client, 0x1000 + client);
  EXPECT_TRUE(ledger.is_in_own_name(9'999, 0x1000 + 9'999));
}

std::vector<std::uint8_t> numbered(std::size_t count, std::uint8_t first) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(first + i);
  return bytes;
}

TEST(RequestLedger, AssemblesPartsDespiteRepetitions) {
  RequestLedger ledger;
  EXPECT_FALSE(ledger.take_part(1, 250, 0, numbered(100, 0), 0ns));
  EXPECT_FALSE(ledger.take_all(1)) << "not yet";
  EXPECT_FALSE(ledger.take_part(1, 250, 100, numbered(100, 100), 0ns));
  EXPECT_FALSE(ledger.take_part(1, 250, 100, numbered(100, 100), 0ns)) << "again";
  EXPECT_TRUE(ledger.take_part(1, 250, 240, numbered(10, 0), 0ns)) << "a gap";
  EXPECT_FALSE(ledger.take_part(1, 250, 200, numbered(50, 200), 0ns));
  const auto all = ledger.take_all(1);
  ASSERT_TRUE(all);
  const auto expected = numbered(250, 0);
  EXPECT_TRUE(std::ranges::equal(*all, std::as_bytes(std::span(expected))));
  EXPECT_FALSE(ledger.take_all(1)) << "it is gone";
}

TEST(RequestLedger, RejectsInvalidParts) {
  RequestLedger ledger;
  EXPECT_TRUE(ledger.take_part(1, wire::largest_data + 1, 0, {}, 0ns));
  EXPECT_TRUE(ledger.take_part(1, wire::largest_data, 0, numbered(wire::largest_part + 1, 0), 0ns));
  EXPECT_TRUE(ledger.take_part(1, 10, 0, numbered(11, 0), 0ns));
  EXPECT_TRUE(ledger.take_part(1, 10, 5, numbered(5, 0), 0ns)) << "it has not begun";
  EXPECT_TRUE(ledger.take_part(1, 10, ~std::uint64_t{0}, numbered(5, 0), 0ns));
  EXPECT_FALSE(ledger.take_part(1, 10, 0, numbered(5, 0), 0ns));
  EXPECT_TRUE(ledger.take_part(1, 11, 5, numbered(5, 0), 0ns)) << "another size";
}

TEST(RequestLedger, ReturnsDataInPartsAndTheReasonWhenItWasDropped) {
  RequestLedger ledger;
  const std::vector<std::byte> data(wire::largest_part + 10, std::byte{7});
  const auto shared = [](std::vector<std::byte> bytes) {
    return std::make_shared<const std::vector<std::byte>>(std::move(bytes));
  };
  ledger.offer(1, shared(data), 0ns);
  ledger.offer(2, shared({std::byte{1}}), 0ns);
  EXPECT_EQ(ledger.part(1, 0)->bytes.size(), wire::largest_part);
  EXPECT_EQ(ledger.part(1, wire::largest_part)->bytes.size(), 10u);
  EXPECT_EQ(ledger.part(1, wire::largest_part)->size, data.size());
  EXPECT_TRUE(ledger.part(1, ~std::uint64_t{0})->bytes.empty());
  EXPECT_FALSE(ledger.part(3, 0));
  const auto both = shared(data);
  ledger.offer(3, both, 1ns);
  ledger.offer(4, both, 2ns);
  std::vector<KeptForClient> kept;
  ledger.list(kept);
  ASSERT_EQ(kept.size(), 3u) << "what two share is kept once";
  ledger.drop(*std::ranges::find(kept, 4u, &KeptForClient::client), "too much");
  EXPECT_FALSE(ledger.part(3, 0));
  EXPECT_FALSE(ledger.part(4, 0));
  EXPECT_TRUE(ledger.part(2, 0));
  EXPECT_EQ(ledger.why_dropped(3, KeptForClient::Kind::saved_snapshot), "too much");
  EXPECT_EQ(ledger.why_dropped(2, KeptForClient::Kind::saved_snapshot), "");
  ledger.offer(3, both, 3ns);
  EXPECT_EQ(ledger.why_dropped(3, KeptForClient::Kind::saved_snapshot), "") << "it is there again";
}

TEST(RequestLedger, ReportsWhyAnUploadWasDropped) {
  RequestLedger ledger;
  EXPECT_FALSE(ledger.take_part(1, 250, 0, numbered(100, 0), 0ns));
  std::vector<KeptForClient> kept;
  ledger.list(kept);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_GE(kept[0].bytes, 100u);
  EXPECT_LE(kept[0].bytes, 250u);
  ledger.drop(kept[0], "too much");
  EXPECT_EQ(ledger.take_part(1, 250, 100, numbered(100, 100), 1ns), "too much");
  EXPECT_FALSE(ledger.take_part(1, 250, 0, numbered(100, 0), 2ns)) << "it may begin again";
}

TEST(KeptForClient, TheOldestIsDroppedUntilTheRestFits) {
  using Kind = KeptForClient::Kind;
  const std::vector<KeptForClient> kept = {
      {Kind::recording, 1, 30ns, 50}, {Kind::upload, 2, 10ns, 40}, {Kind::saved_snapshot, 3, 20ns, 30}};
  EXPECT_TRUE(what_goes(kept, 120).empty());
  const auto one = what_goes(kept, 119);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].client, 2u);
  const auto two = what_goes(kept, 50);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[1].client, 3u);
  EXPECT_EQ(what_goes(kept, 0).size(), 3u);
}

TEST(AnswerTimes, CountFromTheFirstSendingOfEachFrame) {
  lockstep::AnswerTimes times;
  times.sent(0, 100ns);
  times.sent(1, 200ns);
  times.sent(0, 900ns);  // again
  times.answered(1, 230ns);
  times.answered(0, 1100ns);
  times.answered(0, 5000ns);  // it is answered
  EXPECT_EQ(times.histogram().count(), 2u);
  EXPECT_EQ(times.histogram().quantile(0.0), 30ns);
  EXPECT_EQ(times.histogram().max(), 1000ns);
  for (std::uint64_t tick = 2; tick < 1000; ++tick) times.sent(tick, 0ns);
  times.answered(2, 7ns);
  EXPECT_EQ(times.histogram().count(), 2u) << "so old a one is forgotten";
}

// Three robots: at once, with a delay, and every second tick with a delay.
description::Experiment experiment_with_delays() {
  using description::OnLate;
  description::Experiment experiment;
  experiment.name = "delays";
  experiment.world = world_with_floor();
  experiment.duration = 1s;
  const std::vector<description::Policy> policies = {
      {}, {1, 0, 2, OnLate::hold, std::chrono::seconds(1)}, {2, 1, 3, OnLate::hold, std::chrono::seconds(1)}};
  for (std::uint32_t robot = 0; robot < policies.size(); ++robot) {
    place(experiment.world, tracked_robot(), "robot_" + std::to_string(robot), at(0.0, robot, 0.0));
    experiment.teams.push_back({"team_" + std::to_string(robot), {robot}, "none", policies[robot]});
  }
  return experiment;
}

// Answers whose values depend on the frame; those to frames of robots with a delay come one tick late.
class Answers {
 public:
  void run(Simulation& simulation, Exchange& exchange, std::uint64_t until) {
    while (simulation.tick() < until) {
      exchange.open({});
      for (std::uint32_t robot = 0; robot < 3; ++robot) {
        const std::uint64_t tick = simulation.tick();
        const std::uint64_t frame = robot == 0 || tick == 0 ? tick : tick - 1;
        const std::vector<std::uint32_t> one = {robot};
        Exchange::Frame due;
        exchange.fill_frame(due, one, frame);
        if (due.robots.empty()) continue;
        const double speed = 0.1 + 0.01 * static_cast<double>(frame % 7) + 0.001 * due.values[2];
        exchange.take(one, frame, one, std::vector<double>{speed, -0.5 * speed, 0.1});
      }
      exchange.barrier().expire(10s);
      exchange.apply();
      simulation.step();
    }
  }
};

TEST(SessionSnapshot, RestoresPendingAnswersBitForBit) {
  const auto experiment = experiment_with_delays();
  Simulation straight(experiment, 1);
  Exchange exchange(straight);
  Answers().run(straight, exchange, 11);
  const auto bytes = to_bytes(take_snapshot(experiment, straight, exchange));
  EXPECT_FALSE(exchange.barrier().unanswered(1).empty()) << "some frames have no answer yet";
  Answers().run(straight, exchange, 40);

  const SessionSnapshot snapshot = snapshot_from_bytes(bytes);
  EXPECT_EQ(snapshot.tick, 11u);
  Simulation simulation(experiment, 2);
  restore(snapshot, simulation);
  Exchange restored(simulation);
  restore(snapshot, restored);
  EXPECT_EQ(to_bytes(take_snapshot(experiment, simulation, restored)), bytes);
  Answers().run(simulation, restored, 40);
  EXPECT_EQ(simulation.state_hash(), straight.state_hash());

  // Without what the barrier holds it is another run.
  Simulation forgetful(experiment, 1);
  restore(snapshot, forgetful);
  Exchange empty(forgetful);
  Answers().run(forgetful, empty, 40);
  EXPECT_NE(forgetful.state_hash(), straight.state_hash());
}

TEST(SessionSnapshot, ADetachedRobotStaysDetached) {
  auto experiment = experiment_with_delays();
  experiment.teams[0].policy = {1, 0, 0, description::OnLate::detach, 1s};
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  exchange.open({});
  exchange.barrier().expire(2s);
  exchange.apply();
  simulation.step();
  const SessionSnapshot snapshot = take_snapshot(experiment, simulation, exchange);
  Simulation again(experiment, 1);
  restore(snapshot, again);
  Exchange restored(again);
  restore(snapshot, restored);
  EXPECT_TRUE(restored.barrier().is_detached(0));
  EXPECT_FALSE(restored.barrier().is_detached(1));
}

TEST(SessionSnapshot, ReportsWhyItDoesNotMatch) {
  auto experiment = experiment_with_delays();
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  const SessionSnapshot snapshot = take_snapshot(experiment, simulation, exchange);
  const auto bytes = to_bytes(snapshot);
  const auto complaint = [](std::vector<std::byte> damaged) -> std::string {
    try {
      snapshot_from_bytes(damaged);
    } catch (const SnapshotError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(bytes), "");
  auto damaged = bytes;
  damaged[damaged.size() / 2] ^= std::byte{1};
  EXPECT_NE(complaint(damaged).find("damaged"), std::string::npos) << complaint(damaged);
  EXPECT_NE(complaint(std::vector(bytes.begin(), bytes.end() - 1)).find("incomplete"), std::string::npos);
  EXPECT_NE(complaint({}).find("only 0 bytes"), std::string::npos);
  damaged = bytes;
  damaged[20] = std::byte{'9'};  // in Cohort's version
  EXPECT_NE(complaint(damaged).find("of Cohort, which version"), std::string::npos) << complaint(damaged);
  for (std::size_t size = 0; size < bytes.size(); size += 97)
    EXPECT_NE(complaint(std::vector(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))), "") << size;

  experiment.name = "another";
  EXPECT_THROW(expect_same_experiment(snapshot, experiment), SnapshotError);
  // Another barrier than this one's.
  experiment.teams[1].policy.delay = 5;
  Simulation other(experiment, 1);
  Exchange others(other);
  EXPECT_THROW(restore(snapshot, others), SnapshotError);
}

TEST(SessionSnapshot, ContainsControllerStateAndNamesTeamsWithoutState) {
  const auto experiment = experiment_with_delays();
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  Answers().run(simulation, exchange, 3);
  ControllerStates states(simulation.robot_count(), ControllerState{"Remembering", {std::byte{1}, std::byte{2}}});
  states[1].reset();
  const SessionSnapshot snapshot =
      snapshot_from_bytes(to_bytes(take_snapshot(experiment, simulation, exchange, states)));
  EXPECT_EQ(snapshot.controllers, states);
  EXPECT_EQ(states_of(snapshot, std::vector<std::uint32_t>{0, 1}), (std::vector<RobotState>{{0, states[0]}}));
  const auto left_out = what_is_left_out(snapshot, experiment);
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_NE(left_out[0].find("'" + experiment.teams[1].name + "' (" + experiment.teams[1].controller + ")"),
            std::string::npos)
      << left_out[0];
  SessionSnapshot early = snapshot;
  early.tick = 0;
  EXPECT_TRUE(what_is_left_out(early, experiment).empty()) << "there is nothing to remember yet";
}

TEST(SessionSnapshot, IdentifiesTheBuildThatTookIt) {
  const auto experiment = experiment_with_delays();
  Simulation simulation(experiment, 1);
  const Exchange exchange(simulation);
  SessionSnapshot snapshot = take_snapshot(experiment, simulation, exchange);
  EXPECT_EQ(snapshot_from_bytes(to_bytes(snapshot)).build.arithmetic, this_build().arithmetic);
  snapshot.build.commit = "0123456789ab";
  snapshot.build.arithmetic = "0123456789abcdef";
  snapshot.build.version = "0.1.0";
  const SessionSnapshot of_other_build = snapshot_from_bytes(to_bytes(snapshot));
  EXPECT_EQ(of_other_build.build.commit, "0123456789ab");
  EXPECT_NE(why_results_differ(of_other_build.build), "");
}

TEST(SessionSnapshot, RejectsInvalidState) {
  const auto experiment = experiment_with_delays();
  Simulation simulation(experiment, 1);
  Exchange exchange(simulation);
  SessionSnapshot snapshot = take_snapshot(experiment, simulation, exchange);
  snapshot.controllers.resize(simulation.robot_count() + 1);
  Simulation other(experiment, 1);
  EXPECT_THROW(restore(snapshot, other), SnapshotError) << "of more robots than there are";
  snapshot.controllers = {ControllerState{"Hoarding", std::vector<std::byte>(largest_state + 1)}};
  EXPECT_THROW(snapshot_from_bytes(to_bytes(snapshot)), SnapshotError) << "larger than it may be";
}

// Megabytes: as large as may be, and what it costs to put into bytes and back.
TEST(SessionSnapshot, MayBeLarge) {
  SessionSnapshot large{"large", 1, 2, std::vector<std::byte>(40'000'000, std::byte{3}), {}};
  large.simulation[12'345'678] = std::byte{4};
  const SessionSnapshot back = snapshot_from_bytes(to_bytes(large));
  EXPECT_TRUE(back.simulation == large.simulation);
}

}  // namespace
}  // namespace cohort::session
