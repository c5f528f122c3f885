#include <Eigen/Eigenvalues>
#include <cmath>
#include <sdf/Box.hh>
#include <sdf/Collision.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Geometry.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>

#include "server/description/read_model.hpp"

namespace cohort::description {
namespace {

constexpr const char* geometries = "box, sphere, cylinder or plane";

// Here and below, NaN passes: check_numbers has reported it.
Inertial read_inertial(const sdf::Link& link, const SdfReport& report) {
  const sdf::ElementPtr element = link.Element();
  const sdf::ElementPtr mass = find(element, {"inertial", "mass"});
  const sdf::ElementPtr inertia = find(element, {"inertial", "inertia"});
  if (!mass) report.warning(element, "has no mass; SDF's default acts, 1 kg");
  if (!inertia) report.warning(element, "has no inertia; SDF's default acts, 1 kg m^2 about each axis");

  Inertial inertial;
  inertial.X_LI = to_pose(link.Inertial().Pose());
  if (mass) inertial.mass = mass->Get<double>();
  if (inertial.mass <= 0.0 || std::isinf(inertial.mass))
    report.problem(mass, "expected a mass > 0 kg, not " + mass->GetValue()->GetAsString());
  if (!inertia) return inertial;

  const auto component = [&](const char* name) { return inertia->Get<double>(name); };
  const double xx = component("ixx"), yy = component("iyy"), zz = component("izz");
  const double xy = component("ixy"), xz = component("ixz"), yz = component("iyz");
  inertial.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (!inertial.inertia.allFinite()) {
    if (!inertial.inertia.hasNaN()) report.problem(inertia, "expected finite moments of inertia");
    return inertial;
  }
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertial.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  // Solids made of mass somewhere obey the triangle inequality, thin ones with equality.
  constexpr double rounding = 1e-6;
  if (!(moments[0] > 0.0))
    report.problem(inertia, "the matrix is not positive definite");
  else if (moments[2] > (moments[0] + moments[1]) * (1.0 + rounding))
    report.problem(inertia, "no body is like this: one principal moment exceeds the sum of the other two");
  return inertial;
}

void check_size(const sdf::ElementPtr& geometry, std::initializer_list<const char*> path, double least,
                const SdfReport& report) {
  const sdf::ElementPtr element = find(geometry, path);
  if (least <= 0.0 || std::isinf(least)) report.problem(element ? element : geometry, "expected a size > 0 m");
}

std::optional<Shape> read_shape(const sdf::Geometry& geometry, const ModelReading& reading) {
  const sdf::ElementPtr element = geometry.Element();
  const SdfReport& report = reading.report;
  if (const sdf::Box* const box = geometry.BoxShape()) {
    const Eigen::Vector3d size = to_eigen(box->Size());
    check_size(element, {"box", "size"}, size.minCoeff(), report);
    return Box{size};
  }
  if (const sdf::Sphere* const sphere = geometry.SphereShape()) {
    check_size(element, {"sphere", "radius"}, sphere->Radius(), report);
    return Sphere{sphere->Radius()};
  }
  if (const sdf::Cylinder* const cylinder = geometry.CylinderShape()) {
    check_size(element, {"cylinder", "radius"}, cylinder->Radius(), report);
    check_size(element, {"cylinder", "length"}, cylinder->Length(), report);
    return Cylinder{cylinder->Radius(), cylinder->Length()};
  }
  if (const sdf::Plane* const plane = geometry.PlaneShape()) {
    const Eigen::Vector3d normal = to_eigen(plane->Normal());
    if (!reading.is_static) report.problem(element, "a plane needs <static>true</static> in its model");
    if (normal.isZero()) report.problem(element, "expected a normal that is not zero");
    return Plane{normal.normalized()};
  }
  const sdf::ElementPtr kind = element->GetFirstElement();
  report.problem(element, (kind ? "<" + kind->GetName() + "> is not supported; expected " : "expected ") +
                              std::string(geometries));
  return std::nullopt;
}

double read_coefficient(const sdf::ElementPtr& element, double by_default, double greatest, const char* expected,
                        const SdfReport& report) {
  if (!element) return by_default;
  const auto value = element->Get<double>();
  if (value < 0.0 || value > greatest) report.problem(element, expected);
  return value;
}

Surface read_surface(const sdf::ElementPtr& collision, const SdfReport& report) {
  const Surface by_default;
  const double most = std::numeric_limits<double>::max();
  return {read_coefficient(find(collision, {"surface", "friction", "ode", "mu"}), by_default.friction, most,
                           "expected a coefficient >= 0", report),
          read_coefficient(find(collision, {"surface", "bounce", "restitution_coefficient"}), by_default.restitution,
                           1.0, "expected a coefficient from 0 to 1", report)};
}

}  // namespace

Link read_link(const sdf::Link& sdf_link, const ModelReading& reading) {
  Link link;
  link.name = sdf_link.Name();
  link.X_ML = resolved_pose(sdf_link, reading);
  if (!reading.is_static) link.inertial = read_inertial(sdf_link, reading.report);
  for (std::uint64_t i = 0; i < sdf_link.CollisionCount(); ++i) {
    const sdf::Collision& sdf_collision = *sdf_link.CollisionByIndex(i);
    const std::optional<Shape> shape = read_shape(*sdf_collision.Geom(), reading);
    if (!shape) continue;
    link.collisions.push_back({sdf_collision.Name(), resolved_pose(sdf_collision, reading), *shape,
                               read_surface(sdf_collision.Element(), reading.report)});
  }
  return link;
}

}  // namespace cohort::description
