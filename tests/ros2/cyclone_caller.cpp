// SPDX-License-Identifier: Apache-2.0

// A client of /get_simulation_state as rmw_cyclonedds has them.
//
// cyclone_caller CALLS OTHERS: prints when it sees the service and calls it CALLS times. Then it waits for OTHERS
// replies to clients on Fast DDS, which it sees as every client does. After one more call it prints the number of
// replies to its own calls. It also prints the number of replies to others, from the service on Cyclone DDS and from
// that on Fast DDS.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "idl/dds/ros2/ros_graph.hpp"
#include "idl/dds/ros2/ros_names.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/ros_simulation_services.hpp"

namespace {

using namespace cohort;
using Service = messages::ros::simulation::GetSimulationState;
using namespace std::chrono_literals;

constexpr std::uint64_t own_guid = 0x1122334455667788;
constexpr std::size_t encapsulation = 4;

struct Header {
  std::uint64_t guid = own_guid;
  std::int64_t number = 0;
};

ros2::EndpointSpec endpoint(ros2::TopicKind kind) {
  const char* const part = kind == ros2::TopicKind::request ? "_Request" : "_Response";
  return {ros2::dds_topic(kind, "/get_simulation_state"),
          ros2::dds_type(std::string(Service::type) + part),
          "clientid=1.2.3;",
          {true, false, 1000}};
}

// Replies received, by the number of the call; replies to others by their origin.
struct Replies {
  std::mutex mutex;
  std::condition_variable has_changed;
  std::map<std::int64_t, int> own;
  int wrong = 0;  // from Cyclone's service, to no client here
  int others = 0;

  void take(const messages::ByteView& bytes, bool is_of_cyclone) {
    const std::scoped_lock lock(mutex);
    Header header{0, 0};
    if (bytes.size() >= encapsulation + sizeof header)
      std::memcpy(&header, bytes.data() + encapsulation, sizeof header);
    if (header.guid == own_guid)
      ++own[header.number];
    else
      ++(is_of_cyclone ? wrong : others);
    has_changed.notify_all();
  }
  bool wait(const auto& condition) {
    std::unique_lock lock(mutex);
    return has_changed.wait_for(lock, 60s, condition);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int calls = std::stoi(argv[1]), others = std::stoi(argv[2]);
  ros2::RosParticipant participant({ros2::RosDomain::from_environment(), "/", "cyclone_caller"});
  Replies replies;
  ros2::RosReader* reader = nullptr;
  ros2::RosReader made(participant, endpoint(ros2::TopicKind::reply), [&](const ros2::Received& received) {
    const auto user_data = reader->user_data_of_writer(received.writer);
    replies.take(received.bytes, user_data && user_data->find("serviceid=") != std::string::npos);
  });
  reader = &made;
  ros2::RosWriter writer(participant, endpoint(ros2::TopicKind::request));
  // The bridge, whose id rmw_cyclonedds looks for, and the helper with its two readers.
  const auto sees_service = [&] {
    for (const std::string& user_data : writer.user_data_of_readers())
      if (user_data.starts_with("serviceid=") && !user_data.starts_with("serviceid=0;")) return true;
    return false;
  };
  const bool has_helper = others > 0;
  while (!sees_service() || made.participants().size() < (has_helper ? 2u : 1u) ||
         writer.readers() < (has_helper ? 3u : 1u))
    std::this_thread::sleep_for(5ms);
  std::puts("services are there");
  std::fflush(stdout);
  std::int64_t number = 0;
  const auto call = [&] {
    const Header header{own_guid, ++number};
    messages::Bytes bytes = messages::encode(Service::Request{});
    const auto* from = reinterpret_cast<const std::byte*>(&header);
    bytes.insert(bytes.begin() + encapsulation, from, from + sizeof header);
    writer.write(bytes);
    return replies.wait([&] { return replies.own.contains(number); });
  };
  bool is_complete = true;
  for (int i = 0; i < calls; ++i) is_complete &= call();
  is_complete &= replies.wait([&] { return replies.others >= others; });
  is_complete &= call();
  int own = 0;
  for (const auto& [each, count] : replies.own) own += count;
  std::printf("%sreplies: %d own, %d wrong, %d of others\n", is_complete ? "" : "a reply is missing; ", own,
              replies.wrong, replies.others);
  return is_complete ? 0 : 1;
}
