// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "server/core/random.hpp"

namespace cohort::parsing {
namespace {

std::size_t intervals(double length, double spacing) {
  const double count = std::max(1.0, std::ceil(length / spacing - 1e-9));  // a whole multiple stays one
  if (!(count < most_terrain_heights))
    throw std::runtime_error("expected at most " + std::to_string(static_cast<int>(most_terrain_heights)) +
                             " height samples along each side; the spacing is too small for this size");
  return static_cast<std::size_t>(count);
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

// Returns value noise: random heights on a lattice, smoothly interpolated.
double hills(const RandomStream& random, double u, double v) {
  const double column = std::floor(u), row = std::floor(v);
  const auto at = [&](double i, double j) {
    return random.uniform(static_cast<std::uint64_t>(column + i), static_cast<std::uint32_t>(row + j));
  };
  const double s = smooth(u - column), t = smooth(v - row);
  return (1.0 - t) * ((1.0 - s) * at(0, 0) + s * at(1, 0)) + t * ((1.0 - s) * at(0, 1) + s * at(1, 1));
}

}  // namespace

HeightGrid terrain_heights(const Terrain& terrain) {
  const std::size_t along_x = intervals(terrain.size.x(), terrain.spacing);
  const std::size_t along_y = intervals(terrain.size.y(), terrain.spacing);
  HeightGrid grid;
  grid.columns = along_x + 1;
  grid.rows = along_y + 1;
  grid.spacing = {terrain.size.x() / static_cast<double>(along_x), terrain.size.y() / static_cast<double>(along_y)};
  grid.heights.reserve(grid.columns * grid.rows);

  const RandomStream random(terrain.seed, "terrain", terrain.kind);
  const double steps = std::ceil(terrain.size.x() / terrain.wavelength - 1e-9);
  const double wave = 2.0 * std::numbers::pi / terrain.wavelength;
  const auto height = [&](std::size_t column, std::size_t row) {
    const double x = static_cast<double>(column) * grid.spacing.x();  // from the corner with the least x and y
    const double y = static_cast<double>(row) * grid.spacing.y();
    if (terrain.kind == "sine") return 0.5 + 0.5 * std::sin(wave * x) * std::sin(wave * y);
    if (terrain.kind == "ramp") return static_cast<double>(column) / static_cast<double>(along_x);
    if (terrain.kind == "steps")
      return steps < 2.0 ? 0.0 : std::min(std::floor(x / terrain.wavelength + 1e-9), steps - 1.0) / (steps - 1.0);
    if (terrain.kind == "hills") return hills(random, x / terrain.wavelength, y / terrain.wavelength);
    return random.uniform(column, static_cast<std::uint32_t>(row));
  };
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      grid.heights.push_back(terrain.size.z() * height(column, row));
  grid.terrain = terrain;
  return grid;
}

}  // namespace cohort::parsing
