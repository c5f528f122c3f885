#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace cohort {

/// DDS domains as people write them: `7`, or `7..14` with both ends. Ascending, at least one. Throws
/// std::invalid_argument that says what was expected.
std::vector<std::uint32_t> parse_domains(std::string_view text);

/// Which of a server's domains this process is to use, so that many processes spread over them.
std::uint32_t domain_of_this_process(const std::vector<std::uint32_t>& domains);

}  // namespace cohort
