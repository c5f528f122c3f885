// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/http.hpp"
#include "tests/view/robots_at.hpp"
#include "tests/view/viewing.hpp"

namespace cohort::view {
namespace {

using namespace test;
using nlohmann::json;

// The demo's first seconds, recorded with a snapshot every second.
void record_demo(const std::filesystem::path& file, const std::string& seconds) {
  run_demo({"--duration", seconds, "--record", file, "--record-snapshots", "1"});
}

// Returns the number of a value among those of all channels.
std::size_t place_of(const std::vector<cohort::Channel>& channels, const std::string& name) {
  std::size_t place = 0;
  for (const cohort::Channel& channel : channels) {
    if (channel.name == name) return place;
    place += channel.size;
  }
  ADD_FAILURE() << "there is no channel " << name;
  return 0;
}

// Returns values of the demo's fourth robot at three times, by a replay.
json values_of_a_robot(const std::filesystem::path& file) {
  constexpr std::uint32_t robot = 3;
  const recording::Recording recording(file);
  recording::Replay replay(recording, 1);
  json samples = json::array();
  for (const double seconds : {0.5, 2.0, 3.5}) {
    EXPECT_TRUE(replay.seek(std::chrono::nanoseconds(std::llround(seconds * 1e9))));
    const Simulation& simulation = replay.simulation();
    const RobotKind& kind = simulation.kinds()[simulation.kind_of(robot)];
    json values;
    for (const char* name : {"treel/left/position", "treel/left/velocity", "proximity/3/reading"})
      values[name] = simulation.observation(robot)[place_of(kind.observation, name)];
    values["→ treel/left/velocity"] = simulation.command(robot)[place_of(kind.command, "treel/left/velocity")];
    samples.push_back({{"time", seconds}, {"values", values}});
  }
  return {{"id", robot}, {"name", replay.simulation().robot_name(robot)}, {"samples", samples}};
}

class InTheBrowser : public InABrowser {
 protected:
  ScratchFolder scratch;
};

TEST_F(InTheBrowser, RobotsOfARecordingAreDrawnWhereItSaysTheyAre) {
  record_demo(scratch / "run.mcap", "4");
  write_file(scratch / "expected.json", robots_at(scratch / "run.mcap", 2.5).dump());
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"draws", view.address(), scratch / "expected.json"});
}

// The process of the view ends with the run.
TEST_F(InTheBrowser, ARunBringsItsView) {
  Process run({cohort_program(), "run", demo_experiment(), "--view", "--control", "--duration", "600"});
  ASSERT_TRUE(run.wait_for_output("http://127.0.0.1:")) << run.output();
  const std::string output = run.output();
  const std::size_t begin = output.find("http://");
  run_script("browser.mjs", {"steers_server", output.substr(begin, output.find('\n', begin) - begin)});
  const std::vector<pid_t> children = children_of(run.pid());
  EXPECT_GE(children.size(), 2u) << "the controllers and the view";
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 130) << run.output();
  for (const pid_t child : children) EXPECT_TRUE(wait_until_gone(child));
}

// It begins when it is seen, and stays as long as it is.
TEST_F(InTheBrowser, ARunThatEndsSaysHowAndShowsItsRecording) {
  write_file(scratch / "xdg-open", "#!/bin/sh\nprintf %s \"$1\" > " + (scratch / "opened").string() + "\n");
  std::filesystem::permissions(scratch / "xdg-open", std::filesystem::perms::owner_all);
  const std::string path = scratch.path().string() + ":" + std::getenv("PATH");
  Process run({cohort_program(), "run", demo_experiment(), "--view", "--open", "--duration", "3", "--record",
               scratch / "run.mcap"},
              {{"PATH", path}});
  ASSERT_TRUE(run.wait_for_output("http://127.0.0.1:")) << run.output();
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(scratch / "opened"); })) << run.output();
  ASSERT_TRUE(eventually([&] { return !read_file(scratch / "opened").empty(); }));
  run_script("browser.mjs", {"sees_the_end", read_file(scratch / "opened")});
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
}

// On a disk that is full after 100 kB, as a limit of file sizes makes it.
TEST_F(InTheBrowser, ARunThatIsNoLongerRecordedIsToldSo) {
  const ReservedDomain domain;
  Process run({"/bin/sh", "-c", "ulimit -f 200; exec \"$@\"", "sh", cohort_program(), "run", demo_experiment(),
               "--domain", domain.text(), "--speed", "5", "--duration", "6000", "--record", scratch / "run.mcap"});
  const View view({"--domain", domain.text()});
  run_script("browser.mjs", {"tells_of_a_lost_recording", view.address()});
}

TEST_F(InTheBrowser, ARecordingIsSteeredByMouseKeysAndConsole) {
  record_demo(scratch / "run.mcap", "4");
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"steers_recording", view.address()});
}

TEST_F(InTheBrowser, PlotsShowTheWholeHistoryAfterASeek) {
  record_demo(scratch / "run.mcap", "4");
  write_file(scratch / "expected.json", values_of_a_robot(scratch / "run.mcap").dump());
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"plots", view.address(), scratch / "expected.json"});
}

TEST_F(InTheBrowser, PlotsOfAServerShowWhatTheViewHasSeen) {
  const ReservedDomain domain;
  Process run(
      {cohort_program(), "run", demo_experiment(), "--domain", domain.text(), "--speed", "1", "--duration", "600"});
  const View view({"--domain", domain.text()});
  run_script("browser.mjs", {"plots_server", view.address()});
}

TEST_F(InTheBrowser, KeyBindingsCanBeChangedAndPersist) {
  record_demo(scratch / "run.mcap", "1");
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"keeps_profile", view.address()});
}

TEST_F(InTheBrowser, ALostConnectionIsFoundAgain) {
  record_demo(scratch / "run.mcap", "2");
  auto view = std::make_unique<View>(std::vector<std::string>{scratch / "run.mcap"});
  const std::string port = view->port();
  Process script = start_script("browser.mjs", {"is_found_again", view->address()});
  ASSERT_TRUE(script.wait_for_output("connected")) << script.output();
  view.reset();
  ASSERT_TRUE(script.wait_for_output("lost")) << script.output();
  const View again({scratch / "run.mcap", "--port", port});
  EXPECT_EQ(script.wait_for_exit(), 0) << script.output();
}

TEST_F(InTheBrowser, ARunningServerIsSeenAndSteered) {
  const ReservedDomain domain;
  Process run(
      {cohort_program(), "run", demo_experiment(), "--domain", domain.text(), "--speed", "1", "--duration", "600"});
  const View view({"--domain", domain.text(), "--control"});
  run_script("browser.mjs", {"steers_server", view.address()});
}

TEST_F(InTheBrowser, ARunningServerGoesBackInTimeAndTellsWhatHappens) {
  const ReservedDomain domain;
  Process run({cohort_program(), "run", demo_experiment(), "--domain", domain.text(), "--speed", "1", "--duration",
               "60", "--keep-snapshots", "0.5"});
  const View view({"--domain", domain.text(), "--control"});
  run_script("browser.mjs", {"goes_back", view.address()});
}

TEST_F(InTheBrowser, AReadOnlyViewCannotControl) {
  const ReservedDomain domain;
  Process run(
      {cohort_program(), "run", demo_experiment(), "--domain", domain.text(), "--speed", "1", "--duration", "600"});
  const View view({"--domain", domain.text()});
  run_script("browser.mjs", {"only_looks", view.address()});
}

// So many s-bots on a plane, for a tenth of a second.
void record_many(const ScratchFolder& folder, int count) {
  const int half = static_cast<int>(std::ceil(0.25 * std::sqrt(count)));
  write_file(folder / "world.yaml", fmt::format(R"(world:
  name: field
  model: {{name: ground, static: true, link: {{name: body, collision: {{name: floor, geometry: {{plane: {{normal: [0, 0, 1], size: [3, 3]}}}}}}}}}}
  cohort:physics: {{fidelity: planar}}
  cohort:population:
    name: swarm
    uri: model://sbot
    count: {}
    placement: {{uniform: {{min: [-{}, -{}], max: [{}, {}]}}, gap: 0.05}}
)",
                                                count, half, half, half, half));
  write_file(folder / "many.yaml",
             "world: world.yaml\nduration: 0.1\nteams:\n  - {name: swarm, robots: swarm/*, controller: "
             "obstacle_avoidance}\n");
  run_experiment(folder / "many.yaml", {"--controllers", "inprocess", "--record", folder / "run.mcap"});
}

class ManyRobotsInTheBrowser : public InTheBrowser, public ::testing::WithParamInterface<int> {};

TEST_P(ManyRobotsInTheBrowser, AreDrawnAtOnce) {
  record_many(scratch, GetParam());
  write_file(scratch / "expected.json", robots_at(scratch / "run.mcap", 0.05).dump());
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"draws_many", view.address(), scratch / "expected.json"});
}
INSTANTIATE_TEST_SUITE_P(AThousandAndTenThousand, ManyRobotsInTheBrowser, ::testing::Values(1000, 10'000));

// Two teams of 8 s-bots each on a plane.
TEST_F(InTheBrowser, RobotsHaveTheColoursOfTheirTeams) {
  write_file(scratch / "world.yaml", R"(world:
  name: field
  model: {name: ground, static: true, link: {name: body, collision: {name: floor, geometry: {plane: {normal: [0, 0, 1], size: [3, 3]}}}}}
  cohort:physics: {fidelity: planar}
  cohort:population:
    - {name: a, uri: model://sbot, count: 8, placement: {uniform: {min: [-1, -1], max: [1, 1]}, gap: 0.05}}
    - {name: b, uri: model://sbot, count: 8, placement: {uniform: {min: [-1, -1], max: [1, 1]}, gap: 0.05}}
)");
  write_file(scratch / "teams.yaml", R"(world: world.yaml
duration: 0.1
teams:
  - {name: first, robots: a/*, controller: obstacle_avoidance}
  - {name: second, robots: b/*, controller: obstacle_avoidance}
)");
  run_experiment(scratch / "teams.yaml", {"--controllers", "inprocess", "--record", scratch / "run.mcap"});
  write_file(scratch / "expected.json", robots_at(scratch / "run.mcap", 0.05).dump());
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"colours_teams", view.address(), scratch / "expected.json"});
}

TEST_F(InTheBrowser, APageThatDrawsTooSlowlyDrawsCoarser) {
  record_demo(scratch / "run.mcap", "1");
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"draws_as_it_can", view.address()});
}

class FramedInTheBrowser : public InTheBrowser, public ::testing::WithParamInterface<const char*> {};

TEST_P(FramedInTheBrowser, RobotsStayInThePictureUntilTheUserMovesTheCamera) {
  run_experiment(
      std::string(COHORT_SOURCE_DIR "/worlds/experiments/") + GetParam() + ".yaml",
      {"--controllers", "inprocess", "--duration", "40", "--record", scratch / "run.mcap", "--record-snapshots", "5"});
  const View view({scratch / "run.mcap"});
  run_script("browser.mjs", {"keeps_in_frame", view.address()});
}
INSTANTIATE_TEST_SUITE_P(OfExperiments, FramedInTheBrowser, ::testing::Values("obstacle_avoidance", "hexapod"));

using ByItsProtocol = Viewing;

TEST_F(ByItsProtocol, ItsOwnClientReadsWhatIsShown) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "2");
  const View view({scratch / "run.mcap"});
  run_script("client.mjs", {"reads", view.address()});
}

TEST_F(ByItsProtocol, HistoriesAreThoseOfTheRecording) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "4");
  write_file(scratch / "expected.json", values_of_a_robot(scratch / "run.mcap").dump());
  const View view({scratch / "run.mcap"});
  run_script("client.mjs", {"histories", view.address(), scratch / "expected.json"});
}

TEST_F(ByItsProtocol, MalformedFramesAreToldAndNothingElse) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "2");
  View view({scratch / "run.mcap"});
  run_script("client.mjs", {"sends_nonsense", view.address()});
  run_script("client.mjs", {"reads", view.address()});
  EXPECT_TRUE(view.process().running());
}

TEST_F(ByItsProtocol, AClientThatDoesNotReadCostsNoMemory) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "4");
  View view({scratch / "run.mcap"});
  run_script("client.mjs", {"reads_nothing", view.address(), std::to_string(view.process().pid())});
}

// They ask again and again, so that none of them is idle for long.
TEST_F(ByItsProtocol, ManyConnectionsOfOneClientLockNobodyOut) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "1");
  const View view({scratch / "run.mcap"});
  std::vector<TcpConnection> connections(200);
  const std::string request = "GET /nothing HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  for (const TcpConnection& connection : connections)
    if (connection.connect(view.port())) connection.send(request);
  std::atomic<bool> is_over = false;
  std::thread asks([&] {
    for (; !is_over; std::this_thread::sleep_for(100ms))
      for (const TcpConnection& connection : connections) connection.send(request);
  });
  expect_page(view.port());
  run_script("client.mjs", {"reads", view.address()});
  is_over = true;
  asks.join();
}

TEST_F(ByItsProtocol, ARunShowsItselfAtThePortThatIsAskedFor) {
  const ReservedDomain domain;
  const std::string port = View({"--domain", domain.text()}).port();  // which is free now
  Process run({cohort_program(), "run", demo_experiment(), "--view", "--port", port, "--duration", "600"});
  EXPECT_TRUE(run.wait_for_output("http://127.0.0.1:" + port + "/")) << run.output();
  expect_page(port);
}

TEST_F(ByItsProtocol, StrangersAreRefused) {
  const ScratchFolder scratch;
  record_demo(scratch / "run.mcap", "1");
  const View view({scratch / "run.mcap", "--token", "0123456789abcdef"});
  run_script("client.mjs", {"is_refused", view.address()});
}

}  // namespace
}  // namespace cohort::view
