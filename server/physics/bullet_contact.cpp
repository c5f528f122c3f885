#include "server/physics/bullet_contact.hpp"

#include <stdexcept>

#include "server/physics/bullet.hpp"

namespace cohort::physics {

class BulletShape {
 public:
  explicit BulletShape(std::unique_ptr<btCollisionShape> shape) : shape_(std::move(shape)) {}
  btCollisionShape* get() const { return shape_.get(); }

 private:
  std::unique_ptr<btCollisionShape> shape_;
};

namespace {

struct Make {
  std::unique_ptr<btCollisionShape> operator()(const description::Box& box) const {
    return std::make_unique<btBoxShape>(to_bullet(0.5 * box.size));
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Sphere& sphere) const {
    return std::make_unique<btSphereShape>(sphere.radius);
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Cylinder& cylinder) const {
    return std::make_unique<btCylinderShapeZ>(btVector3(cylinder.radius, cylinder.radius, 0.5 * cylinder.length));
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Plane& plane) const {
    return std::make_unique<btStaticPlaneShape>(to_bullet(plane.normal), 0.0);
  }
};

btDefaultCollisionConstructionInfo without_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 1;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  return info;
}

}  // namespace

std::shared_ptr<const BulletShape> make_bullet_shape(const geometry::Shape& shape) {
  return std::make_shared<BulletShape>(std::visit(Make{}, shape));
}

// Bullet's dispatcher hands out manifolds and algorithms from pools that are not safe for several threads, and lists
// all manifolds in one array; ours takes memory from the allocator and keeps no list.
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
  state_->shape_a = std::move(a);
  state_->shape_b = std::move(b);
}

BulletContact::~BulletContact() = default;
BulletContact::BulletContact(BulletContact&&) noexcept = default;
BulletContact& BulletContact::operator=(BulletContact&&) noexcept = default;

void BulletContact::update(const Pose& X_WA, const Pose& X_WB, ContactPoints& points) {
  State& state = *state_;
  state.a.setWorldTransform(to_bullet(X_WA));
  state.b.setWorldTransform(to_bullet(X_WB));
  const btCollisionObjectWrapper a(nullptr, state.a.getCollisionShape(), &state.a, state.a.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper b(nullptr, state.b.getCollisionShape(), &state.b, state.b.getWorldTransform(), -1, -1);
  btManifoldArray manifolds;
  if (state.algorithm == nullptr) {
    state.algorithm = state.dispatcher->findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  } else {
    state.algorithm->getAllContactManifolds(manifolds);
  }

  // Bullet moves its points about as it drops and replaces some: the impulses go along with them.
  if (manifolds.size() > 0) {
    for (int i = 0; i < manifolds[0]->getNumContacts(); ++i) {
      const ContactPoint& point = points.points[static_cast<std::size_t>(i)];
      btManifoldPoint& theirs = manifolds[0]->getContactPoint(i);
      theirs.m_appliedImpulse = point.impulse[0];
      theirs.m_appliedImpulseLateral1 = point.impulse[1];
      theirs.m_appliedImpulseLateral2 = point.impulse[2];
    }
  }
  btManifoldResult result(&a, &b);
  const btDispatcherInfo info;
  state.algorithm->processCollision(&a, &b, info, &result);
  manifolds.resize(0);
  state.algorithm->getAllContactManifolds(manifolds);
  points.count = 0;
  if (manifolds.size() == 0) return;
  const bool flipped = manifolds[0]->getBody0() != &state.a;
  for (int i = 0; i < manifolds[0]->getNumContacts(); ++i) {
    const btManifoldPoint& theirs = manifolds[0]->getContactPoint(i);
    const Eigen::Vector3d normal_W = (flipped ? -1.0 : 1.0) * to_eigen(theirs.m_normalWorldOnB);
    const Eigen::Vector3d position_W =
        0.5 * (to_eigen(theirs.getPositionWorldOnA()) + to_eigen(theirs.getPositionWorldOnB()));
    points.add(position_W, normal_W, theirs.getDistance());
    points.points[static_cast<std::size_t>(i)].impulse = {theirs.m_appliedImpulse, theirs.m_appliedImpulseLateral1,
                                                          theirs.m_appliedImpulseLateral2};
  }
}

}  // namespace cohort::physics
