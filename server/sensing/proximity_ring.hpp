#pragma once

#include <optional>

#include "server/core/random.hpp"
#include "server/geometry/ray_fan.hpp"
#include "server/geometry/shadow_ring.hpp"
#include "server/sensing/sample_table.hpp"
#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// Infrared proximity. The real sensor sees a cone of 40 degrees and 20 cm (thesis, section 3.2.1). What a ray of
/// length `range` meets at distance d counts 1 - d / range, and 0 if it meets nothing; a sensor that gathers what comes
/// back from its whole cone reads the mean of that over the cone. The techniques of the thesis are ways to it:
///  - ray: the ray along the sensor's axis stands for all.
///  - random_ray: at each tick another ray, with equal probability anywhere in the cone (in solid angle): the mean over
///    many ticks is right, and nothing small stays hidden.
///  - five_rays: the mean of the ray along the axis and four at sqrt(5/8) of half the cone from it, to both sides, up
///    and down. At that angle the mean of the five is that over a small cone for every function of up to third order
///    (equal second moments: 4/5 t^2 = R^2 / 2).
///  - shadow: the mean over the directions of a ShadowRing of 360 that end in the mouth of the sensor's cone. They
///    start in the middle of the ring, and count from `ring_radius` on; so they lie within
///    atan2(range sin c, ring_radius + range cos c) of the axis, for half a cone c.
///  - samples: the readings of a table for each solid that reaches through the plane of the ring and is no ground, by
///    the distance of its nearest point from the middle of the ring and that point's bearing, seen from above and
///    through all else; the greatest counts.
class ProximityRing final : public Sensor {
 public:
  ProximityRing(const description::ProximityRing& ring, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  double bearing_of(std::size_t sensor) const;
  Eigen::Vector3d turned(std::size_t sensor, double aside, double up) const;
  double reading(const geometry::RayFan& fan, const Pose& X_WS, std::size_t sensor,
                 const Eigen::Vector3d& direction_S) const;
  void cast_axes(const Pose& X_WS, std::span<double> values) const;
  void cast_in_cones(std::uint64_t tick, const Pose& X_WS, std::span<double> values) const;
  void cast_shadows(const Pose& X_WS, std::span<double> values) const;
  void look_up(const Pose& X_WS, std::span<double> values) const;

  description::ProximityRing ring_;
  Mount mount_;
  std::vector<Eigen::Vector3d> directions_S_;
  RandomStream random_;
  std::optional<geometry::ShadowRing> shadows_;
  double shadow_width_ = 0.0;  // half the angle at the middle of the ring that a sensor's directions are in
  std::optional<SampleTable> table_;
};

}  // namespace cohort::sensing
