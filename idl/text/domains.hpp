// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace cohort {

/// Parses DDS domains: `7`, or `7..14` with both ends. Returns at least one, in ascending order. Throws
/// std::invalid_argument with the expected format.
std::vector<std::uint32_t> parse_domains(std::string_view text);

/// Returns one of `domains` for this process, chosen by its id, so that processes are distributed over the domains.
std::uint32_t domain_of_this_process(const std::vector<std::uint32_t>& domains);

}  // namespace cohort
