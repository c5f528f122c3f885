// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace cohort::viewing {
namespace {

using Eigen::Vector3d;

constexpr int largest_side = 4096;
const Vector3d sky(0.80, 0.86, 0.92);
const Vector3d to_light_W = Vector3d(0.3, -0.4, 0.85).normalized();

// The pixels of a row are next to each other.
struct Picture {
  int width = 0, height = 0;
  Vector3d origin_W, forward_W, right_W, up_W;  // right and up: from the centre to the edge, at distance 1
  std::vector<Vector3d> rays_W;
  std::vector<std::optional<geometry::RayHit>> hits;
};

Picture picture_of(const PictureCamera& camera, int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.origin_W = camera.position_W;
  picture.forward_W = (camera.target_W - camera.position_W).normalized();
  const Vector3d across = picture.forward_W.cross(Vector3d::UnitZ());
  const Vector3d right = across.norm() > 1e-6 ? across.normalized() : Vector3d::UnitX();  // if it looks straight down
  const double half_height = std::tan(0.5 * camera.vertical_field_of_view);
  picture.right_W = half_height * width / height * right;
  picture.up_W = half_height * right.cross(picture.forward_W);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const double x = (2.0 * column + 1.0) / width - 1.0, y = 1.0 - (2.0 * row + 1.0) / height;
      picture.rays_W.push_back((picture.forward_W + x * picture.right_W + y * picture.up_W).normalized());
    }
  picture.hits.resize(picture.rays_W.size());
  return picture;
}

// A range of columns or rows, the last not included.
struct Range {
  int begin = 0, end = 0;
};

// The pixels in which a ball can be: along one axis of the picture, its centre is at `across` and `ahead` of the
// camera.
Range pixels_of(double across, double ahead, double radius, double half_extent, int pixels, bool is_downward) {
  // The tangents from the camera to the ball, as slopes. A ball around the camera or beside it can be anywhere.
  const double squared = ahead * ahead - radius * radius;
  if (ahead <= 0.0 || squared <= 0.0) return {0, pixels};
  const double root = radius * std::sqrt(std::max(0.0, across * across + squared));
  const double least = (across * ahead - root) / squared / half_extent,
               most = (across * ahead + root) / squared / half_extent;
  const auto pixel_of = [&](double share) {
    const double place = 0.5 * (is_downward ? 1.0 - share : 1.0 + share) * pixels;
    return static_cast<int>(std::clamp(std::floor(place), 0.0, static_cast<double>(pixels)));
  };
  const int first = pixel_of(is_downward ? most : least), last = pixel_of(is_downward ? least : most);
  return {first, std::min(pixels, last + 1)};
}

void draw_solid(const geometry::Scene& scene, std::uint32_t solid, Picture& picture) {
  const geometry::Scene::Ball ball = scene.ball(solid);
  Range columns{0, picture.width}, rows{0, picture.height};
  if (std::isfinite(ball.radius)) {
    const Vector3d offset = ball.centre_W - picture.origin_W;
    const double ahead = offset.dot(picture.forward_W);
    if (ahead < -ball.radius) return;
    const double half_width = picture.right_W.norm(), half_height = picture.up_W.norm();
    columns = pixels_of(offset.dot(picture.right_W) / half_width, ahead, ball.radius, half_width, picture.width, false);
    rows = pixels_of(offset.dot(picture.up_W) / half_height, ahead, ball.radius, half_height, picture.height, true);
  }
  for (int row = rows.begin; row < rows.end; ++row)
    for (int column = columns.begin; column < columns.end; ++column) {
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(column);
      auto& hit = picture.hits[pixel];
      const double range = hit ? hit->distance : std::numeric_limits<double>::infinity();
      scene.improve(hit, solid, picture.origin_W, picture.rays_W[pixel], range);
    }
}

Vector3d color_of(const geometry::Scene& scene, const geometry::RayHit& hit, const Vector3d& point_W) {
  const geometry::Solid& solid = scene.solid(hit.solid);
  Vector3d color = solid.color();
  // Squares of a metre, so that motion over an even ground can be seen.
  if (std::holds_alternative<description::Plane>(solid.shape())) {
    const bool is_odd = (std::llround(std::floor(point_W.x())) + std::llround(std::floor(point_W.y()))) % 2 != 0;
    color *= is_odd ? 1.1 : 1.25;
  }
  const double light = 0.45 + 0.55 * std::max(0.0, hit.normal_W.dot(to_light_W));
  return (color * light).cwiseMin(1.0).cwiseMax(0.0);
}

// Returns the greatest distance of a point of the model from its origin as described [m].
double reach_of(const description::Model& model) {
  double reach = 0.0;
  for (const description::Link& link : model.links)
    for (const description::Collision& collision : link.collisions) {
      const double radius = geometry::radius_of(collision.shape);
      if (std::isfinite(radius)) reach = std::max(reach, (link.X_ML * collision.X_LC).position.norm() + radius);
    }
  return reach;
}

void check(const PictureCamera& camera, int width, int height) {
  for (const int side : {width, height})
    if (side < 1 || side > largest_side)
      throw std::invalid_argument("the picture has " + std::to_string(width) + " x " + std::to_string(height) +
                                  " pixels, expected 1 to " + std::to_string(largest_side) + " for each");
  const bool is_finite = camera.position_W.allFinite() && camera.target_W.allFinite();
  if (!is_finite || !((camera.target_W - camera.position_W).squaredNorm() > 0.0))
    throw std::invalid_argument("expected a camera with a finite position [m] and another finite target [m]");
  if (!(camera.vertical_field_of_view > 0.0 && camera.vertical_field_of_view < 3.1))
    throw std::invalid_argument("the camera's vertical field of view is " +
                                std::to_string(camera.vertical_field_of_view) + " rad, expected 0 to 3.1 rad");
}

}  // namespace

PictureCamera camera_for(const Simulation& simulation, double aspect) {
  const geometry::Scene& scene = simulation.world().scene();
  geometry::Bounds all{Vector3d::Constant(std::numeric_limits<double>::infinity()),
                       Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  const auto include = [&](const Vector3d& lower, const Vector3d& upper) {
    all.lower = all.lower.cwiseMin(lower);
    all.upper = all.upper.cwiseMax(upper);
  };
  for (std::uint32_t solid = 0; solid < scene.size(); ++solid) {
    const geometry::Bounds& bounds = scene.bounds(solid);
    const bool is_bounded = bounds.lower.allFinite() && bounds.upper.allFinite();
    if (!scene.solid(solid).moves && is_bounded) include(bounds.lower, bounds.upper);
  }
  const description::World& world = simulation.experiment().world;
  for (const std::size_t robot : world.robots) {
    const description::Instance& instance = world.instances[robot];
    const Vector3d reach = Vector3d::Constant(reach_of(world.models[instance.model]));
    include(instance.X_WM.position - reach, instance.X_WM.position + reach);
  }
  if (!all.lower.allFinite()) all = {Vector3d::Constant(-1.0), Vector3d::Constant(1.0)};
  PictureCamera camera;
  camera.target_W = 0.5 * (all.lower + all.upper);
  // Worlds are usually flat, and seen at an angle: the ball around them may be larger than the picture.
  const double radius = 0.85 * 0.5 * (all.upper - all.lower).norm();
  const double half_angle = 0.5 * camera.vertical_field_of_view * std::min(1.0, aspect);
  camera.position_W = camera.target_W + radius / std::sin(half_angle) * Vector3d(0.0, -0.6, 0.8);
  return camera;
}

std::vector<std::uint8_t> draw_picture(const Simulation& simulation, const PictureCamera& camera, int width,
                                       int height) {
  check(camera, width, height);
  Picture picture = picture_of(camera, width, height);
  const geometry::Scene& scene = simulation.world().scene();
  for (std::uint32_t solid = 0; solid < scene.size(); ++solid)
    if (!scene.is_removed(solid)) draw_solid(scene, solid, picture);

  std::vector<std::uint8_t> colors;
  colors.reserve(3 * picture.hits.size());
  for (std::size_t pixel = 0; pixel < picture.hits.size(); ++pixel) {
    const auto& hit = picture.hits[pixel];
    const Vector3d color = hit ? color_of(scene, *hit, picture.origin_W + hit->distance * picture.rays_W[pixel]) : sky;
    for (const double part : color) colors.push_back(static_cast<std::uint8_t>(std::lround(255.0 * part)));
  }
  return colors;
}

}  // namespace cohort::viewing
