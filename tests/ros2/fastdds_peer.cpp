// SPDX-License-Identifier: Apache-2.0

// A peer on Fast DDS that knows no types, for tests: fastdds_peer echo TOPIC TYPE QOS, or fastdds_peer match TYPE.
//
// `echo` writes what it reads from rt/TOPIC to rt/TOPIC_again. QOS: `reliable` or `best_effort`, then `,transient` if
// it is transient-local. `match` has a reader and a writer of each of the four kinds for each topic rt/to_N and
// rt/from_N. Either runs until it is ended by a signal.

#include <unistd.h>

#include <cstdio>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <stdexcept>
#include <string>

#include "tools/bridges/ros2/fastdds/opaque_type.hpp"

namespace {

namespace dds = eprosima::fastdds::dds;
constexpr auto dynamic_memory = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;

template <class Qos>
Qos with(Qos qos, const std::string& text) {
  const bool is_reliable = text.starts_with("reliable"), is_transient = text.ends_with(",transient");
  qos.reliability().kind = is_reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = is_transient ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 10;
  qos.endpoint().history_memory_policy = dynamic_memory;
  qos.data_sharing().off();
  return qos;
}

// Writes what a reader has.
struct Echo : dds::DataReaderListener {
  void on_data_available(dds::DataReader* reader) override {
    std::string sample;
    dds::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      writer->write(&sample);
      std::printf("echo %zu\n", sample.size());
      std::fflush(stdout);
    }
  }
  dds::DataWriter* writer = nullptr;
};

class Peer {
 public:
  explicit Peer(const std::string& type) : type_(type) {
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(0, dds::PARTICIPANT_QOS_DEFAULT);
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    dds::TypeSupport(new cohort::bridges::ros2::OpaqueType(type)).register_type(participant_);
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~Peer() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  dds::Topic* topic(const std::string& name) {
    return participant_->create_topic("rt/" + name, type_, dds::TOPIC_QOS_DEFAULT);
  }
  dds::DataWriter* write(dds::Topic* topic, const std::string& qos) {
    return publisher_->create_datawriter(topic, with(dds::DATAWRITER_QOS_DEFAULT, qos));
  }
  dds::DataReader* read(dds::Topic* topic, const std::string& qos, dds::DataReaderListener* listener = nullptr) {
    return subscriber_->create_datareader(topic, with(dds::DATAREADER_QOS_DEFAULT, qos), listener);
  }

 private:
  std::string type_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
};

// On both ends, the endpoints that match least are created first: if the last one matches, all have been announced.
constexpr const char* requested[] = {"reliable,transient", "reliable", "best_effort,transient", "best_effort"};
constexpr const char* offered[] = {"best_effort", "best_effort,transient", "reliable", "reliable,transient"};

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  Echo echo;
  if (what == "echo" && argc == 5) {
    Peer peer(argv[3]);
    const std::string name = argv[2];
    echo.writer = peer.write(peer.topic(name + "_again"), argv[4]);
    peer.read(peer.topic(name), argv[4], &echo);
    ::pause();
  } else if (what == "match" && argc == 3) {
    Peer peer(argv[2]);
    for (const char digit : {'0', '1', '2', '3'}) {
      auto* const to = peer.topic(std::string("to_") + digit);
      for (const char* qos : requested) peer.read(to, qos);
      auto* const from = peer.topic(std::string("from_") + digit);
      for (const char* qos : offered) peer.write(from, qos);
    }
    ::pause();
  } else {
    std::fprintf(stderr, "usage: fastdds_peer echo TOPIC TYPE QOS | match TYPE\n");
    return 2;
  }
}
