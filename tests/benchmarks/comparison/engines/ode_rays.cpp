// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>

#include "tests/benchmarks/comparison/engines/ode_start.hpp"
#include "tests/benchmarks/comparison/engines/sensing_run.hpp"

namespace cohort::bench {
namespace {

// Sensors measured with rays of ODE. Each robot has a space for its solids and one for its rays, whose boxes are tested
// first. Rays are placed again in each frame, as moving robots require.
class OdeRays : public SensingRun {
 public:
  // `first_hit`: stop at any hit instead of searching for the nearest.
  OdeRays(const SensingScene& scene, bool first_hit)
      : scene_(scene), first_hit_(first_hit), solids_(dHashSpaceCreate(nullptr)) {
    dSpaceSetSublevel(solids_, 1);  // each space of rays counts as one geom
    dCreatePlane(solids_, 0.0, 0.0, 1.0, 0.0);
    for (const Wall& wall : scene.scene.walls())
      place(dCreateBox(solids_, wall.size.x(), wall.size.y(), wall.size.z()), {wall.centre.x(), wall.centre.y(), 0.0},
            wall.centre.z());
    const double z = 0.5 * scene.obstacle_height;
    for (const Placement& at : scene.boxes)
      place(dCreateBox(solids_, scene.box_size, scene.box_size, scene.obstacle_height), at, z);
    for (const Placement& at : scene.pillars)
      place(dCreateCylinder(solids_, scene.pillar_radius, scene.obstacle_height), at, z);
    for (const Placement& at : scene.scene.robots) add_robot(at);
  }
  ~OdeRays() override {
    for (const Rays& rays : rays_) dSpaceDestroy(rays.space);
    dSpaceDestroy(solids_);
  }

  void sense() override {
    for (Rays& rays : rays_) {
      const double c = std::cos(rays.at.yaw), s = std::sin(rays.at.yaw);
      for (Ray& ray : rays.rays) {
        const Eigen::Vector3d &p = ray.origin_R, &d = ray.direction_R;
        dGeomRaySet(ray.geom, rays.at.x + c * p.x() - s * p.y(), rays.at.y + s * p.x() + c * p.y(), p.z(),
                    c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
        ray.depth = ray.length;
      }
      dSpaceCollide2(reinterpret_cast<dGeomID>(rays.space), reinterpret_cast<dGeomID>(solids_), &rays, near_callback);
    }
  }

 protected:
  struct Ray {
    dGeomID geom = nullptr;
    Eigen::Vector3d origin_R;  // in the axes of the robot, relative to its position on the ground
    Eigen::Vector3d direction_R;
    double depth = 0.0;  // depth of the nearest hit; the ray's length if there is none
    double length = 0.0;
  };
  struct Rays {
    Placement at;
    dSpaceID space = nullptr;
    dSpaceID own = nullptr;  // space of the robot's own solids, which its rays ignore
    bool first_hit = false;
    std::deque<Ray> rays;  // geoms keep pointers to them
  };

  void add_ray(Rays& of, const Eigen::Vector3d& origin_R, const Eigen::Vector3d& direction_R, double length) {
    Ray& ray = of.rays.emplace_back();
    ray.geom = dCreateRay(of.space, length);
    ray.origin_R = origin_R;
    ray.direction_R = direction_R;
    ray.length = ray.depth = length;
    dGeomSetData(ray.geom, &ray);
  }

  const std::deque<Rays>& rays() const { return rays_; }
  std::deque<Rays>& rays() { return rays_; }
  const SensingScene& scene() const { return scene_; }

 private:
  static void place(dGeomID geom, const Placement& at, double z) {
    dGeomSetPosition(geom, at.x, at.y, z);
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0.0, 0.0, 1.0, at.yaw);
    dGeomSetRotation(geom, rotation);
  }

  void add_robot(const Placement& at) {
    const Robot& robot = scene_.scene.robot;
    Rays& rays = rays_.emplace_back();
    rays.at = at;
    rays.first_hit = first_hit_;
    rays.own = dSimpleSpaceCreate(solids_);
    place(dCreateCylinder(rays.own, robot.hull_radius, robot.hull_height), at, robot.hull_z);
    place(dCreateCylinder(rays.own, robot.turret.radius, robot.turret.height), at, robot.turret.z);
    rays.space = dSimpleSpaceCreate(nullptr);
  }

  // Handles a pair of spaces, or a ray and a solid in either order.
  static void near_callback(void* data, dGeomID a, dGeomID b) {
    auto& rays = *static_cast<Rays*>(data);
    if (a == reinterpret_cast<dGeomID>(rays.own) || b == reinterpret_cast<dGeomID>(rays.own)) return;
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
      dSpaceCollide2(a, b, data, near_callback);
      return;
    }
    const bool is_first = dGeomGetClass(a) == dRayClass;
    auto& ray = *static_cast<Ray*>(dGeomGetData(is_first ? a : b));
    if (rays.first_hit && ray.depth < ray.length) return;
    dContactGeom contact;
    if (dCollide(a, b, 1, &contact, sizeof contact) == 0) return;
    ray.depth = std::min(ray.depth, contact.depth);
  }

  SensingScene scene_;
  bool first_hit_;
  dSpaceID solids_;
  std::deque<Rays> rays_;
};

class OdeProximity final : public OdeRays {
 public:
  explicit OdeProximity(const SensingScene& scene) : OdeRays(scene, false) {
    const ProximityLayout& layout = scene.proximity;
    for (std::size_t robot = 0; robot < scene.scene.robots.size(); ++robot) {
      for (std::size_t i = 0; i < layout.sensors; ++i) {
        const double bearing = layout.first_bearing + static_cast<double>(i) * layout.spacing;
        const Eigen::Vector3d direction_R(std::cos(bearing), std::sin(bearing), 0.0);
        add_ray(rays()[robot], Eigen::Vector3d(0.0, 0.0, layout.height) + layout.radius * direction_R, direction_R,
                layout.range);
      }
    }
  }

  std::optional<double> answer() const override {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Rays& of : rays())
      for (const Ray& ray : of.rays) {
        sum += 1.0 - ray.depth / ray.length;
        ++count;
      }
    return sum / static_cast<double>(count);
  }
};

class OdeVisibility final : public OdeRays {
 public:
  explicit OdeVisibility(const SensingScene& scene) : OdeRays(scene, true) {
    for (std::size_t robot = 0; robot < scene.scene.robots.size(); ++robot) {
      const Placement& at = scene.scene.robots[robot];
      const Eigen::Vector3d eye_R(0.0, 0.0, scene.light_height);
      const Eigen::Quaterniond R_RW(Eigen::AngleAxisd(-at.yaw, Eigen::Vector3d::UnitZ()));
      for (const Eigen::Vector3d& source_W : scene.sources) {
        const Eigen::Vector3d way_R = R_RW * (source_W - Eigen::Vector3d(at.x, at.y, 0.0)) - eye_R;
        add_ray(rays()[robot], eye_R, way_R.normalized(), way_R.norm());
      }
    }
  }

  std::optional<double> answer() const override {
    std::size_t seen = 0;
    std::size_t count = 0;
    for (const Rays& of : rays())
      for (const Ray& ray : of.rays) {
        seen += ray.depth == ray.length ? 1 : 0;
        ++count;
      }
    return static_cast<double>(seen) / static_cast<double>(count);
  }
};

}  // namespace

std::unique_ptr<SensingRun> make_ode_proximity(const SensingScene& scene) {
  start_ode();
  return std::make_unique<OdeProximity>(scene);
}

std::unique_ptr<SensingRun> make_ode_visibility(const SensingScene& scene) {
  start_ode();
  return std::make_unique<OdeVisibility>(scene);
}

}  // namespace cohort::bench
