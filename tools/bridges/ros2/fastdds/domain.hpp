// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "tools/bridges/ros2/services/service_frames.hpp"

namespace cohort::bridges::ros2 {

/// The helper's participant in a domain. All members except is_of_cyclone are called from one thread.
class Domain : private eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// Joins a domain. Throws std::runtime_error.
  explicit Domain(const OpenDomain& how);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  ~Domain() override;

  Guid guid() const;
  eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
  eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }

  /// Returns a new topic of an opaque type. Throws std::runtime_error.
  eprosima::fastdds::dds::Topic* make_topic(const std::string& name, const std::string& type);
  /// Publishes a sample in place of the last one on its topic. Throws std::runtime_error.
  void announce(Announce announced);
  /// Returns whether this writer belongs to a client on Cyclone DDS, which the bridge answers without the helper. Any
  /// thread.
  bool is_of_cyclone(const Guid& writer);

 private:
  using WriterInfo = eprosima::fastrtps::rtps::WriterDiscoveryInfo;
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*, WriterInfo&& info) override;

  std::mutex mutex_;
  std::set<Guid> writers_of_cyclone_;  // under mutex_
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  std::map<std::string, eprosima::fastdds::dds::DataWriter*> announcers_;  // by topic
};

}  // namespace cohort::bridges::ros2
