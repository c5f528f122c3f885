// SPDX-License-Identifier: Apache-2.0
#include "tools/common/drawing/run_trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "server/core/infinity.hpp"
#include "server/geometry/shapes/footprint.hpp"

namespace cohort::tool {
namespace {

using geometry::Scene;
using geometry::Solid;

constexpr std::uint32_t none = 0xffffffffu;
constexpr double floor_tolerance = 1e-3;  // [m]; robots sink in a little

// Returns how far a shape extends from `centre_V` in the view.
struct Reach {
  const Pose& X_VC;
  Eigen::Vector2d centre_V;

  double operator()(const description::Box& box) const {
    double reach = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      reach = std::max(reach, ((X_VC * sign.cwiseProduct(box.size).eval()).head<2>() - centre_V).norm());
    }
    return reach;
  }
  double operator()(const description::Sphere& sphere) const {
    return (X_VC.position.head<2>() - centre_V).norm() + sphere.radius;
  }
  double operator()(const description::Cylinder& cylinder) const {  // exact if upright, else an upper bound
    const Eigen::Vector3d half_axis_V = X_VC.orientation * Eigen::Vector3d(0.0, 0.0, cylinder.length / 2.0);
    return (X_VC.position.head<2>() - centre_V).norm() + cylinder.radius + half_axis_V.head<2>().norm();
  }
  double operator()(const description::Mesh& mesh) const {
    double reach = 0.0;
    for (const Eigen::Vector3d& vertex : mesh.triangles->vertices)
      reach = std::max(reach, ((X_VC * vertex).head<2>() - centre_V).norm());
    return reach;
  }
  double operator()(const description::Capsule& capsule) const { return around_footprint(capsule); }
  double operator()(const description::Ellipsoid& ellipsoid) const { return around_footprint(ellipsoid); }
  double operator()(const description::Plane&) const { return 0.0; }
  double operator()(const description::Heightmap&) const { return 0.0; }

  double around_footprint(const geometry::Shape& shape) const {  // an upper bound
    const auto footprint = geometry::footprint_of(shape, X_VC);
    return (footprint->centre - centre_V).norm() + footprint->half.norm() + footprint->radius;
  }
};

}  // namespace

TraceRecorder::TraceRecorder(const description::World& world, const Simulation& simulation, Viewpoint viewpoint)
    : world_(world),
      simulation_(simulation),
      R_VW_(viewpoint == Viewpoint::above
                ? Eigen::Quaterniond::Identity()
                : Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()))),
      sample_ticks_(static_cast<std::uint64_t>(
          std::max<std::int64_t>(1, std::chrono::nanoseconds(sample_interval) / world.step))),
      next_sample_(simulation.tick()),
      robot_of_body_(world.instances.size(), none),
      is_floor_(world.instances.size(), 1) {
  trace_.viewpoint = viewpoint;
  trace_.robots.resize(world.robots.size());
  for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
    robot_of_body_[world.robots[robot]] = robot;
    trace_.robots[robot].name = simulation.robot_name(robot);
  }

  for (const description::Team& team : simulation.experiment().teams) {
    for (const std::uint32_t robot : team.robots)
      if (robot < trace_.robots.size()) trace_.robots[robot].team = static_cast<std::uint32_t>(trace_.teams.size());
    trace_.teams.push_back(team.name);
  }

  const Scene& scene = simulation.world().scene();
  // Without robots, no solid is a floor.
  double lowest_robot = world.robots.empty() ? -infinity : infinity;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    const std::uint32_t robot = robot_of(solid.body);
    if (robot == none) continue;
    lowest_robot = std::min(lowest_robot, scene.bounds(i).lower.z());
    double& radius = trace_.robots[robot].radius;
    const Eigen::Vector2d centre_V = seen(simulation.robot_pose(robot).position);
    radius = std::max(radius, std::visit(Reach{pose_seen(solid.X_WC), centre_V}, solid.shape()));
  }
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    const bool below = !solid.moves && scene.bounds(i).upper.z() <= lowest_robot + floor_tolerance;
    if (!geometry::is_ground(solid.shape()) && !below) is_floor_[solid.body.value] = 0;
  }
  sample();
  if (viewpoint == Viewpoint::side) note_robots(&RobotTrace::at_start);
}

// Objects that were added during the run are neither robots nor floors.
std::uint32_t TraceRecorder::robot_of(BodyId body) const {
  return body.value < robot_of_body_.size() ? robot_of_body_[body.value] : none;
}

bool TraceRecorder::is_floor(BodyId body) const { return body.value < is_floor_.size() && is_floor_[body.value] != 0; }

void TraceRecorder::boundary() {
  if (simulation_.tick() >= next_sample_) sample();
  note_contacts();
}

void TraceRecorder::sample() {
  next_sample_ = simulation_.tick() + sample_ticks_;
  for (std::uint32_t robot = 0; robot < trace_.robots.size(); ++robot) {
    if (!simulation_.is_present(robot)) continue;
    const Pose X_WL = simulation_.robot_pose(robot);
    const Eigen::Vector3d forward_V = R_VW_ * (X_WL.orientation * Eigen::Vector3d::UnitX());
    if (!X_WL.position.allFinite() || !forward_V.allFinite()) continue;
    RobotTrace& trace = trace_.robots[robot];
    trace.path_V.push_back(seen(X_WL.position));
    trace.end_heading = std::atan2(forward_V.y(), forward_V.x());
  }
}

void TraceRecorder::note_contacts() {
  for (const physics::Contact& contact : simulation_.world().contacts()) {
    // A contact of two robots is marked once, for the first robot.
    std::uint32_t robot = robot_of(contact.body_a);
    std::uint32_t other = robot_of(contact.body_b);
    if (robot == none && other == none) continue;
    const bool of_robots = robot != none && other != none;
    if (!of_robots && is_floor(robot == none ? contact.body_a : contact.body_b)) continue;
    robot = std::min(robot, other);
    const Eigen::Vector2d position_V = seen(contact.position_W);
    if (!position_V.allFinite()) continue;
    const ContactMark::Kind kind = of_robots ? ContactMark::Kind::robot : ContactMark::Kind::obstacle;
    const Eigen::Vector2d cell = (position_V / contact_spacing).array().floor();
    if (touched_.insert({robot, kind, std::llround(cell.x()), std::llround(cell.y())}).second)
      trace_.contacts.push_back({kind, position_V});
  }
}

// Tracks have no collisions: their ground contact is drawn as a box up to the height of a wheel's centre.
void TraceRecorder::note_robots(std::vector<TracedSolid> RobotTrace::*solids) {
  using Kind = TracedSolid::Kind;
  const auto add = [&](std::uint32_t robot, const geometry::Shape& shape, const Pose& X_WC) {
    if (!X_WC.position.allFinite()) return;
    (trace_.robots[robot].*solids).push_back({Kind::robot, shape, pose_seen(X_WC)});
  };
  for (std::uint32_t robot = 0; robot < trace_.robots.size(); ++robot) {
    if (!simulation_.is_present(robot)) continue;
    for (const description::Device& device : world_.robot_model(robot).devices) {
      const auto* const drive = std::get_if<description::TreelDrive>(&device);
      if (drive == nullptr) continue;
      const description::Box tracks{{2.0 * drive->half_contact_length, 2.0 * drive->half_gauge, drive->wheel_radius}};
      Pose X_LT;
      X_LT.position.z() = drive->ground_height + 0.5 * drive->wheel_radius;
      const auto body = static_cast<std::uint32_t>(world_.robots[robot]);
      add(robot, tracks, simulation_.world().link_pose(BodyId{body}, LinkId{drive->link}) * X_LT);
    }
  }
  const Scene& scene = simulation_.world().scene();
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    const std::uint32_t robot = robot_of(solid.body);
    if (robot != none && simulation_.is_present(robot)) add(robot, solid.shape(), solid.X_WC);
  }
}

RunTrace TraceRecorder::finish() {
  sample();
  if (trace_.viewpoint == Viewpoint::side) note_robots(&RobotTrace::at_end);
  const Scene& scene = simulation_.world().scene();
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    if (!simulation_.objects().is_present(solid.body.value)) continue;
    const bool of_robot = robot_of(solid.body) != none;
    if (!of_robot && !geometry::is_ground(solid.shape()) && scene.bounds(i).lower.allFinite() &&
        scene.bounds(i).upper.allFinite())
      order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return trace_.viewpoint == Viewpoint::above ? scene.bounds(a).upper.z() < scene.bounds(b).upper.z()
                                                : scene.bounds(a).lower.y() > scene.bounds(b).lower.y();
  });
  for (const std::uint32_t i : order) {
    const Solid& solid = scene.solid(i);
    using Kind = TracedSolid::Kind;
    const Kind kind = solid.moves ? Kind::object : is_floor(solid.body) ? Kind::floor : Kind::obstacle;
    trace_.solids.push_back({kind, solid.shape(), pose_seen(solid.X_WC)});
  }
  for (const emission::Lamp& lamp : simulation_.emitters().lamps()) {
    const bool of_robot = robot_of(lamp.mount.body) != none;
    if (of_robot || lamp.light.kind == description::Light::Kind::directional) continue;
    // A lamp that was never in the world has no position in the emitters.
    const Pose X_WE = simulation_.world().link_pose(lamp.mount.body, lamp.mount.link) * lamp.mount.X_LE;
    if (!X_WE.position.allFinite()) continue;
    trace_.lamps.push_back({seen(X_WE.position), lamp.is_on && simulation_.emitters().is_in_world(lamp.mount)});
  }
  return std::move(trace_);
}

}  // namespace cohort::tool
