// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/readings/sample_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace cohort::sensing {
namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;

bool are_ascending(const std::vector<double>& values) {
  return !values.empty() &&
         std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }) &&
         std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return a >= b; }) == values.end();
}

}  // namespace

SampleTable::SampleTable(std::shared_ptr<const description::Samples> samples) : samples_(std::move(samples)) {
  const auto& [distances, angles, units, readings, file] = *samples_;
  if (!are_ascending(distances) || !are_ascending(angles) || distances.front() < 0.0 ||
      angles.back() - angles.front() >= full_turn || units.empty() ||
      readings.size() != distances.size() * angles.size() * units.size())
    throw std::invalid_argument("samples must be a full grid of ascending distances and angles within one turn");
}

SampleTable::Cell SampleTable::cell_of(double distance, double angle) const {
  const std::vector<double>& distances = samples_->distances;
  const std::vector<double>& angles = samples_->angles;
  Cell cell;
  const auto index_of = [](const std::vector<double>& values, double value) {
    return static_cast<std::size_t>(std::upper_bound(values.begin(), values.end(), value) - values.begin());
  };
  const std::size_t far = index_of(distances, distance);
  cell.near_row = far == 0 ? 0 : far - 1;
  cell.far_row = std::min(far, distances.size() - 1);
  if (cell.far_row > cell.near_row)
    cell.far_share = (distance - distances[cell.near_row]) / (distances[cell.far_row] - distances[cell.near_row]);

  // Maps the angle to the turn that starts at the first angle; fmod is exact.
  double around = std::fmod(angle - angles.front(), full_turn);
  if (around < 0.0) around += full_turn;
  const double within = angles.front() + around;
  const std::size_t second = index_of(angles, within);
  cell.first = second == 0 ? 0 : second - 1;
  cell.second = second == angles.size() ? 0 : std::max<std::size_t>(second, 1) % angles.size();
  const double next = cell.second > cell.first ? angles[cell.second] : angles.front() + full_turn;
  cell.second_share = std::clamp((within - angles[cell.first]) / (next - angles[cell.first]), 0.0, 1.0);
  return cell;
}

double SampleTable::interpolate(const Cell& cell, std::size_t index) const {
  const auto at = [&](std::size_t row, std::size_t angle) {
    return samples_->readings[(row * samples_->angles.size() + angle) * count() + index];
  };
  const auto between = [](double a, double b, double share) { return a + share * (b - a); };
  return between(between(at(cell.near_row, cell.first), at(cell.near_row, cell.second), cell.second_share),
                 between(at(cell.far_row, cell.first), at(cell.far_row, cell.second), cell.second_share),
                 cell.far_share);
}

double SampleTable::reading(double distance, double angle, std::size_t index) const {
  return is_beyond(distance) ? 0.0 : interpolate(cell_of(distance, angle), index);
}

void SampleTable::keep_greatest(double distance, double angle, std::span<double> values) const {
  if (is_beyond(distance)) return;
  const Cell cell = cell_of(distance, angle);
  for (std::size_t i = 0; i < count(); ++i) values[i] = std::max(values[i], interpolate(cell, i));
}

void SampleTable::add(double distance, double angle, double factor, std::span<double> values) const {
  if (is_beyond(distance)) return;
  const Cell cell = cell_of(distance, angle);
  for (std::size_t i = 0; i < count(); ++i) values[i] += factor * interpolate(cell, i);
}

}  // namespace cohort::sensing
