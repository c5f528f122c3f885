// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/wire.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <array>
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
#include <vector>

#include "cohortPubSubTypes.h"

namespace cohort::conformance {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

constexpr const char* loopback = "127.0.0.1";
constexpr std::uint32_t socket_buffer = 4 * 1024 * 1024;
const Duration_t longest_write(0, 100'000'000);
const Duration_t join_lease(1, 0);

template <class Handle>
Handle* made(Handle* handle, const char* what) {
  if (handle == nullptr) throw std::runtime_error(std::string("Fast DDS makes no ") + what);
  return handle;
}

// Star topology: a separate transport without shared memory, the server as the only peer, no multicast.
dds::DomainParticipantQos participant_qos(std::uint32_t domain) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back(loopback);
  udp->sendBufferSize = socket_buffer;
  udp->receiveBufferSize = socket_buffer;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);

  rtps::Locator_t server;
  rtps::IPLocator::setIPv4(server, loopback);
  server.port = 7410 + 250 * domain;
  rtps::Locator_t own;
  rtps::IPLocator::setIPv4(own, loopback);
  auto& builtin = qos.wire_protocol().builtin;
  builtin.initialPeersList.push_back(server);
  // A separate locator for discovery avoids multicast. Index 0 is that of the server, even if it has not started: Fast
  // DDS begins at this index and takes the next one with free ports.
  builtin.metatrafficUnicastLocatorList.push_back(own);
  qos.wire_protocol().participant_id = 1;
  builtin.discovery_config.leaseDuration = Duration_t(5, 0);
  builtin.discovery_config.leaseDuration_announcementperiod = Duration_t(1, 0);
  return qos;
}

// QoS of a topic in the table of docs/protocol.md.
struct Quality {
  bool transient_local = false;
  int depth = 1;
  bool leased = false;
  bool reliable = true;
};
constexpr Quality join_quality{true, 1, true};
constexpr Quality admit_quality{true, 1};
constexpr Quality description_quality{true, 1};
constexpr Quality frame_quality{false, 8, false, false};
constexpr Quality report_quality{true, 16};
constexpr Quality state_quality{false, 4};

template <class Qos>
Qos endpoint_qos(Qos qos, const Quality& quality) {
  qos.reliability().kind = quality.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = longest_write;
  qos.durability().kind = quality.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = quality.depth;
  // Unlimited: the default is ten keys, and there may be more kinds of robots.
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  if (quality.leased) {
    qos.liveliness().kind = dds::AUTOMATIC_LIVELINESS_QOS;
    qos.liveliness().lease_duration = join_lease;
    qos.liveliness().announcement_period = Duration_t(0, 300'000'000);
  }
  // fastddsgen treats an unbounded sequence as one of at most a hundred elements.
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}

std::string partition_of(std::uint64_t client) {
  std::array<char, 18> text{};
  std::snprintf(text.data(), text.size(), "c%016llx", static_cast<unsigned long long>(client));
  return text.data();
}

}  // namespace

struct Wire::State final : dds::DataReaderListener {
  State(std::uint32_t domain, std::uint64_t its_client) : client(its_client) {
    participant =
        made(dds::DomainParticipantFactory::get_instance()->create_participant(domain, participant_qos(domain)),
             "participant");
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() override {
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }

  template <class PubSubType>
  dds::Topic* make_topic(const char* name) {
    dds::TypeSupport type(new PubSubType);
    type->auto_fill_type_object(false);
    type->auto_fill_type_information(false);
    type.register_type(participant);
    if (auto* known = dynamic_cast<dds::Topic*>(participant->lookup_topicdescription(name)); known != nullptr) {
      return known;
    }
    return made(participant->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT), name);
  }

  template <class PubSubType>
  dds::DataReader* make_reader(dds::Subscriber* subscriber, const char* topic, const Quality& quality) {
    return made(subscriber->create_datareader(make_topic<PubSubType>(topic),
                                              endpoint_qos(dds::DATAREADER_QOS_DEFAULT, quality), this),
                topic);
  }

  template <class PubSubType>
  dds::DataWriter* make_writer(dds::Publisher* publisher, const char* topic, const Quality& quality) {
    dds::DataWriterQos qos = endpoint_qos(dds::DATAWRITER_QOS_DEFAULT, quality);
    // The loss of a Join or Report is detected at the next heartbeat, by default every three seconds.
    qos.reliable_writer_qos().times.heartbeatPeriod = Duration_t(0, 100'000'000);
    return made(publisher->create_datawriter(make_topic<PubSubType>(topic), qos), topic);
  }

  void make_endpoints() {
    dds::SubscriberQos own_partition = dds::SUBSCRIBER_QOS_DEFAULT;
    own_partition.partition().push_back(partition_of(client).c_str());
    auto* to_all = made(participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
    auto* to_us = made(participant->create_subscriber(own_partition), "subscriber");
    auto* publisher = made(participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT), "publisher");
    descriptions =
        make_reader<message::RobotDescriptionPubSubType>(to_all, "cohort/v1/robot_description", description_quality);
    admits = make_reader<message::AdmitPubSubType>(to_us, "cohort/v1/admit", admit_quality);
    observations = make_reader<message::ObservationPubSubType>(to_us, "cohort/v1/observation", frame_quality);
    reports = make_reader<message::ReportPubSubType>(to_us, "cohort/v1/report", report_quality);
    states = make_reader<message::ControllerStatePubSubType>(to_us, "cohort/v1/controller_state", state_quality);
    own_states =
        make_writer<message::ControllerStatePubSubType>(publisher, "cohort/v1/controller_state", state_quality);
    joins = make_writer<message::JoinPubSubType>(publisher, "cohort/v1/join", join_quality);
    commands = make_writer<message::CommandPubSubType>(publisher, "cohort/v1/command", frame_quality);
    own_reports = make_writer<message::ReportPubSubType>(publisher, "cohort/v1/report", report_quality);
  }

  void on_data_available(dds::DataReader*) override {
    const std::lock_guard lock(mutex);
    news = true;
    arrived.notify_one();
  }

  template <class Message>
  static std::optional<Received<Message>> receive(dds::DataReader* reader) {
    Received<Message> received;
    dds::SampleInfo info;
    while (reader->take_next_sample(&received.message, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;  // it tells of the end of a writer
      std::ranges::copy(info.sample_identity.writer_guid().guidPrefix.value, received.from.begin());
      return received;
    }
    return std::nullopt;
  }

  template <class Message>
  static std::optional<Message> take(dds::DataReader* reader) {
    auto received = receive<Message>(reader);
    if (!received) return std::nullopt;
    return std::move(received->message);
  }

  std::uint64_t client;
  std::mutex mutex;
  std::condition_variable arrived;
  bool news = false;
  dds::DomainParticipant* participant = nullptr;
  dds::DataReader* descriptions = nullptr;
  dds::DataReader* admits = nullptr;
  dds::DataReader* observations = nullptr;
  dds::DataReader* reports = nullptr;
  dds::DataReader* states = nullptr;
  dds::DataWriter* joins = nullptr;
  dds::DataWriter* commands = nullptr;
  dds::DataWriter* own_reports = nullptr;
  dds::DataWriter* own_states = nullptr;
};

Wire::Wire(std::uint32_t domain, std::uint64_t client) : state_(std::make_unique<State>(domain, client)) {
  state_->make_endpoints();
}

Wire::~Wire() = default;

void Wire::wait_for_news(std::chrono::milliseconds at_most) {
  std::unique_lock lock(state_->mutex);
  state_->arrived.wait_for(lock, at_most, [&] { return state_->news; });
  state_->news = false;
}

std::optional<Received<message::Admit>> Wire::take_admit() { return State::receive<message::Admit>(state_->admits); }
std::optional<Received<message::RobotDescription>> Wire::take_description() {
  return State::receive<message::RobotDescription>(state_->descriptions);
}
std::optional<message::Observation> Wire::take_observation() {
  return State::take<message::Observation>(state_->observations);
}
std::optional<message::Report> Wire::take_report() { return State::take<message::Report>(state_->reports); }
std::optional<message::ControllerState> Wire::take_state() {
  return State::take<message::ControllerState>(state_->states);
}

void Wire::write(message::Join join) { state_->joins->write(&join); }
void Wire::write(message::Command command) { state_->commands->write(&command); }
void Wire::write(message::Report report) { state_->own_reports->write(&report); }
void Wire::write(message::ControllerState state) { state_->own_states->write(&state); }
void Wire::wait_for_reports_to_arrive() { state_->own_reports->wait_for_acknowledgments(Duration_t(0, 500'000'000)); }

bool Wire::sees_server() const {
  dds::SubscriptionMatchedStatus status;
  state_->admits->get_subscription_matched_status(status);
  return status.current_count > 0;
}

}  // namespace cohort::conformance
