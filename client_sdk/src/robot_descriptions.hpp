#pragma once

#include <cstdint>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// What servers have said of their robots. A server that takes the place of another is another participant of DDS, and
/// may give the same number to another description.
class RobotDescriptions {
 public:
  /// Replaces the description of this number, if the server has given one.
  void add(const wire::RobotDescription& description, std::uint64_t server);

  /// Returns whether the server has described all robots that it admits.
  bool describe(const wire::Admit& admit, std::uint64_t server) const;

  /// Forgets what other servers have said, and returns what this one has.
  std::vector<wire::RobotDescription> keep(std::uint64_t server);

 private:
  struct Known {
    wire::RobotDescription description;
    std::uint64_t server = 0;
  };
  std::vector<Known> known_;
};

}  // namespace cohort
