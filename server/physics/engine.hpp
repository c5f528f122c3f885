#pragma once

#include "server/physics/world.hpp"

namespace cohort::physics {

/// What moves the bodies of a world: one for full dynamics and one for flat ground. `World` says what each function
/// does; who may call it when is the same here.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual void step() = 0;
  virtual std::span<const Quarantine> quarantined() const = 0;
  virtual bool is_active(std::uint32_t body) const = 0;
  virtual std::uint32_t add_body(std::size_t model, const Pose& X_WM) = 0;
  virtual void remove_body(std::uint32_t body) = 0;
  virtual void put_back_body(std::uint32_t body) = 0;
  virtual void place_body(std::uint32_t body, const Pose& X_WM) = 0;
  virtual void push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) = 0;

  virtual const geometry::Scene& scene() const = 0;
  virtual std::size_t body_count() const = 0;
  virtual std::size_t model_of(std::uint32_t body) const = 0;
  virtual Pose link_pose(std::uint32_t body, std::size_t link) const = 0;
  virtual Twist link_twist(std::uint32_t body, std::size_t link) const = 0;
  virtual double joint_position(std::uint32_t body, std::size_t joint) const = 0;
  virtual double joint_velocity(std::uint32_t body, std::size_t joint) const = 0;
  virtual TrackState track(std::uint32_t body, std::size_t drive, Side side) const = 0;
  virtual void record(std::uint32_t body) = 0;
  virtual Wrench joint_wrench(std::uint32_t body, std::size_t joint) const = 0;
  virtual Eigen::Vector3d link_acceleration(std::uint32_t body, std::size_t link,
                                            const Eigen::Vector3d& p_LP) const = 0;
  virtual double joint_effort(std::uint32_t body, std::size_t joint) const = 0;

  virtual std::uint32_t connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                                std::size_t link_b, const ConnectionLimits& limits) = 0;
  virtual void disconnect(std::uint32_t connection) = 0;
  virtual bool is_connected(std::uint32_t connection) const = 0;
  virtual void set_connection_give(std::uint32_t connection, const ConnectionGive& give) = 0;
  virtual Wrench connection_wrench(std::uint32_t connection) const = 0;
  virtual Wrench connection_reaction(std::uint32_t connection) const = 0;
  virtual std::span<const std::uint32_t> broken_connections() const = 0;

  virtual void set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) = 0;
  virtual void set_joint_position_target(std::uint32_t body, std::size_t joint, double position) = 0;
  virtual void set_joint_effort_target(std::uint32_t body, std::size_t joint, double effort) = 0;
  virtual void set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) = 0;
  virtual void set_root_twist(std::uint32_t body, const Twist& twist) = 0;
  virtual void set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                               std::span<const double> velocities) = 0;

  virtual std::span<const Contact> contacts() const = 0;
  virtual void hash_body(std::uint32_t body, StateHash& hash) const = 0;
  virtual void hash_contacts(StateHash& hash) const = 0;
  virtual void save(SnapshotWriter& writer) const = 0;
  virtual void restore(SnapshotReader& reader) = 0;
};

}  // namespace cohort::physics
