#pragma once

#include <memory>
#include <span>
#include <vector>

#include "server/core/worker_pool.hpp"
#include "server/geometry/scene.hpp"
#include "server/physics/bullet.hpp"

namespace cohort::physics {

/// Contact manifolds between the solids of a scene. Keeps Bullet's algorithm for each pair of solids that are near each
/// other, as long as they are; pairs and manifolds are always in the order of the solids' indices, so nothing depends
/// on the number of workers or on what was near before.
class Collision {
 public:
  /// `objects[i]` is Bullet's object for solid i of the scene; both must outlive this.
  Collision(const geometry::Scene& scene, std::span<btCollisionObject* const> objects);
  ~Collision();

  /// Finds near pairs and their contact points for the objects' current transforms.
  void detect(WorkerPool& workers, double step);

  struct PairContact {
    std::uint32_t solid_a;
    std::uint32_t solid_b;
    btPersistentManifold* manifold;  ///< has at least one point; body 0 is one of the two solids' object
  };
  std::span<const PairContact> contacts() const { return contacts_; }

 private:
  struct Pair;
  class Dispatcher;

  void find_pairs(WorkerPool& workers);
  void narrow(Pair& pair, const btDispatcherInfo& info);

  const geometry::Scene& scene_;
  std::span<btCollisionObject* const> objects_;
  std::vector<std::uint32_t> moving_;
  std::unique_ptr<btCollisionConfiguration> configuration_;
  std::unique_ptr<Dispatcher> dispatcher_;
  std::vector<Pair> pairs_;                        // ascending
  std::vector<std::vector<std::uint64_t>> found_;  // for each moving solid, keys of its pairs
  std::vector<PairContact> contacts_;
};

}  // namespace cohort::physics
