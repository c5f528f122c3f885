// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>

namespace cohort {

/// An index into a list of one kind. Ids of different kinds do not convert into each other or into numbers, so the
/// compiler rejects a joint that is passed as a link.
template <class Tag>
struct Id {
  std::uint32_t value = 0;

  constexpr Id() = default;
  template <std::integral Index>
  explicit constexpr Id(Index index) : value(static_cast<std::uint32_t>(index)) {}

  friend constexpr bool operator==(const Id&, const Id&) = default;
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using BodyId = Id<struct BodyTag>;              ///< a body of a world: an instance of the description
using LinkId = Id<struct LinkTag>;              ///< a link of a model
using JointId = Id<struct JointTag>;            ///< a joint of a model
using DeviceId = Id<struct DeviceTag>;          ///< a device of a model
using RobotId = Id<struct RobotTag>;            ///< a robot of a world; its body has another index
using ConnectionId = Id<struct ConnectionTag>;  ///< a connection that a world made

}  // namespace cohort
