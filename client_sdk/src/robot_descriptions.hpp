#pragma once

#include <cstdint>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// Robot descriptions received from servers. A server that replaces another is another DDS participant, and may use the
/// same number for another description.
class RobotDescriptions {
 public:
  /// Adds a description; replaces an earlier one of the server with this number.
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
