// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/core/snapshot.hpp"
#include "server/physics/contact/bullet_shape.hpp"
#include "server/physics/contact/contact_point.hpp"

namespace cohort::physics {

/// Bullet's narrow phase for shapes of any kind. Thread-safe.
class BulletNarrowPhase {
 public:
  /// Finds points nearer than `margin` [m].
  explicit BulletNarrowPhase(double margin);
  ~BulletNarrowPhase();

 private:
  friend class BulletContact;
  class Dispatcher;
  struct State;
  std::unique_ptr<State> state_;
};

/// The contact between two shapes. Bullet finds one or a few points per step and keeps those of the last steps.
/// Therefore this object lives as long as the two shapes are near each other, and its points are state. Different
/// objects may be used from different threads at once.
class BulletContact {
 public:
  /// The narrow phase must outlive this.
  BulletContact(BulletNarrowPhase& narrow_phase, std::shared_ptr<const BulletShape> a,
                std::shared_ptr<const BulletShape> b);
  ~BulletContact();
  BulletContact(BulletContact&&) noexcept;
  BulletContact& operator=(BulletContact&&) noexcept;

  /// Updates `points`, which must be those of the last call with the impulses that the solver has given them since.
  void update(const Pose& X_WA, const Pose& X_WB, ContactPoints& points);

  /// Saves Bullet's part of the points; `points` holds the rest.
  void save(SnapshotWriter& writer) const;
  /// Restores Bullet's part of the points; the shapes must have the poses at which it was saved.
  void restore(const Pose& X_WA, const Pose& X_WB, SnapshotReader& reader);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cohort::physics
