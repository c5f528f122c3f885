// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/live_recordings.hpp"

#include <algorithm>
#include <utility>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/run_recorder.hpp"
#include "server/serving/control/request_refusal.hpp"

namespace cohort::session {
namespace {

using wire::ResultCode;

constexpr std::size_t most_recordings = 4;
// Limits for each recording: bytes of its file that are not fetched, and messages that wait to be written.
constexpr std::size_t spool_size = std::size_t{16} << 20;
constexpr std::size_t most_display_queued = std::size_t{16} << 20;
constexpr std::size_t most_queued = std::size_t{64} << 20;

description::Recorded selection_in(const std::string& text, const description::Experiment& experiment) try {
  return parsing::read_recorded(text, experiment);
} catch (const description::InputError& error) {
  throw RequestRefusal(ResultCode::invalid_selection, error.what());
}

}  // namespace

LiveRecordings::One::One(std::uint64_t its_client, const description::Experiment& experiment,
                         description::Recorded recorded)
    : client(its_client),
      spool(std::make_shared<recording::Spool>(spool_size)),
      recorder(spool, {.most_queued = most_display_queued, .most_essential_queued = most_queued}, experiment,
               std::move(recorded)) {}

void LiveRecordings::begin(const description::Experiment& experiment, const Simulation& simulation, bool is_restored) {
  experiment_ = &experiment;
  simulation_ = &simulation;
  for (recording::Recorder* recorder : telling_)
    recorder->begin(experiment, simulation, is_restored ? recording::Beginning::restored : recording::Beginning::reset);
}

RunListener LiveRecordings::listening(RunListener listener) const {
  add_recorders(listener, telling_);
  return listener;
}

void LiveRecordings::end(RunResult::End how, const std::string& reason) {
  for (One& one : ones_) end(one, word_of(how), reason);
  simulation_ = nullptr;
}

void LiveRecordings::end(One& one, const std::string& word, const std::string& reason) {
  if (std::exchange(one.has_ended, true)) return;
  one.recorder.begin_finishing(word, reason);
  std::erase(telling_, &one.recorder);
}

LiveRecordings::One* LiveRecordings::find(std::uint64_t client) {
  const auto found = std::ranges::find(ones_, client, &One::client);
  return found == ones_.end() ? nullptr : &*found;
}

void LiveRecordings::start(std::uint64_t client, const std::string& recorded) {
  forget_the_gone();
  if (const One* one = find(client); one != nullptr && !one->has_ended)
    throw RequestRefusal(ResultCode::already_recording, "this client is already recording");
  if (ones_.size() + gone_.size() >= most_recordings)
    throw RequestRefusal(ResultCode::too_many_recordings,
                         std::to_string(most_recordings) + " recordings of this run are active, which is the limit");
  description::Recorded holds = recorded.empty() ? experiment_->recorded : selection_in(recorded, *experiment_);
  leave(client);  // also forgets why an earlier recording was dropped
  One& one = ones_.emplace_back(client, *experiment_, std::move(holds));
  one.recorder.begin(*experiment_, *simulation_, recording::Beginning::attached);
  telling_.push_back(&one.recorder);
}

void LiveRecordings::stop(std::uint64_t client) {
  if (One* one = find(client)) end(*one, "stopped", "its client stopped it");
}

void LiveRecordings::leave(std::uint64_t client) {
  dropped_.erase(client);
  forget(client, "its client has disconnected");
}

void LiveRecordings::list(std::vector<KeptForClient>& kept) const {
  for (const One& one : ones_)
    kept.push_back({KeptForClient::Kind::recording, one.client, one.since, one.spool->size() + one.recorder.queued()});
}

void LiveRecordings::drop(std::uint64_t client, const std::string& why) {
  dropped_[client] = why;
  forget(client, why);
}

void LiveRecordings::forget(std::uint64_t client, const std::string& why) {
  const auto found = std::ranges::find(ones_, client, &One::client);
  if (found == ones_.end()) return;
  end(*found, "stopped", why);
  found->spool->abandon();
  gone_.splice(gone_.end(), ones_, found);
  forget_the_gone();
}

// Does not wait for threads that still compress.
void LiveRecordings::forget_the_gone() {
  std::erase_if(gone_, [](const One& one) { return one.recorder.is_closed(); });
}

std::optional<LiveRecordings::Part> LiveRecordings::fetch(std::uint64_t client, std::uint64_t offset) {
  if (const auto why = dropped_.find(client); why != dropped_.end()) throw std::runtime_error(why->second);
  One* const one = find(client);
  if (one == nullptr) return std::nullopt;
  auto bytes = one->spool->fetch(offset, wire::largest_part);
  if (!bytes) return std::nullopt;
  fetched_ += bytes->bytes.size();
  Part part{std::move(*bytes), ""};
  if (!part.bytes.size) return part;
  part.problem = one->recorder.error().value_or("");
  if (const std::uint64_t dropped = one->recorder.dropped(); part.problem.empty() && dropped > 0)
    part.problem =
        std::to_string(dropped) +
        " poses and observations are missing, as the client fetched too slowly; commands and events are complete";
  return part;
}

bool LiveRecordings::are_fetched() const {
  return std::ranges::all_of(ones_, [](const One& one) { return !one.has_ended || one.spool->is_done(); });
}

}  // namespace cohort::session
