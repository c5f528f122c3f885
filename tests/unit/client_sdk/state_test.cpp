// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/state_parts.hpp"
#include "client_sdk/include/cohort/cohort.h"
#include "tests/support/counting_controller.hpp"

namespace cohort {
namespace {

using namespace test;
using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

enum class Mood : std::uint8_t { calm, busy, tired };

Bytes bytes_of(const StateWriter& writer) { return {writer.bytes().begin(), writer.bytes().end()}; }

TEST(State, IsReadAsItWasWritten) {
  std::mt19937_64 random(7);
  random();
  StateWriter writer;
  writer.write(Mood::busy, 1.5, true, std::uint16_t{7}, 250ms, std::string("text"), std::vector<double>{1.0, 2.0},
               random);
  StateReader reader(writer.bytes());
  Mood mood{};
  double real = 0.0;
  bool flag = false;
  std::uint16_t number = 0;
  std::chrono::milliseconds time{0};
  std::string text;
  std::vector<double> values;
  std::mt19937_64 other;
  reader.read_up_to(mood, Mood::tired);
  reader.read(real, flag, number, time, text, values, other);
  EXPECT_TRUE(reader.rest().empty());
  EXPECT_EQ(mood, Mood::busy);
  EXPECT_EQ(real, 1.5);
  EXPECT_TRUE(flag);
  EXPECT_EQ(number, 7);
  EXPECT_EQ(time, 250ms);
  EXPECT_EQ(text, "text");
  EXPECT_EQ(values, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(other(), random());
}

TEST(State, ThatCannotBeIsRefused) {
  StateWriter writer;
  writer.write(std::uint8_t{3}, std::uint64_t{1} << 60);
  std::vector<double> values;
  std::string text;
  bool flag = false;
  Mood mood{};
  double real = 0.0;
  std::mt19937_64 random;
  EXPECT_THROW(StateReader(writer.bytes()).read(flag), StateError);
  EXPECT_THROW(StateReader(writer.bytes()).read_up_to(mood, Mood::tired), StateError);
  EXPECT_THROW(StateReader(writer.bytes().subspan(1)).read(values), StateError);
  EXPECT_THROW(StateReader(writer.bytes().subspan(1)).read(text), StateError);
  EXPECT_THROW(StateReader(writer.bytes().subspan(2)).read(real), StateError);
  StateWriter words;
  words.write(std::string("no generator"));
  EXPECT_THROW(StateReader(words.bytes()).read(random), StateError);
}

TEST(State, OfRobotsIsPackedAsBytes) {
  const std::vector<RobotState> states = {
      {2, ControllerState{"Counting", Bytes(5, std::byte{1})}}, {3, {}}, {7, ControllerState{"Other", {}}}};
  const Bytes packed = pack(states);
  EXPECT_EQ(unpack(packed), states);
  EXPECT_LE(packed.size(), largest_packed(states.size()));
  EXPECT_TRUE(unpack({}).empty());
  for (std::size_t size = 1; size < packed.size(); ++size) {
    try {
      unpack(std::span(packed).first(size));
    } catch (const StateError&) {
    }
  }
  EXPECT_THROW(unpack(std::span(packed).first(packed.size() - 1)), StateError);
  Bytes twice = packed;
  twice.insert(twice.end(), packed.begin(), packed.end());
  EXPECT_THROW(unpack(twice), StateError) << "its robots do not ascend";
}

TEST(StateParts, AreRequestedUntilTheStateIsComplete) {
  const Bytes all(wire::largest_state_part + 10, std::byte{9});
  StateParts parts;
  parts.begin(all.size(), 100ms);
  EXPECT_TRUE(parts.is_due(100ms));
  parts.note_question(100ms);
  EXPECT_FALSE(parts.is_due(110ms));
  EXPECT_TRUE(parts.is_due(150ms)) << "again";
  const auto give = [&](std::uint64_t offset, StateParts::Time now) {
    const wire::ControllerState part = part_of(all, offset);
    return parts.take(part.data, part.offset, part.size, now);
  };
  EXPECT_TRUE(give(0, 160ms));
  EXPECT_EQ(parts.heard_at(), 160ms);
  EXPECT_FALSE(give(0, 170ms)) << "once more";
  EXPECT_TRUE(parts.is_due(170ms)) << "the next at once";
  EXPECT_FALSE(parts.is_complete());
  EXPECT_TRUE(give(parts.offset(), 180ms));
  EXPECT_TRUE(parts.is_complete());
  EXPECT_TRUE(std::ranges::equal(parts.bytes(), all));
}

TEST(StateParts, ThatDoNotFitAreRefused) {
  const std::vector<std::uint8_t> data(10);
  StateParts parts;
  parts.begin(15, 0ms);
  EXPECT_THROW(parts.take(data, 0, 16, 0ms), StateError) << "more than is possible";
  EXPECT_THROW(parts.take(data, 0, 9, 0ms), StateError) << "more than there is";
  EXPECT_THROW(parts.take({}, 0, 9, 0ms), StateError) << "nothing, and no end";
  EXPECT_TRUE(parts.take(data, 0, 15, 0ms));
  EXPECT_THROW(parts.take(std::span(data).first(4), 10, 14, 0ms), StateError) << "of something else";
  parts.begin(15, 0ms);
  EXPECT_TRUE(parts.take({}, 0, 0, 0ms)) << "nothing at all";
  EXPECT_TRUE(parts.is_complete());
}

// Counts its steps, and saves the count.
class RememberingController : public Controller {
 public:
  void start(const Start& start) override {
    count_ = start.command("count/0/steps");
    steps_ = 0;
  }
  void step(const Observation&, Command& command) override { command.set(count_, ++steps_); }
  void save(StateWriter& state) const override { state.write(steps_); }
  void load(StateReader& state) override {
    state.read(steps_);
    if (steps_ < 0) throw std::runtime_error("that cannot be");
  }

 private:
  CommandChannel count_;
  std::int32_t steps_ = 0;
};

ControllerKind remembering(const std::string& name = "remembering") {
  return {name, [] { return OwnedController(new RememberingController, [](Controller* it) { delete it; }); }};
}

class RememberedState : public testing::Test {
 protected:
  void start(ControllerHost& host, wire::StartReason reason = wire::StartReason::first) {
    wire::Admit admit{.start_reason = reason, .tick = 100, .step_ns = 10'000'000};
    for (const std::uint32_t robot : {3u, 4u})
      admit.robots.push_back({.robot = robot, .name = "r" + std::to_string(robot)});
    host.start(admit, descriptions);
  }
  double steps_of(ControllerHost& host, std::uint32_t robot) {
    const std::vector<std::uint32_t> robots{robot};
    return host.answer({.tick = 100, .robots = robots, .values = std::vector<double>{0.5}})[0];
  }
  std::string failure_of_load(const std::vector<RobotState>& states) {
    ControllerHost host(remembering());
    start(host);
    try {
      host.load(states);
    } catch (const ControllerFailure& failure) {
      return failure.what();
    }
    return "it did not fail";
  }

  std::vector<wire::RobotDescription> descriptions{CountingController::description()};
};

class ForgetfulController final : public StatelessController {
 public:
  void start(const Start&) override {}
  void step(const Observation&, Command&) override {}
};

TEST_F(RememberedState, OfAStatelessControllerIsSavedAsNothing) {
  ControllerHost host(
      {"forgetful", [] { return OwnedController(new ForgetfulController, [](Controller* it) { delete it; }); }});
  start(host);
  const std::vector<RobotState> states = host.save();
  ASSERT_EQ(states.size(), 2u);
  for (const RobotState& each : states) {
    ASSERT_TRUE(each.state.has_value()) << "it is not left out";
    EXPECT_TRUE(each.state->bytes.empty());
  }
  host.load(states);
}

TEST_F(RememberedState, GoesOnInAnotherProcess) {
  ControllerHost host(remembering());
  start(host);
  steps_of(host, 3);
  steps_of(host, 3);
  steps_of(host, 4);
  const std::vector<RobotState> states = unpack(pack(host.save()));
  ASSERT_EQ(states.size(), 2u);
  ControllerHost other(remembering());
  start(other, wire::StartReason::restored_with_state);
  EXPECT_TRUE(other.load(states).empty());
  EXPECT_EQ(steps_of(other, 3), 3.0);
  EXPECT_EQ(steps_of(other, 4), 2.0);
}

TEST_F(RememberedState, IsLeftOutByAControllerThatDoesNotSave) {
  ControllerHost host(CountingController::plugin());
  start(host);
  for (const RobotState& each : host.save()) EXPECT_FALSE(each.state);
}

TEST_F(RememberedState, IsNeverAskedOfAPluginOfAnOlderInterface) {
  Plugin old = CountingController::plugin();
  old.abi = Plugin::first_abi_with_state - 1;
  old.create = []() -> Controller* { return new RememberingController; };
  ControllerHost host(old);
  start(host);
  for (const RobotState& each : host.save()) EXPECT_FALSE(each.state);
  EXPECT_EQ(host.load(std::vector{RobotState{3, ControllerState{"counting", Bytes(4)}}}).size(), 1u);
}

TEST_F(RememberedState, OfOtherControllersIsReportedAsUnusable) {
  ControllerHost host(remembering());
  start(host);
  const ControllerState foreign{"Foreign", Bytes(4, std::byte{1})};
  const auto notices = host.load(std::vector<RobotState>{{3, foreign}, {4, foreign}, {9, foreign}});
  ASSERT_EQ(notices.size(), 1u) << "once";
  EXPECT_NE(notices[0].find("'Foreign'"), std::string::npos) << notices[0];
  EXPECT_EQ(steps_of(host, 3), 1.0);
}

TEST_F(RememberedState, ThatCannotBeLoadedNamesTheRobotAndTheReason) {
  const auto state_of = [](Bytes bytes) {
    return std::vector<RobotState>{{4, ControllerState{"remembering", std::move(bytes)}}};
  };
  const std::string thrown = failure_of_load(state_of(Bytes(4, std::byte{0xff})));
  EXPECT_NE(thrown.find("'r4' failed in load"), std::string::npos) << thrown;
  EXPECT_NE(thrown.find("that cannot be"), std::string::npos) << thrown;
  const std::string early = failure_of_load(state_of(Bytes(3)));
  EXPECT_NE(early.find("unexpected end"), std::string::npos) << early;
  const std::string left = failure_of_load(state_of(Bytes(6)));
  EXPECT_NE(left.find("did not read 2 of 6 bytes"), std::string::npos) << left;
}

TEST_F(RememberedState, AboveItsLimitIsNotSavedAndNothingElseFails) {
  class Hoarding final : public RememberingController {
    void save(StateWriter& state) const override { state.write(std::vector<double>(largest_state / 8)); }
  };
  ControllerHost host({"hoarding", [] { return OwnedController(new Hoarding, [](Controller* it) { delete it; }); }});
  start(host);
  try {
    host.save();
    ADD_FAILURE() << "it did not fail";
  } catch (const SaveFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("'r3' failed in save"), std::string::npos) << failure.what();
    EXPECT_NE(std::string(failure.what()).find("the maximum is 1048576"), std::string::npos) << failure.what();
  }
  EXPECT_EQ(steps_of(host, 3), 1.0) << "it goes on";
}

// In C: a number of each kind.
struct Numbers {
  double real = 0.0;
  std::int64_t whole = 0;
  bool flag = false;
  char bytes[3] = {};
};

const CohortController numbers = {"numbers", []() -> void* { return new Numbers; },
                                  [](void*, const CohortStart*) { return 0; },
                                  [](void* self, const CohortObservation*, CohortCommand*) {
                                    *static_cast<Numbers*>(self) = {0.5, -7, true, {'a', 'b', 'c'}};
                                    return 0;
                                  },
                                  [](void* self) { delete static_cast<Numbers*>(self); }};

const CohortMemory numbers_memory = {[](const void* self, CohortStateWriter* state) {
                                       const auto& saved = *static_cast<const Numbers*>(self);
                                       cohort_save_real(state, saved.real);
                                       cohort_save_whole(state, saved.whole);
                                       cohort_save_flag(state, saved.flag);
                                       cohort_save_bytes(state, saved.bytes, sizeof saved.bytes);
                                       return 0;
                                     },
                                     [](void* self, CohortStateReader* state) {
                                       auto& loaded = *static_cast<Numbers*>(self);
                                       loaded.real = cohort_load_real(state);
                                       loaded.whole = cohort_load_whole(state);
                                       loaded.flag = cohort_load_flag(state);
                                       cohort_load_bytes(state, loaded.bytes, sizeof loaded.bytes);
                                       return loaded.whole == 1 ? cohort_fail("one is too few") : 0;
                                     }};

ControllerKind in_c(bool with_memory) {
  return {"numbers", [with_memory] {
            void* const made = with_memory ? cohort_make_controller_with_memory(&numbers, &numbers_memory)
                                           : cohort_make_controller(&numbers);
            return OwnedController(static_cast<Controller*>(made),
                                   [](Controller* it) { cohort_destroy_controller(it); });
          }};
}

TEST_F(RememberedState, IsSavedAndLoadedByCallbacksInC) {
  ControllerHost host(in_c(true));
  start(host);
  steps_of(host, 3);
  const std::vector<RobotState> states = host.save();
  ControllerHost other(in_c(true));
  start(other);
  EXPECT_NE(other.save(), states);
  other.load(states);
  EXPECT_EQ(other.save(), states);

  ControllerHost without(in_c(false));
  start(without);
  EXPECT_FALSE(without.save()[0].state);
}

TEST_F(RememberedState, ThatEndsTooEarlyFailsALoadInCEvenIfItSucceeds) {
  const auto failure = [&](const StateWriter& writer) -> std::string {
    ControllerHost host(in_c(true));
    start(host);
    try {
      host.load(std::vector<RobotState>{{3, ControllerState{"numbers", bytes_of(writer)}}});
    } catch (const ControllerFailure& error) {
      return error.what();
    }
    return "it did not fail";
  };
  StateWriter cut;
  cut.write(0.5, std::int64_t{4});
  EXPECT_NE(failure(cut).find("unexpected end"), std::string::npos) << failure(cut);
  StateWriter other_size;
  other_size.write(0.5, std::int64_t{4}, true, std::string("abcd"));
  EXPECT_NE(failure(other_size).find("expected 3 bytes, not 4"), std::string::npos) << failure(other_size);
  StateWriter refused;
  refused.write(0.5, std::int64_t{1}, true, std::string("abc"));
  EXPECT_NE(failure(refused).find("one is too few"), std::string::npos) << failure(refused);
}

}  // namespace
}  // namespace cohort
