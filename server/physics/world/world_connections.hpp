// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>

#include "server/core/ids.hpp"
#include "server/core/pose.hpp"

namespace cohort::physics {

struct Wrench {
  Eigen::Vector3d force_W;   ///< [N]
  Eigen::Vector3d torque_W;  ///< [N m]
};

/// The load at which a connection breaks.
struct ConnectionLimits {
  double force = std::numeric_limits<double>::infinity();   ///< [N]
  double torque = std::numeric_limits<double>::infinity();  ///< [N m]
};

/// The compliance of a connection; rigid by default. Axes are those of P on body a. Springs and dampers are implicit,
/// and so stable at any stiffness and step. A connection slips beyond its holding limits and then has a new rest
/// position.
struct ConnectionGive {
  static constexpr double rigid = std::numeric_limits<double>::infinity();

  double linear_stiffness = rigid;  ///< [N/m]
  double linear_damping = 0.0;      ///< only with a stiffness that is not rigid [N s/m]
  double holding_force = rigid;     ///< along each axis [N]
  Eigen::Vector3d angular_stiffness = Eigen::Vector3d::Constant(rigid);  ///< about each axis [N m/rad]
  Eigen::Vector3d angular_damping = Eigen::Vector3d::Zero();             ///< [N m s/rad]
  Eigen::Vector3d holding_torque = Eigen::Vector3d::Constant(rigid);     ///< 0: turns freely [N m]
};

/// A link of a body of the world.
struct BodyLink {
  BodyId body;
  LinkId link;
};

enum class ConnectionEnd : std::uint8_t { a, b };

/// The connections of a world: each holds a link of one body to a link of another. Functions that change something must
/// be called between steps.
class WorldConnections {
 public:
  /// Connects a link of a moving body `a` to a link of `b` in their present relative pose, at the frame P of link a,
  /// from the next step on. Returns the connection, whose number counts up from 0.
  virtual ConnectionId connect(const BodyLink& a, const Pose& X_LP, const BodyLink& b,
                               const ConnectionLimits& limits = {}) = 0;
  virtual void disconnect(ConnectionId connection) = 0;
  /// Sets the compliance from the next step on.
  virtual void set_give(ConnectionId connection, const ConnectionGive& give) = 0;

  /// Returns the number of connections ever made.
  virtual std::uint32_t made() const = 0;
  virtual bool holds(ConnectionId connection) const = 0;
  /// Returns the mean wrench over the last step on the link of `end` by the other link, about the origin of P as fixed
  /// to the link of `end`. If the connection broke in the last step, this is the wrench that broke it; it is zero if
  /// the connection was released earlier.
  virtual Wrench wrench(ConnectionId connection, ConnectionEnd end = ConnectionEnd::a) const = 0;
  /// Returns the connections that broke in the last step, ascending.
  virtual std::span<const ConnectionId> broken() const = 0;

 protected:
  ~WorldConnections() = default;
};

}  // namespace cohort::physics
