// SPDX-License-Identifier: Apache-2.0
#include "server/geometry/scene/scene.hpp"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "server/core/infinity.hpp"
#include "server/core/is_unit.hpp"

namespace cohort::geometry {
namespace {

// A solid that touches more cells than this is kept in a separate list: walls, floors, planes.
constexpr double most_cells = 64.0;

}  // namespace

std::uint32_t Scene::add(SolidKindPtr kind, BodyId body, bool moves, const Pose& X_WC) {
  const auto index = static_cast<std::uint32_t>(solids_.size());
  const double radius = kind->radius;
  bounds_.push_back(bounds_of(kind->shape, X_WC));
  p_CW_.push_back(X_WC.inverse().position);
  is_removed_.push_back(0);
  solids_.push_back({std::move(kind), body, moves, radius, X_WC});
  return index;
}

std::uint32_t Scene::add(const LoneSolid& solid) {
  return add(make_solid_kind({.shape = solid.shape, .surface = solid.surface}), solid.body, solid.moves, solid.X_WC);
}

void Scene::reserve(std::size_t solids) {
  solids_.reserve(solids);
  p_CW_.reserve(solids);
  bounds_.reserve(solids);
  is_removed_.reserve(solids);
}

// Returns the cell size: the width of the widest moving body, ignoring the few that are much wider than the others. It
// has a lower bound, because a search extends some millimetres around things of any size.
double Scene::choose_cell_size() const {
  constexpr double much_wider = 4.0;
  constexpr double narrowest = 0.02;  // [m]
  // Collect the widest solid of each body. The solids of one body are mostly contiguous.
  std::vector<std::pair<BodyId, double>> widest;
  for (const Solid& solid : solids_) {
    if (!solid.moves) continue;
    const double width = 2.0 * solid.radius;
    if (widest.empty() || widest.back().first != solid.body)
      widest.emplace_back(solid.body, width);
    else
      widest.back().second = std::max(widest.back().second, width);
  }
  if (widest.empty()) return 1.0;
  if (!std::ranges::is_sorted(widest, {}, &std::pair<BodyId, double>::first)) std::ranges::sort(widest);
  std::vector<double> widths;
  for (std::size_t i = 0; i < widest.size(); ++i)
    if (i + 1 == widest.size() || widest[i + 1].first != widest[i].first) widths.push_back(widest[i].second);
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  const double most = much_wider * *middle;
  double edge = narrowest;
  for (const double width : widths)
    if (width <= most) edge = std::max(edge, width);
  return edge;
}

void Scene::build() {
  const double edge = choose_cell_size();
  static_grid_.set_cell_size(edge);
  moving_grid_.set_cell_size(edge);
  wide_grid_.set_cell_size(edge);

  for (std::vector<std::uint32_t>* list : {&large_, &moving_, &wide_, &large_moving_}) list->clear();
  std::vector<std::uint32_t> small;
  for (std::uint32_t index = 0; index < solids_.size(); ++index) {
    if (is_removed_[index]) continue;
    const double width = 2.0 * solids_[index].radius;
    if (!solids_[index].moves) {
      (static_grid_.cells_covered(bounds_[index]) <= most_cells ? small : large_).push_back(index);
    } else {
      (width <= edge ? moving_ : width * width > most_cells * edge * edge ? large_moving_ : wide_).push_back(index);
    }
  }
  static_grid_.build(small, bounds_);
  update();
}

void Scene::update() {
  moving_grid_.build(moving_, bounds_);
  wide_grid_.build(wide_, bounds_);
}

void Scene::remove(std::uint32_t index) {
  is_removed_[index] = 1;
  if (!solids_[index].moves) return build();
  for (std::vector<std::uint32_t>* list : {&moving_, &wide_, &large_moving_}) std::erase(*list, index);
  update();
}

void Scene::put_back(std::uint32_t index) {
  assert(is_removed_[index]);
  is_removed_[index] = 0;
  build();
}

void Scene::renew(std::uint32_t index, BodyId body, const Pose& X_WC) {
  is_removed_[index] = 0;
  solids_[index].body = body;
  set_pose(index, X_WC);
}

void Scene::set_pose(std::uint32_t index, const Pose& X_WC) {
  solids_[index].X_WC = X_WC;
  p_CW_[index] = X_WC.inverse().position;
  bounds_[index] = bounds_of(solids_[index].shape(), X_WC);
}

double Scene::improve(std::optional<RayHit>& best, std::uint32_t index, const Eigen::Vector3d& origin_W,
                      const Eigen::Vector3d& direction_W, double range) const {
  const double reach = best ? best->distance : range;
  const Solid& solid = solids_[index];
  const Pose X_CW{p_CW_[index], solid.X_WC.orientation.conjugate()};
  const Eigen::Vector3d origin_C = X_CW * origin_W;
  const Eigen::Vector3d direction_C = X_CW.orientation * direction_W;
  const RayEntry entry = solid.kind->mesh ? solid.kind->mesh->cast_ray(origin_C, direction_C, reach)
                                          : geometry::cast_ray(solid.shape(), origin_C, direction_C, reach);
  const bool is_nearer = entry.distance < reach || (entry.distance == reach && (!best || index < best->solid));
  if (!is_nearer || !(entry.distance < infinity)) return reach;
  best = RayHit{entry.distance, index, solid.X_WC.orientation * entry.normal};
  return entry.distance;
}

std::optional<RayHit> Scene::cast_ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range,
                                      BodyId ignored_body) const {
  assert(is_unit(direction_W) && range >= 0.0);
  std::optional<RayHit> best;
  const auto test = [&](std::uint32_t index) {
    const double reach = best ? best->distance : range;
    if (solids_[index].body == ignored_body || ball(index).is_missed(origin_W, direction_W, reach)) return reach;
    return improve(best, index, origin_W, direction_W, range);
  };
  for (const std::uint32_t index : large_) test(index);
  for (const std::uint32_t index : large_moving_) test(index);
  static_grid_.for_each_along(origin_W, direction_W, best ? best->distance : range, test);
  wide_grid_.for_each_along(origin_W, direction_W, best ? best->distance : range, test);
  moving_grid_.for_each_along(origin_W, direction_W, best ? best->distance : range, test);
  return best;
}

bool Scene::is_free(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double range,
                    BodyId ignored_body, BodyId other_ignored_body) const {
  constexpr double no_further = -1.0;
  std::optional<RayHit> hit;
  const auto test = [&](std::uint32_t index) {
    const BodyId body = solids_[index].body;
    if (hit || body == ignored_body || body == other_ignored_body ||
        ball(index).is_missed(origin_W, direction_W, range))
      return hit ? no_further : range;
    improve(hit, index, origin_W, direction_W, range);
    return hit ? no_further : range;
  };
  for (const std::uint32_t index : large_) test(index);
  for (const std::uint32_t index : large_moving_) test(index);
  if (!hit) static_grid_.for_each_along(origin_W, direction_W, range, test);
  if (!hit) wide_grid_.for_each_along(origin_W, direction_W, range, test);
  if (!hit) moving_grid_.for_each_along(origin_W, direction_W, range, test);
  return !hit;
}

std::optional<RayHit> Scene::cast_ray_among(std::span<const std::uint32_t> candidates, const Eigen::Vector3d& origin_W,
                                            const Eigen::Vector3d& direction_W, double range) const {
  std::optional<RayHit> best;
  for (const std::uint32_t index : candidates)
    if (!ball(index).is_missed(origin_W, direction_W, best ? best->distance : range))
      improve(best, index, origin_W, direction_W, range);
  return best;
}

bool Scene::reaches(std::uint32_t large_solid, const Bounds& query) const {
  const auto* plane = std::get_if<description::Plane>(&solids_[large_solid].shape());
  if (plane == nullptr) return bounds_[large_solid].overlaps(query);
  const Eigen::Vector3d normal_W = solids_[large_solid].X_WC.orientation * plane->normal;
  const Eigen::Vector3d centre = 0.5 * (query.lower + query.upper);
  const Eigen::Vector3d half = 0.5 * (query.upper - query.lower);
  return normal_W.dot(centre - solids_[large_solid].X_WC.position) <= normal_W.cwiseAbs().dot(half);
}

}  // namespace cohort::geometry
