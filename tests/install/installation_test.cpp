// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <iterator>
#include <sstream>
#include <thread>

#include "tests/support/http.hpp"
#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// Nothing of the build tree is in sight.
const Process::Environment environment = {{"COHORT_MODEL_PATH", ""}, {"COHORT_PLUGIN_PATH", ""}};
// Nor fused multiply-add for the C library.
const Process::Environment environment_of_another_cpu = {
    {"COHORT_MODEL_PATH", ""}, {"COHORT_PLUGIN_PATH", ""}, {"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"}};

std::string version(int minor) { return std::to_string(COHORT_VERSION_MAJOR) + "." + std::to_string(minor); }
const std::string this_version = version(COHORT_VERSION_MINOR);

struct Ended {
  std::optional<int> exit_code;
  std::string output;
};

// A build is not waited for in vain, and takes as long as the machine needs: only ctest gives up.
Ended run(const std::vector<std::string>& command) {
  Process process(command, environment);
  while (process.running()) process.wait_for_exit();
  return {process.wait_for_exit(), process.output()};
}

// Cohort, installed into a prefix, and a project that knows nothing else of it.
class Installation : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch.emplace();
    prefix = *scratch / "prefix";
    outside = *scratch / "outside";
    const Ended installed = run({COHORT_CMAKE, "--install", COHORT_BUILD_DIR, "--prefix", prefix});
    ASSERT_EQ(installed.exit_code, 0) << installed.output;
    fs::copy(COHORT_SOURCE_DIR "/tests/install/outside", outside, fs::copy_options::recursive);
    fs::copy(COHORT_SOURCE_DIR "/client_sdk/examples", outside / "examples", fs::copy_options::recursive);
    for (const char* project : {"", "in_c"}) {
      const Ended configured = configure("build", this_version, project);
      ASSERT_EQ(configured.exit_code, 0) << configured.output;
      const Ended built = build(fs::path(project) / "build");
      ASSERT_EQ(built.exit_code, 0) << built.output;
    }
  }
  static void TearDownTestSuite() { scratch.reset(); }

  static Ended configure(const std::string& build_folder, const std::string& version, const fs::path& project = "") {
    const fs::path source = outside / project;
    return run({COHORT_CMAKE, "-G", COHORT_GENERATOR, "-S", source, "-B", source / build_folder, "-C", COHORT_SETTINGS,
                "-DCMAKE_PREFIX_PATH=" + prefix.string(), "-DWANTED_VERSION=" + version});
  }
  static Ended build(const std::string& build_folder, const std::string& target = "all") {
    return run({COHORT_CMAKE, "--build", outside / build_folder, "--target", target});
  }

  static std::string cohort() { return prefix / "bin/cohort"; }

  static std::string hash_of_run(const std::string& experiment, const std::string& controllers) {
    const ScratchFolder folder;
    const fs::path summary = folder / "summary.json";
    const Ended ended =
        run({cohort(), "run", outside / experiment, "--controllers", controllers, "--summary", summary});
    EXPECT_EQ(ended.exit_code, 0) << ended.output;
    return hash_in(summary);
  }

  static std::string hash_with_attached(const std::string& program, const Process::Environment& its_environment) {
    const ScratchFolder folder;
    const ReservedDomain domain;
    const fs::path summary = folder / "summary.json";
    Process server({cohort(), "serve", outside / "experiment.yaml", "--domain", domain.text(), "--summary", summary},
                   environment);
    Process controller({outside / program, "--domain", domain.text()}, its_environment);
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_EQ(controller.wait_for_exit(), 0) << controller.output();
    return hash_in(summary);
  }

  static inline std::optional<ScratchFolder> scratch;
  static inline fs::path prefix;
  static inline fs::path outside;
};

TEST_F(Installation, AnOutsideControllerGivesTheSameBitsAsPluginInEitherPlacementAndAsAProgram) {
  const std::string in_process = hash_of_run("experiment.yaml", "inprocess");
  EXPECT_EQ(in_process.size(), 16u) << in_process;
  EXPECT_EQ(hash_of_run("experiment.yaml", "process"), in_process);
  EXPECT_EQ(hash_with_attached("build/weaver", environment), in_process);
}

TEST_F(Installation, AnOutsideControllerInCGivesTheBitsOfItsTwinInCpp) {
  const std::string expected = hash_of_run("experiment.yaml", "inprocess");
  EXPECT_EQ(hash_of_run("in_c.yaml", "inprocess"), expected);
  EXPECT_EQ(hash_of_run("in_c.yaml", "process"), expected);
  EXPECT_EQ(hash_with_attached("in_c/build/weaver", environment_of_another_cpu), expected);
}

TEST_F(Installation, AnOutsideControllerGivesTheSameBitsOnAnyCpu) {
  const std::string expected = hash_of_run("experiment.yaml", "inprocess");
  EXPECT_EQ(hash_of_run("tuned.yaml", "inprocess"), expected);
  EXPECT_EQ(hash_with_attached("build/weaver", environment_of_another_cpu), expected);
}

// Firmware that speaks UDP: answers each datagram of a bridge with a command that depends on it.
class UdpFirmware {
 public:
  UdpFirmware() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place);
    socklen_t size = sizeof place;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { answer(); });
  }
  UdpFirmware(const UdpFirmware&) = delete;
  UdpFirmware& operator=(const UdpFirmware&) = delete;
  ~UdpFirmware() {
    ends_ = true;
    thread_.join();
    ::close(socket_);
  }
  std::string port() const { return std::to_string(port_); }
  int answers() const { return answers_; }

 private:
  void answer() {
    while (!ends_) {
      pollfd readable{socket_, POLLIN, 0};
      if (::poll(&readable, 1, 50) != 1) continue;
      std::string text(65536, ' ');
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const ssize_t count = ::recvfrom(socket_, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
      if (count <= 0) continue;
      std::istringstream observed(text.substr(0, static_cast<std::size_t>(count)));
      std::uint64_t tick = 0;
      double sum = 0.0;
      observed >> tick;
      for (double value = 0.0; observed >> value;) sum += value;
      std::string command = std::to_string(tick);
      for (int i = 0; i < 64; ++i) command += " " + std::to_string(0.05 + 0.01 * sum * i);
      ::sendto(socket_, command.data(), command.size(), 0, reinterpret_cast<sockaddr*>(&from), size);
      ++answers_;
    }
  }

  int socket_;
  std::uint16_t port_ = 0;
  std::atomic<bool> ends_{false};
  std::atomic<int> answers_{0};
  std::thread thread_;
};

TEST_F(Installation, AnOutsideBridgeIsAProgramOfItsOwnInCppAndInC) {
  std::vector<std::string> hashes;
  for (const char* bridge : {"build/udp_bridge", "in_c/build/udp_bridge", "build/udp_bridge"}) {
    const ScratchFolder folder;
    const ReservedDomain domain;
    const UdpFirmware firmware;
    Process server({cohort(), "serve", outside / "one_robot.yaml", "--domain", domain.text(), "--summary",
                    folder / "summary.json"},
                   environment);
    Process client({outside / bridge, "sbot", firmware.port()}, {{"COHORT_DOMAIN", domain.text()}});
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_EQ(client.wait_for_exit(), 0) << client.output();
    EXPECT_GE(firmware.answers(), 100);
    hashes.push_back(hash_in(folder / "summary.json"));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST_F(Installation, OutsideProgramsControlAndObserveARunInCppAndInC) {
  const ScratchFolder folder;
  const ReservedDomain domain;
  const Process::Environment its_domain = {{"COHORT_DOMAIN", domain.text()}};
  const auto serve = [&] {
    return std::make_unique<Process>(std::vector<std::string>{cohort(), "serve", outside / "one_robot.yaml", "--paused",
                                                              "--keep-snapshots", "0.5", "--domain", domain.text()},
                                     environment);
  };
  const auto drive = [&] {
    return std::make_unique<Process>(std::vector<std::string>{outside / "build/weaver"}, its_domain);
  };
  {
    const auto server = serve();
    const auto controller = drive();
    Process experimenter({outside / "in_c/build/experimenter", folder / "run.mcap"}, its_domain);
    EXPECT_EQ(experimenter.wait_for_exit(), 0) << experimenter.output();
    EXPECT_EQ(server->wait_for_exit(), 0) << server->output();
    for (const char* line : {"crate at 2.5 2 0.5\n", "event control\n", "with seed 5: 1 robot at tick 0, step 10 ms\n",
                             " of sbot\n", "the end: told\n"})
      EXPECT_NE(experimenter.output().find(line), std::string::npos) << line << experimenter.output();
    EXPECT_TRUE(fs::exists(folder / "run.mcap"));
  }
  const auto server = serve();
  const auto controller = drive();
  Process repeat({outside / "build/repeat_until_good", "0.01", "0.2", "3"}, its_domain);
  EXPECT_EQ(repeat.wait_for_exit(), 0) << repeat.output();
  EXPECT_NE(repeat.output().find("is good"), std::string::npos) << repeat.output();
  EXPECT_EQ(server->wait_for_exit(), 0) << server->output();
}

TEST_F(Installation, AnOutsidePluginShowsNothingButItself) {
  const std::string plugin = outside / "build/weaver.so";
  void* const library = dlopen(plugin.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << dlerror();
  EXPECT_NE(dlsym(library, "cohort_plugin"), nullptr);
  EXPECT_EQ(dlsym(library, "cohort_portable_math"), nullptr);
  dlclose(library);
}

TEST_F(Installation, FindPackageAcceptsThisMinorVersionOnly) {
  for (const int step : {-1, 1}) {
    const Ended other = configure("other", version(COHORT_VERSION_MINOR + step));
    EXPECT_NE(other.exit_code, 0);
    EXPECT_NE(other.output.find("version: " + this_version), std::string::npos) << other.output;
  }
  const Ended same = configure("same", this_version);
  EXPECT_EQ(same.exit_code, 0) << same.output;
}

TEST_F(Installation, ThePackageNamesNoFolderOfTheBuildAndNoneOfOurWarnings) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(prefix / COHORT_LIB_DIR / "cmake/Cohort")) {
    const std::string text = read_file(entry.path());
    for (const char* ours : {COHORT_SOURCE_DIR, COHORT_BUILD_DIR, "-Werror", "-Wall"})
      EXPECT_EQ(text.find(ours), std::string::npos) << entry.path() << " has " << ours;
    ++files;
  }
  EXPECT_GE(files, 5);
}

TEST_F(Installation, HasTheShippedExperimentAndItsController) {
  const fs::path experiment = prefix / "share/cohort/worlds/experiments/obstacle_avoidance.yaml";
  const Ended ended = run({cohort(), "run", experiment, "--duration", "0.1"});
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
}

TEST_F(Installation, HasThePageOfTheView) {
  if (!fs::exists(COHORT_BUILD_DIR "/share/cohort/view/page.js"))
    GTEST_SKIP() << "the page was not built: it needs a way to npm's registry, and tools/dev/install-packages "
                    "tools/dev/packages-node.txt";
  const fs::path recording = *scratch / "page.mcap";
  const fs::path experiment = prefix / "share/cohort/worlds/experiments/obstacle_avoidance.yaml";
  const Ended recorded = run({cohort(), "run", experiment, "--duration", "0.1", "--record", recording});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.output;
  Process view({cohort(), "view", recording, "--port", "0"}, environment);
  ASSERT_TRUE(view.wait_for_output("http://127.0.0.1:")) << view.output();
  expect_page(port_in(view.output()));
}

TEST_F(Installation, MayBeMoved) {
  const std::string before = hash_of_run("experiment.yaml", "process");
  const fs::path elsewhere = *scratch / "else where";
  fs::rename(prefix, elsewhere);
  prefix = elsewhere;
  EXPECT_EQ(hash_of_run("experiment.yaml", "process"), before);
  const Ended configured = configure("moved", this_version);
  EXPECT_EQ(configured.exit_code, 0) << configured.output;
  const Ended built = build("moved", "weaver_plugin");
  EXPECT_EQ(built.exit_code, 0) << built.output;
}

TEST_F(Installation, ContainsTheNoticesOfTheNpmPackagesInThePage) {
  if (!fs::exists(prefix / "share/cohort/view")) GTEST_SKIP() << "the page is not built";
  const std::string notices = read_file(prefix / "share/cohort/view/notices.txt");
  for (const char* package : {"three 0.", "uplot 1.", "Permission is hereby granted"})
    EXPECT_NE(notices.find(package), std::string::npos) << package;
}

TEST_F(Installation, ServiceHasFewRights) {
  if (!fs::exists("/usr/bin/systemd-analyze")) GTEST_SKIP() << "no systemd-analyze here";
  const fs::path instance = *scratch / "cohort@field.service";
  fs::copy_file(prefix / "lib/systemd/system/cohort@.service", instance);
  const Ended rated = run({"/usr/bin/systemd-analyze", "security", "--offline=true", "--threshold=30", instance});
  EXPECT_EQ(rated.exit_code, 0) << "an exposure above 3.0: " << rated.output;
}

}  // namespace
}  // namespace cohort::test
