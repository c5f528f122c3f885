// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/film_source.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/recording/recorder.hpp"
#include "tests/support/files.hpp"

namespace cohort::film {
namespace {

using namespace std::chrono_literals;

// A robot that falls, recorded for 20 ticks of 10 ms, and the same again after a reset.
class FilmOfARecording : public ::testing::Test {
 protected:
  static constexpr int ticks = 20;

  void SetUp() override {
    test::write_file(folder / "world.sdf", R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">
  <world name="w">
    <physics type="cohort"><max_step_size>0.01</max_step_size></physics>
    <model name="robot">
      <pose>1 2 3 0 0 0</pose>
      <link name="hull">
        <inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
        <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      </link>
      <link name="wheel"><inertial><mass>1</mass><inertia/></inertial></link>
      <joint name="hinge" type="revolute">
        <parent>hull</parent><child>wheel</child><axis><xyz>0 0 1</xyz></axis>
      </joint>
      <cohort:velocity_motor name="motor">
        <cohort:joint>hinge</cohort:joint><cohort:max_velocity>5</cohort:max_velocity><cohort:max_effort>1</cohort:max_effort>
      </cohort:velocity_motor>
    </model>
  </world>
</sdf>
)");
    test::write_file(folder / "run.yaml",
                     "world: world.sdf\nduration: 9\nrecord: {snapshots: 0.05}\n"
                     "teams: [{name: all, robots: all, controller: none}]\n");
    const description::Experiment experiment = parsing::read_experiment(folder / "run.yaml");
    recording::Recorder recorder(folder / "run.mcap", experiment);
    for (const auto reason : {recording::Beginning::first, recording::Beginning::reset}) {
      Simulation simulation(experiment, 1);
      recorder.begin(experiment, simulation, reason);
      for (int tick = 0; tick <= ticks; ++tick) {
        if (tick > 0) simulation.step();
        recorder.boundary();
        if (reason == recording::Beginning::first) heights.push_back(simulation.robot_pose(0).position.z());
      }
    }
    recorder.finish("finished", "");
    step = experiment.world.step;
  }

  double height_at(FilmSource& source, std::chrono::nanoseconds time) {
    source.go_to(time);
    source.show();
    return shown().positions.at(2);
  }
  messages::SceneFrame shown() const {
    return messages::decode<messages::SceneFrame>(topics.newest(view::Topic::frame)->data);
  }

  test::ScratchFolder folder;
  view::Topics topics;
  std::vector<double> heights;
  std::chrono::nanoseconds step{0};
};

TEST_F(FilmOfARecording, ShowsTheExactTick) {
  const recording::Recording recording(folder / "run.mcap");
  for (const int first : {0, 7}) {  // at the beginning, and from a snapshot
    FilmSource source(recording, topics, {});
    for (int tick = first; tick < ticks; ++tick) {
      EXPECT_EQ(height_at(source, tick * step), static_cast<float>(heights[tick])) << tick;
      EXPECT_EQ(shown().tick, static_cast<std::uint64_t>(tick));
    }
  }
}

TEST_F(FilmOfARecording, InterpolatesBetweenTicks) {
  const recording::Recording recording(folder / "run.mcap");
  FilmSource source(recording, topics, {.follow = "robot"});
  for (const double share : {0.25, 0.5, 0.9}) {
    const auto time = 5 * step + std::chrono::round<std::chrono::nanoseconds>(share * step);
    const double expected = std::lerp(heights[5], heights[6], share);
    EXPECT_NEAR(height_at(source, time), expected, 1e-6);
    EXPECT_NEAR(source.followed().value().centre.z(), expected, 1e-6);
    EXPECT_EQ(shown().tick, 5u);
  }
  // The last tick of a world stays until the next world begins.
  EXPECT_EQ(height_at(source, ticks * step + step / 2), static_cast<float>(heights[ticks]));
  EXPECT_EQ(height_at(source, (ticks + 1) * step), static_cast<float>(heights[0]));
}

TEST_F(FilmOfARecording, ShowsTheLastTickAfterTheEnd) {
  const recording::Recording recording(folder / "run.mcap");
  FilmSource source(recording, topics, {});
  for (const auto time : {100s, 101s}) EXPECT_EQ(height_at(source, time), static_cast<float>(heights.back()));
}

TEST_F(FilmOfARecording, FollowsTeamsRobotsAndObjects) {
  const recording::Recording recording(folder / "run.mcap");
  for (const char* name : {"all", "robot", "0", "rob*"}) {
    FilmSource source(recording, topics, {.follow = name});
    source.go_to(0ns);
    EXPECT_TRUE(source.followed().value().centre.isApprox(Eigen::Vector3d(1, 2, heights[0]))) << name;
    EXPECT_EQ(source.followed()->radius, 0.0);
  }
  FilmSource source(recording, topics, {.follow = "robt"});
  EXPECT_THROW(source.go_to(0ns), std::invalid_argument);
}

TEST_F(FilmOfARecording, GivesEveryMessageItsOwnTime) {
  const recording::Recording recording(folder / "run.mcap");
  FilmSource source(recording, topics, {.shows_contacts = true});
  std::int64_t last = 0;
  for (int tick = 0; tick < 3; ++tick) {
    source.go_to(tick * step);
    EXPECT_EQ(topics.newest(view::Topic::scene)->time.count(), source.scene().time);
    const std::vector<Stamp> stamps = source.show();
    EXPECT_EQ(stamps.size(), 3u);
    for (const Stamp& stamp : stamps) {
      EXPECT_EQ(topics.newest(stamp.topic)->time.count(), stamp.time);
      EXPECT_GT(stamp.time, last);
    }
    last = stamps.front().time;
  }
}

TEST(InterpolatedFrames, TurnTheShortWay) {
  constexpr auto half = static_cast<std::int16_t>(std::numbers::sqrt2 / 2.0 * 32767.0);
  messages::SceneFrame a;
  a.positions = {0.0F, 0.0F, 0.0F};
  a.orientations = {0, 0, 0, 32767};
  messages::SceneFrame b = a;
  b.positions = {1.0F, 2.0F, -4.0F};
  b.orientations = {0, 0, -half, -half};  // a quarter turn, with the other sign
  const messages::SceneFrame between = interpolated(a, b, 0.5);
  EXPECT_EQ(between.positions, (std::vector<float>{0.5F, 1.0F, -2.0F}));
  EXPECT_EQ(between.orientations[0], 0);
  EXPECT_NEAR(between.orientations[2], 32767 * std::sin(std::numbers::pi / 8), 2);
  EXPECT_NEAR(between.orientations[3], 32767 * std::cos(std::numbers::pi / 8), 2);
}

}  // namespace
}  // namespace cohort::film
