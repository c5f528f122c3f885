// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/transport.hpp"

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "idl/dds/codec.hpp"
#include "idl/dds/dds.hpp"

namespace cohort::wire {
namespace {

using namespace std::chrono_literals;

using Listener = std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)>;

constexpr auto longest_write = 100ms;

constexpr dds_duration_t to_dds(std::chrono::nanoseconds duration) { return duration.count(); }

Qos qos_of(const Topic& topic, const std::string& partition, int depth) {
  Qos qos = make_qos();
  dds_qset_reliability(qos.get(), topic.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       to_dds(longest_write));
  dds_qset_durability(qos.get(), topic.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, topic.depth != 0 ? topic.depth : depth);
  if (topic.transient_local) {
    // This history limits the messages for late joiners, not the one above.
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, topic.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  if (topic.lease.count() != 0) dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, to_dds(topic.lease));
  if (!partition.empty()) dds_qset_partition1(qos.get(), partition.c_str());
  return qos;
}

Entity create_topic(const Participant& participant, const Topic& topic) {
  return Entity(
      check(dds_create_topic(participant.state().participant.handle(), topic.type, topic.name, nullptr, nullptr),
            "create the topic", topic.name));
}

}  // namespace

template <class Message>
struct Writer<Message>::State {
  Entity topic;
  Entity writer;
};

template <class Message>
Writer<Message>::Writer(Participant& participant, const std::string& partition, int depth)
    : state_(std::make_unique<State>()) {
  const Topic& topic = Codec<Message>::topic;
  state_->topic = create_topic(participant, topic);
  state_->writer = Entity(check(dds_create_writer(participant.state().participant.handle(), state_->topic.handle(),
                                                  qos_of(topic, partition, depth).get(), nullptr),
                                "write", topic.name));
}

template <class Message>
bool Writer<Message>::write(const Message& message) {
  const typename Codec<Message>::Outgoing outgoing(message);
  const dds_return_t result = dds_write(state_->writer.handle(), &outgoing.sample);
  if (result == DDS_RETCODE_TIMEOUT) return false;
  check(result, "write", Codec<Message>::topic.name);
  return true;
}

template <class Message>
bool Writer<Message>::wait_until_received(std::chrono::milliseconds at_most) {
  return dds_wait_for_acks(state_->writer.handle(), to_dds(at_most)) == DDS_RETCODE_OK;
}

template <class Message>
std::uint32_t Writer<Message>::matched() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(state_->writer.handle(), &status);
  return status.current_count;
}

// True if the memory of a sample is reused for the next one. Frames and answers arrive too often to allocate memory for
// each; other messages arrive too rarely to keep memory for the largest one.
template <class Sample>
bool is_kept(const Sample& sample) {
  constexpr std::uint32_t most_kept = 1 << 17;  // in elements: a megabyte of values
  if constexpr (requires { sample.robots._maximum + sample.values._maximum; })
    return sample.robots._maximum <= most_kept && sample.values._maximum <= most_kept;
  return false;
}

template <class Message>
struct Reader<Message>::State {
  using Sample = typename Codec<Message>::Sample;

  State(Callbacks its_callbacks, const Participant& participant)
      : callbacks(std::move(its_callbacks)),
        own_participant(static_cast<std::uint64_t>(participant.state().participant.handle()) * 0xbf58476d1ce4e5b9u) {
    // Zeroed, as dds_take requires; it then allocates their sequences and strings, and reuses them.
    for (void*& sample : samples) sample = dds_alloc(sizeof(Sample));
  }

  ~State() {
    // Returns when no callback runs, and prevents further ones. Deleting alone would close the handle during a running
    // one.
    if (reader.handle() != 0) dds_set_listener(reader.handle(), nullptr);
    reader = Entity();
    for (void* sample : samples) dds_sample_free(sample, Codec<Message>::topic.type, DDS_FREE_ALL);
  }

  // DDS calls the functions of one reader one at a time, so the samples need no lock.
  static void on_data(dds_entity_t handle, void* argument) noexcept {
    State& state = *static_cast<State*>(argument);
    dds_return_t taken = 0;
    do {
      taken = dds_take(handle, state.samples.data(), state.infos.data(), state.samples.size(),
                       static_cast<std::uint32_t>(state.samples.size()));
      for (dds_return_t i = 0; i < taken; ++i) {
        const auto index = static_cast<std::size_t>(i);
        // An invalid sample only reports the end of a writer, which on_liveliness does better.
        if (!state.infos[index].valid_data) continue;
        Sample& sample = *static_cast<Sample*>(state.samples[index]);
        state.callbacks.message(Codec<Message>::decode(sample),
                                state.sender_of(handle, state.infos[index].publication_handle));
        if (!is_kept(sample)) {
          dds_sample_free(&sample, Codec<Message>::topic.type, DDS_FREE_CONTENTS);
          sample = Sample{};
        }
      }
    } while (taken == static_cast<dds_return_t>(state.samples.size()));
  }

  // Called once for each change of one writer, also when it is matched and unmatched.
  static void on_liveliness(dds_entity_t handle, const dds_liveliness_changed_status_t status,
                            void* argument) noexcept {
    State& state = *static_cast<State*>(argument);
    const bool alive = status.alive_count_change > 0;
    const bool dead = status.alive_count_change < 0 || status.not_alive_count_change > 0;
    if (alive || dead) state.callbacks.liveliness(state.sender_of(handle, status.last_publication_handle), alive);
  }

  // Uses the handle from DDS, because a callback may run before the constructor has its own.
  Sender sender_of(dds_entity_t handle, dds_instance_handle_t writer) {
    if (const auto known = participants.find(writer); known != participants.end()) return {writer, known->second};
    dds_builtintopic_endpoint_t* endpoint = dds_get_matched_publication_data(handle, writer);
    if (endpoint == nullptr) return {writer, 0};  // it is already gone
    // Uses its GUID, which stays the same when the participant is lost and found again.
    std::array<std::uint64_t, 2> guid{};
    std::memcpy(guid.data(), endpoint->participant_key.v, sizeof guid);
    // Also uses the own participant: with security, a client that one participant has authenticated may choose any GUID
    // at another.
    const Sender sender{writer, (guid[0] * 0x9e3779b97f4a7c15u ^ guid[1]) + own_participant};
    dds_builtintopic_free_endpoint(endpoint);
    if (participants.size() >= most_participants) participants.clear();
    participants.emplace(writer, sender.participant);
    return sender;
  }

  static constexpr std::size_t most_participants = 10'000;  // the cache is cleared if there are more

  Callbacks callbacks;
  const std::uint64_t own_participant;                          // this reader's
  std::map<dds_instance_handle_t, std::uint64_t> participants;  // by writer
  std::array<void*, 8> samples{};
  std::array<dds_sample_info_t, 8> infos{};
  Entity topic;
  Entity reader;
};

template <class Message>
Reader<Message>::Reader(Participant& participant, Callbacks callbacks, const std::string& partition, int depth)
    : state_(std::make_unique<State>(std::move(callbacks), participant)) {
  const Topic& topic = Codec<Message>::topic;
  const Listener listener(dds_create_listener(state_.get()), [](dds_listener_t* l) { dds_delete_listener(l); });
  if (state_->callbacks.message) dds_lset_data_available(listener.get(), &State::on_data);
  if (state_->callbacks.liveliness) dds_lset_liveliness_changed(listener.get(), &State::on_liveliness);
  state_->topic = create_topic(participant, topic);
  // With the listener set at creation, no message and no change is missed.
  state_->reader = Entity(check(dds_create_reader(participant.state().participant.handle(), state_->topic.handle(),
                                                  qos_of(topic, partition, depth).get(), listener.get()),
                                "read", topic.name));
}

template <class Message>
std::uint32_t Reader<Message>::matched() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(state_->reader.handle(), &status);
  return status.current_count;
}

template <class Message>
Writer<Message>::Writer(Writer&&) noexcept = default;
template <class Message>
Writer<Message>& Writer<Message>::operator=(Writer&&) noexcept = default;
template <class Message>
Writer<Message>::~Writer() = default;
template <class Message>
Reader<Message>::Reader(Reader&&) noexcept = default;
template <class Message>
Reader<Message>& Reader<Message>::operator=(Reader&&) noexcept = default;
template <class Message>
Reader<Message>::~Reader() = default;

template class Writer<Join>;
template class Writer<Admit>;
template class Writer<RobotDescription>;
template class Writer<RobotTree>;
template class Writer<Observation>;
template class Writer<Command>;
template class Writer<WorldState>;
template class Writer<SceneDescription>;
template class Writer<SceneUpdate>;
template class Writer<Report>;
template class Writer<ControllerState>;
template class Writer<Request>;
template class Writer<Reply>;
template class Reader<Join>;
template class Reader<Admit>;
template class Reader<RobotDescription>;
template class Reader<RobotTree>;
template class Reader<Observation>;
template class Reader<Command>;
template class Reader<WorldState>;
template class Reader<SceneDescription>;
template class Reader<SceneUpdate>;
template class Reader<Report>;
template class Reader<ControllerState>;
template class Reader<Request>;
template class Reader<Reply>;

}  // namespace cohort::wire
