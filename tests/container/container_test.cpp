// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/container/podman.hpp"
#include "tests/support/file_lock.hpp"
#include "tests/support/http.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_bytes = 300'000'000;
constexpr auto npos = std::string::npos;
const std::string demo = "/usr/share/cohort/worlds/experiments/obstacle_avoidance.yaml";
const std::string sdk_image = "localhost/cohort-sdk:" COHORT_VERSION;

constexpr const char* install_list = ": tools/dev/install-packages tools/dev/packages-container.txt";

// The images of docker/, built of these sources.
class Container : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const fs::path folder = COHORT_CONTAINER_DIR;
    if (!is_installed("podman")) {
      missing = std::string("there is no podman") + install_list;
      return;
    }
    missing = make_base(folder);
    if (missing) return;
    podman.emplace(folder / "podman");
    const FileLock lock(folder / "podman/lock");
    missing = podman->prepare(folder);
    if (missing) return;
    // The first is named so that it stays, for what of it is needed again.
    for (const auto& [target, tag] : {std::pair{std::string("build"), std::string("localhost/cohort-build")},
                                      {"runtime", image},
                                      {"sdk", sdk_image}}) {
      const Ended built = podman->build(target, tag);
      ASSERT_EQ(built.exit_code, 0) << built.out;
    }
    (*podman)({"image", "prune", "--force"});
  }
  void SetUp() override {
    if (missing) GTEST_SKIP() << *missing;
  }

  static void start_server(Containers& containers, const std::vector<std::string>& more) {
    std::vector<std::string> command = {"serve", demo, "--verbose"};
    command.insert(command.end(), more.begin(), more.end());
    containers.start("server", {"--env", "COHORT_NETWORK=server", "--env", "COHORT_SERVER=server", "--cpus", "1"},
                     command);
  }
  static void start_controller(Containers& containers, const std::string& name, const std::string& robots) {
    containers.start(name, {"--env", "COHORT_SERVER=server", "--add-host", containers.server_host()},
                     {"host", "obstacle_avoidance", "--robots", robots});
  }
  static std::uint64_t tick_of(const Containers& containers) {
    const Ended status = containers.execute("server", {"cohort", "ctl", "status", "--json"});
    const auto json = nlohmann::json::parse(status.out, nullptr, false);
    return json.is_object() ? json.value("tick", std::uint64_t{0}) : 0;
  }
  static bool reaches(const Containers& containers, std::uint64_t tick) {
    return eventually([&] { return tick_of(containers) >= tick; });
  }

  static inline std::optional<std::string> missing;
  static inline std::optional<Podman> podman;
};

TEST_F(Container, ImageOfTheServerIsSmallAndHasNoCompilersPrivilegesOrSecrets) {
  const Ended size = (*podman)({"image", "inspect", "--format", "{{.Size}}", image});
  EXPECT_LT(std::stoull(size.out), most_bytes);
  RecordProperty("megabytes", std::to_string(std::stoull(size.out) / 1'000'000));
  const Ended labels = (*podman)({"image", "inspect", "--format", "{{json .Labels}}", image});
  EXPECT_NE(labels.out.find(R"("org.opencontainers.image.version":")" COHORT_VERSION), npos) << labels.out;
  EXPECT_NE(labels.out.find(R"("org.opencontainers.image.revision":"of-the-test")"), npos) << labels.out;

  const Ended inside =
      (*podman)({"run", "--rm", "--entrypoint", "sh", image, "-c",
                 "id -u; pwd; cohort --version; for each in cc gcc g++ cmake git; do command -v $each; "
                 "done; find / -xdev -name '*.pem' -path '*cohort*'"});
  EXPECT_TRUE(inside.out.starts_with("10001\n/var/lib/cohort\ncohort " COHORT_VERSION "\ncommit        of-the-test\n"))
      << inside.out;
  EXPECT_EQ(inside.out.find("/bin/"), npos) << "a compiler: " << inside.out;
  EXPECT_EQ(inside.out.find(".pem"), npos) << "a key: " << inside.out;
}

TEST_F(Container, ServerAndControllersInSeparateOnesGiveTheBitsOfOneProcess) {
  Containers containers(*podman);
  start_server(containers, {"--duration", "10"});
  start_controller(containers, "red", "0..7");
  start_controller(containers, "blue", "8..15");
  EXPECT_EQ(containers.wait("server"), 0);
  EXPECT_EQ(containers.wait("red"), 0) << containers.logs("red");
  EXPECT_EQ(containers.wait("blue"), 0) << containers.logs("blue");
  const std::string log = containers.logs("server");
  EXPECT_NE(log.find(reference_hash(10)), npos) << log;
  EXPECT_NE(log.find("built the world for 1 thread "), npos) << "of a quota of one core: " << log;
}

TEST_F(Container, ARunSurvivesTheKillingOfAControllersContainer) {
  Containers containers(*podman);
  start_server(containers, {"--duration", "10", "--paused", "--record", "run.mcap"});
  start_controller(containers, "red", "0..7");
  start_controller(containers, "blue", "8..15");
  const auto control = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"cohort", "ctl", "--timeout", patience_in_seconds};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ended ended = containers.execute("server", command);
    ASSERT_EQ(ended.exit_code, 0) << ended.out << containers.logs("server");
  };
  control({"step", "100"});
  containers.kill("red");
  control({"resume"});
  start_controller(containers, "red_again", "0..7");
  EXPECT_EQ(containers.wait("server"), 0);
  EXPECT_EQ(containers.wait("red"), 137);
  const std::string log = containers.logs("server");
  EXPECT_NE(log.find(reference_hash(10)), npos) << log;
  const Ended replayed = containers.run({"replay", "run.mcap", "--verify"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
}

TEST_F(Container, IsHealthyWhileItServesAndClosesItsRecordingWhenItIsStopped) {
  Containers containers(*podman);
  start_server(containers, {"--speed", "1", "--record", "run.mcap"});
  start_controller(containers, "all", "all");
  ASSERT_TRUE(reaches(containers, 50)) << containers.logs("server");
  EXPECT_TRUE(containers.is_healthy("server"));
  containers.stop("server");
  EXPECT_EQ(containers.wait("server"), 130) << containers.logs("server");
  EXPECT_EQ(containers.wait("all"), 0) << "it was told that the run is over: " << containers.logs("all");
  const Ended replayed = containers.run({"replay", "run.mcap", "--verify"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
  EXPECT_EQ(replayed.out.find("warning"), npos) << "the recording was not closed: " << replayed.out;
}

TEST_F(Container, ShowsThePageOfAServerInAnotherOneThroughItsPublishedPort) {
  Containers containers(*podman);
  start_server(containers, {"--speed", "1"});
  start_controller(containers, "all", "all");
  containers.start(
      "view", {"--env", "COHORT_SERVER=server", "--add-host", containers.server_host(), "--publish", "127.0.0.1::8080"},
      {"view", "--network", "0.0.0.0"});
  const std::string port = containers.published("view", "8080");
  expect_page(port);
  const std::string log = containers.logs("view");
  const std::size_t begin = log.find("#token=");
  ASSERT_NE(begin, npos) << log;
  const std::string token = log.substr(begin + 1, log.find('\n', begin) - begin - 1);
  EXPECT_TRUE(http_get_socket(port, "/").starts_with("HTTP/1.1 403 ")) << "without the token";
  EXPECT_TRUE(http_get_socket(port, "/?" + token).starts_with("HTTP/1.1 101 ")) << "with it";
  ASSERT_TRUE(reaches(containers, 50)) << containers.logs("server");
}

TEST_F(Container, ImageOfTheSdkBuildsAControllerThatTheServersImageRuns) {
  const ScratchFolder folder;
  fs::copy(COHORT_SOURCE_DIR "/tests/install/outside", folder / "robots", fs::copy_options::recursive);
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(folder / "robots", fs::perms::all);
  const std::string robots = (folder / "robots").string() + ":/robots";
  const Ended built = (*podman)({"run", "--rm", "--volume", robots, "--workdir", "/robots", sdk_image, "sh", "-ec",
                                 "cmake -G Ninja -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build"});
  ASSERT_EQ(built.exit_code, 0) << built.out;
  const Ended inside = (*podman)({"run", "--rm", "--volume", robots + ":ro", image, "run", "/robots/experiment.yaml"});
  EXPECT_EQ(inside.exit_code, 0) << inside.out;
  EXPECT_NE(inside.out.find("state hash"), npos) << inside.out;
}

// The services of the compose files, each started when what it depends on is ready, as Docker does. podman-compose 1.0
// ignores these conditions: it starts one service a second.
class ComposeFiles : public Container, public ::testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    Container::SetUp();
    if (!IsSkipped() && !is_installed("podman-compose")) GTEST_SKIP() << "there is no podman-compose" << install_list;
  }
  void TearDown() override {
    if (podman) podman->remove(project);
  }

  [[nodiscard]] bool is_secure() const { return *GetParam() != '\0'; }
  [[nodiscard]] std::string full(const std::string& service) const { return project + "_" + service + "_1"; }

  void create() const {
    std::vector<std::string> arguments = {"--project-name", project, "--file",
                                          COHORT_SOURCE_DIR "/docker/compose.yaml"};
    if (is_secure()) arguments.insert(arguments.end(), {"--file", GetParam()});
    arguments.insert(arguments.end(), {"up", "--no-build", "--no-start"});
    const Ended created = podman->compose(arguments);
    ASSERT_EQ(created.exit_code, 0) << created.out;
  }
  void start(const std::string& service) const {
    const Ended started = (*podman)({"start", full(service)});
    ASSERT_EQ(started.exit_code, 0) << started.out;
  }
  int wait(const std::string& service) const { return std::stoi((*podman)({"wait", full(service)}).out); }
  std::string logs(const std::string& service) const { return (*podman)({"logs", full(service)}).out; }
  // podman-compose 1.0 puts the health check of compose.secure.yaml behind that of compose.yaml.
  bool is_healthy(const std::string& service) const {
    const bool has_two_checks = is_secure() && service == "server";
    const Ended checked =
        has_two_checks
            ? (*podman)({"exec", full(service), "cohort", "ctl", "--secure", "/observer", "--timeout", "5", "status"})
            : (*podman)({"healthcheck", "run", full(service)});
    return checked.exit_code == 0;
  }

  const std::string project = fmt::format("cohort-test-{}", getpid());
};

TEST_P(ComposeFiles, RunServerControllersAndRecorderToTheBitsOfOneProcess) {
  ASSERT_NO_FATAL_FAILURE(create());
  if (is_secure()) {
    ASSERT_NO_FATAL_FAILURE(start("identities"));
    ASSERT_EQ(wait("identities"), 0) << logs("identities");
  }
  for (const char* service : {"server", "recorder"}) {
    ASSERT_NO_FATAL_FAILURE(start(service));
    ASSERT_TRUE(eventually([&] { return is_healthy(service) || logs(service).find("name resolution") != npos; }));
    if (logs(service).find("name resolution") != npos)
      GTEST_SKIP() << "podman knows no names of containers: golang-github-containernetworking-plugin-dnsname"
                   << install_list;
  }
  for (const char* service : {"red", "blue"}) ASSERT_NO_FATAL_FAILURE(start(service));
  for (const char* service : {"server", "red", "blue", "recorder"}) EXPECT_EQ(wait(service), 0) << logs(service);

  const auto summary = run_demo({"--controllers", "inprocess"});
  EXPECT_NE(logs("server").find(summary.value("state_hash", "no summary")), npos) << logs("server");
  const Ended replayed = (*podman)(
      {"run", "--rm", "--volume", project + "_state:/var/lib/cohort:ro", image, "replay", "run.mcap", "--verify"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << logs("recorder");
  EXPECT_NE(replayed.out.find("identical"), npos) << replayed.out;
}

INSTANTIATE_TEST_SUITE_P(Variants, ComposeFiles, ::testing::Values("", COHORT_SOURCE_DIR "/docker/compose.secure.yaml"),
                         [](const auto& variant) { return *variant.param == '\0' ? "Open" : "Secure"; });

TEST_F(Container, WithAViewShowsTheRunOfTheComposeFilesInTheHostsBrowser) {
  if (!is_installed("podman-compose")) GTEST_SKIP() << "there is no podman-compose" << install_list;
  const std::string project = fmt::format("cohort-test-view-{}", getpid());
  const std::string port = free_port();
  const Ended started =
      podman->compose({"--project-name", project, "--file", COHORT_SOURCE_DIR "/docker/compose.yaml", "--file",
                       COHORT_SOURCE_DIR "/docker/compose.view.yaml", "up", "--detach", "--no-build"},
                      {{"COHORT_VIEW_PORT", port}, {"COHORT_SPEED", "1"}});
  const std::string page = http_get(port, "/");
  const std::string log = (*podman)({"logs", project + "_view_1"}).out;
  podman->remove(project);
  EXPECT_EQ(started.exit_code, 0) << started.out;
  EXPECT_NE(page.find("<title>Cohort</title>"), npos) << page << started.out;
  EXPECT_NE(log.find("http://127.0.0.1:" + port + "/#token="), npos) << log;
}

}  // namespace
}  // namespace cohort::test
