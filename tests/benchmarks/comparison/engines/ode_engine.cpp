// SPDX-License-Identifier: Apache-2.0
#include <ode/ode.h>

#include <array>
#include <cmath>
#include <deque>

#include "tests/benchmarks/comparison/engines/engines.hpp"
#include "tests/benchmarks/comparison/engines/ode_start.hpp"

namespace cohort::bench {
namespace {

constexpr double error_reduction = 0.2;
constexpr double constraint_force_mixing = 1e-5;
constexpr int quick_step_iterations = 20;
constexpr int most_points = 4;  // contact points of a pair of shapes
// Cells of the hash space are 2^-4 m to 2^2 m wide.
constexpr int smallest_cell = -4;
constexpr int largest_cell = 2;

// Collision bits: a pair collides if one names the other. Wheels and casters collide with the ground only.
constexpr unsigned long nothing = 0;
constexpr unsigned long ground_bit = 1;
constexpr unsigned long wall_bit = 2;
constexpr unsigned long shell_bit = 4;
constexpr unsigned long wheel_bit = 8;

class OdeEngine final : public Engine {
 public:
  OdeEngine(const Scene& scene, OdeStepper stepper)
      : scene_(scene),
        stepper_(stepper),
        world_(dWorldCreate()),
        space_(dHashSpaceCreate(nullptr)),
        contact_joints_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, 0.0, 0.0, -scene.gravity);
    dWorldSetERP(world_, error_reduction);
    dWorldSetCFM(world_, constraint_force_mixing);
    dWorldSetQuickStepNumIterations(world_, quick_step_iterations);
    dHashSpaceSetLevels(space_, smallest_cell, largest_cell);

    set_surface(dCreatePlane(space_, 0.0, 0.0, 1.0, 0.0), scene.ground_friction, ground_bit, nothing, Touch::wall);
    for (const Wall& wall : scene.walls()) add_wall(wall);
    for (const Placement& placement : scene.robots) add_robot(placement);
  }

  ~OdeEngine() override {
    dJointGroupDestroy(contact_joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void set_command(std::uint32_t robot, const Command& command) override {
    const Body& body = robots_[robot];
    dJointSetHingeParam(body.left_wheel, dParamVel, command.left / scene_.robot.wheel_radius);
    dJointSetHingeParam(body.right_wheel, dParamVel, command.right / scene_.robot.wheel_radius);
    dJointSetHingeParam(body.turret, dParamVel, command.turret);
  }

  void step() override {
    touches_.clear();
    dJointGroupEmpty(contact_joints_);
    dSpaceCollide(space_, this, near_callback);
    if (stepper_ == OdeStepper::quick_step)
      dWorldQuickStep(world_, scene_.step);
    else
      dWorldStep(world_, scene_.step);
  }

  Eigen::Vector3d turret_centre(std::uint32_t robot) const override {
    const dReal* position = dBodyGetPosition(robots_[robot].turret_body);
    return {position[0], position[1], position[2]};
  }

  std::vector<Touch> touches() const override { return touches_; }

 private:
  struct Body {
    dBodyID chassis;
    dJointID left_wheel;
    dJointID right_wheel;
    dJointID turret;
    dBodyID turret_body;
  };
  struct Surface {
    double friction;
    std::uint32_t robot;
  };

  void set_surface(dGeomID geom, double friction, unsigned long is, unsigned long touches, std::uint32_t robot) {
    dGeomSetCategoryBits(geom, is);
    dGeomSetCollideBits(geom, touches);
    surfaces_.push_back({friction, robot});
    dGeomSetData(geom, &surfaces_.back());
  }

  void add_wall(const Wall& wall) {
    dGeomID geom = dCreateBox(space_, wall.size.x(), wall.size.y(), wall.size.z());
    dGeomSetPosition(geom, wall.centre.x(), wall.centre.y(), wall.centre.z());
    set_surface(geom, scene_.robot.friction, wall_bit, shell_bit, Touch::wall);
  }

  // `z` is the height of its centre of mass.
  dBodyID add_body(const Placement& at, double x, double y, double z) {
    dBodyID body = dBodyCreate(world_);
    dBodySetPosition(body, at.x + x * std::cos(at.yaw) - y * std::sin(at.yaw),
                     at.y + x * std::sin(at.yaw) + y * std::cos(at.yaw), z);
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0.0, 0.0, 1.0, at.yaw);
    dBodySetRotation(body, rotation);
    return body;
  }

  static void set_mass(dBodyID body, const CylinderBody& cylinder) {
    dMass mass;
    dMassSetCylinderTotal(&mass, cylinder.mass, 3, cylinder.radius, cylinder.height);
    dBodySetMass(body, &mass);
  }

  void add_geom(dGeomID geom, dBodyID body, double x, double z, double friction, bool is_wheel) {
    dGeomSetBody(geom, body);
    if (x != 0.0 || z != 0.0) dGeomSetOffsetPosition(geom, x, 0.0, z);
    const auto robot = static_cast<std::uint32_t>(robots_.size());
    if (is_wheel)
      set_surface(geom, friction, wheel_bit, ground_bit, robot);
    else
      set_surface(geom, friction, shell_bit, ground_bit | wall_bit | shell_bit, robot);
  }

  dJointID add_hinge(dBodyID parent, dBodyID child, double height, const dReal* axis, double max_torque) {
    dJointID hinge = dJointCreateHinge(world_, nullptr);
    dJointAttach(hinge, child, parent);
    const dReal* position = dBodyGetPosition(child);
    dJointSetHingeAnchor(hinge, position[0], position[1], height);
    dJointSetHingeAxis(hinge, axis[0], axis[1], axis[2]);
    dJointSetHingeParam(hinge, dParamFMax, max_torque);
    dJointSetHingeParam(hinge, dParamVel, 0.0);
    return hinge;
  }

  dJointID add_wheel(dSpaceID space, dBodyID chassis, const Placement& at, double y) {
    const Robot& robot = scene_.robot;
    dBodyID wheel = add_body(at, 0.0, y, robot.wheel_radius);
    dMass mass;
    dMassSetSphereTotal(&mass, robot.wheel_mass, robot.wheel_radius);
    dBodySetMass(wheel, &mass);
    add_geom(dCreateSphere(space, robot.wheel_radius), wheel, 0.0, 0.0, robot.track_friction, true);
    const std::array<dReal, 3> axis = {-std::sin(at.yaw), std::cos(at.yaw), 0.0};
    return add_hinge(chassis, wheel, robot.wheel_radius, axis.data(), robot.max_torque);
  }

  // Each robot has its own space, so that its parts are not tested against each other.
  void add_robot(const Placement& at) {
    const Robot& robot = scene_.robot;
    dSpaceID space = dSimpleSpaceCreate(space_);
    Body body{};
    const CylinderBody chassis = robot.chassis_without_wheels();
    body.chassis = add_body(at, 0.0, 0.0, chassis.z);
    set_mass(body.chassis, chassis);
    add_geom(dCreateCylinder(space, robot.hull_radius, robot.hull_height), body.chassis, 0.0, robot.hull_z - chassis.z,
             robot.friction, false);
    for (const double x : {-robot.caster_x, robot.caster_x})
      add_geom(dCreateSphere(space, robot.caster_radius), body.chassis, x,
               robot.caster_radius + robot.caster_clearance - chassis.z, 0.0, true);
    body.left_wheel = add_wheel(space, body.chassis, at, robot.half_gauge);
    body.right_wheel = add_wheel(space, body.chassis, at, -robot.half_gauge);

    body.turret_body = add_body(at, 0.0, 0.0, robot.turret.z);
    set_mass(body.turret_body, robot.turret);
    add_geom(dCreateCylinder(space, robot.turret.radius, robot.turret.height), body.turret_body, 0.0, 0.0,
             robot.friction, false);
    const std::array<dReal, 3> up = {0.0, 0.0, 1.0};
    body.turret =
        add_hinge(body.chassis, body.turret_body, robot.turret_joint_height, up.data(), robot.max_turret_torque);
    if (scene_.connected && !robots_.empty()) {
      dJointID connection = dJointCreateFixed(world_, nullptr);
      dJointAttach(connection, body.turret_body, robots_.back().turret_body);
      dJointSetFixed(connection);
    }
    robots_.push_back(body);
  }

  static void near_callback(void* self, dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) || dGeomIsSpace(b))
      dSpaceCollide2(a, b, self, near_callback);
    else
      static_cast<OdeEngine*>(self)->collide(a, b);
  }

  void collide(dGeomID a, dGeomID b) {
    const int count = dCollide(a, b, most_points, &contacts_[0].geom, sizeof(dContact));
    if (count == 0) return;
    const auto& surface_a = *static_cast<const Surface*>(dGeomGetData(a));
    const auto& surface_b = *static_cast<const Surface*>(dGeomGetData(b));
    const bool on_ground = ((dGeomGetCategoryBits(a) | dGeomGetCategoryBits(b)) & ground_bit) != 0;
    for (int i = 0; i < count; ++i) {
      dContact& contact = contacts_[static_cast<std::size_t>(i)];
      contact.surface = {};
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = std::min(surface_a.friction, surface_b.friction);
      dJointAttach(dJointCreateContact(world_, contact_joints_, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }
    if (on_ground) return;
    const auto [robot, other] = std::minmax(surface_a.robot, surface_b.robot);  // a wall has the larger index
    touches_.push_back({robot, other});
  }

  Scene scene_;
  OdeStepper stepper_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contact_joints_;
  std::vector<Body> robots_;
  std::deque<Surface> surfaces_;                  // ODE keeps pointers to them
  std::array<dContact, most_points> contacts_{};  // contacts of the present pair
  std::vector<Touch> touches_;
};

}  // namespace

std::unique_ptr<Engine> make_ode_engine(const Scene& scene, OdeStepper stepper) {
  start_ode();
  return std::make_unique<OdeEngine>(scene, stepper);
}

}  // namespace cohort::bench
