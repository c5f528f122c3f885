// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

using namespace std::chrono_literals;

// An experiment with robots `a` and `b` in the team `red`, `c` in `blue`, and a section `ros2`.
class RosSection : public Description {
 protected:
  RosSection() {
    std::string robots;
    for (const std::string name : {"a", "b", "c"})
      robots += "<include><uri>model://sbot</uri><name>" + name + "</name><pose>" + std::to_string(name[0] - 'a') +
                " 0 0 0 0 0</pose></include>";
    write_world(robots);
  }
  // The added text begins on line 4.
  std::filesystem::path write_experiment(const std::string& section) const {
    return write("e.yaml",
                 "world: world.sdf\nduration: 10\nteams: [{name: red, robots: [a, b], controller: x}, "
                 "{name: blue, robots: c, controller: x}]\n" +
                     section);
  }
  Ros2 read_section(const std::string& section) const {
    return parsing::read_experiment(write_experiment(section)).ros2;
  }
};

TEST_F(RosSection, HasDefaultsIfAbsent) {
  for (const char* const section : {"", "ros2: {}\n"}) {
    const Ros2 ros2 = read_section(section);
    EXPECT_FALSE(ros2.domain);
    EXPECT_EQ(ros2.robots, std::vector<std::string>{"all"});
    const Ros2Settings& settings = ros2.of_team("red");
    EXPECT_EQ(settings.sync, RosSync::free);
    EXPECT_FALSE(settings.wait);
    EXPECT_EQ(settings.on_silence, RosOnSilence::wait);
    EXPECT_EQ(settings.name_space, "");
    EXPECT_EQ(settings.frames, "");
    EXPECT_EQ(settings.odometry, RosOdometry::encoders);
    EXPECT_EQ(settings.base_frame, "base_link");
    EXPECT_TRUE(settings.topics.empty());
    EXPECT_FALSE(settings.drive);
  }
}

TEST_F(RosSection, ReadsAllKeys) {
  const Ros2 ros2 = read_section(
      "ros2:\n  domain: 7\n  robots: [c]\n  sync: idle\n  wait: 1.5\n  on_silence: stand\n  namespace: /left/one\n"
      "  frames: turtle/\n  odometry: truth\n  base_frame: base_footprint\n"
      "  topics:\n    scan: {name: /scan, rate: 10}\n    range/*: false\n    odom: {name: odometry}\n"
      "  drive: {left: left/0/velocity, right: [r1, r2], wheel_radius: 0.033, wheel_separation: 0.16}\n");
  EXPECT_EQ(ros2.domain, 7u);
  EXPECT_EQ(ros2.robots, std::vector<std::string>{"c"});
  const Ros2Settings& settings = ros2.common;
  EXPECT_EQ(settings.sync, RosSync::idle);
  EXPECT_EQ(settings.wait, 1500ms);
  EXPECT_EQ(settings.on_silence, RosOnSilence::stand);
  EXPECT_EQ(settings.name_space, "/left/one");
  EXPECT_EQ(settings.frames, "turtle/");
  EXPECT_EQ(settings.odometry, RosOdometry::truth);
  EXPECT_EQ(settings.base_frame, "base_footprint");
  ASSERT_EQ(settings.topics.size(), 3u);
  EXPECT_EQ(settings.topics[0].topic, "scan");
  EXPECT_TRUE(settings.topics[0].is_published);
  EXPECT_EQ(settings.topics[0].name, "/scan");
  EXPECT_EQ(settings.topics[0].rate, 10.0);
  EXPECT_EQ(settings.topics[0].line, 15);
  EXPECT_EQ(settings.topics[1].topic, "range/*");
  EXPECT_FALSE(settings.topics[1].is_published);
  EXPECT_EQ(settings.topics[2].name, "odometry");
  EXPECT_FALSE(settings.topics[2].rate);
  ASSERT_TRUE(settings.drive);
  EXPECT_EQ(settings.drive->left, std::vector<std::string>{"left/0/velocity"});
  EXPECT_EQ(settings.drive->right, (std::vector<std::string>{"r1", "r2"}));
  EXPECT_EQ(settings.drive->wheel_radius, 0.033);
  EXPECT_EQ(settings.drive->wheel_separation, 0.16);
  EXPECT_EQ(settings.drive->line, 18);
}

TEST_F(RosSection, LetsTeamsOverrideSettings) {
  const Ros2 ros2 = read_section(
      "ros2:\n  wait: 2\n  base_frame: base\n  topics: {image: false}\n"
      "  teams:\n    blue: {sync: free, namespace: /, topics: {image: {rate: 5}}}\n");
  EXPECT_EQ(ros2.of_team("red").sync, RosSync::free);
  EXPECT_EQ(ros2.of_team("red").topics.size(), 1u);
  const Ros2Settings& blue = ros2.of_team("blue");
  EXPECT_EQ(blue.sync, RosSync::free);
  EXPECT_EQ(blue.base_frame, "base");
  EXPECT_EQ(blue.name_space, "/");
  ASSERT_EQ(blue.topics.size(), 2u);
  EXPECT_FALSE(blue.topics[0].is_published);
  EXPECT_TRUE(blue.topics[1].is_published) << "the last one counts";
  EXPECT_EQ(blue.topics[1].rate, 5.0);
}

TEST_F(RosSection, AcceptsANamespaceForASingleRobot) {
  EXPECT_EQ(read_section("ros2: {namespace: /, robots: b}\n").common.name_space, "/");
}

class FlawOfARosSection : public RosSection, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfARosSection, IsReportedAloneWithFileLineAndKey) {
  const std::filesystem::path file = write_experiment(GetParam().content);
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, GetParam());
  EXPECT_EQ(problems.size(), 1u) << texts_of(problems);
}

INSTANTIATE_TEST_SUITE_P(
    Sections, FlawOfARosSection,
    testing::Values(
        Flaw{"ros2: 3\n", 4, "ros2", "expected 'KEY: VALUE' lines"},
        Flaw{"ros2:\n  synch: free\n", 5, "ros2.synch", "did you mean 'sync'?"},
        Flaw{"ros2:\n  sync: fre\n", 5, "ros2.sync", "did you mean 'free'?"},
        Flaw{"ros2:\n  domain: 233\n", 5, "ros2.domain", "at most 232"},
        Flaw{"ros2:\n  domain: -1\n", 5, "ros2.domain", "whole number"},
        Flaw{"ros2:\n  robots: [a, d]\n", 5, "ros2.robots", "no robot"},
        Flaw{"ros2:\n  wait: 0\n", 5, "ros2.wait", "> 0"}, Flaw{"ros2:\n  wait: 1 s\n", 5, "ros2.wait", "not '1 s'"},
        Flaw{"ros2:\n  sync: free\n  wait: 1\n", 6, "ros2.wait", "cannot be used with sync: free"},
        Flaw{"ros2:\n  on_silence: hold\n", 5, "ros2.on_silence", "requires `wait`"},
        Flaw{"ros2:\n  robots: a\n  namespace: left\n", 6, "ros2.namespace", "each preceded by a slash"},
        Flaw{"ros2:\n  robots: a\n  namespace: /left/\n", 6, "ros2.namespace", "each preceded by a slash"},
        Flaw{"ros2:\n  namespace: /\n", 5, "ros2.namespace", "is used by 'a' and 'b'"},
        Flaw{"ros2:\n  teams:\n    red: {namespace: /}\n", 6, "ros2.teams.red.namespace", "is used by 'a' and 'b'"},
        Flaw{"ros2:\n  frames: /turtle\n", 5, "ros2.frames", "without a leading slash"},
        Flaw{"ros2:\n  base_frame: base link\n", 5, "ros2.base_frame", "without spaces"},
        Flaw{"ros2:\n  odometry: magic\n", 5, "ros2.odometry", "unknown value 'magic'"},
        Flaw{"ros2:\n  topics: [scan]\n", 5, "ros2.topics", "expected 'TOPIC: …' lines"},
        Flaw{"ros2:\n  topics:\n    /scan: false\n", 6, "ros2.topics./scan", "expected a topic of a robot"},
        Flaw{"ros2:\n  topics:\n    scan: true\n", 6, "ros2.topics.scan", "expected false, or a map"},
        Flaw{"ros2:\n  topics:\n    scan: {rate: 0}\n", 6, "ros2.topics.scan.rate", "> 0"},
        Flaw{"ros2:\n  topics:\n    scan: {nam: x}\n", 6, "ros2.topics.scan.nam", "did you mean 'name'?"},
        Flaw{"ros2:\n  topics:\n    scan: {name: 1st}\n", 6, "ros2.topics.scan.name", "letters, digits"},
        Flaw{"ros2:\n  topics:\n    range/*: {name: r}\n", 6, "ros2.topics.range/*.name", "cannot share a name"},
        Flaw{"ros2:\n  topics:\n    scan: false\n    scan: false\n", 7, "ros2.topics.scan", "given twice"},
        Flaw{"ros2:\n  drive: {left: l, right: r, wheel_radius: 1}\n", 5, "ros2.drive.wheel_separation", "missing"},
        Flaw{"ros2:\n  drive: {left: l, right: r, wheel_radius: 1, wheel_separation: 0}\n", 5,
             "ros2.drive.wheel_separation", "> 0"},
        Flaw{"ros2:\n  teams: [red]\n", 5, "ros2.teams", "expected 'TEAM: SETTINGS' lines"},
        Flaw{"ros2:\n  teams:\n    re: {sync: free}\n", 6, "ros2.teams.re", "did you mean 'red'?"},
        Flaw{"ros2:\n  teams:\n    red: {domain: 1}\n", 6, "ros2.teams.red.domain", "unknown key"},
        Flaw{"ros2:\n  teams:\n    red: {sync: no}\n", 6, "ros2.teams.red.sync", "unknown value 'no'"}));

}  // namespace
}  // namespace cohort::description
