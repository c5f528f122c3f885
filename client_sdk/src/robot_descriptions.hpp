// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "idl/wire/messages.hpp"

namespace cohort {

/// Robot descriptions received from servers. A server that replaces another one is a different DDS participant, and may
/// reuse a number for another description.
class RobotDescriptions {
 public:
  /// Adds a description without its tree; replaces an earlier one with the same number from the same server.
  void add(const wire::RobotDescription& description, std::uint64_t server);
  /// Adds the tree of a description, likewise.
  void add(const wire::RobotTree& tree, std::uint64_t server);
  /// Notes that the server sends a tree for each description; servers of protocol 1.3 send none.
  void expect_trees(std::uint64_t server) { with_trees_.insert(server); }

  /// Returns true if the server has described all robots that it admits, with their trees if it sends them.
  bool describe(const wire::Admit& admit, std::uint64_t server) const;

  /// Discards the descriptions of other servers, and returns those of this one, with their trees.
  std::vector<wire::RobotDescription> keep(std::uint64_t server);

 private:
  struct Known {
    wire::RobotDescription description;
    std::uint64_t server = 0;
  };
  using Id = std::pair<std::uint64_t, std::uint32_t>;  // a server, and its number for a description
  bool is_described(const wire::AdmittedRobot& robot, std::uint64_t server) const;

  std::vector<Known> known_;
  std::map<Id, KinematicTree> trees_;
  std::set<std::uint64_t> with_trees_;  // servers
};

}  // namespace cohort
