#include "client_sdk/include/cohort/controller.hpp"

#include <algorithm>
#include <numeric>

namespace cohort {
namespace {

// `*` stands for any run of characters but `/`.
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

// Levenshtein's: how many characters to insert, delete or replace.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

ChannelError no_channel(const Start& start, std::string_view kind, std::string_view name,
                        const std::vector<ChannelInfo>& channels) {
  std::string message =
      "robot '" + start.name + "' (" + start.model + ") has no " + std::string(kind) + " '" + std::string(name) + "'";
  if (channels.empty()) return ChannelError{message + ", and no other " + std::string(kind) + " either"};
  std::vector<const ChannelInfo*> nearest;
  nearest.reserve(channels.size());
  for (const ChannelInfo& channel : channels) nearest.push_back(&channel);
  std::stable_sort(nearest.begin(), nearest.end(), [&](const ChannelInfo* a, const ChannelInfo* b) {
    return edit_distance(a->name, name) < edit_distance(b->name, name);
  });
  constexpr std::size_t shown = 3;
  message += "; the nearest are";
  for (std::size_t i = 0; i < std::min(shown, nearest.size()); ++i) {
    message += (i == 0 ? " " : ", ") + nearest[i]->name;
  }
  return ChannelError{message};
}

constexpr std::string_view observation_kind = "observation channel";
constexpr std::string_view command_kind = "command channel";

// The channels that `accepts`; throws if none.
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
