// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/mesh_file.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_polylines.hpp"
#include "server/parsing/model/terrain.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* geometries = "box, sphere, cylinder, capsule, ellipsoid, mesh, polyline, plane or heightmap";

constexpr const char* left_out = "the collision is left out";

// Reports a collision that cannot be read. Without it, a moving model would pass through others, so this is an error
// for moving models, also in files from other sources.
void report_lost(const Element* element, const std::string& message, const ModelReading& reading) {
  if (reading.is_static)
    reading.report.flaw(element, message, left_out);
  else
    reading.report.problem(element, message);
}

// Returns false if the shape is omitted. NaN passes, since check_numbers has reported it.
bool check_size(const Element& shape, const char* size, double least, const SdfReport& report) {
  const Element* const element = shape.child(size);
  const bool is_wrong = least <= 0.0 || std::isinf(least);
  return !is_wrong || !report.flaw(element != nullptr ? element : &shape, "expected a size > 0 m", left_out);
}

MeshPart part_of_mesh(const Element& mesh) {
  const Element* const name = find(&mesh, {"submesh", "name"});
  return is_written(name) ? MeshPart{name->text(), mesh.child("submesh")->flag("center")} : MeshPart{};
}

// Returns the replacement of a mesh that cannot be read; nothing if it has none, or is left out.
std::optional<Shape> replaced_mesh(const Element* uri, const std::string& problem, const ModelReading& reading) {
  switch (reading.shape_files.replacement_of(uri)) {
    case MissingMesh::box:
      reading.report.warning_once(uri, problem + "; a cube of " + shortest_text(missing_mesh_size) + " m replaces it");
      return Box{Eigen::Vector3d::Constant(missing_mesh_size)};
    case MissingMesh::skip: reading.report.warning_once(uri, problem + "; " + left_out); return std::nullopt;
    case MissingMesh::refused: break;
  }
  const bool has_remedy = !reading.is_static && reading.shape_files.is_missing(uri);
  report_lost(uri, problem + (has_remedy ? "; --missing-meshes box or skip reads the model without it" : ""), reading);
  return std::nullopt;
}

// Returns the whole mesh, in a third-party file whose <submesh> cannot be read: the names of its parts may be lost in
// the file. Returns nothing if this is not so, or if the file cannot be read at all.
std::optional<Mesh> whole_mesh(const Element& mesh, const Eigen::Vector3d& scale, bool convex,
                               const ModelReading& reading) {
  if (!is_written(find(&mesh, {"submesh", "name"})) || !SdfReport::is_foreign(&mesh)) return std::nullopt;
  try {
    return Mesh{reading.shape_files.mesh(mesh.child("uri"), scale, convex, {}), convex};
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

std::optional<Shape> read_mesh_shape(const Element& mesh, const ModelReading& reading) {
  const Eigen::Vector3d scale = mesh.vector("scale");
  if ((scale.array() == 0.0).any()) {
    reading.report.flaw(mesh.child("scale"), "expected a scale that is not zero", left_out);
    return std::nullopt;
  }
  const bool convex = !reading.is_static;
  const Element* const uri = mesh.child("uri");
  if (!is_written(uri)) {
    report_lost(&mesh, "missing: <uri>, the file of the mesh", reading);
    return std::nullopt;
  }
  if (!scale.allFinite()) return std::nullopt;  // has been reported
  try {
    return Mesh{reading.shape_files.mesh(uri, scale, convex, part_of_mesh(mesh)), convex};
  } catch (const ImporterFailed& error) {
    reading.report.stop(uri, error.what());
  } catch (const std::runtime_error& error) {
    if (std::optional<Mesh> whole = whole_mesh(mesh, scale, convex, reading)) {
      reading.report.warning(uri, std::string(error.what()) + "; the whole mesh is used");
      return whole;
    }
    return replaced_mesh(uri, error.what(), reading);
  }
}

std::optional<Shape> read_visual_mesh(const Element& mesh, const ModelReading& reading) {
  const Eigen::Vector3d scale = mesh.vector("scale");
  const Element* const uri = mesh.child("uri");
  if (!is_written(uri) || !scale.allFinite() || (scale.array() == 0.0).any()) return std::nullopt;
  try {
    Mesh shape{reading.shape_files.mesh(uri, scale, false, part_of_mesh(mesh)), false};
    for (const std::string& warning : reading.shape_files.warnings_of(*shape.triangles))
      reading.report.warning_once(uri, warning);
    return shape;
  } catch (const ImporterFailed& error) {
    reading.report.stop(uri, error.what());
  } catch (const std::runtime_error&) {
    return whole_mesh(mesh, scale, false, reading);
  }
}

std::optional<Shape> read_polyline_shape(const Element& geometry, const ModelReading& reading) {
  const bool convex = !reading.is_static;
  try {
    std::optional<TriangleMesh> mesh = read_polylines(geometry, convex, &reading.report);
    if (!mesh) return std::nullopt;
    return Mesh{std::make_shared<const TriangleMesh>(*std::move(mesh)), convex};
  } catch (const PolylineFlaw& flaw) {
    report_lost(flaw.element, flaw.what(), reading);
    return std::nullopt;
  }
}

std::optional<Shape> read_visual_polyline(const Element& geometry) {
  try {
    std::optional<TriangleMesh> mesh = read_polylines(geometry, false, nullptr);
    if (!mesh) return std::nullopt;
    return Mesh{std::make_shared<const TriangleMesh>(*std::move(mesh)), false};
  } catch (const PolylineFlaw&) {
    return std::nullopt;
  }
}

std::optional<Shape> read_terrain(const Element* element, const Eigen::Vector3d& size, const SdfReport& report) {
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

std::optional<Shape> read_heightmap(const Element& map, const ModelReading& reading) {
  const Eigen::Vector3d size = map.vector("size");
  if (!reading.is_static) report_lost(&map, "a heightmap requires <static>true</static> in its model", reading);
  if (!check_size(map, "size", size.minCoeff(), reading.report)) return std::nullopt;
  const Element* const terrain = map.child("cohort:terrain");
  if (terrain != nullptr && size.minCoeff() > 0.0 && size.allFinite())
    return read_terrain(terrain, size, reading.report);
  const Element* const uri = map.child("uri");
  if (uri == nullptr || terrain != nullptr || !(size.minCoeff() > 0.0)) return std::nullopt;  // has been reported
  try {
    return Heightmap{reading.shape_files.height_grid(uri, size)};
  } catch (const std::runtime_error& error) {
    report_lost(uri, error.what(), reading);
    return std::nullopt;
  }
}

std::optional<Shape> shape_of(std::string_view kind, const Element& element) {
  if (kind == "box") return Box{element.vector("size")};
  if (kind == "sphere") return Sphere{element.real("radius")};
  if (kind == "cylinder") return Cylinder{element.real("radius"), element.real("length")};
  if (kind == "capsule") return Capsule{element.real("radius"), element.real("length")};
  if (kind == "ellipsoid") return Ellipsoid{element.vector("radii")};
  return std::nullopt;
}

// Returns whether all sizes of a simple shape are right; reports those that are not.
bool check_sizes(const Element& shape, const SdfReport& report) {
  bool are_right = true;
  for (const char* const size : {"size", "radius", "length", "radii"})
    if (shape.rule()->child(size) != nullptr) {
      const bool is_vector = shape.rule()->child(size)->value.type == ValueType::vector3;
      const double least = is_vector ? shape.vector(size).minCoeff() : shape.real(size);
      are_right = check_size(shape, size, least, report) && are_right;
    }
  return are_right;
}

std::optional<Shape> read_plane(const Element& plane, const ModelReading& reading) {
  if (!reading.is_static) report_lost(plane.parent(), "a plane requires <static>true</static> in its model", reading);
  const Eigen::Vector3d normal = plane.vector("normal");
  if (normal.isZero()) reading.report.problem(plane.parent(), "expected a normal that is not zero");
  return Plane{written_unit_vector(plane.child("normal")).value_or(normal.normalized())};
}

// Returns the first shape in a <geometry>; nullptr if it has none that SDF knows.
const Element* shape_in(const Element& geometry) {
  for (const Element* const child : geometry.children())
    if (child->rule() != nullptr && child->name() != "empty") return child;
  return nullptr;
}

}  // namespace

std::optional<Shape> read_shape(const Element& geometry, const ModelReading& reading) {
  const Element* const shape = geometry.name() == "geometry" ? shape_in(geometry) : nullptr;
  if (shape != nullptr) {
    if (std::optional<Shape> simple = shape_of(shape->name(), *shape))
      return check_sizes(*shape, reading.report) ? std::move(simple) : std::nullopt;
    if (shape->name() == "plane") return read_plane(*shape, reading);
    if (shape->name() == "mesh") return read_mesh_shape(*shape, reading);
    if (shape->name() == "polyline") return read_polyline_shape(geometry, reading);
    if (shape->name() == "heightmap") return read_heightmap(*shape, reading);
  }
  if (geometry.name() != "geometry") {
    reading.report.flaw(&geometry, "missing: <geometry>", left_out);
    return std::nullopt;
  }
  const Element* const kind = !geometry.children().empty() ? geometry.children().front() : nullptr;
  if (kind != nullptr && kind->name() == "empty") return std::nullopt;
  report_lost(
      &geometry,
      (kind != nullptr ? "<" + kind->name() + "> is not supported; expected " : "expected ") + std::string(geometries),
      reading);
  return std::nullopt;
}

std::optional<Shape> read_visual_shape(const Element& geometry, const ModelReading& reading) {
  const Element* const shape = shape_in(geometry);
  if (shape == nullptr) return std::nullopt;
  if (shape->name() == "mesh") return read_visual_mesh(*shape, reading);
  if (shape->name() == "polyline") return read_visual_polyline(geometry);
  std::optional<Shape> simple = shape_of(shape->name(), *shape);  // others are shown as what they collide as
  if (!simple) return std::nullopt;
  const auto is_size = [](double size) { return size > 0.0 && std::isfinite(size); };
  for (const char* const size : {"size", "radii"})
    if (shape->rule()->child(size) != nullptr && !is_size(shape->vector(size).minCoeff())) return std::nullopt;
  for (const char* const size : {"radius", "length"})
    if (shape->rule()->child(size) != nullptr && !is_size(shape->real(size))) return std::nullopt;
  return simple;
}

}  // namespace cohort::parsing
