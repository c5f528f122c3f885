#pragma once

#include <atomic>
#include <chrono>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "idl/dds/ros2/ros_graph.hpp"
#include "tools/bridges/ros2/cyclone_service.hpp"
#include "tools/bridges/ros2/robots/ros_inbox.hpp"
#include "tools/bridges/ros2/service_helper.hpp"

namespace cohort::ros2 {

/// Services in the graph of ROS: takes requests and answers one after the other, on a thread of its own. Clients on
/// Cyclone DDS have endpoints here, clients on Fast DDS in the helper. Each request comes to both, and one answers it.
class ServiceHost {
 public:
  /// Offers the services when the helper does. They must outlive this, and so must the others. `graph` then leaves out
  /// the helper. Throws wire::WireError.
  ServiceHost(RosParticipant& participant, RosGraph& graph, std::span<const OfferedService> services,
              ServiceHelper::Options helper, const std::atomic<bool>& stop);
  /// Returns when the request at hand is answered.
  ~ServiceHost();
  ServiceHost(const ServiceHost&) = delete;
  ServiceHost& operator=(const ServiceHost&) = delete;

  /// Tells others of the helper's node, in this format from now on. Any thread.
  void announce(GidFormat format);
  /// Waits until no request is being answered, for `at_most`. Any thread.
  void wait_for_request(std::chrono::milliseconds at_most) const;

 private:
  // A reply to a client on Cyclone DDS that cannot receive it yet.
  struct Waiting {
    CycloneService& service;
    CycloneRequest to;
    messages::Bytes reply;
    std::chrono::steady_clock::time_point until;
  };
  void run();
  void answer_cyclone();
  void answer_helper();
  void send_waiting();
  std::optional<messages::Bytes> reply_to(std::size_t service, messages::ByteView request);

  const std::span<const OfferedService> services_;
  RosInbox inbox_;
  ServiceHelper helper_;
  std::vector<std::unique_ptr<CycloneService>> cyclone_;  // by service
  std::list<Waiting> waiting_;
  std::atomic<GidFormat> format_{GidFormat::since_iron};
  std::atomic<bool> is_to_announce_{true};
  std::atomic<bool> is_busy_{false};
  std::atomic<bool> is_over_{false};
  std::thread thread_;  // made last
};

}  // namespace cohort::ros2
