// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "tests/commands/small_experiment.hpp"

// Messages for users' mistakes: one message says where the mistake is and what to do, the exit code is 2, and nothing
// is started.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void expect_only(const Ended& ended, const std::string& prefix, const std::string& message) {
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(lines_in(ended.err), 1u) << ended.err;
  EXPECT_TRUE(ended.err.starts_with(prefix)) << "expected " << prefix << "\ngot " << ended.err;
  EXPECT_NE(ended.err.find(message), std::string::npos) << "expected " << message << "\ngot " << ended.err;
  EXPECT_EQ(ended.out, "");
}

// Checks the same in a log that reports each started process.
nlohmann::json expect_only_in_json(std::vector<std::string> command, const std::string& message) {
  command.insert(command.end(), {"--verbose", "--log-format", "json"});
  const Ended ended = run_to_end(command);
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.err.find("is started"), std::string::npos) << ended.err;
  EXPECT_EQ(ended.out, "");
  nlohmann::json problem;
  std::istringstream log(ended.err);
  for (std::string line; std::getline(log, line);) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    if (object.value("level", "") == "info") continue;
    EXPECT_TRUE(problem.is_null()) << "a second message: " << line;
    problem = object;
  }
  EXPECT_EQ(problem.value("level", ""), "error");
  EXPECT_NE(problem.value("message", "").find(message), std::string::npos) << problem;
  return problem;
}

// ---- Mistakes in files ----

struct Mistake {
  const char* name;
  const char* file;  // that it is in
  const char* pattern;
  std::string replacement;
  int line;
  std::string element;  // or nothing
  std::string message;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class MistakeInAFile : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakeInAFile, PrintsOneMessageWithItsPlaceAndStartsNothing) {
  const Mistake& mistake = GetParam();
  const SmallExperiment experiment;
  const fs::path file = experiment / mistake.file;
  const std::string before = read_file(file);
  const std::string after = std::regex_replace(before, std::regex(mistake.pattern), mistake.replacement);
  ASSERT_NE(before, after);
  write_file(file, after);

  const nlohmann::json problem =
      expect_only_in_json(experiment.run({"--summary", (experiment / "summary.json").string(), "--plot",
                                          (experiment / "plot.svg").string()}),
                          mistake.message);
  EXPECT_EQ(problem.value("file", ""), file.string());
  EXPECT_EQ(problem.value("line", 0), mistake.line);
  EXPECT_EQ(problem.value("element", ""), mistake.element);
  EXPECT_FALSE(fs::exists(experiment / "summary.json"));
  EXPECT_FALSE(fs::exists(experiment / "plot.svg"));

  const std::string element = mistake.element.empty() ? "" : mistake.element + ": ";
  std::vector<std::string> check = {cohort_program(), "check", experiment.file()};
  if (mistake.name == std::string("PluginWithAnUnresolvedSymbol")) check.emplace_back("--load-controllers");
  expect_only(run_to_end(check), file.string() + ":" + std::to_string(mistake.line) + ": " + element, mistake.message);
}

const std::string plugin = R"(controller: \S*)";
Mistake bad_plugin(const char* name, const std::string& controller, const std::string& message) {
  return {name, "experiment.yaml", plugin.c_str(), "controller: " + controller, 6, "teams[0].controller", message};
}
const std::string link = "world/model[r0]/link[hull]";

INSTANTIATE_TEST_SUITE_P(
    Mistakes, MistakeInAFile,
    ::testing::Values(
        Mistake{"BadXml", "world.sdf", "</collision>", "</colision>", 10, "", "</colision> does not close <collision>"},
        Mistake{"UnknownElement", "world.sdf", "<mass>2</mass>", "<mas>2</mas>", 7, link + "/inertial/mas",
                "unknown element; did you mean 'mass'?"},
        Mistake{"UnknownExtension", "world.sdf", "\n *<cohort:joint>hinge</cohort:joint>",
                "\n<cohort:jont>hinge</cohort:jont>", 17, "world/model[r0]/cohort:joint_encoder[angle]/cohort:jont",
                "unknown element; did you mean 'cohort:joint'?"},
        Mistake{"ZeroMass", "world.sdf", "<mass>2", "<mass>0", 7, link + "/inertial/mass",
                "expected a mass > 0 kg, not 0"},
        Mistake{"NegativeMass", "world.sdf", "<mass>2", "<mass>-2", 7, link + "/inertial/mass",
                "expected a mass > 0 kg, not -2"},
        Mistake{"TwoOfOneName", "world.sdf", "\"r1\"", "\"r0\"", 20, "world/model[r0]",
                "another model has the name 'r0'"},
        Mistake{"NoSuchModel", "world.sdf", "</world>", "<include><uri>model://sbit</uri></include></world>", 29,
                "world/include/uri", "; did you mean 'sbot'?"},
        Mistake{"ForbiddenInclude", "world.sdf", "</world>", "<include><uri>/etc/passwd</uri></include></world>", 29,
                "world/include/uri", "the file is outside of all allowed folders; use --allow-files /etc to allow it"},
        Mistake{"BadYaml", "experiment.yaml", "duration: ", "\tduration: ", 2, "", "not YAML: "},
        Mistake{"UnknownKey", "experiment.yaml", "duration", "duraton", 2, "duraton",
                "unknown key; did you mean 'duration'?"},
        Mistake{"UnknownKeyOfATeam", "experiment.yaml", "controller", "controler", 6, "teams[0].controler",
                "unknown key; did you mean 'controller'?"},
        Mistake{"NoSuchWorld", "experiment.yaml", "world.sdf", "wold.sdf", 1, "world", "there is no such file: '/"},
        Mistake{"NoSuchRobot", "experiment.yaml", "robots: all", "robots: r2", 5, "teams[0].robots",
                "there is no robot 'r2'; did you mean 'r0'?"},
        Mistake{"UnknownRestart", "experiment.yaml", "    robots", "    restart: nevr\n    robots", 5,
                "teams[0].restart", "unknown value 'nevr'; did you mean 'never'?"},
        Mistake{"UnknownMode", "experiment.yaml", "    robots", "    mode: fre\n    robots", 5, "teams[0].mode",
                "unknown mode 'fre'; did you mean 'free'?"},
        Mistake{"FreeAndDelayed", "experiment.yaml", "    robots", "    mode: free\n    delay: 2\n    robots", 6,
                "teams[0].delay", "cannot be used with mode: free"},
        Mistake{"FreeAndWaitedFor", "experiment.yaml", "    robots", "    mode: free\n    on_late: wait\n    robots", 6,
                "teams[0].on_late", "'wait' cannot be used with mode: free; expected hold, zero, detach or stop"},
        Mistake{"RequiredOrNot", "experiment.yaml", "    robots", "    required: perhaps\n    robots", 5,
                "teams[0].required", "expected true or false, not 'perhaps'"},
        bad_plugin("PluginMissing", "nothing_like_it", "unknown controller plugin 'nothing_like_it'; known: "),
        bad_plugin("PluginPathMissing", "./nothing.so", "no controller plugin at /"),
        bad_plugin("NotAPlugin", test_controller("not_a_plugin"),
                   "is not a controller plugin: the symbol cohort_plugin is missing"),
        bad_plugin("NotALibrary", "./world.sdf", "is not a shared object. Build the plugin with cohort_add_controller"),
        bad_plugin("PluginOfAnotherVersion", test_controller("other_version"), "Rebuild the plugin"),
        bad_plugin("PluginWithAnUnresolvedSymbol", test_controller("unresolved"),
                   "undefined symbol: function_that_nobody_defines. Link the library that defines the symbol into the "
                   "plugin")),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Errors, ReportAMissingFile) {
  for (const char* command : {"run", "serve", "check"})
    for (const char* file : {"/nowhere/a.yaml", "/nowhere/a.sdf"})
      expect_only(run_to_end({cohort_program(), command, file}), std::string(file) + ": ", "there is no such file");
}

TEST(Errors, ReportAFolderInsteadOfAnExperiment) {
  const SmallExperiment experiment;
  const std::string folder = (experiment / "").string();
  expect_only(run_to_end({cohort_program(), "run", folder}), folder + ": ", "this is a folder");
}

TEST(Errors, NameTheMissingPluginsOfAllTeams) {
  const SmallExperiment experiment("nothing_like_it");
  write_file(experiment.file(),
             "world: world.sdf\nduration: 1\nteams:\n  - {name: a, robots: r0, controller: one}\n"
             "  - {name: b, robots: r1, controller: two}\n");
  const Ended run = run_to_end(experiment.run());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(lines_in(run.err), 2u) << run.err;
  EXPECT_NE(run.err.find(":4: teams[0].controller: unknown controller plugin 'one'"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(":5: teams[1].controller: unknown controller plugin 'two'"), std::string::npos) << run.err;
}

// ---- The network ----

TEST(Errors, NameADomainThatIsInUse) {
  const SmallExperiment experiment;
  const ReservedDomain domain;
  Process first({cohort_program(), "serve", experiment.file(), "--domain", domain.text()});
  ASSERT_TRUE(first.wait_for_output("serving 2 robots on 127.0.0.1, domain " + domain.text())) << first.output();
  expect_only(run_to_end({cohort_program(), "serve", experiment.file(), "--domain", domain.text()}),
              "cohort: error: ", "domain " + domain.text() + " is in use: another program uses UDP port ");
  expect_only_in_json(experiment.run({"--domain", domain.text()}),
                      "choose another domain for this server and its clients");
  EXPECT_TRUE(first.running());
}

TEST(Errors, NameAnAddressWithoutInterfaceAndThoseAvailable) {
  const SmallExperiment experiment;
  expect_only(run_to_end({cohort_program(), "serve", experiment.file(), "--network", "203.0.113.7"}),
              "cohort: error: ", "no active network interface has the address 203.0.113.7; known: 127.0.0.1");
}

TEST(Errors, ReportAMachineWithoutNetwork) {
  if (run_to_end({"/bin/sh", "-c", "unshare -rn true"}).exit_code != 0)
    GTEST_SKIP() << "namespaces are not permitted here";
  const SmallExperiment experiment;
  const auto without_network = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"/bin/sh", "-c", "exec unshare -rn \"$@\"", "sh", cohort_program()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  };
  expect_only_in_json(without_network({"run", experiment.file()}),
                      "no network interface that is up, not even loopback");
  expect_only(run_to_end(without_network({"host", "obstacle_avoidance", "--robots", "all"})),
              "cohort: error: ", "no route to the server at 127.0.0.1: Network is unreachable");
  EXPECT_EQ(run_to_end(without_network({"run", experiment.file(), "--controllers", "inprocess", "--duration", "0.1"}))
                .exit_code,
            0);
}

TEST(Errors, NameAServerWithoutAddress) {
  expect_only(run_to_end({cohort_program(), "host", "obstacle_avoidance", "--robots", "all", "--server",
                          "no.such.host.invalid"}),
              "cohort: error: ", "cannot find the address of 'no.such.host.invalid'");
}

// ---- Files that it writes ----

TEST(Errors, ReportAReadOnlyFolderBeforeTheRun) {
  const SmallExperiment experiment;
  // Even root cannot write there.
  for (const char* option : {"--summary", "--plot"})
    for (const char* file : {"/proc/nowhere", "/nowhere/at/all"})
      expect_only_in_json(experiment.run({option, file}), std::string(" cannot be written to ") + file + ": ");
}

TEST(Errors, DoNotRequireAWritableHome) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  for (const std::string& home : {std::string("/proc"), std::string("/nowhere/at/all"), experiment.file()}) {
    const Ended run = run_to_end(experiment.run({"--quiet"}), {{"HOME", home}});
    EXPECT_EQ(run.exit_code, 0) << home;
    EXPECT_EQ(run.err, "") << home;
  }
  std::vector<std::string> command = experiment.run({"--quiet"});
  command.insert(command.begin(), {"/usr/bin/env", "-u", "HOME"});
  const Ended run = run_to_end(command);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
}

// ---- Command lines ----

struct Typed {
  std::vector<std::string> arguments;
  std::string message;
  Process::Environment environment{};
};
void PrintTo(const Typed& typed, std::ostream* out) {
  for (const std::string& argument : typed.arguments) *out << argument << ' ';
}

class MistypedCommand : public ::testing::TestWithParam<Typed> {};

TEST_P(MistypedCommand, PrintsOneMessageThatSaysWhatToDo) {
  std::vector<std::string> command = {cohort_program()};
  command.insert(command.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  expect_only(run_to_end(command, GetParam().environment), "cohort: error: ", GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, MistypedCommand,
    ::testing::Values(
        Typed{{},
              "expected a command; known: run, serve, host, teleop, exec, ctl, record, view, page, film, examples, "
              "check, export, models, samples, security, doctor, recordings, replay, diff, export-data, plot, recover, "
              "help, completion, man-page, bench. Try 'cohort --help'"},
        Typed{{"rn", "x"}, "there is no command 'rn'; did you mean 'run'?"},
        Typed{{"run"}, "FILE is required. Try 'cohort run --help'"}, Typed{{"run", "x", "y"}, "unexpected 'y'"},
        Typed{{"run", "x", "--thread", "3"}, "there is no option '--thread'; did you mean '--threads'?"},
        Typed{{"run", "x", "--threads"}, "--threads needs a value"},
        Typed{{"run", "x", "--threads", "0"}, "--threads: expected a whole number from 1 to 1024, not '0'"},
        Typed{{"run", "x", "--duration", "nan"}, "--duration: expected a number of seconds above 0"},
        Typed{{"run", "x", "--duration", "1e300"}, "--duration: expected a number of seconds above 0"},
        Typed{{"run", "x", "--duration", "5s"}, "--duration: expected a number of seconds above 0 and up to"},
        Typed{{"run", "x", "--seed", "-1"}, "--seed: expected a whole number"},
        Typed{{"run", "x", "--speed", "fast"}, "--speed: expected max, or a number above 0"},
        Typed{{"run", "x", "--domain", "231"},
              "--domain: expected a domain from 0 to 230, or a range such as 7..14, not '231'"},
        Typed{{"run", "x"}, "not 'five' (COHORT_DOMAIN is 'five')", {{"COHORT_DOMAIN", "five"}}},
        Typed{{"run", "x"}, "there is no file, example or model named 'x'", {{"COHORT_DOMAIN", "70..72"}}},
        Typed{{"run", "x", "--controllers", "proces"}, "there is no 'proces'; did you mean 'process'?"},
        Typed{{"run", "x", "--quiet", "--verbose"}, "'--verbose' cannot be used with '--quiet'"},
        Typed{{"run", "x", "--log-format", "xml"}, "--log-format: there is no 'xml'; known: text, json"},
        Typed{
            {"run", "x"}, "COHORT_LOG_FORMAT: invalid format 'xml'; known: text, json", {{"COHORT_LOG_FORMAT", "xml"}}},
        Typed{{"run", "x"},
              "COHORT_LOG: invalid level 'loud'; known: debug, info, warn, error, off",
              {{"COHORT_LOG", "loud"}}},
        Typed{{"serve", "x", "--netwrk", "y"}, "there is no option '--netwrk'; did you mean '--network'?"},
        Typed{{"ctl", "set-pose", "x", "--pose", "0 0 0 0 1e100 0"},
              "expected roll, pitch and yaw from -1e6 to 1e6 rad, not '0 0 0 0 1e100 0'"},
        Typed{{"host", "x"}, "--robots is required"}, Typed{{"check"}, "FILE is required"},
        Typed{{"page"}, "FILE is required"}, Typed{{"page", "run.mcap"}, "--output is required"},
        Typed{{"page", "run.mcap", "-o", "run.html", "--fps", "0"}, "--fps: expected a number above 0"},
        Typed{{"page", "/nowhere/run.mcap", "-o", "run.html"}, "/nowhere/run.mcap"},
        Typed{{"film", "run.mcap"}, "--output is required"},
        Typed{{"film", "run.mcap", "-o", "run.png", "--size", "640"}, "--size 640: expected WIDTHxHEIGHT in pixels"},
        Typed{{"film", "run.mcap", "-o", "run.png", "--size", "4096x4096"}, "at most 3840x2160 in all"},
        Typed{{"film", "run.mcap", "-o", "run.png", "--fps", "0"}, "--fps: expected a whole number from 1 to 120"},
        Typed{{"film", "run.mcap", "-o", "run.png", "--theme", "drak"},
              "--theme: there is no 'drak'; did you mean 'dark'?"},
        Typed{{"film", "run.mcap", "-o", "run.png", "--top", "--camera", "c.yaml"},
              "'--camera' cannot be used with '--top'"},
        Typed{{"film", "obstacle_avoidance", "-o", "run.png"}, "cohort run obstacle_avoidance --record run.mcap"},
        Typed{{"bench", "--scene", "crowd,crwd"}, "--scene: there is no 'crwd'; did you mean 'crowd'?"},
        Typed{{"bench", "--engines", "mujocko"}, "--engines: there is no 'mujocko'; did you mean 'mujoco'?"},
        Typed{{"bench", "--robots", "0"}, "--robots: expected a whole number from 1 to 100000, not '0'"},
        Typed{{"bench", "--json", "/nowhere/at/all"}, "the results cannot be written to /nowhere/at/all: "}));

TEST(Errors, ReportAViewThatWasNotBuilt) {
  const ScratchFolder folder;
  const std::string alone = folder / "cohort";
  fs::copy_file(cohort_program(), alone);
  const Ended view = run_to_end({alone, "view", "run.mcap", "--port", "0"});
  EXPECT_EQ(view.exit_code, 2);
  EXPECT_NE(view.err.find("'cohort view' requires the program " + alone + "-whole, which does not exist"),
            std::string::npos)
      << view.err;
}

TEST(Help, ShowsAnExampleForEveryCommand) {
  for (const char* command : {"", "run", "serve", "host", "check", "view", "page", "film"}) {
    std::vector<std::string> arguments = {cohort_program(), command, "--help"};
    if (*command == '\0') arguments.erase(arguments.begin() + 1);
    const Ended help = run_to_end(arguments);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find(std::string("Example: cohort ") + command), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("--log-format"), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("--verbose"), std::string::npos) << help.out;
  }
}

TEST(Help, OfTheBenchIsThatOfItsProgram) {
  const Ended help = run_to_end({cohort_program(), "bench", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const char* text : {"cohort-bench [OPTIONS]", "Example: cohort-bench", "--log-format", "--verbose"})
    EXPECT_NE(help.out.find(text), std::string::npos) << text << help.out;
}

TEST(Help, ShowsVersionAndBuild) {
  const Ended version = run_to_end({cohort_program(), "--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(std::regex_search(version.out, std::regex(R"(^cohort \d+\.\d+\.\d+\ncommit +\w)"))) << version.out;
  for (const char* fact :
       {"\ncompiler  ", "-ffp-contract=off", "\narchitecture  ", "Cyclone DDS ", "\nmathematics   portable"})
    EXPECT_NE(version.out.find(fact), std::string::npos) << fact << version.out;
}

}  // namespace
}  // namespace cohort::test
