// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "tests/support/process.hpp"

// Programs that link a simulation, a batch, or whole runs with controllers in their process do not contain DDS or any
// other network code.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

std::string output_of(const std::vector<std::string>& command) {
  const Ended ended = run_to_end(command, {});
  EXPECT_EQ(ended.exit_code, 0) << command[0] << ": " << ended.err;
  return ended.out;
}

// Returns the network symbols that the program defines or imports, without their versions.
std::set<std::string> symbols_of_network(const fs::path& program) {
  // send and recv are excluded: a mesh is imported by a child process, over a pair of sockets.
  static const std::set<std::string> calls = {"socket",  "bind",     "listen",      "accept",    "accept4",
                                              "connect", "sendto",   "sendmsg",     "sendmmsg",  "recvfrom",
                                              "recvmsg", "recvmmsg", "getaddrinfo", "getifaddrs"};
  std::istringstream lines(output_of({"nm", "--format=posix", program}));
  std::set<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find_first_of(" @"));
    const bool is_of_dds =
        name.starts_with("dds") || name.starts_with("nn_") || name.find("cohort4wire11Participant") != name.npos;
    if (is_of_dds || name.starts_with("SSL_") || calls.contains(name)) found.insert(name);
  }
  return found;
}

// Returns the names of the network libraries that are loaded with it.
std::set<std::string> libraries_of_network(const fs::path& program) {
  std::istringstream lines(output_of({"ldd", program}));
  std::set<std::string> found;
  for (std::string name, line; lines >> name && std::getline(lines, line);)
    // libcrypto is excluded, as it hashes types of messages: TLS also needs libssl.
    for (const char* library : {"libddsc", "libdds", "libiceoryx", "libssl", "libcurl", "libboost"})
      if (fs::path(name).filename().string().starts_with(library)) found.insert(name);
  return found;
}

const fs::path programs = COHORT_BUILD_DIR "/bin";

class SimulatingNeedsNoNetwork : public ::testing::TestWithParam<std::string> {};

TEST_P(SimulatingNeedsNoNetwork, AndHasNoneInIt) {
  EXPECT_EQ(symbols_of_network(programs / GetParam()), std::set<std::string>());
  EXPECT_EQ(libraries_of_network(programs / GetParam()), std::set<std::string>());
}
INSTANTIATE_TEST_SUITE_P(Programs, SimulatingNeedsNoNetwork, ::testing::Values("step_world", "step_batch", "run_alone"),
                         [](const auto& program) { return program.param; });

TEST(SimulatingNeedsNoNetwork, ButAServerDoesAndIsDetected) {
  const std::set<std::string> symbols = symbols_of_network(programs / "send_bad_commands");
  EXPECT_TRUE(symbols.contains("dds_write")) << symbols.size();
}

TEST(SimulatingNeedsNoNetwork, ARunInAnotherProgramHasTheBitsOfCohortRun) {
  const std::string experiment = COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml";
  const std::string embedded =
      output_of({programs / "run_alone", experiment, COHORT_BUILD_DIR "/lib/controllers/obstacle_avoidance.so"});
  const ScratchFolder folder;
  std::string expected;
  for (const char* seed : {"1", "2"}) {
    const fs::path summary = folder / (std::string(seed) + ".json");
    output_of({cohort_program(), "run", experiment, "--controllers", "inprocess", "--seed", seed, "--summary", summary,
               "--quiet"});
    expected += hash_in(summary) + "\n";
  }
  EXPECT_EQ(embedded, expected);
}

TEST(SimulatingNeedsNoNetwork, ABatchInAnotherProgramHasTheSameBits) {
  const auto hashes = [](const std::string& worlds, const std::string& threads) {
    return output_of(
        {programs / "step_batch", COHORT_SOURCE_DIR "/worlds/experiments/plane.yaml", worlds, "20", threads});
  };
  const std::string of_five = hashes("5", "2");
  EXPECT_EQ(hashes("5", "1"), of_five);
  EXPECT_TRUE(of_five.starts_with(hashes("2", "1")));
}

}  // namespace
}  // namespace cohort::test
