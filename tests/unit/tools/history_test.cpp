// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "tools/view/history/history_collector.hpp"
#include "tools/view/history/history_thread.hpp"
#include "tools/view/history/seen_values.hpp"

namespace cohort::view {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

ViewRequest history_of(std::vector<double> robots, std::vector<std::string> names) {
  return {.operation = "history", .numbers = std::move(robots), .names = std::move(names)};
}
constexpr auto never = [] { return false; };

TEST(Reduction, KeepsAllSamplesOfAShortHistory) {
  Reduction reduction(0s, 1s, 100);
  for (int i = 0; i < 100; ++i) reduction.add({i * 10ms, std::sin(i)});
  EXPECT_FALSE(reduction.is_reduced());
  const std::vector<Sample> samples = reduction.samples();
  ASSERT_EQ(samples.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(samples[i], (Sample{i * 10ms, std::sin(i)}));
}

TEST(Reduction, KeepsEveryPeakAndTheEndsOfALongHistory) {
  constexpr int count = 100'000;
  constexpr std::size_t most = 200;
  Reduction reduction(0s, 100s, most);
  for (int i = 0; i < count; ++i) {
    double value = std::sin(0.001 * i);
    if (i == 31'415) value = 7.0;
    if (i == 77'777) value = -9.0;
    reduction.add({i * 1ms, value});
  }
  EXPECT_TRUE(reduction.is_reduced());
  const std::vector<Sample> samples = reduction.samples();
  EXPECT_LE(samples.size(), most);
  EXPECT_GT(samples.size(), most / 2);
  const auto has = [&](const Sample& wanted) { return std::ranges::find(samples, wanted) != samples.end(); };
  EXPECT_TRUE(has({31'415ms, 7.0}));
  EXPECT_TRUE(has({77'777ms, -9.0}));
  EXPECT_EQ(samples.front(), (Sample{0s, 0.0}));
  EXPECT_EQ(samples.back().time, (count - 1) * 1ms);
  EXPECT_TRUE(std::ranges::is_sorted(samples, {}, &Sample::time));
}

TEST(Reduction, IgnoresWhatIsOutsideAndPrefersNumbersToNone) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Reduction reduction(1s, 2s, Reduction::least);
  reduction.add({999ms, 1.0});
  reduction.add({2001ms, 1.0});
  EXPECT_TRUE(reduction.samples().empty());
  for (int i = 0; i <= 100; ++i) reduction.add({1s + i * 10ms, i == 50 ? 3.0 : none});
  const std::vector<Sample> samples = reduction.samples();
  EXPECT_LE(samples.size(), Reduction::least);
  EXPECT_TRUE(std::ranges::find(samples, Sample{1500ms, 3.0}) != samples.end());
}

TEST(Reduction, HasNoNegativeZeroAndOneValueForEachTime) {
  Reduction reduction(0s, 1s, 10);
  reduction.add({0s, -0.0});
  reduction.add({1s, 1.0});
  reduction.add({1s, 2.0});
  const std::vector<Sample> samples = reduction.samples();
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_FALSE(std::signbit(samples[0].value));
  EXPECT_EQ(samples[1].value, 2.0);
}

TEST(HistoryRequest, IsBounded) {
  EXPECT_EQ(history_request_of(history_of({3}, {"a"})).points, HistoryRequest::most_points);
  const HistoryRequest request = history_request_of(history_of({3, 4}, {"a", "b"}));
  EXPECT_EQ(request.points, HistoryRequest::most_points / 4);
  ViewRequest asked = history_of({3}, {"a"});
  asked.number = 100;
  asked.from = 1.5;
  asked.to = 2.25;
  EXPECT_EQ(history_request_of(asked).points, 100U);
  EXPECT_EQ(history_request_of(asked).from, 1500ms);
  EXPECT_EQ(history_request_of(asked).to, 2250ms);
  asked.number = 1e300;
  EXPECT_EQ(history_request_of(asked).points, HistoryRequest::most_points);
  const auto is_refused = [](const ViewRequest& each) {
    EXPECT_THROW(history_request_of(each), std::invalid_argument);
  };
  is_refused(history_of({}, {"a"}));
  is_refused(history_of({3}, {}));
  is_refused(history_of({-1}, {"a"}));
  is_refused(history_of({std::nan("")}, {"a"}));
  is_refused(history_of(std::vector<double>(17, 1.0), {"a"}));
  is_refused(history_of({1}, std::vector<std::string>(33, "a")));
  is_refused(history_of(std::vector<double>(16, 1.0), std::vector<std::string>(9, "a")));
  is_refused(history_of({1}, {std::string(257, 'a')}));
  asked.number = 3;
  is_refused(asked);
  asked.number = 100;
  asked.to = 1.0;
  is_refused(asked);
  asked.to = std::nan("");
  is_refused(asked);
}

TEST(HistoryRequest, FindsValuesByTheNamesOfThePage) {
  const std::vector<messages::SceneChannel> observation = {{.name = "a", .unit = "m", .size = 1},
                                                           {.name = "b", .unit = "rad", .size = 3}};
  const std::vector<messages::SceneChannel> command = {{.name = "a", .unit = "m/s", .size = 1}};
  const auto place_of = [&](std::string_view name) { return find_value(observation, command, name); };
  EXPECT_EQ(place_of("a")->index, 0U);
  EXPECT_EQ(place_of("b[2]")->index, 3U);
  EXPECT_EQ(place_of("b[2]")->unit, "rad");
  EXPECT_TRUE(place_of("→ a")->is_commanded);
  EXPECT_EQ(place_of("→ a")->unit, "m/s");
  for (const char* name :
       {"b", "b[3]", "b[-1]", "b[]", "b[1", "b[1]x", "a[0]", "", "→ b[0]", "→ ", "b[99999999999999999999]"})
    EXPECT_FALSE(place_of(name)) << name;
}

TEST(HistoryThread, AnswersInOrderAndRefusesWhatIsTooMuch) {
  std::atomic<int> answers = 0;
  std::atomic<int> refusals = 0;
  {
    HistoryThread thread([&](const HistoryRequest&, const HistoryThread::IsCancelled& is_cancelled) {
      while (!is_cancelled()) std::this_thread::yield();
      return Answer{true, ""};
    });
    const auto count = [&](const Answer& answer) { ++(answer.is_done ? answers : refusals); };
    for (int i = 0; i < 10; ++i) thread.ask(history_of({1}, {"a"}), count);
    EXPECT_GE(refusals, 5);
    thread.ask(history_of({}, {}), count);
    EXPECT_GE(refusals, 6);
  }
  EXPECT_EQ(answers + refusals, 11);
  EXPECT_EQ(answers, 0) << "no answer came before the end of the thread";
}

TEST(HistoryThread, GivesUpForAVisitorWhoHasLeft) {
  std::atomic<bool> is_begun = false;
  std::atomic<bool> was_cancelled = false;
  HistoryThread thread([&](const HistoryRequest&, const HistoryThread::IsCancelled& is_cancelled) {
    is_begun = true;
    is_begun.notify_all();
    while (!is_cancelled()) std::this_thread::yield();
    was_cancelled = true;
    was_cancelled.notify_all();
    return Answer{false, ""};
  });
  ViewRequest asked = history_of({1}, {"a"});
  asked.visitor = 5;
  thread.ask(asked, [](const Answer&) {});
  is_begun.wait(false);
  thread.leave(4);
  EXPECT_FALSE(was_cancelled);
  thread.leave(5);
  was_cancelled.wait(false);
}

// A robot with one observed and one commanded value.
messages::Scene scene_of_one() {
  messages::SceneModel model;
  model.observation = {{.name = "a", .unit = "m"}};
  model.command = {{.name = "b", .unit = "V"}};
  messages::Scene scene;
  scene.models.push_back(std::move(model));
  scene.entities.push_back({.name = "m", .model = 0, .robot = 0});
  return scene;
}
messages::Bytes values_at(double observed, double commanded) {
  return messages::encode(messages::SceneRobots{{{.robot = 0, .observation = {observed}, .command = {commanded}}}});
}

TEST(SeenValues, AreThoseSinceTheViewBegan) {
  SeenValues seen;
  seen.set_scene(scene_of_one());
  for (int i = 0; i < 10; ++i) seen.add(i * 100ms, values_at(i, -i));
  const HistoryRequest request = history_request_of(history_of({0, 1}, {"a", "→ b", "c"}));
  const Answer answer = seen.read(request, never);
  ASSERT_TRUE(answer.is_done);
  ASSERT_EQ(answer.history->series.size(), 2U);
  const auto& [observed, commanded] = std::tie(answer.history->series[0], answer.history->series[1]);
  EXPECT_EQ(observed.unit, "m");
  EXPECT_EQ(commanded.unit, "V");
  EXPECT_EQ(observed.times, (std::vector{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}));
  EXPECT_EQ(commanded.values, (std::vector{0.0, -1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -7.0, -8.0, -9.0}));
  EXPECT_FALSE(seen.read(history_request_of(history_of({0}, {"c"})), never).is_done);
}

TEST(SeenValues, ForgetWhatTheRunHasDiscarded) {
  SeenValues seen;
  seen.set_scene(scene_of_one());
  for (int i = 0; i < 10; ++i) seen.add(i * 100ms, values_at(i, 0));
  seen.add(400ms, values_at(40, 0));
  const Answer answer = seen.read(history_request_of(history_of({0}, {"a"})), never);
  EXPECT_EQ(answer.history->series.at(0).values, (std::vector{0.0, 1.0, 2.0, 3.0, 40.0}));
}

TEST(SeenValues, HoldABoundedNumberOfBytes) {
  const std::size_t size = values_at(0, 0).size();
  SeenValues seen(3 * size);
  seen.set_scene(scene_of_one());
  for (int i = 0; i < 10; ++i) seen.add(i * 100ms, values_at(i, 0));
  const Answer answer = seen.read(history_request_of(history_of({0}, {"a"})), never);
  EXPECT_EQ(answer.history->series.at(0).values, (std::vector{7.0, 8.0, 9.0}));
}

}  // namespace
}  // namespace cohort::view
