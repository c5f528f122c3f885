#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "client_sdk/text/printable.hpp"

/// What people and programs are given to read: UTF-8, and nothing that a terminal obeys, whatever is in it.
namespace cohort::tool {

/// Returns JSON of nlohmann's library as text; what is not UTF-8 in it is replaced.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return printable(json.dump(indent, ' ', false, Json::error_handler_t::replace), std::string::npos, Lines::kept);
}

/// Prints it to standard output.
inline void show(std::string_view text) { std::fputs(printable(text, std::string::npos, Lines::kept).c_str(), stdout); }

}  // namespace cohort::tool
