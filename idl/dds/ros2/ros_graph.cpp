// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/ros_graph.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "idl/dds/ros2/participant_state.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/cdr.hpp"
#include "idl/text/printable.hpp"

namespace cohort::ros2 {
namespace {

// Limits of the graph, whose size depends on other programs: further entries are ignored.
constexpr std::size_t most_endpoints = 100'000;
constexpr std::size_t most_participants = 10'000;

RosEndpoint to_endpoint(const dds_builtintopic_endpoint_t& from, bool is_writer) {
  RosEndpoint endpoint;
  endpoint.gid = to_gid(from.key);
  endpoint.participant = to_gid(from.participant_key);
  endpoint.is_writer = is_writer;
  endpoint.topic = from.topic_name;
  endpoint.type = from.type_name;
  endpoint.user_data = user_data_of(from.qos);
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t blocking = 0;
  dds_qget_reliability(from.qos, &reliability, &blocking);
  dds_qget_durability(from.qos, &durability);
  endpoint.is_reliable = reliability == DDS_RELIABILITY_RELIABLE;
  endpoint.is_transient_local = durability != DDS_DURABILITY_VOLATILE;
  return endpoint;
}

std::string full_name(const NodeInfo& node) {
  return printable(node.name_space.ends_with('/') ? node.name_space + node.name : node.name_space + "/" + node.name);
}

}  // namespace

struct RosGraph::State {
  State(RosParticipant& participant, std::function<void()> its_changed)
      : own_node(full_name(participant.state().info.nodes.front())),
        changed(std::move(its_changed)),
        own{participant.gid()} {
    // The listener is called for known endpoints before this returns, so no lock is held here.
    for (Watch& watch : watches) {
      const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(&watch),
                                                                                dds_delete_listener);
      dds_lset_data_available(listener.get(), &State::on_endpoints);
      watch.reader = wire::Entity(wire::check(
          dds_create_reader(participant.state().handle(), watch.topic, nullptr, listener.get()), "watch", "endpoints"));
    }
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    info.reset();
    for (const Watch& watch : watches)
      if (watch.reader.handle() != 0) dds_set_listener(watch.reader.handle(), nullptr);
  }

  static void on_endpoints(dds_entity_t reader, void* argument) noexcept {
    const Watch& watch = *static_cast<const Watch*>(argument);
    State& state = watch.state;
    std::array<void*, 16> samples{};  // null: allocated by DDS
    std::array<dds_sample_info_t, 16> infos{};
    bool has_news = false;
    for (;;) {
      samples.fill(nullptr);
      const dds_return_t count = dds_take(reader, samples.data(), infos.data(), samples.size(), samples.size());
      if (count <= 0) break;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        has_news |=
            state.note(watch.is_of_writers, infos[i], *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]));
      dds_return_loan(reader, samples.data(), count);
    }
    if (has_news) state.changed();
  }

  bool note(bool is_writer, const dds_sample_info_t& info, const dds_builtintopic_endpoint_t& endpoint) {
    const std::scoped_lock lock(mutex);
    if (info.instance_state != DDS_IST_ALIVE) return forget(info.instance_handle);
    if (!info.valid_data || endpoints.size() >= most_endpoints) return false;
    RosEndpoint made = to_endpoint(endpoint, is_writer);
    if (is_own(made.participant)) return false;
    endpoints.insert_or_assign(info.instance_handle, std::move(made));
    return true;
  }

  // A participant without endpoints is gone, and so are its nodes, even if it did not announce that.
  bool forget(std::uint64_t handle) {
    const auto found = endpoints.find(handle);
    if (found == endpoints.end()) return false;
    const Gid participant = found->second.participant;
    endpoints.erase(found);
    const auto is_its = [&](const auto& each) { return each.second.participant == participant; };
    if (std::ranges::none_of(endpoints, is_its)) nodes.erase(participant);
    return true;
  }

  bool is_own(const Gid& participant) const { return own.contains(participant); }

  void note_nodes(const Received& received) {
    {
      const std::scoped_lock lock(mutex);
      ParticipantInfo told;
      try {
        told = decode_discovery(received.bytes);
      } catch (const std::exception&) {
        return;  // from an unknown participant
      }
      if (is_own(told.participant)) return;
      if (nodes.size() >= most_participants && !nodes.contains(told.participant)) return;
      Nodes& its = nodes[told.participant];
      its = {};
      its.count = told.nodes.size();
      its.format = gid_format_of(received.bytes);
      for (const NodeInfo& node : told.nodes) {
        its.names += (its.names.empty() ? "" : " and ") + full_name(node);
        its.is_namesake |= full_name(node) == own_node;
        for (const auto& gids : {node.readers, node.writers}) its.endpoints.insert(gids.begin(), gids.end());
      }
    }
    changed();
  }

  const std::string own_node;
  const std::function<void()> changed;
  mutable std::mutex mutex;
  struct Watch {
    State& state;
    dds_entity_t topic = 0;
    bool is_of_writers = false;
    wire::Entity reader{};
  };
  std::array<Watch, 2> watches{Watch{*this, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, true},
                               Watch{*this, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, false}};
  std::optional<RosReader> info;
  std::set<Gid> own;                               // this program's participants
  std::map<std::uint64_t, RosEndpoint> endpoints;  // by handle
  struct Nodes {
    std::string names;
    std::size_t count = 0;
    std::set<Gid> endpoints;
    GidFormat format = GidFormat::since_iron;
    bool is_namesake = false;  // another program of ours, which also adapts to the others
  };
  std::map<Gid, Nodes> nodes;  // by participant
};

RosGraph::RosGraph(RosParticipant& participant, std::function<void()> changed)
    : state_(std::make_unique<State>(participant, std::move(changed))) {
  // Keep all unread announcements, since each one is from another participant.
  constexpr std::int32_t announcements_kept = 1000;
  state_->info.emplace(
      participant,
      EndpointSpec{
          discovery_topic, discovery_type, "typehash=" + discovery_type_hash() + ";", {true, true, announcements_kept}},
      [state = state_.get()](const Received& received) { state->note_nodes(received); });
}

RosGraph::~RosGraph() = default;

std::vector<RosEndpoint> RosGraph::endpoints() const {
  const std::scoped_lock lock(state_->mutex);
  std::vector<RosEndpoint> all;
  for (const auto& [handle, endpoint] : state_->endpoints) all.push_back(endpoint);
  std::ranges::sort(all, {}, &RosEndpoint::gid);
  return all;
}

std::optional<RosEndpoint> RosGraph::endpoint(std::uint64_t handle) const {
  const std::scoped_lock lock(state_->mutex);
  const auto found = state_->endpoints.find(handle);
  return found == state_->endpoints.end() ? std::nullopt : std::optional(found->second);
}

std::string RosGraph::nodes_of(const Gid& participant) const {
  const std::scoped_lock lock(state_->mutex);
  const auto found = state_->nodes.find(participant);
  if (found != state_->nodes.end() && !found->second.names.empty()) return found->second.names;
  constexpr const char* digits = "0123456789abcdef";
  std::string text = "a participant without a node (";
  for (std::size_t i = 0; i < 12; ++i) {
    text += digits[participant[i] >> 4];
    text += digits[participant[i] & 15];
  }
  return text + ")";
}

bool RosGraph::knows_nodes_of(const Gid& participant) const {
  const std::scoped_lock lock(state_->mutex);
  const auto found = state_->nodes.find(participant);
  return found != state_->nodes.end() && !found->second.names.empty();
}

bool RosGraph::has(const Gid& participant) const {
  const std::scoped_lock lock(state_->mutex);
  return std::ranges::any_of(state_->endpoints,
                             [&](const auto& each) { return each.second.participant == participant; });
}

bool RosGraph::is_complete() const {
  const std::scoped_lock lock(state_->mutex);
  std::set<Gid> known;
  for (const auto& [handle, endpoint] : state_->endpoints) known.insert(endpoint.gid);
  return std::ranges::all_of(state_->nodes,
                             [&](const auto& each) { return std::ranges::includes(known, each.second.endpoints); });
}

std::size_t RosGraph::node_count() const {
  const std::scoped_lock lock(state_->mutex);
  std::size_t count = 0;
  for (const auto& [participant, its] : state_->nodes) count += its.count;
  return count;
}

std::vector<Gid> RosGraph::participants() const {
  const std::scoped_lock lock(state_->mutex);
  std::vector<Gid> all;
  for (const auto& [participant, its] : state_->nodes)
    if (!its.names.empty()) all.push_back(participant);
  return all;
}

void RosGraph::leave_out(const Gid& participant) {
  const std::scoped_lock lock(state_->mutex);
  state_->own.insert(participant);
  std::erase_if(state_->endpoints, [&](const auto& each) { return each.second.participant == participant; });
  state_->nodes.erase(participant);
}

std::vector<Gid> RosGraph::listeners(std::span<const Gid> participants) const {
  const std::scoped_lock lock(state_->mutex);
  const auto listens = [&](const Gid& each) {
    return std::ranges::any_of(state_->endpoints, [&](const auto& entry) {
      const RosEndpoint& endpoint = entry.second;
      return endpoint.participant == each && !endpoint.is_writer && endpoint.topic == discovery_topic;
    });
  };
  std::vector<Gid> found;
  std::ranges::copy_if(participants, std::back_inserter(found), listens);
  return found;
}

std::optional<GidFormat> RosGraph::gid_format() const {
  const std::scoped_lock lock(state_->mutex);
  std::optional<GidFormat> format;
  for (const auto& [participant, its] : state_->nodes) {
    if (its.is_namesake) continue;
    // One newer node is decisive: it cannot read what older ones write, and they cannot read what it writes.
    if (format != GidFormat::since_iron) format = its.format;
  }
  return format;
}

}  // namespace cohort::ros2
