// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/include/cohort/controller.hpp"

#include <utility>

#include "client_sdk/hosting/nearest.hpp"

namespace cohort {
namespace {

// Returns true if the name matches; `*` matches any characters except `/`.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*') {
    for (std::size_t taken = 0;; ++taken) {
      if (matches(pattern.substr(1), name.substr(taken))) return true;
      if (taken == name.size() || name[taken] == '/') return false;
    }
  }
  return !name.empty() && name.front() == pattern.front() && matches(pattern.substr(1), name.substr(1));
}

ChannelError no_channel(const Start& start, std::string_view kind, std::string_view name,
                        const std::vector<ChannelInfo>& channels) {
  std::string message =
      "robot '" + start.name + "' (" + start.model + ") has no " + std::string(kind) + " '" + std::string(name) + "'";
  if (channels.empty()) return ChannelError{message + "; it has no " + std::string(kind) + "s at all"};
  std::vector<std::string> names;
  names.reserve(channels.size());
  for (const ChannelInfo& channel : channels) names.push_back(channel.name);
  constexpr std::size_t shown = 3;
  message += "; the nearest are";
  const char* separator = " ";
  for (const std::string& near : nearest_names(name, std::move(names), shown)) {
    message += separator + near;
    separator = ", ";
  }
  return ChannelError{message};
}

constexpr std::string_view observation_kind = "observation channel";
constexpr std::string_view command_kind = "command channel";

// Returns the channels for which `accepts` is true; throws if there are none.
template <class Accepts>
std::vector<const ChannelInfo*> select(const Start& start, std::string_view kind, std::string_view name,
                                       const std::vector<ChannelInfo>& channels, Accepts accepts) {
  std::vector<const ChannelInfo*> found;
  for (const ChannelInfo& channel : channels) {
    if (accepts(channel)) found.push_back(&channel);
  }
  if (found.empty()) throw no_channel(start, kind, name, channels);
  return found;
}

ObservationChannel observation_handle(const ChannelInfo& info) { return {info.offset, info.size}; }
CommandChannel command_handle(const ChannelInfo& info) { return {info.offset, info.size, info.lower, info.upper}; }

}  // namespace

ObservationChannel Start::observation(std::string_view name_wanted) const {
  const auto is_it = [&](const ChannelInfo& channel) { return channel.name == name_wanted; };
  return observation_handle(*select(*this, observation_kind, name_wanted, observation_channels, is_it).front());
}

std::vector<ObservationChannel> Start::observations(std::string_view pattern) const {
  const auto fits = [&](const ChannelInfo& channel) { return matches(pattern, channel.name); };
  std::vector<ObservationChannel> handles;
  for (const ChannelInfo* channel : select(*this, observation_kind, pattern, observation_channels, fits)) {
    handles.push_back(observation_handle(*channel));
  }
  return handles;
}

std::vector<ObservationChannel> Start::observations(std::string_view pattern, std::size_t count) const {
  std::vector<ObservationChannel> found = observations(pattern);
  if (found.size() != count)
    throw ChannelError("robot '" + name + "' (" + model + ") has " + std::to_string(found.size()) + " " +
                       std::string(observation_kind) + "s that match '" + std::string(pattern) + "', expected " +
                       std::to_string(count));
  return found;
}

CommandChannel Start::command(std::string_view name_wanted) const {
  const auto is_it = [&](const ChannelInfo& channel) { return channel.name == name_wanted; };
  return command_handle(*select(*this, command_kind, name_wanted, command_channels, is_it).front());
}

std::vector<CommandChannel> Start::commands(std::string_view pattern) const {
  const auto fits = [&](const ChannelInfo& channel) { return matches(pattern, channel.name); };
  std::vector<CommandChannel> handles;
  for (const ChannelInfo* channel : select(*this, command_kind, pattern, command_channels, fits)) {
    handles.push_back(command_handle(*channel));
  }
  return handles;
}

}  // namespace cohort
