// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace cohort::session {

/// A regular expression that selects names of objects, as in docs/protocol.md, "Control". Compiling and matching take
/// time and memory in proportion to the length of the expression and of the name.
class EntityFilter {
 public:
  /// Compiles the expression; an empty one matches all names. Throws std::invalid_argument with the reason if it is
  /// invalid or too large.
  explicit EntityFilter(const std::string& pattern);
  EntityFilter(const EntityFilter&) = delete;
  EntityFilter& operator=(const EntityFilter&) = delete;
  ~EntityFilter();

  /// Returns true if a part of the name matches.
  bool matches(const std::string& name) const;

 private:
  struct Compiled;
  std::unique_ptr<const Compiled> compiled_;  // null: all names match
};

}  // namespace cohort::session
