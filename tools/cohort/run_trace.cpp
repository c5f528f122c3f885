#include "tools/cohort/run_trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "server/description/footprint.hpp"

namespace cohort::tool {
namespace {

using geometry::Scene;
using geometry::Solid;

constexpr std::uint32_t none = 0xffffffffu;
constexpr double floor_tolerance = 1e-3;  // [m]; robots sink in a little

// How far the shape reaches from `centre_W`, seen from above.
struct Reach {
  const Pose& X_WC;
  Eigen::Vector2d centre_W;

  double operator()(const description::Box& box) const {
    double reach = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      reach = std::max(reach, ((X_WC * sign.cwiseProduct(box.size).eval()).head<2>() - centre_W).norm());
    }
    return reach;
  }
  double operator()(const description::Sphere& sphere) const {
    return (X_WC.position.head<2>() - centre_W).norm() + sphere.radius;
  }
  double operator()(const description::Cylinder& cylinder) const {  // exact if upright, else an upper bound
    const Eigen::Vector3d half_axis_W = X_WC.orientation * Eigen::Vector3d(0.0, 0.0, cylinder.length / 2.0);
    return (X_WC.position.head<2>() - centre_W).norm() + cylinder.radius + half_axis_W.head<2>().norm();
  }
  double operator()(const description::Mesh& mesh) const {
    double reach = 0.0;
    for (const Eigen::Vector3d& vertex : mesh.triangles->vertices)
      reach = std::max(reach, ((X_WC * vertex).head<2>() - centre_W).norm());
    return reach;
  }
  double operator()(const description::Capsule& capsule) const { return around_footprint(capsule); }
  double operator()(const description::Ellipsoid& ellipsoid) const { return around_footprint(ellipsoid); }
  double operator()(const description::Plane&) const { return 0.0; }
  double operator()(const description::Heightmap&) const { return 0.0; }

  double around_footprint(const geometry::Shape& shape) const {  // an upper bound
    const auto footprint = description::footprint_of(shape, X_WC);
    return (footprint->centre - centre_W).norm() + footprint->half.norm() + footprint->radius;
  }
};

}  // namespace

TraceRecorder::TraceRecorder(const description::World& world, const Simulation& simulation)
    : world_(world),
      simulation_(simulation),
      sample_ticks_(static_cast<std::uint64_t>(
          std::max<std::int64_t>(1, std::chrono::nanoseconds(sample_interval) / world.step))),
      next_sample_(simulation.tick()),
      robot_of_body_(world.instances.size(), none),
      is_floor_(world.instances.size(), 1) {
  trace_.robots.resize(world.robots.size());
  for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) {
    robot_of_body_[world.robots[robot]] = robot;
    trace_.robots[robot].name = simulation.robot_name(robot);
  }

  const Scene& scene = simulation.world().scene();
  // Without robots nothing is a floor.
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double lowest_robot = world.robots.empty() ? -infinity : infinity;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    const std::uint32_t robot = robot_of_body_[solid.body];
    if (robot == none) continue;
    lowest_robot = std::min(lowest_robot, scene.bounds(i).lower.z());
    double& radius = trace_.robots[robot].radius;
    const Eigen::Vector2d centre_W = simulation.robot_pose(robot).position.head<2>();
    radius = std::max(radius, std::visit(Reach{solid.X_WC, centre_W}, solid.shape));
  }
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    const bool below = !solid.moves && scene.bounds(i).upper.z() <= lowest_robot + floor_tolerance;
    if (!geometry::is_ground(solid.shape) && !below) is_floor_[solid.body] = 0;
  }
  sample();
}

void TraceRecorder::boundary() {
  if (simulation_.tick() >= next_sample_) sample();
  note_contacts();
}

void TraceRecorder::sample() {
  next_sample_ = simulation_.tick() + sample_ticks_;
  for (std::uint32_t robot = 0; robot < trace_.robots.size(); ++robot) {
    if (!simulation_.is_present(robot)) continue;
    const Pose X_WL = simulation_.robot_pose(robot);
    const Eigen::Vector3d forward_W = X_WL.orientation * Eigen::Vector3d::UnitX();
    if (!X_WL.position.allFinite() || !forward_W.allFinite()) continue;
    RobotTrace& trace = trace_.robots[robot];
    trace.path_W.push_back(X_WL.position.head<2>());
    trace.end_heading = std::atan2(forward_W.y(), forward_W.x());
  }
}

void TraceRecorder::note_contacts() {
  for (const physics::Contact& contact : simulation_.world().contacts()) {
    // A contact of two robots is marked once, as the first one's.
    std::uint32_t robot = robot_of_body_[contact.body_a];
    std::uint32_t other = robot_of_body_[contact.body_b];
    if (robot == none && other == none) continue;
    const bool of_robots = robot != none && other != none;
    if (!of_robots && is_floor_[robot == none ? contact.body_a : contact.body_b]) continue;
    robot = std::min(robot, other);
    const Eigen::Vector2d position_W = contact.position_W.head<2>();
    if (!position_W.allFinite()) continue;
    const ContactMark::Kind kind = of_robots ? ContactMark::Kind::robot : ContactMark::Kind::obstacle;
    const Eigen::Vector2d cell = (position_W / contact_spacing).array().floor();
    if (touched_.insert({robot, kind, std::llround(cell.x()), std::llround(cell.y())}).second)
      trace_.contacts.push_back({kind, position_W});
  }
}

RunTrace TraceRecorder::finish() {
  sample();
  const Scene& scene = simulation_.world().scene();
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Solid& solid = scene.solid(i);
    if (!simulation_.objects().is_present(solid.body)) continue;
    const bool of_robot = robot_of_body_[solid.body] != none;
    if (!of_robot && !geometry::is_ground(solid.shape) && scene.bounds(i).lower.allFinite() &&
        scene.bounds(i).upper.allFinite())
      order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return scene.bounds(a).upper.z() < scene.bounds(b).upper.z();
  });
  for (const std::uint32_t i : order) {
    const Solid& solid = scene.solid(i);
    using Kind = TracedSolid::Kind;
    const Kind kind = solid.moves ? Kind::object : is_floor_[solid.body] ? Kind::floor : Kind::obstacle;
    trace_.solids.push_back({kind, solid.shape, solid.X_WC});
  }
  for (const emission::Lamp& lamp : simulation_.emitters().lamps()) {
    const bool of_robot = lamp.mount.body < robot_of_body_.size() && robot_of_body_[lamp.mount.body] != none;
    if (of_robot || lamp.light.kind == description::Light::Kind::directional) continue;
    // Also of one that was never in the world, which the emitters know no place of.
    const Pose X_WE = simulation_.world().link_pose(lamp.mount.body, lamp.mount.link) * lamp.mount.X_LE;
    if (!X_WE.position.allFinite()) continue;
    trace_.lamps.push_back({X_WE.position.head<2>(), lamp.is_on && simulation_.emitters().is_in_world(lamp.mount)});
  }
  return std::move(trace_);
}

}  // namespace cohort::tool
