// SPDX-License-Identifier: Apache-2.0

// Writes arbitrary bytes, again and again, on a topic of ROS 2: ros_writer TOPIC TYPE HEX.

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "idl/dds/ros2/ros_graph.hpp"
#include "idl/dds/ros2/ros_participant.hpp"

int main(int argc, char** argv) {
  using namespace cohort::ros2;
  if (argc != 4) return 2;
  const std::string hex = argv[3];
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  RosParticipant::Options options;
  options.name = "stray";
  RosParticipant participant(options);
  const RosGraph graph(participant, [] {});  // as all nodes have it: it hears what the bridge announces
  RosWriter writer(participant, topic_endpoint(argv[1], argv[2], ""));
  participant.announce(GidFormat::since_iron);
  for (;;) {
    writer.write(bytes);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}
