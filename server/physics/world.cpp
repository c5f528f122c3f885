#include "server/physics/world.hpp"

#include "server/physics/planar_engine.hpp"
#include "server/physics/stepper.hpp"

namespace cohort::physics {
namespace {

std::unique_ptr<Engine> make_engine(const description::World& description, WorkerPool& workers) {
  if (description.physics.fidelity == description::Fidelity::planar)
    return std::make_unique<PlanarEngine>(description, workers);
  return std::make_unique<Stepper>(description, workers);
}

}  // namespace

World::World(const description::World& description, WorkerPool& workers) : engine_(make_engine(description, workers)) {}
World::~World() = default;

void World::step() { engine_->step(); }
std::span<const Quarantine> World::quarantined() const { return engine_->quarantined(); }
bool World::is_active(std::uint32_t body) const { return engine_->is_active(body); }
std::uint32_t World::add_body(std::size_t model, const Pose& X_WM) { return engine_->add_body(model, X_WM); }
void World::remove_body(std::uint32_t body) { engine_->remove_body(body); }
void World::put_back_body(std::uint32_t body) { engine_->put_back_body(body); }
void World::place_body(std::uint32_t body, const Pose& X_WM) { engine_->place_body(body, X_WM); }
void World::push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) {
  engine_->push_body(body, link, wrench);
}
const geometry::Scene& World::scene() const { return engine_->scene(); }
std::size_t World::body_count() const { return engine_->body_count(); }
std::size_t World::model_of(std::uint32_t body) const { return engine_->model_of(body); }
std::span<const Contact> World::contacts() const { return engine_->contacts(); }

Pose World::link_pose(std::uint32_t body, std::size_t link) const { return engine_->link_pose(body, link); }
Twist World::link_twist(std::uint32_t body, std::size_t link) const { return engine_->link_twist(body, link); }

std::uint32_t World::connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                             std::size_t link_b, const ConnectionLimits& limits) {
  return engine_->connect(body_a, link_a, X_LP, body_b, link_b, limits);
}
void World::disconnect(std::uint32_t connection) { engine_->disconnect(connection); }
bool World::is_connected(std::uint32_t connection) const { return engine_->is_connected(connection); }
void World::set_connection_give(std::uint32_t connection, const ConnectionGive& give) {
  engine_->set_connection_give(connection, give);
}
Wrench World::connection_wrench(std::uint32_t connection) const { return engine_->connection_wrench(connection); }
Wrench World::connection_reaction(std::uint32_t connection) const { return engine_->connection_reaction(connection); }
std::span<const std::uint32_t> World::broken_connections() const { return engine_->broken_connections(); }

double World::joint_position(std::uint32_t body, std::size_t joint) const {
  return engine_->joint_position(body, joint);
}
double World::joint_velocity(std::uint32_t body, std::size_t joint) const {
  return engine_->joint_velocity(body, joint);
}
void World::record(std::uint32_t body) { engine_->record(body); }
Wrench World::joint_wrench(std::uint32_t body, std::size_t joint) const { return engine_->joint_wrench(body, joint); }
Eigen::Vector3d World::link_acceleration(std::uint32_t body, std::size_t link, const Eigen::Vector3d& p_LP) const {
  return engine_->link_acceleration(body, link, p_LP);
}
double World::joint_effort(std::uint32_t body, std::size_t joint) const { return engine_->joint_effort(body, joint); }
TrackState World::track(std::uint32_t body, std::size_t drive, Side side) const {
  return engine_->track(body, drive, side);
}
void World::set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) {
  engine_->set_joint_velocity_target(body, joint, velocity);
}
void World::set_joint_position_target(std::uint32_t body, std::size_t joint, double position) {
  engine_->set_joint_position_target(body, joint, position);
}
void World::set_joint_effort_target(std::uint32_t body, std::size_t joint, double effort) {
  engine_->set_joint_effort_target(body, joint, effort);
}
void World::set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) {
  engine_->set_track_velocity_target(body, drive, side, velocity);
}

void World::set_root_twist(std::uint32_t body, const Twist& twist) { engine_->set_root_twist(body, twist); }
void World::set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                            std::span<const double> velocities) {
  engine_->set_joint_state(body, joint, coordinates, velocities);
}

void World::hash_body(std::uint32_t body, StateHash& hash) const { engine_->hash_body(body, hash); }
void World::hash_contacts(StateHash& hash) const { engine_->hash_contacts(hash); }
void World::save(SnapshotWriter& writer) const { engine_->save(writer); }
void World::restore(SnapshotReader& reader) { engine_->restore(reader); }

}  // namespace cohort::physics
