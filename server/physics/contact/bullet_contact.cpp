// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/bullet_contact.hpp"

#include "server/core/state_visitors.hpp"
#include "server/physics/contact/bullet.hpp"

namespace cohort::physics {

namespace {

btDefaultCollisionConstructionInfo without_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 1;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  return info;
}

}  // namespace

// A dispatcher that allocates from the heap and keeps no list of manifolds. Bullet's own takes manifolds and algorithms
// from pools that are not thread-safe, and lists all manifolds in one array.
class BulletNarrowPhase::Dispatcher final : public btCollisionDispatcher {
 public:
  Dispatcher(btCollisionConfiguration* configuration, double margin)
      : btCollisionDispatcher(configuration), margin_(margin) {}

  btPersistentManifold* getNewManifold(const btCollisionObject* a, const btCollisionObject* b) override {
    void* memory = btAlignedAlloc(sizeof(btPersistentManifold), 16);
    return new (memory) btPersistentManifold(
        a, b, 0, margin_, std::min(a->getContactProcessingThreshold(), b->getContactProcessingThreshold()));
  }
  void releaseManifold(btPersistentManifold* manifold) override {
    clearManifold(manifold);
    manifold->~btPersistentManifold();
    btAlignedFree(manifold);
  }
  void* allocateCollisionAlgorithm(int size) override { return btAlignedAlloc(size, 16); }
  void freeCollisionAlgorithm(void* algorithm) override { btAlignedFree(algorithm); }

 private:
  double margin_;
};

struct BulletNarrowPhase::State {
  explicit State(double margin) : dispatcher(&configuration, margin) {}

  btDefaultCollisionConfiguration configuration{without_pools()};
  Dispatcher dispatcher;
};

BulletNarrowPhase::BulletNarrowPhase(double margin) : state_(std::make_unique<State>(margin)) {}
BulletNarrowPhase::~BulletNarrowPhase() = default;

struct BulletContact::State {
  btCollisionDispatcher* dispatcher = nullptr;
  std::shared_ptr<const BulletShape> shape_a;
  std::shared_ptr<const BulletShape> shape_b;
  btCollisionObject a;
  btCollisionObject b;
  btCollisionAlgorithm* algorithm = nullptr;
  double skin = 0.0;  // [m]

  btPersistentManifold* manifold() const;
  void collide(const Pose& X_WA, const Pose& X_WB);
  ~State() {
    if (algorithm == nullptr) return;
    algorithm->~btCollisionAlgorithm();
    dispatcher->freeCollisionAlgorithm(algorithm);
  }
};

BulletContact::BulletContact(BulletNarrowPhase& narrow_phase, std::shared_ptr<const BulletShape> a,
                             std::shared_ptr<const BulletShape> b)
    : state_(std::make_unique<State>()) {
  state_->dispatcher = &narrow_phase.state_->dispatcher;
  state_->a.setCollisionShape(a->get());
  state_->b.setCollisionShape(b->get());
  const auto is_sphere = [](const BulletShape& shape) { return shape.get()->getShapeType() == SPHERE_SHAPE_PROXYTYPE; };
  state_->skin = (is_sphere(*b) ? 0.0 : a->skin()) + (is_sphere(*a) ? 0.0 : b->skin());
  state_->shape_a = std::move(a);
  state_->shape_b = std::move(b);
}

BulletContact::~BulletContact() = default;
BulletContact::BulletContact(BulletContact&&) noexcept = default;
BulletContact& BulletContact::operator=(BulletContact&&) noexcept = default;

namespace {

// Visits those members of a Bullet contact point that decide which points Bullet keeps in the next step.
template <class Point, class Visit>
void visit_point(Point& point, Visit&& visit) {
  for (auto* vector : {&point.m_localPointA, &point.m_localPointB, &point.m_positionWorldOnA, &point.m_positionWorldOnB,
                       &point.m_normalWorldOnB})
    for (int axis = 0; axis < 3; ++axis) visit((*vector)[axis]);
  visit(point.m_distance1);
  visit(point.m_lifeTime);
}

}  // namespace

// Returns the manifold, or nullptr if the algorithm has none yet.
btPersistentManifold* BulletContact::State::manifold() const {
  if (algorithm == nullptr) return nullptr;
  btManifoldArray manifolds;
  algorithm->getAllContactManifolds(manifolds);
  return manifolds.size() > 0 ? manifolds[0] : nullptr;
}

void BulletContact::State::collide(const Pose& X_WA, const Pose& X_WB) {
  a.setWorldTransform(to_bullet(X_WA * Pose{shape_a->offset()}));
  b.setWorldTransform(to_bullet(X_WB * Pose{shape_b->offset()}));
  const btCollisionObjectWrapper wrapped_a(nullptr, a.getCollisionShape(), &a, a.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper wrapped_b(nullptr, b.getCollisionShape(), &b, b.getWorldTransform(), -1, -1);
  if (algorithm == nullptr)
    algorithm = dispatcher->findAlgorithm(&wrapped_a, &wrapped_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  btManifoldResult result(&wrapped_a, &wrapped_b);
  const btDispatcherInfo info;
  algorithm->processCollision(&wrapped_a, &wrapped_b, info, &result);
}

void BulletContact::update(const Pose& X_WA, const Pose& X_WB, ContactPoints& points) {
  State& state = *state_;
  // Bullet reorders its points when it drops or replaces some. The impulses move with them.
  if (btPersistentManifold* manifold = state.manifold()) {
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      const ContactPoint& point = points.points[static_cast<std::size_t>(i)];
      btManifoldPoint& theirs = manifold->getContactPoint(i);
      theirs.m_appliedImpulse = point.impulse[0];
      theirs.m_appliedImpulseLateral1 = point.impulse[1];
      theirs.m_appliedImpulseLateral2 = point.impulse[2];
    }
  }
  state.collide(X_WA, X_WB);
  points.count = 0;
  const btPersistentManifold* manifold = state.manifold();
  if (manifold == nullptr) return;
  const bool flipped = manifold->getBody0() != &state.a;
  for (int i = 0; i < manifold->getNumContacts(); ++i) {
    const btManifoldPoint& theirs = manifold->getContactPoint(i);
    const Eigen::Vector3d normal_W = (flipped ? -1.0 : 1.0) * to_eigen(theirs.m_normalWorldOnB);
    const Eigen::Vector3d position_W =
        0.5 * (to_eigen(theirs.getPositionWorldOnA()) + to_eigen(theirs.getPositionWorldOnB()) - state.skin * normal_W);
    points.add(position_W, normal_W, theirs.getDistance() + state.skin);
    points.points[static_cast<std::size_t>(i)].impulse = {theirs.m_appliedImpulse, theirs.m_appliedImpulseLateral1,
                                                          theirs.m_appliedImpulseLateral2};
  }
}

void BulletContact::save(SnapshotWriter& writer) const {
  const btPersistentManifold* manifold = state_->manifold();
  const int count = manifold == nullptr ? 0 : manifold->getNumContacts();
  writer.add(count);
  for (int i = 0; i < count; ++i)
    visit_point(manifold->getContactPoint(i), [&](const auto& number) { writer.add(number); });
}

void BulletContact::restore(const Pose& X_WA, const Pose& X_WB, SnapshotReader& reader) {
  int count = 0;
  reader.read(count);
  if (count < 0 || count > MANIFOLD_CACHE_SIZE) throw SnapshotError("snapshot: a contact has too many points");
  state_->collide(X_WA, X_WB);  // creates the manifold
  btPersistentManifold* manifold = state_->manifold();
  if (manifold == nullptr && count > 0)
    throw SnapshotError("snapshot: contact points of two solids that have no contact");
  if (manifold == nullptr) return;
  manifold->clearManifold();
  manifold->setNumContacts(count);
  for (int i = 0; i < count; ++i) {
    btManifoldPoint point;
    visit_point(point, StateRestorer{reader});
    manifold->getContactPoint(i) = point;
  }
}

}  // namespace cohort::physics
