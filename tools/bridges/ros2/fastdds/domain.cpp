// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/fastdds/domain.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/bridges/ros2/fastdds/guids.hpp"
#include "tools/bridges/ros2/fastdds/opaque_type.hpp"

namespace cohort::bridges::ros2 {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::rtps::IPLocator;

constexpr std::uint32_t participants_of_peer = 32;  // so many are looked for at each address

rtps::Locator_t locator_of(const std::string& address) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  locator.port = 0;
  if (!IPLocator::setIPv4(locator, address))
    throw std::runtime_error("peer '" + address + "': expected an IPv4 address");
  return locator;
}

dds::DomainParticipantQos participant_qos(const OpenDomain& how) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.name("/");
  qos.user_data().assign(how.user_data.begin(), how.user_data.end());
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->maxInitialPeersRange = participants_of_peer;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  auto& discovery = qos.wire_protocol().builtin;
  for (const std::string& peer : how.peers) discovery.initialPeersList.push_back(locator_of(peer));
  if (!how.multicast) {
    // An address of one's own choice takes the place of the multicast group.
    discovery.metatrafficUnicastLocatorList.push_back(locator_of("0.0.0.0"));
    if (how.peers.empty()) discovery.initialPeersList.push_back(locator_of("127.0.0.1"));
  } else if (!how.peers.empty()) {
    discovery.initialPeersList.push_back(locator_of("239.255.0.1"));
  }
  return qos;
}

}  // namespace

Domain::Domain(const OpenDomain& how) {
  const dds::StatusMask no_status = dds::StatusMask::none();  // discovery is reported all the same
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(how.domain, participant_qos(how),
                                                                                   this, no_status);
  if (participant_ == nullptr) throw std::runtime_error("cannot join domain " + std::to_string(how.domain));
  publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (publisher_ == nullptr || subscriber_ == nullptr)
    throw std::runtime_error("cannot create a publisher and a subscriber");
}

Domain::~Domain() {
  if (participant_ == nullptr) return;
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

Guid Domain::guid() const { return to_guid(participant_->guid()); }

dds::Topic* Domain::make_topic(const std::string& name, const std::string& type) {
  if (participant_->find_type(type).empty() &&
      dds::TypeSupport(new OpaqueType(type)).register_type(participant_) != ReturnCode_t::RETCODE_OK)
    throw std::runtime_error("type '" + type + "' cannot be registered");
  dds::Topic* topic = participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT);
  if (topic == nullptr) throw std::runtime_error("topic '" + name + "' cannot be created; it may exist already");
  return topic;
}

void Domain::on_publisher_discovery(dds::DomainParticipant*, WriterInfo&& info) {
  const auto& user_data = info.info.m_qos.m_userData;
  const std::string_view text(reinterpret_cast<const char*>(user_data.data()), user_data.size());
  const Guid writer = to_guid(info.info.guid());
  const std::lock_guard lock(mutex_);
  if (info.status == WriterInfo::REMOVED_WRITER)
    writers_of_cyclone_.erase(writer);
  else if (text.find("clientid=") != std::string_view::npos)
    writers_of_cyclone_.insert(writer);
}

bool Domain::is_of_cyclone(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  return writers_of_cyclone_.contains(writer);
}

void Domain::announce(Announce announced) {
  dds::DataWriter*& writer = announcers_[announced.topic];
  if (writer == nullptr) {
    dds::DataWriterQos qos = publisher_->get_default_datawriter_qos();
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 1;
    qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
    qos.data_sharing().off();
    writer = publisher_->create_datawriter(make_topic(announced.topic, announced.type), qos);
    if (writer == nullptr) throw std::runtime_error("cannot create a writer for '" + announced.topic + "'");
  }
  writer->write(&announced.sample);
}

}  // namespace cohort::bridges::ros2
