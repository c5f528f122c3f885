#include "server/physics/collision.hpp"

#include <algorithm>

namespace cohort::physics {
namespace {

// Points this near count as touching for the solver, which lets them close the gap within the step. Bullet's default of
// 20 mm is a third of an s-bot's radius and would tie neighbours into one island.
constexpr double contact_margin = 0.005;

constexpr std::size_t solids_a_chunk = 64;
constexpr std::size_t pairs_a_chunk = 32;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

}  // namespace

// Bullet's dispatcher hands out manifolds and algorithms from pools that are not safe for several threads, and lists
// all manifolds in one array; ours takes memory from the allocator and keeps no list.
class Collision::Dispatcher final : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;

  btPersistentManifold* getNewManifold(const btCollisionObject* a, const btCollisionObject* b) override {
    void* memory = btAlignedAlloc(sizeof(btPersistentManifold), 16);
    return new (memory) btPersistentManifold(
        a, b, 0, contact_margin, std::min(a->getContactProcessingThreshold(), b->getContactProcessingThreshold()));
  }
  void releaseManifold(btPersistentManifold* manifold) override {
    clearManifold(manifold);
    manifold->~btPersistentManifold();
    btAlignedFree(manifold);
  }
  void* allocateCollisionAlgorithm(int size) override { return btAlignedAlloc(size, 16); }
  void freeCollisionAlgorithm(void* algorithm) override { btAlignedFree(algorithm); }
};

struct Collision::Pair {
  std::uint64_t key;
  btCollisionAlgorithm* algorithm = nullptr;
  btPersistentManifold* manifold = nullptr;  // null while the pair has no point

  std::uint32_t a() const { return static_cast<std::uint32_t>(key >> 32); }
  std::uint32_t b() const { return static_cast<std::uint32_t>(key); }
  void release(Dispatcher& dispatcher) {
    if (algorithm == nullptr) return;
    algorithm->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(algorithm);
    algorithm = nullptr;
  }
};

Collision::Collision(const geometry::Scene& scene, std::span<btCollisionObject* const> objects)
    : scene_(scene), objects_(objects) {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 1;  // the pools stay unused
  info.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  configuration_ = std::make_unique<btDefaultCollisionConfiguration>(info);
  dispatcher_ = std::make_unique<Dispatcher>(configuration_.get());
  for (std::uint32_t solid = 0; solid < scene.size(); ++solid)
    if (scene.solid(solid).moves) moving_.push_back(solid);
  found_.resize(moving_.size());
}

Collision::~Collision() {
  for (Pair& pair : pairs_) pair.release(*dispatcher_);
}

void Collision::detect(WorkerPool& workers, double step) {
  find_pairs(workers);

  btDispatcherInfo info;
  info.m_timeStep = step;
  workers.for_each_chunk(pairs_.size(), pairs_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) narrow(pairs_[i], info);
  });

  contacts_.clear();
  for (const Pair& pair : pairs_)
    if (pair.manifold != nullptr) contacts_.push_back({pair.a(), pair.b(), pair.manifold});
}

void Collision::find_pairs(WorkerPool& workers) {
  workers.for_each_chunk(moving_.size(), solids_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t solid = moving_[i];
      std::vector<std::uint64_t>& keys = found_[i];
      keys.clear();
      scene_.for_each_overlap(scene_.bounds(solid).grown_by(contact_margin), [&](std::uint32_t other) {
        if (scene_.solid(other).body == scene_.solid(solid).body) return;
        if (scene_.solid(other).moves && other < solid) return;  // the other one reports it
        keys.push_back(key_of(solid, other));
      });
    }
  });
  std::vector<std::uint64_t> keys;
  for (const auto& found : found_) keys.insert(keys.end(), found.begin(), found.end());
  std::sort(keys.begin(), keys.end());

  // Old pairs that are still near keep their algorithm, with the contact points that it caches.
  std::vector<Pair> next;
  next.reserve(keys.size());
  std::size_t old = 0;
  for (const std::uint64_t key : keys) {
    while (old < pairs_.size() && pairs_[old].key < key) pairs_[old++].release(*dispatcher_);
    if (old < pairs_.size() && pairs_[old].key == key)
      next.push_back(pairs_[old++]);
    else
      next.push_back({key});
  }
  while (old < pairs_.size()) pairs_[old++].release(*dispatcher_);
  pairs_ = std::move(next);
}

void Collision::narrow(Pair& pair, const btDispatcherInfo& info) {
  btCollisionObject* a = objects_[pair.a()];
  btCollisionObject* b = objects_[pair.b()];
  const btCollisionObjectWrapper wrapped_a(nullptr, a->getCollisionShape(), a, a->getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper wrapped_b(nullptr, b->getCollisionShape(), b, b->getWorldTransform(), -1, -1);
  if (pair.algorithm == nullptr)
    pair.algorithm = dispatcher_->findAlgorithm(&wrapped_a, &wrapped_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  pair.manifold = nullptr;
  if (pair.algorithm == nullptr) return;

  btManifoldResult result(&wrapped_a, &wrapped_b);
  pair.algorithm->processCollision(&wrapped_a, &wrapped_b, info, &result);
  btManifoldArray manifolds;
  pair.algorithm->getAllContactManifolds(manifolds);
  if (manifolds.size() == 0 || manifolds[0]->getNumContacts() == 0) return;

  pair.manifold = manifolds[0];
  const description::Surface& surface_a = scene_.solid(pair.a()).surface;
  const description::Surface& surface_b = scene_.solid(pair.b()).surface;
  for (int i = 0; i < pair.manifold->getNumContacts(); ++i) {
    btManifoldPoint& point = pair.manifold->getContactPoint(i);
    point.m_combinedFriction = std::min(surface_a.friction, surface_b.friction);
    point.m_combinedRestitution = std::max(surface_a.restitution, surface_b.restitution);
  }
}

}  // namespace cohort::physics
