// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/survey.hpp"

#include <dds/version.h>
#include <dlfcn.h>

#include <array>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "idl/dds/dds.hpp"
#include "idl/dds/transport.hpp"

namespace cohort::wire {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t own_major = 1;

// Readers of the writers and readers that DDS knows.
class EndpointWatch {
 public:
  using Callback = std::function<void(const dds_builtintopic_endpoint_t&)>;

  EndpointWatch(const Participant& participant, Callback callback) : callback_(std::move(callback)) {
    const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(this),
                                                                              dds_delete_listener);
    dds_lset_data_available(listener.get(), &EndpointWatch::on_data);
    for (std::size_t i = 0; i < readers_.size(); ++i)
      readers_[i] =
          Entity(check(dds_create_reader(participant.state().participant.handle(), topics[i], nullptr, listener.get()),
                       "watch", "endpoints"));
  }
  EndpointWatch(const EndpointWatch&) = delete;
  EndpointWatch& operator=(const EndpointWatch&) = delete;
  ~EndpointWatch() {
    for (const Entity& reader : readers_)
      if (reader.handle() != 0) dds_set_listener(reader.handle(), nullptr);
  }

 private:
  static constexpr std::array topics = {DDS_BUILTIN_TOPIC_DCPSPUBLICATION, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION};

  static void on_data(dds_entity_t reader, void* argument) noexcept {
    const EndpointWatch& self = *static_cast<const EndpointWatch*>(argument);
    std::array<void*, 16> samples{};  // null: allocated by DDS
    std::array<dds_sample_info_t, 16> infos{};
    for (;;) {
      samples.fill(nullptr);
      const dds_return_t count = dds_take(reader, samples.data(), infos.data(), samples.size(), samples.size());
      if (count <= 0) return;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        if (infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE)
          self.callback_(*static_cast<const dds_builtintopic_endpoint_t*>(samples[i]));
      dds_return_loan(reader, samples.data(), count);
    }
  }

  const Callback callback_;
  std::array<Entity, topics.size()> readers_;
};

}  // namespace

std::optional<std::uint32_t> major_version_of(std::string_view topic) {
  constexpr std::string_view prefix = "cohort/v";
  if (!topic.starts_with(prefix)) return std::nullopt;
  topic.remove_prefix(prefix.size());
  std::uint32_t major = 0;
  const auto [end, error] = std::from_chars(topic.data(), topic.data() + topic.size(), major);
  if (error != std::errc() || end == topic.data() + topic.size() || *end != '/') return std::nullopt;
  return major;
}

struct VersionWatch::State {
  EndpointWatch watch;
};

VersionWatch::VersionWatch(Participant& participant, std::function<void(std::uint32_t major)> callback)
    : state_(new State{{participant, [callback = std::move(callback)](const dds_builtintopic_endpoint_t& endpoint) {
                          const auto major = major_version_of(endpoint.topic_name);
                          if (major && *major != own_major) callback(*major);
                        }}}) {}
VersionWatch::VersionWatch(VersionWatch&&) noexcept = default;
VersionWatch& VersionWatch::operator=(VersionWatch&&) noexcept = default;
VersionWatch::~VersionWatch() = default;

Survey survey(std::uint32_t domain, const std::string& address, const std::optional<Identity>& identity,
              std::chrono::milliseconds patience) {
  std::mutex mutex;
  std::condition_variable changed;
  Survey found;
  const auto note = [&](const auto& change) {
    const std::lock_guard lock(mutex);
    change();
    changed.notify_all();
  };
  Participant participant = Participant::client(domain, address, identity);
  const VersionWatch versions(participant, [&](std::uint32_t major) { note([&] { found.majors.insert(major); }); });
  const Reader<RobotDescription> descriptions(participant, {[&](const RobotDescription& description, const Sender&) {
                                                              note([&] { found.models.insert(description.model); });
                                                            },
                                                            {}});
  std::optional<Reader<WorldState>> states;
  if (!identity || identity->role == Role::observer)
    states.emplace(participant,
                   Reader<WorldState>::Callbacks{[&](const WorldState& state, const Sender&) {
                                                   note([&] {
                                                     found.run = state.run;
                                                     found.tick = state.tick;
                                                   });
                                                 },
                                                 {}},
                   "view");
  std::unique_lock lock(mutex);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  changed.wait_until(lock, deadline, [&] { return !found.models.empty() || !found.majors.empty(); });
  // A running run publishes soon; one that waits for controllers does not.
  if (states && !found.models.empty())
    changed.wait_until(lock, std::min(deadline, std::chrono::steady_clock::now() + 1s),
                       [&] { return found.run.has_value(); });
  Survey result = found;
  lock.unlock();
  result.has_server = descriptions.matched() > 0;
  return result;
}

std::string dds_version() { return DDS_VERSION; }

std::filesystem::path dds_library() {
  Dl_info library{};
  if (::dladdr(reinterpret_cast<const void*>(&dds_create_participant), &library) == 0 || library.dli_fname == nullptr)
    throw WireError("cannot determine where Cyclone DDS is installed");
  return std::filesystem::canonical(library.dli_fname);
}

}  // namespace cohort::wire
