// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "idl/text/printable.hpp"
#include "idl/text/standard_streams.hpp"

/// Output for users and programs: valid UTF-8 without terminal control sequences, even if the input is not.
namespace cohort::tool {

/// Returns a JSON value of nlohmann's library as text, with invalid UTF-8 replaced.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return printable(json.dump(indent, ' ', false, Json::error_handler_t::replace), std::string::npos, Lines::kept);
}

/// Prints text to standard output.
inline void show(std::string_view text) { write_output(printable(text, std::string::npos, Lines::kept)); }

}  // namespace cohort::tool
