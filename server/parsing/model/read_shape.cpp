#include <algorithm>
#include <cmath>
#include <memory>
#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Heightmap.hh>
#include <sdf/Mesh.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>
#include <stdexcept>
#include <utility>

#include "server/parsing/files/mesh_file.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/terrain.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* geometries = "box, sphere, cylinder, capsule, ellipsoid, mesh, plane or heightmap";

constexpr const char* left_out = "the collision is left out";

// Reports a collision that cannot be read. Without it, a moving model would pass through others, so this is an error
// for moving models, also in files from other sources.
void report_lost(const sdf::ElementPtr& element, const std::string& message, const ModelReading& reading) {
  if (reading.is_static)
    reading.report.flaw(element, message, left_out);
  else
    reading.report.problem(element, message);
}

// Returns false if the shape is omitted. NaN passes, since check_numbers has reported it.
bool check_size(const sdf::ElementPtr& geometry, std::initializer_list<const char*> path, double least,
                const SdfReport& report) {
  const sdf::ElementPtr element = find(geometry, path);
  const bool is_wrong = least <= 0.0 || std::isinf(least);
  return !is_wrong || !report.flaw(element ? element : geometry, "expected a size > 0 m", left_out);
}

std::optional<Shape> read_mesh_shape(const sdf::Mesh& mesh, const ModelReading& reading) {
  const sdf::ElementPtr element = mesh.Element();
  const Eigen::Vector3d scale = to_eigen(mesh.Scale());
  if ((scale.array() == 0.0).any()) {
    reading.report.flaw(find(element, {"scale"}), "expected a scale that is not zero", left_out);
    return std::nullopt;
  }
  const bool convex = !reading.is_static;
  const sdf::ElementPtr uri = find(element, {"uri"});
  if (!uri || !scale.allFinite()) return std::nullopt;  // has been reported
  try {
    return Mesh{reading.shape_files.mesh(uri, scale, convex), convex};
  } catch (const ImporterFailed& error) {
    reading.report.stop(uri, error.what());
  } catch (const std::runtime_error& error) {
    report_lost(uri, error.what(), reading);
    return std::nullopt;
  }
}

std::optional<Shape> read_visual_mesh(const sdf::Mesh& mesh, const ModelReading& reading) {
  const Eigen::Vector3d scale = to_eigen(mesh.Scale());
  const sdf::ElementPtr uri = find(mesh.Element(), {"uri"});
  if (!uri || !scale.allFinite() || (scale.array() == 0.0).any()) return std::nullopt;
  try {
    Mesh shape{reading.shape_files.mesh(uri, scale, false), false};
    for (const std::string& warning : reading.shape_files.warnings_of(*shape.triangles))
      reading.report.warning_once(uri, warning);
    return shape;
  } catch (const ImporterFailed& error) {
    reading.report.stop(uri, error.what());
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

std::optional<Shape> shown(Shape shape, double least) {
  return least > 0.0 && std::isfinite(least) ? std::optional(std::move(shape)) : std::nullopt;
}

std::optional<Shape> read_terrain(const sdf::ElementPtr& element, const Eigen::Vector3d& size,
                                  const SdfReport& report) {
  const auto values = ExtensionValues::read(element, *find_extension("terrain", "heightmap"), report);
  if (!values) return std::nullopt;
  try {
    return Heightmap{std::make_shared<const HeightGrid>(terrain_heights(
        {values->text("kind"), size, values->real("spacing"), values->real("wavelength"), values->whole("seed")}))};
  } catch (const std::runtime_error& error) {
    report.problem(values->where("spacing"), error.what());
    return std::nullopt;
  }
}

std::optional<Shape> read_heightmap(const sdf::Heightmap& map, const ModelReading& reading) {
  const sdf::ElementPtr element = map.Element();
  const Eigen::Vector3d size = to_eigen(map.Size());
  if (!reading.is_static) report_lost(element, "a heightmap requires <static>true</static> in its model", reading);
  if (!check_size(element, {"size"}, size.minCoeff(), reading.report)) return std::nullopt;
  const sdf::ElementPtr terrain = find(element, {"cohort:terrain"});
  if (terrain && size.minCoeff() > 0.0 && size.allFinite()) return read_terrain(terrain, size, reading.report);
  const sdf::ElementPtr uri = find(element, {"uri"});
  if (!uri || terrain || !(size.minCoeff() > 0.0)) return std::nullopt;  // has been reported
  try {
    return Heightmap{reading.shape_files.height_grid(uri, size)};
  } catch (const std::runtime_error& error) {
    report_lost(uri, error.what(), reading);
    return std::nullopt;
  }
}

}  // namespace

std::optional<Shape> read_shape(const sdf::Geometry& geometry, const ModelReading& reading) {
  const sdf::ElementPtr element = geometry.Element();
  const SdfReport& report = reading.report;
  if (const sdf::Box* const box = geometry.BoxShape()) {
    const Eigen::Vector3d size = to_eigen(box->Size());
    if (!check_size(element, {"box", "size"}, size.minCoeff(), report)) return std::nullopt;
    return Box{size};
  }
  if (const sdf::Sphere* const sphere = geometry.SphereShape()) {
    if (!check_size(element, {"sphere", "radius"}, sphere->Radius(), report)) return std::nullopt;
    return Sphere{sphere->Radius()};
  }
  if (const sdf::Cylinder* const cylinder = geometry.CylinderShape()) {
    const bool has_radius = check_size(element, {"cylinder", "radius"}, cylinder->Radius(), report);
    const bool has_length = check_size(element, {"cylinder", "length"}, cylinder->Length(), report);
    if (!has_radius || !has_length) return std::nullopt;
    return Cylinder{cylinder->Radius(), cylinder->Length()};
  }
  if (const sdf::Capsule* const capsule = geometry.CapsuleShape()) {
    const bool has_radius = check_size(element, {"capsule", "radius"}, capsule->Radius(), report);
    const bool has_length = check_size(element, {"capsule", "length"}, capsule->Length(), report);
    if (!has_radius || !has_length) return std::nullopt;
    return Capsule{capsule->Radius(), capsule->Length()};
  }
  if (const sdf::Ellipsoid* const ellipsoid = geometry.EllipsoidShape()) {
    const Eigen::Vector3d radii = to_eigen(ellipsoid->Radii());
    if (!check_size(element, {"ellipsoid", "radii"}, radii.minCoeff(), report)) return std::nullopt;
    return Ellipsoid{radii};
  }
  if (const sdf::Plane* const plane = geometry.PlaneShape()) {
    const Eigen::Vector3d normal = to_eigen(plane->Normal());
    if (!reading.is_static) report_lost(element, "a plane requires <static>true</static> in its model", reading);
    if (normal.isZero()) report.problem(element, "expected a normal that is not zero");
    return Plane{written_unit_vector(find(element, {"plane", "normal"})).value_or(normal.normalized())};
  }
  if (const sdf::Mesh* const mesh = geometry.MeshShape()) return read_mesh_shape(*mesh, reading);
  if (const sdf::Heightmap* const map = geometry.HeightmapShape()) return read_heightmap(*map, reading);
  const sdf::ElementPtr kind = element->GetFirstElement();
  report_lost(element,
              (kind ? "<" + kind->GetName() + "> is not supported; expected " : "expected ") + std::string(geometries),
              reading);
  return std::nullopt;
}

std::optional<Shape> read_visual_shape(const sdf::Geometry& geometry, const ModelReading& reading) {
  const sdf::ElementPtr element = geometry.Element();
  if (const sdf::Box* const box = geometry.BoxShape()) return shown(Box{to_eigen(box->Size())}, box->Size().Min());
  if (const sdf::Sphere* const sphere = geometry.SphereShape())
    return shown(Sphere{sphere->Radius()}, sphere->Radius());
  if (const sdf::Cylinder* const cylinder = geometry.CylinderShape())
    return shown(Cylinder{cylinder->Radius(), cylinder->Length()}, std::min(cylinder->Radius(), cylinder->Length()));
  if (const sdf::Capsule* const capsule = geometry.CapsuleShape())
    return shown(Capsule{capsule->Radius(), capsule->Length()}, std::min(capsule->Radius(), capsule->Length()));
  if (const sdf::Ellipsoid* const ellipsoid = geometry.EllipsoidShape())
    return shown(Ellipsoid{to_eigen(ellipsoid->Radii())}, ellipsoid->Radii().Min());
  if (const sdf::Mesh* const mesh = geometry.MeshShape()) return read_visual_mesh(*mesh, reading);
  return std::nullopt;  // planes and height maps are shown as what they collide as
}

}  // namespace cohort::parsing
