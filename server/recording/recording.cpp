// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording.hpp"

#include <utility>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"

namespace cohort::recording {
namespace {

std::vector<ChannelId> channels_of(const McapReader& reader, std::initializer_list<std::string_view> topics) {
  std::vector<ChannelId> channels;
  for (const std::string_view topic : topics)
    if (const Channel* channel = reader.channel(topic)) channels.push_back(channel->id);
  return channels;
}

// A query for no channel means all of them, so the topic must exist.
MessageStream messages_of(const McapReader& reader, ChannelId channel) {
  return reader.messages({.channels = {channel}});
}

}  // namespace

TickStream::TickStream(const McapReader& reader, const std::filesystem::path& file, Timestamp from)
    : reader_(&reader),
      file_(file),
      messages_(
          reader.messages({.channels = channels_of(reader, {WorldBegins::topic, ActionTaken::topic, Boundary::topic,
                                                            RecordedSnapshot::topic, Commands::topic}),
                           .from = from,
                           .order = Order::file})) {}

std::optional<RecordedTick> TickStream::next() {
  std::optional<RecordedTick> result = std::exchange(waiting_, std::nullopt);
  // Assigns the message to its tick; a message of the next tick waits until this one is returned.
  const auto tick_of = [&](const Message& message, std::uint64_t tick) -> RecordedTick& {
    if (!result) result = RecordedTick{.tick = tick, .log_time = message.log_time};
    if (result->tick == tick && result->log_time == std::chrono::nanoseconds(message.log_time)) return *result;
    waiting_ = RecordedTick{.tick = tick, .log_time = message.log_time};
    return *waiting_;
  };
  try {
    while (!waiting_) {
      const std::optional<Message> message = messages_.next();
      if (!message) break;
      const std::string& topic = reader_->channels().at(message->channel).topic;
      if (topic == WorldBegins::topic) {
        const auto begins = messages::decode<WorldBegins>(message->data);
        tick_of(*message, begins.tick).begins = begins;
      } else if (topic == ActionTaken::topic) {
        auto action = messages::decode<ActionTaken>(message->data);
        tick_of(*message, action.tick).actions.push_back(std::move(action));
      } else if (topic == Boundary::topic) {
        const auto boundary = messages::decode<Boundary>(message->data);
        tick_of(*message, boundary.tick).state_hash = boundary.state_hash;
      } else if (topic == RecordedSnapshot::topic) {
        auto snapshot = messages::decode<RecordedSnapshot>(message->data);
        tick_of(*message, snapshot.tick).snapshot = std::move(snapshot);
      } else {
        auto commands = decode_commands(message->data);
        tick_of(*message, commands.tick).commands = std::move(commands);
      }
    }
  } catch (const messages::CdrError& error) {
    throw McapError(file_, 0, std::string("a message is not in Cohort's format: ") + error.what());
  }
  return result;
}

Recording::Recording(const std::filesystem::path& file) : file_(file), reader_(file) {
  const std::optional<Metadata> facts = reader_.metadata(facts_name);
  const Channel* const worlds = reader_.channel(WorldBegins::topic);
  if (!facts || worlds == nullptr)
    throw McapError(file, 0,
                    reader_.is_complete() ? "it is an MCAP file, but not a Cohort recording"
                                          : "it has no readable run: " + reader_.damage());
  facts_ = facts->entries;
  try {
    MessageStream stream = messages_of(reader_, worlds->id);
    while (const auto message = stream.next())
      worlds_.push_back({messages::decode<WorldBegins>(message->data), message->log_time});
  } catch (const messages::CdrError& error) {
    throw McapError(file, 0, std::string("invalid description of the run: ") + error.what());
  }
  if (worlds_.empty()) throw McapError(file, 0, "it has no readable run" + (damage().empty() ? "" : ": " + damage()));
  if (const Channel* const snapshots = reader_.channel(RecordedSnapshot::topic)) {
    MessageStream stream = messages_of(reader_, snapshots->id);
    while (const auto message = stream.next()) snapshots_.push_back(message->log_time);
  }
  inputs_ = std::make_shared<const description::KeptFiles>(inputs_of(reader_, file));
}

std::string Recording::end() const {
  const std::optional<Metadata> metadata = reader_.metadata(end_name);
  if (!metadata) return "";
  const auto end = metadata->entries.find("end");
  return end == metadata->entries.end() ? "" : end->second;
}

description::Experiment Recording::experiment(const World& world) const {
  return parsing::read_experiment(inputs_, world.begins.seed, std::chrono::nanoseconds(world.begins.duration_ns));
}

TickStream Recording::ticks(std::chrono::nanoseconds from) const { return {reader_, file_, from}; }

}  // namespace cohort::recording
