#pragma once

#include "server/geometry/panorama.hpp"
#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// An image of all round (description::PanoramicCamera), one ray for each pixel, through its middle. A surface has the
/// colour of its link times 0.4 + 0.6 max(0, n . l), where n is its normal and l the direction (2, 1, 3) / sqrt(14) of
/// a light that is always the same and throws no shadows (Lambert's law). Markers that are in sight (markers_in_sight)
/// are drawn over it as spots with a radius of 5 mm and their own colour, at least the pixel that they are in, the
/// nearest last. Lamps light nothing up.
class PanoramicCamera final : public Sensor {
 public:
  PanoramicCamera(const description::PanoramicCamera& camera, Mount mount);
  std::vector<Channel> channels() const override;
  void sense(std::uint64_t tick, std::span<double> values) const override;

 private:
  void draw_surfaces(const Pose& X_WS, std::span<double> image) const;
  void draw_markers(const Pose& X_WS, std::span<double> image) const;

  description::PanoramicCamera camera_;
  Mount mount_;
  geometry::Panorama panorama_;
};

}  // namespace cohort::sensing
