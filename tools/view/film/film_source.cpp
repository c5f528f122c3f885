// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/film_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/description/select_robots.hpp"

namespace cohort::film {
namespace {

constexpr double full_scale = 32767.0;  // scale of orientations in a frame

// Returns the objects with this name, of which the first parts may be left out.
std::vector<std::uint32_t> objects_named(const std::string& name, const Objects& objects) {
  if (const auto object = objects.find(name)) return {*object};
  std::vector<std::uint32_t> found;
  for (std::uint32_t object = 0; object < objects.size(); ++object)
    if (objects.name(object).ends_with("/" + name)) found.push_back(object);
  return found;
}

// Returns the objects that a name refers to: a team, an object, or robots as other commands select them. Throws
// std::invalid_argument if there are none.
std::vector<std::uint32_t> objects_called(const std::string& name, const description::Experiment& experiment,
                                          const Simulation& simulation) {
  std::vector<std::uint32_t> robots;
  const auto team = std::ranges::find(experiment.teams, name, &description::Team::name);
  if (team != experiment.teams.end()) {
    robots = team->robots;
  } else if (auto objects = objects_named(name, simulation.objects()); !objects.empty()) {
    return objects;
  } else {
    robots = description::select_robots(experiment.world, name);
  }
  std::vector<std::uint32_t> objects;
  for (const std::uint32_t robot : robots)
    if (robot < simulation.robot_count()) objects.push_back(simulation.body_of(robot).value);
  return objects;
}

Eigen::Vector4d orientation_in(const messages::SceneFrame& frame, std::size_t link) {
  Eigen::Vector4d q;
  for (std::size_t i = 0; i < 4; ++i) q[static_cast<Eigen::Index>(i)] = frame.orientations[4 * link + i];
  return q;
}

}  // namespace

messages::SceneFrame interpolated(const messages::SceneFrame& first, const messages::SceneFrame& second, double share) {
  messages::SceneFrame frame = first;
  for (std::size_t i = 0; i < frame.positions.size(); ++i)
    frame.positions[i] = static_cast<float>(
        std::lerp(static_cast<double>(first.positions[i]), static_cast<double>(second.positions[i]), share));
  for (std::size_t link = 0; 4 * link < frame.orientations.size(); ++link) {
    const Eigen::Vector4d a = orientation_in(first, link);
    const Eigen::Vector4d b = orientation_in(second, link);
    const Eigen::Vector4d q = (1.0 - share) * a + (a.dot(b) < 0.0 ? -share : share) * b;
    const double length = q.norm();
    if (length > 0.0)
      for (std::size_t i = 0; i < 4; ++i)
        frame.orientations[4 * link + i] =
            static_cast<std::int16_t>(std::lround(full_scale * q[static_cast<Eigen::Index>(i)] / length));
  }
  return frame;
}

FilmSource::FilmSource(const recording::Recording& recording, view::Topics& topics, Options options)
    : options_(std::move(options)), recording_(recording), replay_(recording, options_.threads), publisher_(topics) {}

void FilmSource::ask(const view::ViewRequest&, std::function<void(const view::Answer&)> answer) {
  answer({false, "a film of this recording is being made"});
}

void FilmSource::go_to(Nanoseconds log_time) {
  time_ = log_time;
  if (!has_begun_) begin(log_time);
  while (!is_at_end_ && log_time_ <= log_time) {
    // Boundaries that are surely not the last one before `log_time` are not looked at.
    const Nanoseconds step = replay_.experiment().world.step;
    if (log_time_ + 2 * step > log_time) keep();
    is_at_end_ = !advance();
  }
  interpolate();
}

// Begins at the last world or snapshot that is not after `log_time`.
void FilmSource::begin(Nanoseconds log_time) {
  Nanoseconds start = recording_.worlds().front().log_time;
  for (const auto& world : recording_.worlds())
    if (world.log_time <= log_time) start = std::max(start, world.log_time);
  for (const Nanoseconds snapshot : recording_.snapshots())
    if (snapshot <= log_time) start = std::max(start, snapshot);
  has_begun_ = true;
  is_at_end_ = !replay_.seek(start);
  if (is_at_end_) throw std::invalid_argument("the recording contains no tick");
  prepare_world();
  keep();
}

bool FilmSource::advance() {
  next_.reset();
  if (!replay_.advance()) return false;
  log_time_ = replay_.recorded().log_time;
  if (replay_.recorded().begins) prepare_world();
  return true;
}

void FilmSource::prepare_world() {
  log_time_ = replay_.recorded().log_time;
  if (replay_.recorded().begins) run_ = replay_.recorded().begins->run;
  is_new_world_ = true;
  followed_objects_.clear();
  if (!options_.follow.empty())
    followed_objects_ = objects_called(options_.follow, replay_.experiment(), replay_.simulation());
}

// Notes the boundary of the replay, and publishes its scene if that is new.
void FilmSource::keep() {
  const Simulation& simulation = replay_.simulation();
  if (std::exchange(is_new_world_, false) || !maker_ || maker_->is_outdated()) {
    const std::int64_t stamp = next_stamp();
    const std::uint32_t revision =
        publisher_.show(viewing::SceneMaker(simulation, 0).scene(), std::chrono::nanoseconds(stamp));
    if (std::exchange(revision_, revision) != revision) scene_stamp_ = stamp;
    maker_.emplace(simulation, revision);
  }
  kept_ = moment();
  signals_ = maker_->signals();
  if (options_.shows_contacts) contacts_ = maker_->contacts();
}

FilmSource::Moment FilmSource::moment() const {
  return {log_time_, maker_->frame(run_, replay_.recorded().state_hash.value_or(0)), find_followed()};
}

std::optional<FilmSource::Followed> FilmSource::find_followed() const {
  const Simulation& simulation = replay_.simulation();
  Followed found;
  std::vector<Eigen::Vector3d> places;
  for (const std::uint32_t object : followed_objects_)
    if (simulation.objects().is_present(object)) places.push_back(simulation.object_pose(object).position);
  if (places.empty()) return std::nullopt;
  for (const Eigen::Vector3d& place : places) found.centre += place / static_cast<double>(places.size());
  for (const Eigen::Vector3d& place : places) found.radius = std::max(found.radius, (place - found.centre).norm());
  return found;
}

void FilmSource::interpolate() {
  shown_ = kept_;
  const bool is_between = kept_.log_time < time_ && !is_at_end_ && log_time_ > time_;
  if (!is_between || is_new_world_ || maker_->is_outdated()) return;
  if (!next_) next_ = moment();
  // Objects that come or go have no place between.
  if (next_->frame.absent != kept_.frame.absent || next_->frame.positions.size() != kept_.frame.positions.size())
    return;
  using Seconds = std::chrono::duration<double>;
  const double share = Seconds(time_ - kept_.log_time) / Seconds(next_->log_time - kept_.log_time);
  shown_.frame = interpolated(kept_.frame, next_->frame, share);
  if (kept_.followed && next_->followed) {
    shown_.followed->centre += share * (next_->followed->centre - kept_.followed->centre);
    shown_.followed->radius = std::lerp(kept_.followed->radius, next_->followed->radius, share);
  }
}

std::vector<Stamp> FilmSource::show() {
  const std::int64_t stamp = next_stamp();
  const std::chrono::nanoseconds time(stamp);
  std::vector<Stamp> stamps = {{view::Topic::frame, stamp}, {view::Topic::signals, stamp}};
  publisher_.publish(view::Topic::signals, signals_, time);
  if (options_.shows_contacts) {
    publisher_.publish(view::Topic::contacts, contacts_, time);
    stamps.push_back({view::Topic::contacts, stamp});
  }
  publisher_.publish(view::Topic::frame, shown_.frame, time);
  return stamps;
}

}  // namespace cohort::film
