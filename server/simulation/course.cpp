#include "server/simulation/course.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cohort {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

}  // namespace

Course::Course(const description::Experiment& experiment, physics::World& world, Objects& objects)
    : experiment_(experiment), world_(world), objects_(objects), boundaries_held_(experiment.stops.size(), 0) {
  for (const description::Event& event : experiment.events)
    event_ticks_.push_back(event.time.count() == 0 ? 0 : ticks_of(event.time, experiment.world.step));
}

std::vector<std::string> Course::begin_tick(std::uint64_t tick) {
  std::vector<std::string> happened;
  for (; next_event_ < event_ticks_.size() && event_ticks_[next_event_] <= tick; ++next_event_)
    happened.push_back(act(experiment_.events[next_event_]));
  return happened;
}

std::string Course::act(const description::Event& event) {
  const auto object = static_cast<std::uint32_t>(event.object);
  std::string text = event.kind + " '" + objects_.name(object) + "'";
  try {
    std::visit(Overloaded{
                   [&](const description::SetPresence& presence) { objects_.set_present(object, presence.present); },
                   [&](const description::PlaceAt& place) { world_.place_body(object, place.X_WM); },
                   [&](const description::SetVelocity& velocity) {
                     if (world_.is_active(object))
                       world_.set_root_twist(object, {velocity.angular_W, velocity.linear_W});
                   },
                   [](const description::ApplyForce&) {},  // acts in the steps that follow
               },
               event.action);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(text + ": " + error.what());
  }
  return text;
}

void Course::push(std::uint64_t tick) {
  for (std::size_t i = 0; i < next_event_; ++i) {
    const auto* const force = std::get_if<description::ApplyForce>(&experiment_.events[i].action);
    const auto object = static_cast<std::uint32_t>(experiment_.events[i].object);
    if (force == nullptr || !world_.is_active(object)) continue;
    if (tick < event_ticks_[i] + ticks_of(force->duration, experiment_.world.step))
      world_.push_body(object, force->link, {force->force_W, force->torque_W});
  }
}

void Course::check_stops() {
  for (std::size_t i = 0; i < boundaries_held_.size() && !stop_reason_; ++i) {
    const description::StopCondition& condition = experiment_.stops[i];
    const std::optional<std::string> reason = why_it_holds(condition);
    boundaries_held_[i] = reason ? boundaries_held_[i] + 1 : 0;
    const std::uint64_t needed =
        condition.holds_for.count() == 0 ? 0 : ticks_of(condition.holds_for, experiment_.world.step);
    if (boundaries_held_[i] > needed) stop_reason_ = condition.name + ": " + *reason;
  }
}

std::optional<std::string> Course::why_it_holds(const description::StopCondition& condition) const {
  std::vector<std::uint32_t> present;
  for (const std::size_t object : condition.objects)
    if (objects_.is_present(static_cast<std::uint32_t>(object))) present.push_back(static_cast<std::uint32_t>(object));
  const auto first = [&](const auto& holds) -> std::optional<std::string> {
    const auto found = std::find_if(present.begin(), present.end(), holds);
    if (found == present.end()) return std::nullopt;
    return "'" + objects_.name(*found) + "'";
  };
  const auto all = [&](const auto& holds) -> std::optional<std::string> {
    if (present.empty() || !std::all_of(present.begin(), present.end(), holds)) return std::nullopt;
    return std::to_string(present.size()) + (present.size() == 1 ? " object" : " objects");
  };
  const auto place = [&](std::uint32_t object) -> Eigen::Vector2d {
    return world_.link_pose(object, 0).position.head<2>();
  };
  return std::visit(
      Overloaded{
          [&](const description::AllInside& inside) {
            return all([&](std::uint32_t object) {
              const Eigen::Vector2d point = place(object);
              return (point.array() >= inside.lower.array()).all() && (point.array() <= inside.upper.array()).all();
            });
          },
          [&](const description::OneBeyond& line) {
            return first([&](std::uint32_t object) { return line.direction.dot(place(object) - line.point) > 0.0; });
          },
          [&](const description::AllAtRest& rest) {
            return all([&](std::uint32_t object) {
              const physics::Twist twist = world_.link_twist(object, 0);
              return twist.linear_W.norm() < rest.speed && twist.angular_W.norm() < rest.turn_rate;
            });
          },
          [&](const description::OneQuarantined&) {
            return first([&](std::uint32_t object) { return objects_.is_quarantined(object); });
          },
      },
      condition.what);
}

void Course::hash(StateHash& hash) const {
  for (const std::uint64_t held : boundaries_held_) hash.add(held);
}

void Course::save(SnapshotWriter& writer) const {
  writer.add_count(boundaries_held_.size());
  writer.add_all(boundaries_held_.data(), boundaries_held_.size());
  const std::string reason = stop_reason_.value_or("");
  writer.add_count(reason.size());
  writer.add_all(reason.data(), reason.size());
}

void Course::restore(SnapshotReader& reader, std::uint64_t tick) {
  reader.expect_count(boundaries_held_.size(), "stop conditions");
  reader.read_all(boundaries_held_.data(), boundaries_held_.size());
  std::string reason(reader.read_count(1), ' ');
  reader.read_all(reason.data(), reason.size());
  stop_reason_.reset();
  if (!reason.empty()) stop_reason_ = std::move(reason);
  next_event_ =
      static_cast<std::size_t>(std::upper_bound(event_ticks_.begin(), event_ticks_.end(), tick) - event_ticks_.begin());
}

}  // namespace cohort
