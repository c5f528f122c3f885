// SPDX-License-Identifier: Apache-2.0

// Drives robots of a run like any client, on Fast DDS: fastdds_client PLUGIN DOMAIN ROBOT[,ROBOT...] [LOSES_EVERY].
// Exit code 0 if the run finished.

#include <cstdio>
#include <exception>
#include <sstream>

#include "tests/conformance/client.hpp"

int main(int argc, char** argv) {
  using namespace cohort::conformance;
  if (argc != 4 && argc != 5) return 2;
  try {
    Options options;
    options.plugin = argv[1];
    options.domain = static_cast<std::uint32_t>(std::stoul(argv[2]));
    std::istringstream robots(argv[3]);
    for (std::string robot; std::getline(robots, robot, ',');) options.robots.push_back(robot);
    if (argc == 5) options.loses_every = std::stoull(argv[4]);
    return static_cast<int>(Client(options).run());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fastdds_client: %s\n", error.what());
  }
  return 64;
}
