#pragma once

#include <chrono>
#include <cstdint>
#include <string>

/// What processes need that talk to each other.
namespace cohort {

/// Another one for every call, in any process on any machine; never 0.
std::uint64_t random_id();

/// Of the machine that this runs on.
std::string host_name();

/// A server that is not seen for longer is lost.
inline constexpr std::chrono::seconds server_may_be_away{2};

}  // namespace cohort
