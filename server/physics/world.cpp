#include "server/physics/world.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "server/physics/collision.hpp"
#include "server/physics/islands.hpp"
#include "server/physics/multibody.hpp"

namespace cohort::physics {
namespace {

constexpr std::uint32_t bodies_a_batch = 16;
constexpr std::size_t bodies_a_chunk = 16;
constexpr int solver_iterations = 10;

std::unique_ptr<btCollisionShape> make_shape(const description::Shape& shape) {
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
    using Shape = std::unique_ptr<btCollisionShape>;
    static Shape refuse() { throw std::invalid_argument("shapes of this kind are not simulated yet"); }
    Shape operator()(const description::Capsule&) const { return refuse(); }
    Shape operator()(const description::Ellipsoid&) const { return refuse(); }
    Shape operator()(const description::Mesh&) const { return refuse(); }
    Shape operator()(const description::Heightmap&) const { return refuse(); }
  };
  return std::visit(Make{}, shape);
}

btContactSolverInfo solver_info(double step) {
  btContactSolverInfo info;
  info.m_timeStep = step;
  info.m_numIterations = solver_iterations;
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_ARTICULATED_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS |
                      SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
  info.m_leastSquaresResidualThreshold = 0.0;  // an early end of one batch would depend on who else is in it
  return info;
}

}  // namespace

class World::Implementation {
 public:
  Implementation(const description::World& description, WorkerPool& workers);

  void step();
  void hash_contacts(StateHash& hash) const;

 private:
  friend World;  // its functions are the other half of this one

  struct Part {  // a solid that moves
    std::uint32_t solid;
    std::size_t link;
    Pose X_LC;
  };
  struct Batch {
    std::vector<btCollisionObject*> bodies;
    std::vector<btPersistentManifold*> manifolds;
    std::vector<btMultiBodyConstraint*> constraints;
  };

  void add_solids(std::uint32_t body);
  void build_batches();
  void solve();
  void integrate();
  void place_solids(std::uint32_t member);
  void report_contacts();
  std::uint32_t member_of(std::uint32_t solid) const { return member_of_body_[scene_.solid(solid).body]; }

  const description::World& description_;
  WorkerPool& workers_;
  double step_;
  btContactSolverInfo info_;
  geometry::Scene scene_;
  std::vector<std::unique_ptr<Multibody>> multibodies_;  // by body; null for what is static
  std::vector<Contact> contacts_;
  std::vector<std::uint32_t> moving_bodies_;   // by member
  std::vector<std::uint32_t> member_of_body_;  // index into moving_bodies_
  std::vector<std::vector<Part>> parts_;       // by member
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::vector<btCollisionObject*> object_of_solid_;
  std::unique_ptr<Collision> collision_;
  Islands islands_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links_;
  std::vector<Batch> batches_;
  std::vector<std::unique_ptr<TreelSolver>> solvers_;  // by worker
  std::vector<Scratch> scratch_;                       // by worker
  std::vector<char> finite_;                           // by member
};

World::Implementation::Implementation(const description::World& description, WorkerPool& workers)
    : description_(description),
      workers_(workers),
      step_(std::chrono::duration<double>(description.step).count()),
      info_(solver_info(step_)) {
  const auto body_count = static_cast<std::uint32_t>(description.instances.size());
  multibodies_.resize(body_count);
  member_of_body_.assign(body_count, geometry::Scene::no_body);
  for (std::uint32_t body = 0; body < body_count; ++body) {
    const description::Instance& instance = description.instances[body];
    const description::Model& model = description.models[instance.model];
    if (!model.is_static) {
      try {
        multibodies_[body] = std::make_unique<Multibody>(model, instance.X_WM, body, scene_);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("model '" + model.name + "': " + error.what());
      }
      member_of_body_[body] = static_cast<std::uint32_t>(moving_bodies_.size());
      moving_bodies_.push_back(body);
      parts_.emplace_back();
    }
    add_solids(body);
  }
  scene_.build();
  collision_ = std::make_unique<Collision>(scene_, object_of_solid_);
  for (unsigned worker = 0; worker < workers.threads(); ++worker) solvers_.push_back(std::make_unique<TreelSolver>());
  scratch_.resize(workers.threads());
  finite_.assign(moving_bodies_.size(), 1);
}

void World::Implementation::add_solids(std::uint32_t body) {
  const description::Instance& instance = description_.instances[body];
  const description::Model& model = description_.models[instance.model];
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    for (const description::Collision& collision : model.links[link].collisions) {
      const Pose X_WC = instance.X_WM * model.links[link].X_ML * collision.X_LC;
      const std::uint32_t solid = scene_.add({collision.shape, collision.surface, body, !model.is_static, X_WC});
      shapes_.push_back(make_shape(collision.shape));
      if (model.is_static) {
        objects_.push_back(std::make_unique<btCollisionObject>());
      } else {
        objects_.push_back(
            std::make_unique<btMultiBodyLinkCollider>(&multibodies_[body]->bullet(), static_cast<int>(link) - 1));
        parts_[member_of_body_[body]].push_back({solid, link, collision.X_LC});
      }
      objects_.back()->setCollisionShape(shapes_.back().get());
      objects_.back()->setWorldTransform(to_bullet(X_WC));
      object_of_solid_.push_back(objects_.back().get());
    }
  }
}

void World::Implementation::step() {
  collision_->detect(workers_, step_);
  build_batches();
  workers_.for_each_chunk(
      moving_bodies_.size(), bodies_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t i = begin; i < end; ++i)
          multibodies_[moving_bodies_[i]]->apply_forces(description_.gravity, step_, scratch_[worker]);
      });
  solve();
  integrate();
  report_contacts();
  scene_.update();
}

void World::Implementation::build_batches() {
  links_.clear();
  for (const Collision::PairContact& contact : collision_->contacts())
    if (scene_.solid(contact.solid_a).moves && scene_.solid(contact.solid_b).moves)
      links_.emplace_back(member_of(contact.solid_a), member_of(contact.solid_b));
  islands_.build(static_cast<std::uint32_t>(moving_bodies_.size()), links_, bodies_a_batch);

  if (batches_.size() < islands_.batch_count()) batches_.resize(islands_.batch_count());
  for (Batch& batch : batches_) {
    batch.bodies.clear();
    batch.manifolds.clear();
    batch.constraints.clear();
  }
  for (std::uint32_t member = 0; member < moving_bodies_.size(); ++member) {
    Multibody& multibody = *multibodies_[moving_bodies_[member]];
    Batch& batch = batches_[islands_.batch_of(member)];
    batch.bodies.push_back(multibody.handle());
    batch.constraints.insert(batch.constraints.end(), multibody.constraints().begin(), multibody.constraints().end());
  }
  for (const Collision::PairContact& contact : collision_->contacts()) {
    const std::uint32_t moving = scene_.solid(contact.solid_a).moves ? contact.solid_a : contact.solid_b;
    batches_[islands_.batch_of(member_of(moving))].manifolds.push_back(contact.manifold);
  }
}

void World::Implementation::solve() {
  workers_.for_each_chunk(islands_.batch_count(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i) {
      Batch& batch = batches_[i];
      solvers_[worker]->solveMultiBodyGroup(batch.bodies.data(), static_cast<int>(batch.bodies.size()),
                                            batch.manifolds.data(), static_cast<int>(batch.manifolds.size()), nullptr,
                                            0, batch.constraints.data(), static_cast<int>(batch.constraints.size()),
                                            info_, nullptr, nullptr);
    }
  });
}

void World::Implementation::integrate() {
  workers_.for_each_chunk(moving_bodies_.size(), bodies_a_chunk,
                          [&](std::size_t begin, std::size_t end, unsigned worker) {
                            for (std::size_t i = begin; i < end; ++i) {
                              finite_[i] = multibodies_[moving_bodies_[i]]->integrate(step_, scratch_[worker]) ? 1 : 0;
                              if (finite_[i]) place_solids(static_cast<std::uint32_t>(i));
                            }
                          });
  for (std::size_t i = 0; i < finite_.size(); ++i)
    if (!finite_[i])
      throw std::runtime_error("the state of '" + description_.instances[moving_bodies_[i]].name +
                               "' is no longer finite");
}

void World::Implementation::place_solids(std::uint32_t member) {
  const Multibody& multibody = *multibodies_[moving_bodies_[member]];
  for (const Part& part : parts_[member]) {
    const Pose X_WC = multibody.link_pose(part.link) * part.X_LC;
    scene_.set_pose(part.solid, X_WC);
    object_of_solid_[part.solid]->setWorldTransform(to_bullet(X_WC));
  }
}

void World::Implementation::report_contacts() {
  contacts_.clear();
  for (const Collision::PairContact& pair : collision_->contacts()) {
    const bool swapped = pair.manifold->getBody0() != object_of_solid_[pair.solid_a];
    for (int i = 0; i < pair.manifold->getNumContacts(); ++i) {
      const btManifoldPoint& point = pair.manifold->getContactPoint(i);
      if (point.getDistance() > 0.0 && point.m_appliedImpulse == 0.0) continue;  // near, but it did not touch
      const Eigen::Vector3d normal_W = to_eigen(point.m_normalWorldOnB);
      contacts_.push_back({scene_.solid(pair.solid_a).body, scene_.solid(pair.solid_b).body,
                           to_eigen(point.getPositionWorldOnB()), swapped ? Eigen::Vector3d(-normal_W) : normal_W,
                           point.getDistance(), point.m_appliedImpulse});
    }
  }
}

void World::Implementation::hash_contacts(StateHash& hash) const {
  for (const Collision::PairContact& pair : collision_->contacts()) {
    hash.add(static_cast<std::uint64_t>(pair.solid_a) << 32 | pair.solid_b);
    for (int i = 0; i < pair.manifold->getNumContacts(); ++i) {
      const btManifoldPoint& point = pair.manifold->getContactPoint(i);
      for (int axis = 0; axis < 3; ++axis) {
        hash.add(point.m_localPointA[axis]);
        hash.add(point.m_localPointB[axis]);
      }
      hash.add(point.m_appliedImpulse);
      hash.add(point.m_prevRHS);
    }
  }
}

World::World(const description::World& description, WorkerPool& workers)
    : implementation_(std::make_unique<Implementation>(description, workers)) {}
World::~World() = default;

void World::step() { implementation_->step(); }
const geometry::Scene& World::scene() const { return implementation_->scene_; }
std::size_t World::body_count() const { return implementation_->multibodies_.size(); }
std::span<const Contact> World::contacts() const { return implementation_->contacts_; }

Pose World::link_pose(std::uint32_t body, std::size_t link) const {
  if (const auto& multibody = implementation_->multibodies_[body]) return multibody->link_pose(link);
  const description::Instance& instance = implementation_->description_.instances[body];
  return instance.X_WM * implementation_->description_.models[instance.model].links[link].X_ML;
}

Twist World::link_twist(std::uint32_t body, std::size_t link) const {
  if (const auto& multibody = implementation_->multibodies_[body]) return multibody->link_twist(link);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

double World::joint_position(std::uint32_t body, std::size_t joint) const {
  return implementation_->multibodies_[body]->joint_position(joint);
}
double World::joint_velocity(std::uint32_t body, std::size_t joint) const {
  return implementation_->multibodies_[body]->joint_velocity(joint);
}
const TrackState& World::track(std::uint32_t body, std::size_t drive, Side side) const {
  return implementation_->multibodies_[body]->drive(drive)->track(side);
}
void World::set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) {
  implementation_->multibodies_[body]->motor(joint)->set_target(velocity);
}
void World::set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) {
  implementation_->multibodies_[body]->drive(drive)->set_target(side, velocity);
}

void World::hash_body(std::uint32_t body, StateHash& hash) const {
  if (const auto& multibody = implementation_->multibodies_[body]) multibody->hash(hash);
}

void World::hash_contacts(StateHash& hash) const { implementation_->hash_contacts(hash); }

}  // namespace cohort::physics
