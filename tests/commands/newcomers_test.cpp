// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/commands/cohort_command.hpp"
#include "tests/support/controlled_run.hpp"

// Things that people try in their first hour: each works, or the message says what does.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "expected " << part << "\ngot " << text;
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& part) {
  const Ended ended = cohort(arguments);
  EXPECT_EQ(ended.exit_code, 2) << ended.out;
  expect_in(ended.err, part);
}

// An arm of three joints on a heavy base. No joint has a motor.
void write_bare_robot(const fs::path& file) {
  const auto link = [](const char* name, const char* mass) {
    return std::string("<link name=\"") + name + "\"><inertial><mass value=\"" + mass +
           "\"/><inertia ixx=\"0.05\" iyy=\"0.05\" izz=\"0.05\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision>"
           "<origin xyz=\"0 0 0.05\"/><geometry><box size=\"0.4 0.3 0.1\"/></geometry></collision></link>\n";
  };
  const auto joint = [](const char* name, const char* type, const char* parent, const char* child, const char* more) {
    return std::string("<joint name=\"") + name + "\" type=\"" + type + "\"><origin xyz=\"0 0 0.3\"/><parent link=\"" +
           parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"0 0 1\"/>" + more + "</joint>\n";
  };
  const char* const limits = "<limit lower=\"-1\" upper=\"1\" effort=\"50\" velocity=\"2\"/>";
  write_file(file, "<robot name=\"bare\">\n" + link("base", "20") + link("upper", "0.5") + link("lower", "0.5") +
                       link("tip", "0.1") + joint("shoulder", "revolute", "base", "upper", limits) +
                       joint("rail", "prismatic", "upper", "lower", limits) +
                       joint("spin", "continuous", "lower", "tip", "") + "</robot>\n");
}

// ---- Robots ----

TEST(RobotSheet, HasChannelsWithUnitsSizeMassNotesAndTheLineThatRunsIt) {
  const Ended epuck2 = cohort({"help", "robot", "epuck2"});
  EXPECT_EQ(epuck2.exit_code, 0) << epuck2.err;
  expect_in(epuck2.out, "0.13 kg");
  expect_in(epuck2.out, " 0.071 x ");
  expect_in(epuck2.out, "130 g in all");
  expect_in(epuck2.out, "run it: cohort run epuck2 --view --control");
  EXPECT_TRUE(std::regex_search(epuck2.out, std::regex(R"(/velocity +rad/s +-\S+ to )"))) << epuck2.out;
  const Ended sbot = cohort({"help", "robot", "sbot"});
  EXPECT_TRUE(std::regex_search(sbot.out, std::regex(R"(/left/velocity +m/s +-\S+ to )"))) << sbot.out;
  EXPECT_TRUE(std::regex_search(sbot.out, std::regex(R"(/0\.\.14/reading +1 +0 to 1)"))) << sbot.out;
}

TEST(RobotSheet, HasAUnitForEachChannelOfEachRobotThatComesWithCohort) {
  const Ended list = cohort({"help", "robot"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  std::istringstream names(list.out.substr(list.out.find('\n') + 1));
  const std::regex channel(R"(  \S+/\S+ +(\S+|N m) +(\S+ to \S+|from \S+|up to \S+|any value)(, \d+ values)?)");
  int robots = 0;
  for (std::string name; names >> name; ++robots) {
    const Ended sheet = cohort({"help", "robot", name});
    EXPECT_EQ(sheet.exit_code, 0) << name << ": " << sheet.err;
    std::istringstream lines(sheet.out);
    bool is_list = false;
    int channels = 0;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("  ")) {
        is_list = line.starts_with("commands,") || line.starts_with("observations,");
        continue;
      }
      if (!is_list) continue;
      ++channels;
      EXPECT_TRUE(std::regex_match(line, channel)) << name << ": " << line;
    }
    EXPECT_GT(channels, 0) << sheet.out;
  }
  EXPECT_GE(robots, 10) << list.out;
}

TEST(RobotSheet, IsPartOfTheCheckOfAModelByNameOrFile) {
  const Ended named = cohort({"check", "epuck2"});
  EXPECT_EQ(named.exit_code, 0) << named.err;
  expect_in(named.out, "run it: cohort run epuck2");
  const ScratchFolder folder;
  const std::string file = folder / "bare.urdf";
  write_bare_robot(file);
  const Ended bare = cohort({"check", file});
  EXPECT_EQ(bare.exit_code, 0) << bare.err;
  expect_in(bare.out, "21.1 kg");
  expect_in(bare.out, "run it: cohort run " + file);
  EXPECT_EQ(cohort({"run", "epuck2", "--duration", "0.1", "--controllers", "inprocess"}).exit_code, 0);
}

TEST(RobotSheet, OfAnUnknownRobotIsRefusedWithTheNearest) {
  expect_refused({"help", "robot", "epuk2"}, "did you mean 'epuck2'?");
  expect_refused({"help", "epuck2"}, "'cohort help robot epuck2' describes the robot");
}

// ---- A model by itself ----

TEST(AModelThatIsLookedAt, RunsUntilItIsStoppedAndItsJointsCanBeMoved) {
  const ScratchFolder folder;
  const std::string file = folder / "bare.urdf";
  const std::string recording = folder / "run.mcap";
  write_bare_robot(file);
  const ReservedDomain domain;
  Process run({cohort_program(), "run", file, "--view", "--speed", "max", "--domain", domain.text(), "--record",
               recording, "--record-joints", "10"});
  ASSERT_TRUE(run.wait_for_output("http://")) << run.output();
  const auto status = [&] { return nlohmann::json::parse(control(domain, {"status", "--json"})); };
  EXPECT_EQ(status()["robots"], 1);
  EXPECT_TRUE(eventually([&] { return status()["sim_time_ns"].get<std::int64_t>() > 30'000'000'000; }));
  EXPECT_TRUE(run.running());
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 130) << run.output();
  const Ended replayed = cohort({"replay", recording, "--verify"});
  expect_in(replayed.out, "identical");
}

TEST(AModelThatIsLookedAt, EndsAfterTheDurationThatIsAskedFor) {
  const ScratchFolder folder;
  const std::string file = folder / "bare.urdf";
  const std::string summary = folder / "summary.json";
  write_bare_robot(file);
  Process run({cohort_program(), "run", file, "--view", "--speed", "max", "--duration", "0.5", "--summary", summary});
  ASSERT_TRUE(run.wait_for_output("the run has ended; the view stays open")) << run.output();
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
  EXPECT_EQ(read_json(summary)["sim_time_ns"], 500'000'000);
}

// ---- cohort ctl ----

TEST(ControlByHand, SpawnsWhatComesWithCohortAndWhatTheWorldHasByNameOrUri) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "2"});
  run.done({"spawn", "post", "--name", "post_1", "--pose", "2 0 0"});
  run.done({"spawn", "model://prey", "--name", "prey_1", "--pose", "2 1 0"});
  run.done({"spawn", "model://sbot", "--name", "swarm/late", "--pose", "3 0 0"});
  EXPECT_EQ(run.status()["robots"], 3);
  const std::string entities = run.done({"entities"});
  for (const char* name : {"post_1\n", "prey_1\n", "swarm/late\n"}) expect_in(entities, name);
  const Ended unknown = run_to_end(run.ctl({"spawn", "sbit", "--name", "x", "--pose", "2 2 0"}));
  EXPECT_EQ(unknown.exit_code, 1);
  expect_in(unknown.err, "did you mean 'sbot'?");
  const Ended missing = run_to_end(run.ctl({"spawn", "crate.sdf", "--name", "x", "--pose", "2 2 0"}));
  expect_in(missing.err, "there is no file 'crate.sdf'");
}

// The s-bot includes a file that a world without s-bots does not have.
TEST(ControlByHand, SaysWhyAModelOfSeveralFilesCannotBeSpawnedAndWhichModelsCan) {
  const ScratchFolder folder;
  write_file(folder / "empty.sdf",
             "<sdf version='1.9'><world name='empty'><include><uri>model://ground_plane</uri>"
             "</include></world></sdf>");
  write_file(folder / "empty.yaml", "world: empty.sdf\nduration: 1e6\nteams: []\n");
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", folder / "empty.yaml", "--paused", "--domain", domain.text()});
  control(domain, {"spawn", "post", "--name", "y", "--pose", "1 0 0"});
  const Ended refused = run_to_end(ctl_command(domain, {"spawn", "sbot", "--name", "x", "--pose", "1 0 0"}));
  EXPECT_EQ(refused.exit_code, 1);
  expect_in(refused.err, "'sbot' cannot be spawned here: it refers to 'model://sbot/base.sdf'");
  expect_in(refused.err, "the world has no model 'sbot'; known: ground_plane");
  expect_in(refused.err, "can be spawned: arm, ");
  EXPECT_EQ(refused.err.find("sbot_detailed"), std::string::npos) << "it has several files too";
}

TEST(ControlByHand, TakesAShortNameThatOneObjectHas) {
  const FieldOfRobots field(2, 1e4);
  ControlledRun run(field, {"--paused"});
  run.done({"step", "2"});
  expect_in(run.done({"set-pose", "sbot_0", "--pose", "3 3 0.02"}), "swarm/sbot_0");
  run.done({"set-velocity", "sbot_1", "--linear", "0.1 0 0"});
  run.done({"apply-force", "sbot_1", "--force", "0.1 0 0"});
  run.done({"spawn", "post", "--name", "other/sbot_0", "--pose", "2 0 0"});
  const Ended ambiguous = run_to_end(run.ctl({"remove", "sbot_0"}));
  EXPECT_EQ(ambiguous.exit_code, 1);
  expect_in(ambiguous.err, "several objects are called 'sbot_0'");
  expect_in(run.done({"remove", "other/sbot_0"}), "other/sbot_0");
}

TEST(ControlByHand, SwitchesALightByTheShortNameOfItsObject) {
  const FieldOfRobots field(2, 1e4);
  const std::string model = field / "lamp.sdf";
  write_file(model, R"(<sdf version="1.9"><model name="lamp"><static>true</static><link name="post">
    <collision name="hull"><geometry><box><size>0.1 0.1 1</size></box></geometry></collision>
    <light name="bulb" type="point"><diffuse>1 1 1 1</diffuse><attenuation><range>5</range></attenuation></light>
    </link></model></sdf>)");
  ControlledRun run(field, {"--paused"});
  run.done({"step", "2"});
  run.done({"spawn", model, "--name", "hall/east/lamp", "--pose", "1 1 0.5"});
  for (const char* name : {"lamp", "east/lamp", "lamp/bulb", "east/lamp/bulb", "hall/east/lamp/bulb"})
    expect_in(run.done({"set-light", name, "off"}), "set_light 'hall/east/lamp'");
  const auto expect_refusal = [&](const std::string& name, const std::string& message) {
    const Ended refused = run_to_end(run.ctl({"set-light", name, "on"}));
    EXPECT_EQ(refused.exit_code, 1) << name;
    expect_in(refused.err, message);
  };
  expect_refusal("lamp/bulbb", "did you mean 'bulb'?");
  expect_refusal("camp", "there is no light or object 'camp'");
  run.done({"spawn", model, "--name", "yard/lamp", "--pose", "2 1 0.5"});
  expect_refusal("lamp/bulb", "several lights are called 'lamp/bulb', such as 'hall/east/lamp/bulb'");
  expect_in(run.done({"set-light", "yard/lamp", "off"}), "set_light 'yard/lamp'");
}

TEST(ControlByHand, SuggestsTheCommandAndNotAnOption) {
  expect_refused({"ctl", "set_pose", "sbot_0", "--pose", "0 0 0"},
                 "there is no command 'set_pose'; did you mean 'set-pose'?");
  expect_refused({"rnu", "x.yaml", "--view"}, "there is no command 'rnu'; did you mean 'run'?");
}

// ---- Files that are something else ----

TEST(AProgramInPlaceOfAPlugin, IsNamedWithThePluginBesideIt) {
  const ScratchFolder folder;
  const std::string program = folder / "wanderer";
  fs::copy_file(cohort_program(), program);
  expect_refused({"host", program, "--robots", "all"},
                 program + " is a program, not a plugin. A plugin is a shared object");
  write_file(program + ".so", "");
  expect_refused({"host", program, "--robots", "all"}, "Its plugin is " + program + ".so");
}

TEST(AnExperimentInPlaceOfARecording, IsNamedWithTheCommandThatRunsIt) {
  const ScratchFolder folder;
  const std::string drawn = folder / "run.svg";
  const std::string run = "is an experiment, not a recording. To run it: cohort run ";
  expect_refused({"plot", demo_experiment(), "-o", drawn}, run + demo_experiment() + " --plot run.svg");
  expect_refused({"plot", "chain", "-o", drawn}, "chain " + run + "chain --plot run.svg");
  expect_refused({"view", demo_experiment()}, run + demo_experiment() + " --view");
  expect_refused({"replay", demo_experiment()}, run + demo_experiment() + " --record run.mcap");
  expect_refused({"view", "sbot"}, "sbot is a model, not a recording");
}

// ---- Manual and files ----

TEST(HelpOfATopic, SuggestsTheNearestAlsoByTheFirstWord) {
  expect_refused({"help", "proximty"}, "there is no topic 'proximty'; did you mean 'proximity_ring'?");
}

TEST(HelpOfATopic, HasNumbersOfSixDigits) {
  const Ended help = cohort({"help", "proximity_ring"});
  expect_in(help.out, "0.698132");
  EXPECT_FALSE(std::regex_search(help.out, std::regex(R"(\d\.\d{8})"))) << help.out;
}

TEST(AFileThatIsNotYaml, IsToldWithLineAndWhatWasExpected) {
  const ScratchFolder folder;
  const std::string file = folder / "e.yaml";
  const auto expect_told = [&](const std::string& text, const std::string& line, const std::string& what) {
    write_file(file, text);
    expect_refused({"check", file}, file + ":" + line + ": not YAML: " + what);
  };
  expect_told("world: a.sdf\nduration: 5 seed: 2\n", "2", "unexpected ':', or none in the line above. Expected one");
  expect_told("world: a.sdf\nduration 5\nseed: 2\n", "3", "unexpected ':', or none in the line above. Expected one");
  expect_told("world: a.sdf\n\tduration: 5\n", "2", "a tab in the indentation. Expected spaces");
  expect_told("world: [a\nduration: 5\n", "2", "'[' is not closed. Expected ',' or ']'");
  expect_told("world: {a: 1\nduration: 5\n", "2", "'{' is not closed. Expected ',' or '}'");
  expect_told("teams:\n  - name: t\n name: u\n", "3", "wrong indentation");
  expect_told("world: @a.sdf\n", "1", "an unquoted string cannot begin with this character. Expected quotes");
}

}  // namespace
}  // namespace cohort::test
