// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/ros2/ros_participant.hpp"

#include <algorithm>
#include <atomic>
#include <string_view>
#include <utility>

#include "idl/dds/ros2/endpoint_owners.hpp"
#include "idl/dds/ros2/opaque_topic.hpp"
#include "idl/dds/ros2/participant_state.hpp"
#include "idl/dds/ros2/ros_names.hpp"

// Replaces Cyclone's function of this name, which processes the answers of peers to requests for types. Nodes on Fast
// DDS 3 send such requests to each other, every participant receives the answers, and Cyclone 0.10.2 crashes on types
// with sequences of structs. The types of endpoints here are only names, so no answers are needed.
struct ddsi_domaingv;
struct ddsi_serdata;
extern "C" __attribute__((visibility("default"))) void ddsi_tl_handle_reply(ddsi_domaingv*, ddsi_serdata*) {}

namespace cohort::ros2 {
namespace {

constexpr dds_duration_t longest_write = DDS_MSECS(100);

void add(std::vector<Gid>& to, const Gid& gid) { to.push_back(gid); }
void remove(std::vector<Gid>& from, const Gid& gid) { std::erase(from, gid); }

using Listener = std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)>;
Listener make_listener(void* argument) { return {dds_create_listener(argument), dds_delete_listener}; }

using Matches = dds_return_t (*)(dds_entity_t, dds_instance_handle_t*, size_t);
using MatchData = dds_builtintopic_endpoint_t* (*)(dds_entity_t, dds_instance_handle_t);

// The participants of a writer's readers, or of a reader's writers. They are queried only after a change.
class MatchedParticipants {
 public:
  MatchedParticipants(Matches matches, MatchData data) : matches_(matches), data_(data) {}

  // Called on a DDS thread.
  void change(std::uint32_t count) {
    count_ = count;
    ++changes_;
  }
  std::uint32_t count() const { return count_; }
  void for_each(dds_entity_t entity, const std::function<void(const dds_builtintopic_endpoint_t&)>& take) const {
    std::vector<dds_instance_handle_t> handles(count_ + 16);
    const dds_return_t count = matches_(entity, handles.data(), handles.size());
    for (dds_return_t i = 0; i < std::min(count, static_cast<dds_return_t>(handles.size())); ++i)
      with(entity, handles[static_cast<std::size_t>(i)], take);
  }
  // Does nothing if the endpoint is gone.
  void with(dds_entity_t entity, dds_instance_handle_t handle,
            const std::function<void(const dds_builtintopic_endpoint_t&)>& take) const {
    dds_builtintopic_endpoint_t* endpoint = data_(entity, handle);
    if (endpoint == nullptr) return;
    take(*endpoint);
    dds_builtintopic_free_endpoint(endpoint);
  }
  std::span<const Gid> of(dds_entity_t entity) {
    const std::uint32_t changes = changes_;
    if (changes != seen_changes_) read(entity);
    seen_changes_ = changes;
    return participants_;
  }

 private:
  void read(dds_entity_t entity) {
    participants_.clear();
    for_each(entity, [this](const dds_builtintopic_endpoint_t& endpoint) {
      participants_.push_back(to_gid(endpoint.participant_key));
    });
    std::ranges::sort(participants_);
    participants_.erase(std::unique(participants_.begin(), participants_.end()), participants_.end());
  }

  const Matches matches_;
  const MatchData data_;
  std::atomic<std::uint32_t> count_{0};
  std::atomic<std::uint32_t> changes_{0};
  std::uint32_t seen_changes_ = 0;
  std::vector<Gid> participants_;
};

}  // namespace

Gid to_gid(const dds_guid_t& guid) {
  Gid gid{};
  std::ranges::copy(guid.v, gid.begin());
  return gid;
}

std::string user_data_of(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (qos == nullptr || !dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

namespace {

Gid gid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  wire::check(dds_get_guid(entity, &guid), "identify", "an endpoint");
  return to_gid(guid);
}

wire::Qos qos_of(const EndpointSpec& spec) {
  wire::Qos qos = wire::make_qos();
  const auto& [is_reliable, is_transient_local, depth] = spec.qos;
  dds_qset_reliability(qos.get(), is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, longest_write);
  dds_qset_durability(qos.get(), is_transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (is_transient_local)
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &xcdr1);
  if (!spec.user_data.empty()) dds_qset_userdata(qos.get(), spec.user_data.data(), spec.user_data.size());
  return qos;
}

}  // namespace

EndpointSpec topic_endpoint(const std::string& name, const std::string& type, const std::string& type_hash,
                            EndpointQos qos) {
  return {dds_topic(TopicKind::message, name), dds_type(type),
          type_hash.empty() ? std::string() : "typehash=" + type_hash + ";", qos};
}

RosParticipant::RosParticipant(const Options& options) : state_(std::make_unique<ParticipantState>()) {
  const wire::Qos qos = wire::make_qos();
  constexpr std::string_view enclave = "enclave=/;";
  dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
  state_->dds = wire::join_domain(options.domain.number, cyclone_configuration(options.domain), qos.get());
  announce_owners(OpaqueTopic(state_->handle(), discovery_topic, discovery_type));
  state_->info.participant = gid_of(state_->handle());
  state_->info.nodes.push_back({options.name_space, options.name, {}, {}});
}

RosParticipant::~RosParticipant() = default;

Gid RosParticipant::gid() const { return state_->info.participant; }

void RosParticipant::announce(GidFormat format) {
  if (!announcement_) {
    const std::string hash = format == GidFormat::humble ? "" : "typehash=" + discovery_type_hash() + ";";
    announcement_ =
        std::make_unique<RosWriter>(*this, EndpointSpec{discovery_topic, discovery_type, hash, {true, true, 1}});
  }
  announcement_->write(encode_discovery(state_->info, format));
}

void RosParticipant::withdraw() { announcement_.reset(); }

bool RosParticipant::is_announced_to(std::span<const Gid> participants) const {
  if (participants.empty()) return true;
  return announcement_ && std::ranges::includes(announcement_->participants(), participants) &&
         announcement_->is_received();
}

struct RosWriter::State {
  State(RosParticipant& its_participant, const EndpointSpec& spec, std::function<void()> its_matched)
      : participant(its_participant.state()),
        matched(std::move(its_matched)),
        topic(participant.handle(), spec.topic, spec.type) {
    const Listener listener = make_listener(this);
    dds_lset_publication_matched(listener.get(), &State::on_matched);
    writer = wire::Entity(
        wire::check(dds_create_writer(participant.handle(), topic.handle(), qos_of(spec).get(), listener.get()),
                    "write", spec.topic.c_str()));
    gid = gid_of(writer.handle());
    // The writer of announcements does not belong to a node itself.
    is_of_node = spec.topic != discovery_topic;
    if (is_of_node) add(participant.info.nodes.front().writers, gid);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (writer.handle() != 0) dds_set_listener(writer.handle(), nullptr);
    if (is_of_node) remove(participant.info.nodes.front().writers, gid);
  }

  static void on_matched(dds_entity_t, const dds_publication_matched_status_t status, void* argument) noexcept {
    State& state = *static_cast<State*>(argument);
    state.matches.change(status.current_count);
    if (state.matched) state.matched();
  }

  ParticipantState& participant;
  std::function<void()> matched;
  MatchedParticipants matches{dds_get_matched_subscriptions, dds_get_matched_subscription_data};
  OpaqueTopic topic;
  wire::Entity writer;
  Gid gid{};
  bool is_of_node = true;
};

RosWriter::RosWriter(RosParticipant& participant, const EndpointSpec& spec, std::function<void()> matched)
    : state_(std::make_unique<State>(participant, spec, std::move(matched))) {}
RosWriter::~RosWriter() = default;
RosWriter::RosWriter(RosWriter&&) noexcept = default;
RosWriter& RosWriter::operator=(RosWriter&&) noexcept = default;

bool RosWriter::write(std::span<const std::byte> message) {
  return state_->topic.write(state_->writer.handle(), message);
}

std::uint32_t RosWriter::readers() const { return state_->matches.count(); }

bool RosWriter::is_received() const { return dds_wait_for_acks(state_->writer.handle(), 0) == DDS_RETCODE_OK; }

std::span<const Gid> RosWriter::participants() const { return state_->matches.of(state_->writer.handle()); }

std::vector<std::string> RosWriter::user_data_of_readers() const {
  std::vector<std::string> all;
  state_->matches.for_each(state_->writer.handle(),
                           [&](const dds_builtintopic_endpoint_t& reader) { all.push_back(user_data_of(reader.qos)); });
  return all;
}

struct RosReader::State {
  State(RosParticipant& its_participant, const EndpointSpec& spec, std::function<void(const Received&)> its_take,
        std::function<void()> its_matched)
      : participant(its_participant.state()),
        take(std::move(its_take)),
        matched(std::move(its_matched)),
        topic(participant.handle(), spec.topic, spec.type) {
    const Listener listener = make_listener(this);
    dds_lset_data_available(listener.get(), &State::on_data);
    dds_lset_subscription_matched(listener.get(), &State::on_matched);
    reader = wire::Entity(
        wire::check(dds_create_reader(participant.handle(), topic.handle(), qos_of(spec).get(), listener.get()), "read",
                    spec.topic.c_str()));
    gid = gid_of(reader.handle());
    is_of_node = spec.topic != discovery_topic;
    if (is_of_node) add(participant.info.nodes.front().readers, gid);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    // Returns when no callback runs, and prevents further ones.
    if (reader.handle() != 0) dds_set_listener(reader.handle(), nullptr);
    if (is_of_node) remove(participant.info.nodes.front().readers, gid);
  }

  static void on_data(dds_entity_t handle, void* argument) noexcept {
    const State& state = *static_cast<const State*>(argument);
    take_opaque(handle, [&](const OpaqueSample& sample) { state.take({sample.bytes, sample.publication}); });
  }
  static void on_matched(dds_entity_t, const dds_subscription_matched_status_t status, void* argument) noexcept {
    State& state = *static_cast<State*>(argument);
    state.matches.change(status.current_count);
    if (state.matched) state.matched();
  }

  ParticipantState& participant;
  std::function<void(const Received&)> take;
  std::function<void()> matched;
  MatchedParticipants matches{dds_get_matched_publications, dds_get_matched_publication_data};
  OpaqueTopic topic;
  wire::Entity reader;
  Gid gid{};
  bool is_of_node = true;
};

RosReader::RosReader(RosParticipant& participant, const EndpointSpec& spec, std::function<void(const Received&)> take,
                     std::function<void()> matched)
    : state_(std::make_unique<State>(participant, spec, std::move(take), std::move(matched))) {}
RosReader::~RosReader() = default;
RosReader::RosReader(RosReader&&) noexcept = default;
RosReader& RosReader::operator=(RosReader&&) noexcept = default;

std::uint32_t RosReader::writers() const { return state_->matches.count(); }

std::span<const Gid> RosReader::participants() const { return state_->matches.of(state_->reader.handle()); }

std::optional<std::string> RosReader::user_data_of_writer(std::uint64_t writer) const {
  std::optional<std::string> data;
  state_->matches.with(state_->reader.handle(), writer,
                       [&](const dds_builtintopic_endpoint_t& found) { data = user_data_of(found.qos); });
  return data;
}

}  // namespace cohort::ros2
