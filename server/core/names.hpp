#pragma once

#include <string>

/// Names of objects, and texts from outside.
namespace cohort {

/// Returns whether a new object can be called so: parts of UTF-8 with a slash between them,
/// without control characters and not too long.
bool is_object_name(const std::string& name);

/// Throws std::invalid_argument if `name` is not UTF-8, has a control character or more than 255 bytes. `what`: for the
/// message.
void check_name(const std::string& name, const std::string& what);

/// Throws std::invalid_argument if `text` is not UTF-8. `what`: for the message.
void check_utf8(const std::string& text, const std::string& what);

}  // namespace cohort
