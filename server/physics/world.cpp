#include "server/physics/world.hpp"

#include "server/physics/stepper.hpp"

namespace cohort::physics {

World::World(const description::World& description, WorkerPool& workers)
    : stepper_(std::make_unique<Stepper>(description, workers)) {}
World::~World() = default;

void World::step() { stepper_->step(); }
std::span<const Quarantine> World::quarantined() const { return stepper_->quarantined(); }
bool World::is_active(std::uint32_t body) const { return stepper_->is_active(body); }
std::uint32_t World::add_body(std::size_t model, const Pose& X_WM) { return stepper_->add_body(model, X_WM); }
void World::remove_body(std::uint32_t body) { stepper_->remove_body(body); }
const geometry::Scene& World::scene() const { return stepper_->scene(); }
std::size_t World::body_count() const { return stepper_->body_count(); }
std::span<const Contact> World::contacts() const { return stepper_->contacts(); }

Pose World::link_pose(std::uint32_t body, std::size_t link) const {
  if (const Multibody* multibody = stepper_->multibody(body)) return multibody->link_pose(link);
  return stepper_->resting_link_pose(body, link);
}

Twist World::link_twist(std::uint32_t body, std::size_t link) const {
  if (const Multibody* multibody = stepper_->multibody(body); multibody != nullptr && stepper_->is_active(body))
    return multibody->link_twist(link);
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

std::uint32_t World::connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                             std::size_t link_b, const ConnectionLimits& limits) {
  return stepper_->connect(body_a, link_a, X_LP, body_b, link_b, limits);
}
void World::disconnect(std::uint32_t connection) { stepper_->disconnect(connection); }
bool World::is_connected(std::uint32_t connection) const { return stepper_->connection(connection).holds(); }
Wrench World::connection_wrench(std::uint32_t connection) const {
  return stepper_->connection(connection).wrench(stepper_->step_size());
}
std::span<const std::uint32_t> World::broken_connections() const { return stepper_->broken_connections(); }

double World::joint_position(std::uint32_t body, std::size_t joint) const {
  return stepper_->multibody(body)->joint_position(joint);
}
double World::joint_velocity(std::uint32_t body, std::size_t joint) const {
  return stepper_->multibody(body)->joint_velocity(joint);
}
TrackState World::track(std::uint32_t body, std::size_t drive, Side side) const {
  return stepper_->multibody(body)->track(drive, side);
}
void World::set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) {
  stepper_->multibody(body)->set_joint_velocity_target(joint, velocity);
}
void World::set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) {
  stepper_->multibody(body)->set_track_velocity_target(drive, side, velocity);
}

void World::set_root_twist(std::uint32_t body, const Twist& twist) { stepper_->multibody(body)->set_root_twist(twist); }
void World::set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                            std::span<const double> velocities) {
  stepper_->multibody(body)->set_joint_state(joint, coordinates, velocities);
  stepper_->place_solids(body);
}

void World::hash_body(std::uint32_t body, StateHash& hash) const { stepper_->hash_body(body, hash); }
void World::hash_contacts(StateHash& hash) const { stepper_->hash_contacts(hash); }
void World::save(SnapshotWriter& writer) const { stepper_->save(writer); }
void World::restore(SnapshotReader& reader) { stepper_->restore(reader); }

}  // namespace cohort::physics
