// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <mutex>
#include <set>

#include "tools/bridges/ros2/fastdds/domain.hpp"
#include "tools/bridges/ros2/fastdds/output.hpp"
#include "tools/bridges/ros2/services/service_frames.hpp"

namespace cohort::bridges::ros2 {

/// The two endpoints of a service. A request is identified by its client's reader and by the sequence number of the
/// client's writer. A reply has both in `related_sample_identity`, as in rmw_fastrtps.
class Service : private eprosima::fastdds::dds::DataReaderListener, private eprosima::fastdds::dds::DataWriterListener {
 public:
  /// Throws std::runtime_error.
  Service(Domain& domain, Output& output, const OfferService& offered);
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() override;

  Guid request_reader() const;
  Guid reply_writer() const;
  void reply(SendReply reply);
  void drop_old_replies();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    SendReply reply;
    Clock::time_point until;
  };

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
  void on_publication_matched(eprosima::fastdds::dds::DataWriter*,
                              const eprosima::fastdds::dds::PublicationMatchedStatus& info) override;
  bool is_there(const Guid& client) const;
  void send_waiting();
  void write(SendReply& reply);

  Domain& domain_;
  Output& output_;
  const std::uint32_t number_;
  mutable std::mutex mutex_;
  std::set<Guid> clients_;       // readers of replies; under mutex_, like the next member
  std::deque<Waiting> waiting_;  // replies whose client's reader is not matched yet
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  eprosima::fastdds::dds::DataReader* counted_reader_ = nullptr;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
};

}  // namespace cohort::bridges::ros2
