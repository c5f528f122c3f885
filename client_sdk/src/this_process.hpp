// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

/// Identity of this process for communication with others.
namespace cohort {

/// Returns a new number at every call, distinct in all processes on all machines; never 0.
std::uint64_t random_id();

/// Returns the name of this machine.
std::string host_name();

/// Time after which a server that is not seen counts as lost.
inline constexpr std::chrono::seconds server_may_be_away{2};

}  // namespace cohort
