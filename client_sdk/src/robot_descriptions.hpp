#pragma once

#include <cstdint>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// Robot descriptions received from servers. A server that replaces another one is a different DDS participant, and may
/// reuse a number for another description.
class RobotDescriptions {
 public:
  /// Adds a description; replaces an earlier one with the same number from the same server.
  void add(const wire::RobotDescription& description, std::uint64_t server);

  /// Returns true if the server has described all robots that it admits.
  bool describe(const wire::Admit& admit, std::uint64_t server) const;

  /// Discards the descriptions of other servers, and returns those of this one.
  std::vector<wire::RobotDescription> keep(std::uint64_t server);

 private:
  struct Known {
    wire::RobotDescription description;
    std::uint64_t server = 0;
  };
  std::vector<Known> known_;
};

}  // namespace cohort
