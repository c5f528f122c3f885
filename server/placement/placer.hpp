// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

struct Placed {
  std::uint64_t number = 0;  ///< number of the position, from 0
  Pose X_WM;
};

/// Draws positions for the populations of a world, by a seed. Everything that does not depend on the seed is prepared
/// once. These are the footprints and the ground of the objects with a pose in the file, sorted into the cells of a
/// grid, and the size of each model.
///
/// Instances are upright. The distance between the bounding circle of an instance and every obstacle is at least `gap`.
/// Obstacles are all solid objects of the file and of earlier populations, and the bounding circles of the other
/// instances. The circle is centred on the origin of the model, so the heading does not matter. The lowest point of the
/// model is on the highest ground under the circle: planes, height maps, and static objects up to `level`; at `level`
/// if there is no ground.
///
/// Random positions that are occupied are drawn again, a bounded number of times; listed ones are skipped. The draws of
/// instance i depend only on the seed, the name and i.
///
/// All members are const and can be called from any number of threads concurrently. They parse, open and lock nothing.
class Placer {
 public:
  /// Copies all it needs from the world.
  explicit Placer(const World& world);
  Placer(Placer&& other) noexcept;
  Placer& operator=(Placer&& other) noexcept;
  ~Placer();

  /// Returns the positions of each population. Adds a problem for a population without enough room, which is then the
  /// last one.
  std::vector<std::vector<Placed>> draw(std::uint64_t seed, std::vector<Problem>& problems) const;

  /// Returns the index into World::instances of the first instance of a population.
  std::size_t first() const { return first_; }
  /// Returns the number of instances of all populations in the world from which this was made.
  std::size_t count() const { return count_; }
  /// Sets the poses of the `count()` instances from `first()` on. Returns false and leaves the poses unchanged if the
  /// seed gives instances other than those of that world, which is possible only if a population may have fewer
  /// instances (`may_be_fewer`). Throws InputError if there is not enough room for a population.
  bool place(std::uint64_t seed, std::span<Pose> X_WM) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

/// Returns a text for messages about populations with too few instances.
std::string how_many_fit(std::size_t placed, std::uint64_t count);

}  // namespace cohort::placement
