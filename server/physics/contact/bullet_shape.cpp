// SPDX-License-Identifier: Apache-2.0
#include "server/physics/contact/bullet_shape.hpp"

#include <algorithm>
#include <mutex>

#include "server/physics/contact/bullet.hpp"

namespace cohort::physics {
namespace {

using description::HeightGrid;
using description::TriangleMesh;
using Eigen::Vector3d;

// Bullet finds contacts between hulls best if they are slightly rounded [m]. The hull is shrunk by this much and Bullet
// adds it as a margin, so that faces stay in place and edges are rounded.
constexpr double hull_rounding = 0.0005;
constexpr double surface_skin = 0.001;  // [m]

std::unique_ptr<btConvexHullShape> rounded_hull(const std::vector<Vector3d>& vertices) {
  auto hull = std::make_unique<btConvexHullShape>();
  constexpr double most_of_its_size = 0.1;
  btConvexHullComputer smaller;
  const double rounding = smaller.compute(vertices[0].data(), sizeof(Vector3d), static_cast<int>(vertices.size()),
                                          hull_rounding, most_of_its_size);
  if (rounding > 0.0) {
    for (int i = 0; i < smaller.vertices.size(); ++i) hull->addPoint(smaller.vertices[i], false);
  } else {  // flat: only the rounding gives it thickness
    for (const Vector3d& vertex : vertices) hull->addPoint(to_bullet(vertex), false);
  }
  hull->recalcLocalAabb();
  hull->setMargin(rounding > 0.0 ? rounding : hull_rounding);
  return hull;
}

// An ellipsoid, which Bullet lacks. Bullet's narrow phase needs only the support point: the one furthest along a
// direction.
class EllipsoidShape final : public btConvexInternalShape {
 public:
  explicit EllipsoidShape(const Vector3d& radii) : radii_(radii) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(0.0);
  }

  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& direction) const override {
    const Vector3d scaled = radii_.cwiseProduct(to_eigen(direction));
    const double length = scaled.norm();
    if (length == 0.0) return to_bullet(Vector3d(radii_.x(), 0.0, 0.0));
    return to_bullet(radii_.cwiseProduct(scaled) / length);
  }
  btVector3 localGetSupportingVertex(const btVector3& direction) const override {
    return localGetSupportingVertexWithoutMargin(direction);
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions, btVector3* found,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) found[i] = localGetSupportingVertexWithoutMargin(directions[i]);
  }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }  // never used
  void getAabb(const btTransform& X_WC, btVector3& lower, btVector3& upper) const override {
    const btVector3 half(radii_.maxCoeff(), radii_.maxCoeff(), radii_.maxCoeff());
    lower = X_WC.getOrigin() - half;
    upper = X_WC.getOrigin() + half;
  }
  const char* getName() const override { return "ellipsoid"; }

 private:
  Vector3d radii_;
};

}  // namespace

struct BulletShape::Data {
  std::shared_ptr<const TriangleMesh> mesh;  // Bullet's shapes point into these
  std::shared_ptr<const HeightGrid> grid;
  std::unique_ptr<btTriangleMesh> triangles;
  std::once_flag is_made;
  std::unique_ptr<btCollisionShape> shape;
};

namespace {

struct Make {
  std::unique_ptr<btTriangleMesh>& triangles;
  Vector3d& offset;

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
  std::unique_ptr<btCollisionShape> operator()(const description::Capsule& capsule) const {
    return std::make_unique<btCapsuleShapeZ>(capsule.radius, capsule.length);
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Ellipsoid& ellipsoid) const {
    return std::make_unique<EllipsoidShape>(ellipsoid.radii);
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Mesh& mesh) const {
    if (mesh.convex) return nullptr;  // made by the first get()
    triangles = std::make_unique<btTriangleMesh>();
    for (const auto& corners : mesh.triangles->triangles)
      triangles->addTriangle(to_bullet(mesh.triangles->vertices[corners[0]]),
                             to_bullet(mesh.triangles->vertices[corners[1]]),
                             to_bullet(mesh.triangles->vertices[corners[2]]));
    const bool compress_boxes = false;
    auto surface = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), compress_boxes);
    surface->setMargin(surface_skin);
    return surface;
  }
  std::unique_ptr<btCollisionShape> operator()(const description::Heightmap& map) const {
    const HeightGrid& grid = *map.grid;
    const auto [lowest, highest] = std::minmax_element(grid.heights.begin(), grid.heights.end());
    const int upwards = 2;
    const bool flip_diagonals = false;
    auto field =
        std::make_unique<btHeightfieldTerrainShape>(static_cast<int>(grid.columns), static_cast<int>(grid.rows),
                                                    grid.heights.data(), *lowest, *highest, upwards, flip_diagonals);
    field->setLocalScaling(btVector3(grid.spacing.x(), grid.spacing.y(), 1.0));
    field->setMargin(surface_skin);
    offset.z() = 0.5 * (*lowest + *highest);
    return field;
  }
};

}  // namespace

BulletShape::BulletShape(const geometry::Shape& shape)
    : data_(std::make_unique<Data>()), half_thickness_(geometry::half_thickness_of(shape)) {
  if (const auto* mesh = std::get_if<description::Mesh>(&shape)) data_->mesh = mesh->triangles;
  if (const auto* map = std::get_if<description::Heightmap>(&shape)) data_->grid = map->grid;
  data_->shape = std::visit(Make{data_->triangles, offset_}, shape);
  if (data_->shape && data_->shape->isConcave()) skin_ = data_->shape->getMargin();
}

BulletShape::~BulletShape() = default;

btCollisionShape* BulletShape::get() const {
  std::call_once(data_->is_made, [&] {
    if (!data_->shape) data_->shape = rounded_hull(data_->mesh->vertices);
  });
  return data_->shape.get();
}

}  // namespace cohort::physics
