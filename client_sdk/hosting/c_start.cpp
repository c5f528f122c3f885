// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <exception>
#include <vector>

#include "client_sdk/hosting/c_handles.hpp"

namespace cohort {

std::string& last_error() {
  thread_local std::string text;
  return text;
}

namespace {

CohortStartReason reason_of(StartReason reason) {
  switch (reason) {
    case StartReason::first:
    case StartReason::going_on: return cohort_start_first;
    case StartReason::takeover: return cohort_start_takeover;
    case StartReason::reset: return cohort_start_reset;
    case StartReason::restored: return cohort_start_restored;
    case StartReason::check: break;
  }
  return cohort_start_check;
}

CohortObservationChannel handle_of(const ObservationChannel& channel) { return {channel.offset, channel.size}; }
CohortCommandChannel handle_of(const CommandChannel& channel) {
  return {channel.offset, channel.size, channel.lower, channel.upper};
}

// Returns the result of `call`. If it throws, records an error of the start and returns `otherwise`.
template <class Result, class Call>
Result looked_up(const CohortStart* start, Result otherwise, Call call) noexcept {
  try {
    return call();
  } catch (const std::exception& error) {
    last_error() = error.what();
    if (!start->mistake) start->mistake = error.what();
    return otherwise;
  }
}

template <class Value>
std::size_t copy_first(const std::vector<Value>& values, Value* to, std::size_t capacity) {
  std::copy_n(values.begin(), std::min(values.size(), capacity), to);
  return values.size();
}

template <class Handle, class Channel>
std::size_t copy_handles(const std::vector<Channel>& channels, Handle* to, std::size_t capacity) {
  std::vector<Handle> handles;
  handles.reserve(channels.size());
  for (const Channel& channel : channels) handles.push_back(handle_of(channel));
  return copy_first(handles, to, capacity);
}

bool has_channel(const std::vector<ChannelInfo>& channels, std::string_view name) {
  return std::any_of(channels.begin(), channels.end(),
                     [&](const ChannelInfo& channel) { return channel.name == name; });
}

const char* kept(const CohortStart* start, std::string text) {
  return start->texts.emplace_back(std::move(text)).c_str();
}

std::int64_t whole(const Parameters& parameters, const char* name) {
  constexpr double most = 9007199254740992.0;  // 2^53: float64 represents all integers up to this one
  const double number = parameters.real(name);
  if (number != std::trunc(number) || std::abs(number) > most) {
    throw ParameterError(name, "expected a whole number, not '" + parameters.text(name) + "'");
  }
  return static_cast<std::int64_t>(number);
}

}  // namespace
}  // namespace cohort

using cohort::looked_up;

CohortStart::CohortStart(const cohort::Start& its_start)
    : start(its_start),
      info{start.robot,
           start.name.c_str(),
           start.model.c_str(),
           start.team.c_str(),
           start.controller.c_str(),
           cohort::reason_of(start.reason),
           start.tick,
           start.seed,
           start.step.count(),
           start.period} {}

const char* cohort_last_error() { return cohort::last_error().c_str(); }

int cohort_fail(const char* format, ...) {
  constexpr std::size_t longest = 1024;
  char text[longest] = {};
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  cohort::last_error() = text;
  return -1;
}

const CohortStartInfo* cohort_start_info(const CohortStart* start) { return &start->info; }

CohortObservationChannel cohort_find_observation(const CohortStart* start, const char* name) {
  return looked_up(start, CohortObservationChannel{},
                   [&] { return cohort::handle_of(start->start.observation(name)); });
}

CohortCommandChannel cohort_find_command(const CohortStart* start, const char* name) {
  return looked_up(start, CohortCommandChannel{}, [&] { return cohort::handle_of(start->start.command(name)); });
}

std::size_t cohort_find_observations(const CohortStart* start, const char* pattern, CohortObservationChannel* channels,
                                     std::size_t capacity) {
  return looked_up(start, std::size_t{0},
                   [&] { return cohort::copy_handles(start->start.observations(pattern), channels, capacity); });
}

std::size_t cohort_find_commands(const CohortStart* start, const char* pattern, CohortCommandChannel* channels,
                                 std::size_t capacity) {
  return looked_up(start, std::size_t{0},
                   [&] { return cohort::copy_handles(start->start.commands(pattern), channels, capacity); });
}

bool cohort_has_observation(const CohortStart* start, const char* name) {
  return cohort::has_channel(start->start.observation_channels, name);
}

bool cohort_has_command(const CohortStart* start, const char* name) {
  return cohort::has_channel(start->start.command_channels, name);
}

bool cohort_has_parameter(const CohortStart* start, const char* name) { return start->start.parameters.has(name); }

double cohort_real(const CohortStart* start, const char* name, double fallback) {
  return looked_up(start, fallback, [&] { return start->start.parameters.real(name, fallback); });
}

std::int64_t cohort_whole(const CohortStart* start, const char* name, std::int64_t fallback) {
  return looked_up(start, fallback, [&] {
    return start->start.parameters.has(name) ? cohort::whole(start->start.parameters, name) : fallback;
  });
}

bool cohort_flag(const CohortStart* start, const char* name, bool fallback) {
  return looked_up(start, fallback, [&] { return start->start.parameters.flag(name, fallback); });
}

const char* cohort_text(const CohortStart* start, const char* name, const char* fallback) {
  return looked_up(start, fallback, [&] {
    return start->start.parameters.has(name) ? cohort::kept(start, start->start.parameters.text(name)) : fallback;
  });
}

std::size_t cohort_reals(const CohortStart* start, const char* name, double* values, std::size_t capacity) {
  return looked_up(start, std::size_t{0},
                   [&] { return cohort::copy_first(start->start.parameters.reals(name), values, capacity); });
}

double cohort_needed_real(const CohortStart* start, const char* name) {
  return looked_up(start, 0.0, [&] { return start->start.parameters.real(name); });
}

const char* cohort_needed_text(const CohortStart* start, const char* name) {
  return looked_up(start, "", [&] { return cohort::kept(start, start->start.parameters.text(name)); });
}
