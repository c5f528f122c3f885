// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/service_helper.hpp"

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "idl/dds/ros2/ros_names.hpp"

namespace cohort::ros2 {
namespace {

namespace frames = bridges::ros2;
using namespace std::chrono_literals;

constexpr auto longest_start = 20s;

std::string bytes_of(messages::ByteView bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

frames::OpenDomain open_domain(const RosDomain& domain) {
  frames::OpenDomain open{.domain = domain.number,
                          .user_data = "enclave=/;",
                          .multicast = domain.range == DiscoveryRange::subnet,
                          .peers = domain.static_peers};
  if (domain.range == DiscoveryRange::localhost) open.peers.push_back("127.0.0.1");
  return open;
}

frames::OfferService offer_of(std::uint32_t number, const OfferedService& service) {
  const std::string user_data = "typehash=" + service.type_hash + ";";
  // Clients on Cyclone DDS look for the writer of this id, and so do not take the helper for their service.
  const std::string other = "serviceid=0;";
  return {.service = number,
          .request_topic = dds_topic(TopicKind::request, service.name),
          .request_type = dds_type(service.type + "_Request"),
          .request_user_data = other + user_data,
          .reply_topic = dds_topic(TopicKind::reply, service.name),
          .reply_type = dds_type(service.type + "_Response"),
          .reply_user_data = user_data,
          .is_shared = true};
}

}  // namespace

ServiceHelper::ServiceHelper(Options options, std::span<const OfferedService> services, const std::atomic<bool>& stop)
    : options_(std::move(options)) {
  // It would be unreachable.
  if (options_.domain.range == DiscoveryRange::off && options_.domain.static_peers.empty()) return;
  try {
    if (!std::filesystem::exists(options_.program)) throw std::runtime_error("no such program: " + options_.program);
    process_ = std::make_unique<frames::ServiceProcess>(std::vector{options_.program});
    offer(services, stop);
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

void ServiceHelper::offer(std::span<const OfferedService> services, const std::atomic<bool>& stop) {
  process_->send(open_domain(options_.domain));
  for (std::uint32_t i = 0; i < services.size(); ++i) process_->send(offer_of(i, services[i]));
  info_.nodes.push_back({"/", options_.node, {}, {}});
  NodeInfo& node = info_.nodes.front();
  const auto deadline = std::chrono::steady_clock::now() + longest_start;
  while (node.readers.size() < services.size() && !stop) {
    const auto frame = process_->receive(100ms);
    if (!frame && process_->has_ended()) throw std::runtime_error("cohort-ros2-services has ended");
    if (!frame && std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error("cohort-ros2-services does not answer");
    if (!frame) continue;
    if (const auto* opened = std::get_if<frames::DomainOpened>(&*frame)) info_.participant = opened->participant;
    if (const auto* offered = std::get_if<frames::ServiceOffered>(&*frame)) {
      node.readers.push_back(offered->request_reader);
      node.writers.push_back(offered->reply_writer);
    }
  }
}

void ServiceHelper::give_up(const std::string& why) {
  process_.reset();
  options_.tell("services are not available to clients on Fast DDS: " + why);
}

void ServiceHelper::with_process(const std::function<void(frames::ServiceProcess&)>& body) {
  if (!process_) return;
  try {
    body(*process_);
    if (process_->has_ended()) give_up("cohort-ros2-services has ended");
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

std::optional<Gid> ServiceHelper::participant() const {
  return process_ ? std::optional(info_.participant) : std::nullopt;
}

void ServiceHelper::announce(GidFormat format) {
  with_process([&](frames::ServiceProcess& process) {
    process.send(frames::Announce{discovery_topic, discovery_type, bytes_of(encode_discovery(info_, format))});
  });
}

std::optional<frames::RequestReceived> ServiceHelper::request() {
  std::optional<frames::RequestReceived> request;
  with_process([&](frames::ServiceProcess& process) {
    while (const auto frame = process.receive())
      if (const auto* received = std::get_if<frames::RequestReceived>(&*frame)) {
        request = *received;
        return;
      }
  });
  return request;
}

void ServiceHelper::reply(const frames::RequestReceived& to, messages::ByteView reply) {
  with_process([&](frames::ServiceProcess& process) {
    process.send(frames::SendReply{to.service, to.client, to.sequence, bytes_of(reply)});
  });
}

}  // namespace cohort::ros2
