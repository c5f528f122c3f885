#pragma once

#include <memory>
#include <string>

namespace cohort::session {

/// A regular expression over names of objects, as clients write it: docs/protocol.md, "Control". Compiling one and
/// matching it take time and memory in proportion to its length and the name's, whatever it says.
class EntityFilter {
 public:
  /// An empty one matches all names. Throws std::invalid_argument, with what is wrong, if it is none or is too large.
  explicit EntityFilter(const std::string& pattern);
  EntityFilter(const EntityFilter&) = delete;
  EntityFilter& operator=(const EntityFilter&) = delete;
  ~EntityFilter();

  /// Whether a part of the name matches.
  bool matches(const std::string& name) const;

 private:
  struct Compiled;
  std::unique_ptr<const Compiled> compiled_;  // null: all names match
};

}  // namespace cohort::session
