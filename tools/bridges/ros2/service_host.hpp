// SPDX-License-Identifier: Apache-2.0
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

/// Services in the ROS graph. A separate thread answers requests one after the other. Clients on Cyclone DDS use the
/// endpoints here, clients on Fast DDS those of the helper. Each request reaches both, and one of them answers it.
class ServiceHost {
 public:
  /// Offers the services once the helper offers them. All arguments passed by reference, and the services, must outlive
  /// this. Hides the helper in `graph`. Throws wire::WireError.
  ServiceHost(RosParticipant& participant, RosGraph& graph, std::span<const OfferedService> services,
              ServiceHelper::Options helper, const std::atomic<bool>& stop);
  /// Waits until the present request is answered.
  ~ServiceHost();
  ServiceHost(const ServiceHost&) = delete;
  ServiceHost& operator=(const ServiceHost&) = delete;

  /// Announces the helper's node to other participants, in this format from now on. Any thread.
  void announce(GidFormat format);
  /// Waits until no request is being answered, for at most `at_most`. Any thread.
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
