// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/commands/small_experiment.hpp"

// Commands for worlds: export, display, and printing of quantities.
namespace cohort::test {
namespace {

TEST(Export, WritesAWorldThatRunsToTheSameHash) {
  const ScratchFolder folder;
  for (const char* const name : {"world.sdf", "world.yaml"}) {
    const std::string world = (folder / name).string();
    const Ended exported = run_to_end({cohort_program(), "export", demo_experiment(), "-o", world});
    EXPECT_EQ(exported.exit_code, 0) << exported.err;
    EXPECT_EQ(exported.out + exported.err, "");
    write_file(folder / "e.yaml", std::string("world: ") + name +
                                      "\nduration: 2\nteams: [{name: t, robots: explorers/*, controller: "
                                      "obstacle_avoidance}]\n");
    const auto summary = run_experiment((folder / "e.yaml").string(), {"--controllers", "inprocess"});
    EXPECT_EQ(summary["state_hash"], reference_hash(2)) << name;
  }
}

TEST(Export, UsesTheRequestedSeed) {
  const ScratchFolder folder;
  const auto exported = [&](const std::vector<std::string>& more) {
    const std::string world = (folder / "w.sdf").string();
    std::vector<std::string> command = {cohort_program(), "export", demo_experiment(), "-o", world};
    command.insert(command.end(), more.begin(), more.end());
    EXPECT_EQ(run_to_end(command).exit_code, 0);
    return read_file(world);
  };
  EXPECT_EQ(exported({}), exported({"--seed", "1"}));
  EXPECT_NE(exported({}), exported({"--seed", "2"}));
}

TEST(Export, RejectsFilesThatItCannotWriteOrRead) {
  const ScratchFolder folder;
  const Ended odd = run_to_end({cohort_program(), "export", demo_experiment(), "-o", (folder / "w.txt").string()});
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_NE(odd.err.find("'.txt'"), std::string::npos) << odd.err;
  const Ended none =
      run_to_end({cohort_program(), "export", (folder / "none.sdf").string(), "-o", (folder / "w.sdf").string()});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("no such file"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "w.sdf"));
}

TEST(Export, AcceptsAFileNameWithoutAFolder) {
  const ScratchFolder folder;
  write_file(folder / "tip.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write_file(
      folder / "m.sdf",
      "<sdf version=\"1.9\"><model name=\"m\"><static>1</static><link name=\"l\"><collision name=\"c\"><geometry>"
      "<mesh><uri>tip.obj</uri></mesh></geometry></collision></link></model></sdf>");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  const Ended exported = run_to_end({cohort_program(), "export", "m.sdf", "-o", "out.sdf"});
  std::filesystem::current_path(before);
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_NE(read_file(folder / "out.sdf").find("<uri>tip.obj</uri>"), std::string::npos);
}

// An SDF element takes 60 kB while it is read, and a model has 20 of them.
TEST(Check, MemoryDoesNotGrowWithTheNumberOfModels) {
  const ScratchFolder folder;
  std::string world = "<sdf version=\"1.6\"><world name=\"w\">\n";
  for (int i = 0; i < 1000; ++i)
    world += "<model name=\"m" + std::to_string(i) + "\"><pose>" + std::to_string(i) +
             " 0 0 0 0 0</pose><link name=\"l\"><inertial><mass>" + std::to_string(i + 1) +
             "</mass></inertial><collision name=\"c\"><geometry><box><size>1 1 1</size></box></geometry></collision>"
             "</link></model>\n";
  write_file(folder / "w.sdf", world + "</world></sdf>\n");
  const Ended checked = run_to_end({cohort_program(), "check", (folder / "w.sdf").string()});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_LT(std::ranges::count(checked.err, '\n'), 4) << checked.err;  // the first warning of each kind
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  EXPECT_LT(used.ru_maxrss, 600'000) << "kB";
}

TEST(Samples, AreReadByTheSamplingTechnique) {
  const ScratchFolder folder;
  const std::string model = std::string(COHORT_SOURCE_DIR) + "/worlds/robots/sbot/base.sdf";
  const std::string file = (folder / "s.csv").string();
  const Ended taken =
      run_to_end({cohort_program(), "samples", model, "proximity", "-o", file, "--distances", "3", "--angles", "30"});
  EXPECT_EQ(taken.exit_code, 0) << taken.err;
  EXPECT_EQ(taken.out + taken.err, "");
  EXPECT_TRUE(read_file(file).starts_with("distance [m],angle [rad],reading_0 [1],")) << read_file(file);
  std::string text = read_file(model);
  const std::string range = "</cohort:range>";
  const std::size_t end = text.find(range, text.find("cohort:proximity_ring"));
  ASSERT_NE(end, std::string::npos);
  text.insert(end + range.size(), "<cohort:technique>samples</cohort:technique><cohort:samples>s.csv</cohort:samples>");
  write_file(folder / "model.sdf", text);
  const Ended checked = run_to_end({cohort_program(), "check", (folder / "model.sdf").string()});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
}

TEST(Samples, AreTakenOfAModelOrAnExperimentByName) {
  const ScratchFolder folder;
  const auto samples_of = [&](const std::string& name) {
    const std::string file = folder / "s.csv";
    std::filesystem::remove(file);
    const Ended taken =
        run_to_end({cohort_program(), "samples", name, "proximity", "-o", file, "--distances", "2", "--angles", "4"});
    EXPECT_EQ(taken.exit_code, 0) << taken.err;
    return read_file(file);
  };
  const std::string samples = samples_of("sbot");
  EXPECT_EQ(samples, samples_of(COHORT_SOURCE_DIR "/worlds/robots/sbot/model.sdf"));
  EXPECT_EQ(samples, samples_of("obstacle_avoidance")) << "its first robot is an s-bot";
  EXPECT_EQ(samples, samples_of(COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml"));
  const Ended unknown = run_to_end({cohort_program(), "samples", "sbott", "proximity", "-o", folder / "s.csv"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("no file, example or model named 'sbott'; did you mean 'sbot'?"), std::string::npos)
      << unknown.err;
}

TEST(Samples, RejectDevicesOtherThanRings) {
  const ScratchFolder folder;
  const Ended ended =
      run_to_end({cohort_program(), "samples", std::string(COHORT_SOURCE_DIR) + "/worlds/robots/sbot/model.sdf",
                  "proximty", "-o", (folder / "s.csv").string()});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("no proximity_ring 'proximty'; did you mean 'proximity'?"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "s.csv"));
}

TEST(Run, AcceptsAModelOrAWorldWithoutAnExperiment) {
  const ScratchFolder folder;
  const std::string model = (folder / "ball.urdf").string();
  write_file(
      model,
      "<robot name=\"ball\"><link name=\"l\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" "
      "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><sphere radius=\"0.1\"/></geometry>"
      "</collision></link></robot>");
  const std::string recording = (folder / "r.mcap").string();
  EXPECT_EQ(run_experiment(model, {"--record", recording})["ticks"], 1000);
  std::filesystem::remove(model);
  EXPECT_EQ(run_to_end({cohort_program(), "replay", recording, "--verify"}).exit_code, 0);
  const SmallExperiment robots;
  for (const std::string placement : {"process", "inprocess", "per-robot"})
    EXPECT_EQ(
        run_experiment((robots / "world.sdf").string(), {"--duration", "0.1", "--controllers", placement})["robots"],
        2);
}

TEST(Worlds, ReportTheirModelsIfTheyHaveNoRobot) {
  const ScratchFolder folder;
  const std::string ball = (folder / "ball.urdf").string();
  write_file(ball,
             "<robot name=\"ball\"><link name=\"l\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" "
             "izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><sphere radius=\"0.1\"/>"
             "</geometry></collision></link></robot>");
  const Ended run = run_to_end({cohort_program(), "run", ball, "--duration", "0.1"});
  EXPECT_NE(run.out.find("(0.10 s simulated, 1 model)"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("robot"), std::string::npos) << run.out;
}

TEST(Worlds, RunXacroOnlyOnRequest) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "bin");
  write_file(folder / "bin/xacro", "#!/bin/sh\ntouch \"$(dirname \"$0\")/trace\"\nexit 3\n");
  std::filesystem::permissions(folder / "bin/xacro", std::filesystem::perms::owner_all);
  const std::string model = (folder / "r.urdf").string();
  write_file(model, "<robot name=\"r\"><xacro:macro/></robot>");
  const auto call = [&](std::vector<std::string> line, bool expands) {
    line.insert(line.begin(), cohort_program());
    if (expands) line.emplace_back("--xacro");
    const Ended ended = run_to_end(line, {{"VIRTUAL_ENV", folder.path().string()}});
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_EQ(std::filesystem::remove(folder / "bin/trace"), expands) << line[1] << ended.err;
  };
  const std::string output = (folder / "o.sdf").string();
  for (const bool expands : {false, true}) {
    for (const char* const command : {"check", "run", "serve"}) call({command, model}, expands);
    call({"models", "show", model}, expands);
    call({"export", model, "-o", output}, expands);
    call({"samples", model, "ring", "-o", output}, expands);
  }
}

TEST(Models, ShowTheirPartsAndRestPoses) {
  const ScratchFolder folder;
  const std::string model = (folder / "cart.urdf").string();
  write_file(
      model,
      "<robot name=\"cart\"><link name=\"rail\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" iyy=\"1\" "
      "izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"2 1 0.2\"/>"
      "</geometry></collision></link><link name=\"slide\"><inertial><origin rpy=\"0 0 1.5707963267948966\"/><mass "
      "value=\"3\"/><inertia ixx=\"4\" iyy=\"5\" izz=\"6\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
      "<joint name=\"j\" type=\"prismatic\"><origin xyz=\"0 0 0.5\"/><parent link=\"rail\"/><child "
      "link=\"slide\"/><axis xyz=\"0 1 0\"/><limit lower=\"-0.3\" upper=\"0.4\" effort=\"7\" velocity=\"8\"/>"
      "</joint></robot>");
  const Ended shown = run_to_end({cohort_program(), "models", "show", model, "--json", "--after", "1"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const auto facts = nlohmann::json::parse(shown.out);
  EXPECT_EQ(facts["time_s"], 1.0);
  const auto& cart = facts["objects"][0];
  EXPECT_NEAR(cart["links"][0]["pose_in_world"][2].get<double>(), 0.1, 1e-3);
  EXPECT_NEAR(cart["links"][1]["inertia"][0][0].get<double>(), 5.0, 1e-9);  // turned by a quarter
  EXPECT_EQ(cart["links"][1]["mass"], 3.0);
  const auto& axis = cart["joints"][0]["axis"];
  EXPECT_NEAR(axis["direction_in_world"][1].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(axis["lower"], -0.3);
  EXPECT_EQ(axis["upper"], 0.4);
  EXPECT_EQ(axis["max_effort"], 7.0);
  const Ended text = run_to_end({cohort_program(), "models", "show", model});
  EXPECT_NE(text.out.find("joint j  prismatic  rail to slide  from -0.3 to 0.4"), std::string::npos) << text.out;
}

TEST(Models, AreFoundByNameAndSuggestTheNearest) {
  const Ended known = run_to_end({cohort_program(), "models", "show", "sbot"});
  EXPECT_EQ(known.exit_code, 0) << known.err;
  EXPECT_TRUE(known.out.starts_with("sbot: ")) << known.out;
  const Ended experiment = run_to_end({cohort_program(), "models", "show", "obstacle_avoidance"});
  EXPECT_EQ(experiment.exit_code, 0) << experiment.err;
  EXPECT_NE(experiment.out.find("explorers/sbot_15: "), std::string::npos) << experiment.out;
  const Ended misspelt = run_to_end({cohort_program(), "models", "show", "sbott"});
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_NE(misspelt.err.find("did you mean 'sbot'?"), std::string::npos) << misspelt.err;
}

TEST(Help, FindsTopicsAndSuggestsTheNearest) {
  const Ended contents = run_to_end({cohort_program(), "help"});
  EXPECT_EQ(contents.exit_code, 0);
  EXPECT_NE(contents.out.find("sensors"), std::string::npos);
  const Ended proximity = run_to_end({cohort_program(), "help", "proximity"});
  EXPECT_EQ(proximity.exit_code, 0);
  EXPECT_NE(proximity.out.find("cohort:proximity_ring"), std::string::npos);
  const Ended misspelt = run_to_end({cohort_program(), "help", "sensers"});
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_NE(misspelt.err.find("did you mean 'sensors'?"), std::string::npos) << misspelt.err;
}

// Code blocks of the guides that begin with the name of a file, all in one folder.
TEST(Guides, HaveExamplesThatRunWithoutWarnings) {
  const ScratchFolder folder;
  const std::regex block(R"(```\w+\n(?:# |<!-- )(\w+\.\w+)(?: -->)?\n([\s\S]*?)```)");
  std::vector<std::string> files;
  for (const char* const guide : {"docs/worlds.md", "docs/devices.md"}) {
    const std::string text = read_file(std::filesystem::path(COHORT_SOURCE_DIR) / guide);
    for (std::sregex_iterator match(text.begin(), text.end(), block), end; match != end; ++match) {
      files.push_back((*match)[1]);
      write_file(folder / files.back(), (*match)[2]);
    }
  }
  EXPECT_EQ(files, (std::vector<std::string>{"cart.yaml", "arena.yaml", "avoid.yaml", "puck.sdf"}));
  for (const std::string& file : files) {
    const Ended checked = run_to_end({cohort_program(), "check", (folder / file).string()});
    EXPECT_EQ(checked.exit_code, 0) << file << ": " << checked.err;
    EXPECT_EQ(checked.err.find("warning"), std::string::npos) << file << ": " << checked.err;
  }
  const auto summary = run_experiment((folder / "avoid.yaml").string(), {"--controllers", "inprocess"});
  EXPECT_GT(summary["ticks"], 500) << summary.dump();  // a cart that leaves the arena ends the run
}

const std::string constant = "constant";
const std::string course =
    "print:\n  - {quantity: position, objects: r1, every: 0.5}\n  - {quantity: count, objects: 'r*', every: 1}\n"
    "events:\n  - {at: 1, move: {objects: r1, pose: [3, 4, 5, 0, 0, 0]}}\n  - {at: 1.5, remove: {objects: r1}}\n"
    "stop:\n  - beyond: {objects: r0, point: [-1, 0], direction: [1, 0], for: 2}\n";

TEST(Print, WritesATableToStandardOutputOrToAFile) {
  const SmallExperiment experiment(constant, course, 5.0);
  const std::string expected = "time,r1/x,r1/y,r1/z,r*/count\n0,1,0,0,2\n0.5,1,0,0,\n1,3,4,5,2\n1.5,,,,\n2,,,,1\n";
  const Ended printed = run_to_end(experiment.run({"--controllers", "inprocess"}));
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_EQ(printed.out, expected) << "nothing else, for scripts";
  EXPECT_NE(printed.err.find("stopped           by beyond: 'r0'"), std::string::npos) << printed.err;
  const std::string file = (experiment / "table.csv").string();
  const Ended written = run_to_end(experiment.run({"--controllers", "inprocess", "--csv", file}));
  EXPECT_EQ(read_file(file), expected);
  EXPECT_EQ(written.out.find("r1/x"), std::string::npos) << written.out;
  EXPECT_NE(written.out.find("stopped           by beyond: 'r0'"), std::string::npos) << written.out;
}

}  // namespace
}  // namespace cohort::test
