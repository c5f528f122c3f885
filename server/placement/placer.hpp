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
  std::uint64_t number = 0;  ///< of the place, from 0
  Pose X_WM;
};

/// Draws places for the populations of a world, by a seed. What does not depend on the seed is prepared once:
/// footprints and ground of what stands where the file says, in the cells of a grid, and the room that each model
/// takes.
///
/// Instances stand upright and with a gap of at least `gap` between the bounding circle of an instance and all that is
/// in its way: everything solid that the file or an earlier population has put there, and the bounding circles of the
/// others. The circle is about the model's origin, so the heading does not matter. The lowest point of the model stands
/// on the highest ground under the circle: planes, height maps, and what is static and no higher than `level`; at
/// `level` if there is none.
///
/// Random places are tried again if they are taken, a bounded number of times; given ones are left out. The draws of
/// instance i depend on seed, name and i alone.
///
/// All members are const, and callable from any number of threads at once. Nothing is parsed, opened or locked.
class Placer {
 public:
  /// Keeps what it needs of the world.
  explicit Placer(const World& world);
  Placer(Placer&& other) noexcept;
  Placer& operator=(Placer&& other) noexcept;
  ~Placer();

  /// Returns the places of each population. One that has less room than it needs is among the problems; it is then the
  /// last one.
  std::vector<std::vector<Placed>> draw(std::uint64_t seed, std::vector<Problem>& problems) const;

  /// Index into World::instances of the first instance of a population.
  std::size_t first() const { return first_; }
  /// The number of instances of all populations in the world that this was made of.
  std::size_t count() const { return count_; }
  /// Sets the poses of the `count()` instances from `first()` on. Returns false, and leaves the poses as they are, if
  /// the seed gives other instances than that world has, which only a population that may be fewer can cause. Throws
  /// InputError if a population has less room than it needs.
  bool place(std::uint64_t seed, std::span<Pose> X_WM) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

/// For messages of populations with fewer instances than they should have.
std::string how_many_fit(std::size_t placed, std::uint64_t count);

}  // namespace cohort::placement
