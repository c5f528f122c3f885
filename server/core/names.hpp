// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// Names of objects, and texts from clients.
namespace cohort {

/// Returns true for a valid name of a new object: parts of UTF-8 separated by slashes, without control characters and
/// not too long.
bool is_object_name(const std::string& name);

/// Throws std::invalid_argument if `name` is not UTF-8, has a control character or more than 255 bytes. `what`: the
/// subject of the message.
void check_name(const std::string& name, const std::string& what);

/// Throws std::invalid_argument if `text` is not UTF-8. `what`: the subject of the message.
void check_utf8(const std::string& text, const std::string& what);

}  // namespace cohort
