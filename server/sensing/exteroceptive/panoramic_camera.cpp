// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "server/core/integer_floor.hpp"
#include "server/geometry/visibility/panorama.hpp"
#include "server/sensing/exteroceptive/markers_in_sight.hpp"
#include "server/sensing/placed.hpp"
#include "server/sensing/sensor_kinds.hpp"

namespace cohort::sensing {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double ambient = 0.4;
constexpr double spot_radius = 5e-3;  // radius of a drawn marker [m]

// Returns the elevation of the middle of each row, the highest first.
std::vector<double> elevations_of(const description::PanoramicCamera& camera) {
  const double height = (camera.max_elevation - camera.min_elevation) / static_cast<double>(camera.height);
  std::vector<double> elevations;
  for (std::size_t row = 0; row < camera.height; ++row)
    elevations.push_back(camera.max_elevation - (static_cast<double>(row) + 0.5) * height);
  return elevations;
}

double brightness(const Eigen::Vector3d& normal_W) {
  const Eigen::Vector3d light = Eigen::Vector3d(2.0, 1.0, 3.0) / std::sqrt(14.0);
  return ambient + (1.0 - ambient) * std::max(0.0, normal_W.dot(light));
}

void paint(std::span<double> image, std::size_t pixel, const Eigen::Vector3d& color) {
  std::copy(color.begin(), color.end(), image.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

/// A panoramic image (description::PanoramicCamera), with one ray for each pixel, through its middle. A surface has the
/// colour of its link times 0.4 + 0.6 max(0, n . l). Here n is its normal and l the direction (2, 1, 3) / sqrt(14) of a
/// fixed light without shadows (Lambert's law). Visible markers (markers_in_sight) are drawn over it as spots with a
/// radius of 5 mm and their own colour, at least the pixel that they are in, the nearest last. Lamps have no effect.
class PanoramicCamera final : public SensorOf<description::PanoramicCamera> {
 public:
  PanoramicCamera(const description::PanoramicCamera& camera, const Mount& mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  void draw_surfaces(const Pose& X_WS, std::span<double> image) const;
  void draw_markers(const Pose& X_WS, std::span<double> image) const;

  geometry::Panorama panorama_;
};

PanoramicCamera::PanoramicCamera(const description::PanoramicCamera& camera, const Mount& mount)
    : SensorOf(camera, mount), panorama_(camera.width, elevations_of(camera)) {}

std::vector<Channel> PanoramicCamera::channels() const {
  const auto size = static_cast<std::uint32_t>(3 * device_.width * device_.height);
  return {{device_.name + "/0/image", "1", size, 0.0, 1.0, 0.0}};
}

void PanoramicCamera::sense(std::uint64_t, std::span<double> values) const {
  const Pose X_WS = pose_of(device_, mount_);
  draw_surfaces(X_WS, values);
  draw_markers(X_WS, values);
}

void PanoramicCamera::draw_surfaces(const Pose& X_WS, std::span<double> image) const {
  const geometry::Scene& scene = mount_.world.scene();
  std::vector<std::optional<geometry::RayHit>> hits(device_.width * device_.height);
  panorama_.cast(geometry::Outlines(scene), X_WS, device_.range, mount_.body, hits);
  for (std::size_t pixel = 0; pixel < hits.size(); ++pixel)
    paint(image, pixel,
          hits[pixel] ? Eigen::Vector3d(brightness(hits[pixel]->normal_W) * scene.solid(hits[pixel]->solid).color())
                      : device_.sky);
}

void PanoramicCamera::draw_markers(const Pose& X_WS, std::span<double> image) const {
  const std::vector<Spot> spots = markers_in_sight(
      mount_, X_WS,
      {device_.range, device_.min_elevation, device_.max_elevation, std::numeric_limits<std::size_t>::max()});
  const auto width = static_cast<std::int64_t>(device_.width);
  const auto height = static_cast<std::int64_t>(device_.height);
  const double columns_a_radian = static_cast<double>(width) / (2.0 * pi);
  const double rows_a_radian = static_cast<double>(height) / (device_.max_elevation - device_.min_elevation);
  for (std::size_t i = spots.size(); i-- > 0;) {
    const Spot& spot = spots[i];
    const Eigen::Vector3d direction_S(std::cos(spot.elevation) * std::cos(spot.bearing),
                                      std::cos(spot.elevation) * std::sin(spot.bearing), std::sin(spot.elevation));
    const std::int64_t column = integer_floor(spot.bearing * columns_a_radian + 0.5);
    const std::int64_t row = std::clamp<std::int64_t>(
        integer_floor((device_.max_elevation - spot.elevation) * rows_a_radian), 0, height - 1);
    const double half_angle = std::asin(std::min(1.0, spot_radius / std::max(spot.distance, spot_radius)));
    const double cosine = std::cos(half_angle);
    // Columns are narrower near a pole.
    const double narrow = std::max(std::cos(std::min(std::abs(spot.elevation) + half_angle, 0.5 * pi)), 1e-6);
    const std::int64_t rows_aside = integer_floor(half_angle * rows_a_radian) + 1;
    const std::int64_t columns_aside = integer_floor(std::min(half_angle / narrow, pi) * columns_a_radian) + 1;
    const Eigen::Vector3d& color = mount_.emitters.marker(spot.marker).color;
    for (std::int64_t y = std::max<std::int64_t>(row - rows_aside, 0); y <= std::min(row + rows_aside, height - 1); ++y)
      for (std::int64_t x = column - columns_aside; x <= column + columns_aside; ++x) {
        const auto at_column = static_cast<std::size_t>((x % width + width) % width);
        const std::size_t pixel = panorama_.pixel(at_column, static_cast<std::size_t>(y));
        const bool is_middle = x == column && y == row;
        if (is_middle || panorama_.direction(pixel).dot(direction_S) >= cosine) paint(image, pixel, color);
      }
  }
}

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::PanoramicCamera& camera, const Mount& mount) {
  return std::make_unique<PanoramicCamera>(camera, mount);
}

}  // namespace cohort::sensing
