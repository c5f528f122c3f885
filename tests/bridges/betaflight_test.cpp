// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <sstream>

#include "tests/bridges/betaflight_stand_in.hpp"
#include "tests/bridges/bridged_run.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

const std::string bridge_program = COHORT_BUILD_DIR "/bin/cohort-betaflight-bridge";

struct Place {
  double time, x, y, z;
};

// Copters of worlds/robots/quadcopter_x, 3 m apart, each on a pad.
class Field {
 public:
  Field(int copters, double duration, double take_off_at, double land_at) {
    std::string world =
        "world:\n  name: field\n  model:\n"
        "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n";
    std::string robots = "  include:\n";
    for (int i = 0; i < copters; ++i) {
      const std::string number = std::to_string(i), x = std::to_string(3 * i);
      world += "    - {name: pad_" + number + ", static: true, pose: [" + x +
               ", 0, 0, 0, 0, 0], link: {visual: {geometry: {cylinder: {radius: 0.4, length: 0.002}}}}}\n";
      robots += "    - {uri: model://quadcopter_x, name: copter_" + number + ", pose: [" + x + ", 0, 0, 0, 0, 0.5]}\n";
    }
    write_file(folder_ / "world.yaml", world + robots);
    std::ostringstream experiment;
    experiment << "world: world.yaml\nstep: 0.001\nduration: " << duration
               << "\nseed: 1\nteams:\n  - name: copters\n    robots: all\n    controller: hover\n"
               << "    parameters: {heights: [1], take_off_at: " << take_off_at << ", land_at: " << land_at << "}\n";
    write_file(folder_ / "experiment.yaml", experiment.str());
  }

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  std::vector<std::string> serve(const ReservedDomain& domain, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {
        cohort_program(), "serve",     (folder_ / "experiment.yaml").string(), "--domain",
        domain.text(),    "--summary", (folder_ / "summary.json").string()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  std::vector<std::string> bridge(const ReservedDomain& domain, const std::vector<std::string>& more) const {
    std::vector<std::string> command = {bridge_program, "--domain", domain.text()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  nlohmann::json summary() const { return read_json(folder_ / "summary.json"); }

 private:
  ScratchFolder folder_;
};

// A server, a bridge, and a stand-in for the program: what the bridge does, without a clock.
class BetaflightBridge : public ::testing::Test {
 protected:
  BetaflightBridge() : program_(domain_.number()) {}

  void simulate(const std::vector<std::string>& options = {}, const std::vector<std::string>& of_server = {}) {
    program_.boot();
    simulate_before_boot(options, of_server);
  }
  void simulate_before_boot(const std::vector<std::string>& options = {},
                            const std::vector<std::string>& of_server = {}) {
    std::vector<std::string> all = {"--listen", program_.simulator(), "--at", program_.address()};
    all.insert(all.end(), options.begin(), options.end());
    server_ = std::make_unique<Process>(field_.serve(domain_, of_server));
    bridge_ = std::make_unique<Process>(field_.bridge(domain_, all));
  }
  // Answers state packets until this time, or until the run ends, with what the copter hovers by.
  void fly(double until = std::numeric_limits<double>::max()) {
    while (server_->running()) {
      const auto state = program_.receive_state(20);
      if (!state) continue;
      program_.command({0.54F, 0.54F, 0.54F, 0.54F});
      if ((*state)[0] >= until) return;
    }
  }
  std::string hash() {
    const auto ended = server_->wait_for_exit();
    EXPECT_EQ(ended, 0) << server_->output();
    if (ended != 0) bridge_->signal(SIGINT);  // it would wait for another server
    EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
    return field_.summary()["state_hash"];
  }

  ReservedDomain domain_;
  Field field_{1, 0.5, 8, 70};
  BetaflightStandIn program_;
  std::unique_ptr<Process> server_, bridge_;
};

TEST_F(BetaflightBridge, StateAndSticksAreWhatTheDescriptionSays) {
  simulate();
  const auto state = program_.receive_state();
  ASSERT_TRUE(state);
  EXPECT_EQ((*state)[0], 0.0);
  for (int axis = 1; axis <= 3; ++axis) EXPECT_NEAR((*state)[axis], 0.0, 0.01) << "angular velocity";
  EXPECT_NEAR((*state)[4], 0.0, 0.5);
  EXPECT_NEAR((*state)[5], 0.0, 0.5);
  EXPECT_NEAR((*state)[7], std::cos(0.25), 1e-6);
  EXPECT_NEAR((*state)[8], 0.0, 1e-6);
  EXPECT_NEAR((*state)[9], 0.0, 1e-6);
  EXPECT_NEAR((*state)[10], -std::sin(0.25), 1e-6) << "half a radian to the left is to the west";
  for (int axis = 11; axis <= 16; ++axis) EXPECT_NEAR((*state)[axis], 0.0, 0.1) << "velocity and position";
  EXPECT_NEAR((*state)[17], 101325.0, 10.0);
  const std::array<std::uint16_t, 16> channels = program_.receive_channels();
  EXPECT_EQ(channels[0], 1500);
  EXPECT_EQ(channels[1], 1500);
  EXPECT_EQ(channels[2], 1000) << "throttle";
  EXPECT_EQ(channels[3], 1500);
  EXPECT_EQ(channels[4], 1000) << "disarmed";
  EXPECT_EQ(channels[5], 2000) << "ANGLE";

  program_.command({0, 0, 0, 0});
  const auto again = program_.receive_state();
  ASSERT_TRUE(again);
  EXPECT_EQ((*again)[0], 0.0) << "after a pause it comes twice, for the program's clock";
  program_.command({0, 0, 0, 0});
  for (int frame = 1; frame <= 3; ++frame) {
    std::optional<std::array<double, 18>> later;
    do {
      later = program_.receive_state();
      ASSERT_TRUE(later);
    } while ((*later)[0] < 0.001 * frame);  // states that came again, since this test was slow
    program_.command({0, 0, 0, 0});
    EXPECT_NEAR((*later)[6], -9.81, 1.0) << "at rest, negated";
  }
}

// Betaflight's clock goes at the rate of simulated to real time between its last two packets. A program whose clock
// stands still never answers, unless a later time comes soon after an earlier one.
TEST_F(BetaflightBridge, AStateThatComesAgainHasALaterTimeSoonAfter) {
  simulate();
  fly(0.1);
  std::optional<std::array<double, 18>> before = program_.receive_state();
  ASSERT_TRUE(before);
  int later = 0;
  for (int packet = 0; packet < 20; ++packet) {
    const auto state = program_.receive_state();
    ASSERT_TRUE(state);
    EXPECT_GE((*state)[0], (*before)[0]) << "the program ignores packets with an earlier time";
    EXPECT_LT((*state)[0], (*before)[0] + 0.001) << "time stands still";
    if ((*state)[0] > (*before)[0]) ++later;
    before = state;
  }
  EXPECT_GE(later, 9);
  fly();
  hash();
}

// The program has the motors 2, 3, 4 and 1 in its packet: front right, rear left, front left, rear right.
TEST_F(BetaflightBridge, MotorsAreThoseOfTheMixer) {
  simulate();
  for (int frame = 0; frame < 200; ++frame) {
    ASSERT_TRUE(program_.receive_state());
    program_.command(
        {0.6F, 0.6F, 0.5F, 0.5F});  // front right and rear left turn counter-clockwise, and turn it clockwise
  }
  const auto state = program_.receive_state();
  ASSERT_TRUE(state);
  EXPECT_GT((*state)[3], 0.1) << "yaw to the right";
  program_.command({0.5F, 0.6F, 0.5F, 0.6F});
  for (int frame = 0; frame < 200; ++frame) {
    ASSERT_TRUE(program_.receive_state());
    program_.command({0.5F, 0.7F, 0.5F, 0.7F});  // the rear ones
  }
  const auto pitched = program_.receive_state();
  ASSERT_TRUE(pitched);
  EXPECT_LT((*pitched)[2], -0.1) << "nose down";
}

// Betaflight crashes if a state comes before its sensors are there.
TEST_F(BetaflightBridge, AProgramThatBootsGetsNoState) {
  simulate_before_boot();
  ASSERT_TRUE(server_->wait_for_output("waiting for copter_0")) << server_->output() << bridge_->output();
  EXPECT_FALSE(program_.receive_state(600)) << "states are sent again every 250 ms";
  program_.boot();
  fly();
  const std::string late = hash();
  simulate();
  fly();
  EXPECT_EQ(late, hash());
}

TEST_F(BetaflightBridge, AProgramThatIsStartedOnceMoreGetsNoStateBeforeItHasBooted) {
  simulate();
  fly(0.1);
  ASSERT_TRUE(bridge_->wait_for_output("is silent")) << bridge_->output();
  program_.shut_down();
  bool is_quiet = false;
  for (int state = 0; state < 100 && !is_quiet; ++state) is_quiet = !program_.receive_state(600);
  EXPECT_TRUE(is_quiet);
  program_.boot();
  fly();
  hash();
}

TEST_F(BetaflightBridge, TwoRunsAndAnyNumberOfThreadsGiveTheSameBitsWithAProgramThatHasNoClock) {
  std::vector<std::string> hashes;
  for (const char* threads : {"1", "1", "2"}) {
    simulate({}, {"--threads", threads});
    fly();
    hashes.push_back(hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST_F(BetaflightBridge, InvalidServoPacketsAreReportedAndIgnored) {
  simulate();
  fly();
  const std::string expected = hash();
  simulate();
  fly(0.1);
  ASSERT_TRUE(program_.receive_state());
  program_.send({1, 2, 3, 4, 5, 6, 7});
  program_.command({0.5F, std::nanf(""), 0.5F, 0.5F});
  program_.command({0.5F, 0.5F, 7.0F, 0.5F});
  EXPECT_TRUE(bridge_->wait_for_output("has sent a datagram of 7 bytes"));
  EXPECT_TRUE(bridge_->wait_for_output("motor 3 has the command nan"));
  EXPECT_TRUE(bridge_->wait_for_output("motor 4 has the command 7"));
  program_.command({0.54F, 0.54F, 0.54F, 0.54F});
  fly();
  EXPECT_EQ(hash(), expected);
}

TEST_F(BetaflightBridge, TimeStandsStillWhileTheProgramIsSilentAndPeopleAreTold) {
  simulate();
  fly(0.1);
  EXPECT_TRUE(bridge_->wait_for_output("is silent"));
  EXPECT_TRUE(server_->running());
  const auto again = program_.receive_state();
  ASSERT_TRUE(again);
  fly();
  hash();
}

TEST_F(BetaflightBridge, OrTheMotorsStopAndTheRunGoesOn) {
  simulate({"--without-program", "stand", "--patience", "10"});
  fly(0.1);
  hash();
}

TEST_F(BetaflightBridge, LeavesWhenTheServerDoesWhileTheProgramIsSilent) {
  simulate();
  fly(0.1);
  server_->signal(SIGINT);
  EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
}

TEST(BetaflightBridgeOptions, AreRefusedWithWhatToDo) {
  expect_refusals("cohort-betaflight-bridge",
                  {{{"--robots", "all"}, "single robots"},
                   {{"--robots", "0..2"}, "--listen expects one address for each robot"},
                   {{"--run", "/no/such/program"}, "cannot run '/no/such/program'"},
                   {{"--run", "/bin/true", "--listen", "127.0.0.1"}, "--listen"},
                   {{"--folder", "here"}, "--run"},
                   {{"--run", "/bin/true", "--configure", "/no/file"}, "cannot read '/no/file'"},
                   {{"--listen", "nowhere"}, "is not an IPv4 address"}});
}

// Betaflight itself.
class Betaflight : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::string_view(COHORT_BETAFLIGHT).empty())
      GTEST_SKIP() << "without the program: tools/dev/python-environment --bridges makes it, tools/test finds it";
    const pid_t child = ::fork();
    if (child == 0) ::_exit(::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0 ? 0 : 1);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (status != 0) GTEST_SKIP() << "this system does not allow user namespaces";
  }
  // Lives until the programs have ended that write there.
  const Field& lay_out(int copters, double duration, double take_off_at, double land_at) {
    field_ = std::make_unique<Field>(copters, duration, take_off_at, land_at);
    return *field_;
  }
  void simulate(const Field& field, const std::string& robots, const std::vector<std::string>& of_server = {},
                const std::vector<std::string>& of_bridge = {}) {
    server_ = std::make_unique<Process>(field.serve(domain_, of_server));
    std::vector<std::string> options = {"--robots",        robots,     "--run",
                                        COHORT_BETAFLIGHT, "--folder", (field / "betaflight").string()};
    options.insert(options.end(), of_bridge.begin(), of_bridge.end());
    bridge_ = std::make_unique<Process>(field.bridge(domain_, options));
  }
  void expect_end() {
    const auto ended = server_->wait_for_exit();
    EXPECT_EQ(ended, 0) << server_->output();
    if (ended != 0) bridge_->signal(SIGINT);  // it would wait for another server
    EXPECT_EQ(bridge_->wait_for_exit(), 0) << bridge_->output();
  }
  using Rows = std::vector<std::vector<std::string>>;
  // Returns a table of the recording.
  static Rows table(const Field& field, const std::string& name) {
    const Ended ended = run_to_end(
        {cohort_program(), "export-data", (field / "run.mcap").string(), "--csv", (field / "tables").string()});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    Rows rows;
    for (const std::string& line : lines_of(read_file(field / ("tables/" + name + ".csv")))) {
      std::istringstream in(line);
      rows.emplace_back();
      for (std::string cell; std::getline(in, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }
  static std::vector<Place> path(const Field& field, const std::string& copter) {
    std::vector<Place> places;
    for (const std::vector<std::string>& cells : table(field, "trajectories")) {
      if (cells.size() < 7 || cells[2] != copter) continue;
      places.push_back({std::stod(cells[1]), std::stod(cells[4]), std::stod(cells[5]), std::stod(cells[6])});
    }
    return places;
  }
  static std::string hash_at(const Field& field, const std::string& tick) {
    for (const std::vector<std::string>& cells : table(field, "ticks"))
      if (cells.size() == 4 && cells[2] == tick) return cells[3];
    return "no tick " + tick;
  }

  ReservedDomain domain_;
  std::unique_ptr<Field> field_;
  std::unique_ptr<Process> server_, bridge_;
};

// The second run ends while the copter hovers.
TEST_F(Betaflight, TakesOffHoversAndLandsWithTheSameBitsTwice) {
  constexpr int again = 11;
  std::string expected;
  {
    const Field& field = lay_out(1, 24, 7, 17);
    simulate(field, "copter_0", {"--threads", "1", "--record", (field / "run.mcap").string(), "--record-poses", "20"});
    expect_end();
    double drift = 0.0, error = 0.0;
    const std::vector<Place> places = path(field, "copter_0");
    ASSERT_FALSE(places.empty());
    for (const Place& place : places) {
      if (place.time < 11 || place.time > 17) continue;
      drift = std::max(drift, std::hypot(place.x, place.y));
      error = std::max(error, std::abs(place.z - 1.0));
    }
    EXPECT_LT(drift, 0.3);
    EXPECT_LT(error, 0.3);
    EXPECT_LT(places.back().z, 0.05);
    EXPECT_LT(std::hypot(places.back().x, places.back().y), 0.5);
    std::printf("drift %.3f m, height %.3f m, real-time factor %.2f\n", drift, error,
                double{field.summary()["real_time_factor"]});
    expected = hash_at(field, std::to_string(again * 1000));
  }
  const Field& field = lay_out(1, again, 7, 17);
  simulate(field, "copter_0", {"--threads", "2"});
  expect_end();
  EXPECT_EQ(field.summary()["ticks"], again * 1000);
  EXPECT_EQ(field.summary()["state_hash"], expected);
}

TEST_F(Betaflight, FliesThreeAtOnceOnOneMachineWithTheSameBitsTwice) {
  std::vector<std::string> hashes;
  for (int run = 0; run < 2; ++run) {
    const Field& field = lay_out(3, 11, 7, 70);
    simulate(field, "0..2", {"--record", (field / "run.mcap").string(), "--record-poses", "10"});
    expect_end();
    hashes.push_back(field.summary()["state_hash"]);
    for (int i = 0; i < 3; ++i) {
      const std::vector<Place> places = path(field, "copter_" + std::to_string(i));
      ASSERT_FALSE(places.empty());
      EXPECT_NEAR(places.back().z, 1.0, 0.6);
      EXPECT_NEAR(places.back().x, 3 * i, 0.5);
      EXPECT_NEAR(places.back().y, 0.0, 0.5);
      EXPECT_TRUE(std::filesystem::exists(field / ("betaflight/" + std::to_string(i) + "/eeprom.bin")));
    }
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Betaflight, FliesByTheWallsClockToo) {
  const Field& field = lay_out(1, 11, 7, 70);
  simulate(field, "copter_0", {"--speed", "1", "--record", (field / "run.mcap").string(), "--record-poses", "10"},
           {"--time", "wall"});
  expect_end();
  EXPECT_NEAR(path(field, "copter_0").back().z, 1.0, 0.6);
}

// Betaflight's scheduler may hang at its start; here a program stands for it that is always silent.
TEST_F(Betaflight, IsStartedAgainIfItNeverBegins) {
  const Field& field = lay_out(1, 60, 7, 70);
  std::filesystem::create_directories(field / "betaflight/0");
  write_file(field / "betaflight/0/eeprom.bin", "configured");
  write_file(field / "silent", "#!/bin/sh\necho started >> starts\nexec sleep 1000\n");
  std::filesystem::permissions(field / "silent", std::filesystem::perms::owner_all);
  server_ = std::make_unique<Process>(field.serve(domain_));
  bridge_ = std::make_unique<Process>(field.bridge(
      domain_, {"--run", (field / "silent").string(), "--folder", (field / "betaflight").string(), "--time", "wall"}));
  EXPECT_TRUE(bridge_->wait_for_output("has sent no servo packet in 20 s, and is started again")) << bridge_->output();
  EXPECT_TRUE(eventually([&] { return read_file(field / "betaflight/0/starts") == "started\nstarted\n"; }));
  EXPECT_TRUE(server_->running());
}

// The same, while it is configured: here its first start only listens.
TEST_F(Betaflight, IsStartedAgainIfItsCommandLineIsSilent) {
  const Field& field = lay_out(1, 0.5, 7, 70);
  write_file(field / "silent_once", "#!/bin/sh\nif [ -e started ]; then exec " COHORT_BETAFLIGHT
                                    " \"$@\"; fi\ntouch started\nexec python3 -c 'import socket, time\n"
                                    "listener = socket.create_server((\"127.0.0.1\", 5761))\ntime.sleep(1000)'\n");
  std::filesystem::permissions(field / "silent_once", std::filesystem::perms::owner_all);
  server_ = std::make_unique<Process>(field.serve(domain_));
  bridge_ = std::make_unique<Process>(
      field.bridge(domain_, {"--run", (field / "silent_once").string(), "--folder", (field / "betaflight").string()}));
  expect_end();
  EXPECT_TRUE(std::filesystem::exists(field / "betaflight/0/eeprom.bin"));
}

TEST_F(Betaflight, IsConfiguredByADumpThatEndsWithSave) {
  const Field& field = lay_out(1, 0.5, 7, 70);
  write_file(field / "dump.txt", "# dump\nbatch start\nset angle_limit = 30\n\nbatch end\nsave\n");
  simulate(field, "copter_0", {}, {"--configure", (field / "dump.txt").string()});
  expect_end();
  EXPECT_TRUE(std::filesystem::exists(field / "betaflight/copter_0/eeprom.bin"));
}

TEST_F(Betaflight, ItsEndInTheMiddleOfARunIsNamed) {
  const Field& field = lay_out(1, 60, 7, 70);
  simulate(field, "copter_0");
  ASSERT_TRUE(bridge_->wait_for_output("flies the robot")) << bridge_->output() << server_->output();
  EXPECT_TRUE(eventually([&] {
    for (const pid_t child : children_of(bridge_->pid())) ::kill(child, SIGKILL);
    return !bridge_->running();
  })) << bridge_->output();
  EXPECT_EQ(bridge_->wait_for_exit(), 1);
  EXPECT_NE(bridge_->output().find("Betaflight was terminated by the signal Killed"), std::string::npos)
      << bridge_->output();
}

TEST_F(Betaflight, AProgramEndsWithItsBridge) {
  const Field& field = lay_out(1, 60, 7, 70);
  simulate(field, "copter_0");
  ASSERT_TRUE(bridge_->wait_for_output("flies the robot")) << bridge_->output() << server_->output();
  std::vector<pid_t> programs;
  ASSERT_TRUE(eventually([&] { return (programs = children_of(bridge_->pid())).size() == 1; }))
      << programs.size() << " children\n"
      << bridge_->output() << server_->output();
  bridge_->signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(programs.front()));
}

TEST_F(Betaflight, RestartsWhenTheWorldIsReset) {
  const Field& field = lay_out(1, 60, 7, 70);
  simulate(field, "copter_0");
  ASSERT_TRUE(bridge_->wait_for_output("flies the robot")) << bridge_->output() << server_->output();
  const std::vector<pid_t> before = children_of(bridge_->pid());
  const Ended reset = run_to_end({cohort_program(), "ctl", "--domain", domain_.text(), "reset"});
  EXPECT_EQ(reset.exit_code, 0) << reset.err;
  EXPECT_TRUE(eventually([&] {
    const std::vector<pid_t> after = children_of(bridge_->pid());
    return after.size() == 1 && after != before &&
           bridge_->output().rfind("flies the robot") != bridge_->output().find("flies the robot");
  })) << bridge_->output();
}

}  // namespace
}  // namespace cohort::test
