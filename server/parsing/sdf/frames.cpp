// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/frames.hpp"

#include <utility>

#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

constexpr std::string_view own_frame = "__model__";

// More steps from frame to frame than this are a cycle: no file has so many frames.
constexpr int most_steps = 100'000;

bool has_frame(const Element& element) {
  const std::string& name = element.name();
  return name == "link" || name == "joint" || name == "frame" || name == "model";
}

}  // namespace

std::string relative_to(const Element& posed) {
  const Element* const pose = posed.child("pose");
  return pose != nullptr ? pose->attribute("relative_to") : "";
}

Frames::Frames(const Element& owner, const Frames* outer) : owner_(owner), outer_(outer) {
  for (const Element* const child : owner.children()) {
    if (!has_frame(*child)) continue;
    elements_.push_back(child);
    by_name_.emplace(name_of(*child), child);
    if (child->name() == "model") nested_.emplace(child, std::make_unique<Frames>(*child, this));
  }
}

const Frames* Frames::of(const Element& model) const {
  const auto found = nested_.find(&model);
  return found == nested_.end() ? nullptr : found->second.get();
}

std::optional<Frames::Place> Frames::find(std::string_view name) const {
  if (name == own_frame || (is_world() && name == "world")) return Place{this, nullptr};
  const auto found = by_name_.find(name);
  if (found != by_name_.end()) return Place{this, found->second};
  for (std::size_t end = name.find("::"); end != std::string_view::npos; end = name.find("::", end + 1)) {
    const auto model = by_name_.find(name.substr(0, end));
    if (model != by_name_.end() && model->second->name() == "model")
      return nested_.at(model->second)->find(name.substr(end + 2));
  }
  return std::nullopt;
}

std::optional<Frames::Place> Frames::written_in(const Place& place) const {
  const Element& element = *place.element;
  if (const std::string name = relative_to(element); !name.empty()) return place.scope->find(name);
  if (element.name() == "joint") return place.scope->find(element.text("child"));
  const std::string attached = element.name() == "frame" ? element.attribute("attached_to") : "";
  return attached.empty() ? Place{place.scope, nullptr} : place.scope->find(attached);
}

std::optional<Pose> Frames::written_pose_of(const Place& place) const {
  const Element* const pose = place.element->child("pose");
  // A pose that cannot be read is reported elsewhere.
  const Pose written = pose != nullptr ? written_pose(pose->node()).value_or(Pose{}) : Pose{};
  const std::string placed =
      place.element->name() == "model" ? place.element->attribute("placement_frame") : std::string();
  if (placed.empty()) return written;
  const std::optional<Pose> X_MP = place.scope->of(*place.element)->pose_of(placed);
  return X_MP ? std::optional(written * X_MP->inverse()) : std::nullopt;
}

const Frames::Step& Frames::step_from(const Place& place) const {
  auto& steps = place.scope->steps_;
  const auto known = steps.find(place.element);
  if (known != steps.end()) return known->second;
  Step step{written_pose_of(place), written_in(place)};
  return steps.emplace(place.element, std::move(step)).first->second;
}

std::optional<Frames::Place> Frames::posed_in(const Place& place) const {
  if (place.element != nullptr) return step_from(place).written ? step_from(place).next : std::nullopt;
  return outer_ == nullptr ? std::nullopt : std::optional(Place{outer_, &owner_});
}

// Goes from the frame to the one in which it is written, and so on, out of nested models.
std::optional<Pose> Frames::pose_at(Place place) const {
  Pose X;
  for (int steps = 0; steps < most_steps; ++steps) {
    if (place.element == nullptr) {
      if (place.scope == this) return X;
      if (place.scope->outer_ == nullptr) return std::nullopt;
      place = {place.scope->outer_, &place.scope->owner_};
    }
    const Step& step = step_from(place);
    if (!step.written || !step.next) return std::nullopt;
    X = *step.written * X;
    place = *step.next;
  }
  return std::nullopt;
}

std::optional<Pose> Frames::pose_of(const std::string& name) const {
  const std::optional<Place> place = find(name);
  return place ? pose_at(*place) : std::nullopt;
}

std::optional<Pose> Frames::pose(const Element& posed, const std::string& in) const {
  const bool is_here = has_frame(posed) || posed.parent() == &owner_;
  const std::string around = is_here ? std::string(own_frame) : name_of(*posed.parent());
  const std::string target = in.empty() ? around : in;
  const std::string written_in_name = relative_to(posed);
  const Element* const pose = posed.child("pose");
  std::optional<Pose> written = pose != nullptr ? written_pose(pose->node()) : Pose{};
  if (!written) return std::nullopt;
  const bool is_placed = posed.name() == "model" && !posed.attribute("placement_frame").empty();
  if (in.empty() && written_in_name.empty() && !is_placed && posed.name() != "joint" && posed.name() != "frame")
    return written;
  std::optional<Pose> X = has_frame(posed) ? pose_at({this, &posed}) : std::nullopt;
  if (!has_frame(posed)) {
    const std::optional<Pose> from_pose = pose_of(written_in_name.empty() ? around : written_in_name);
    if (from_pose) X = *from_pose * *written;
  }
  if (!X || target == own_frame) return X;
  const std::optional<Pose> in_pose = pose_of(target);
  return in_pose ? std::optional(in_pose->inverse() * *X) : std::nullopt;
}

std::optional<Eigen::Vector3d> Frames::direction(const Eigen::Vector3d& vector, const std::string& from,
                                                 const std::string& in) const {
  const std::optional<Pose> from_pose = pose_of(from);
  const std::optional<Pose> in_pose = pose_of(in);
  if (!from_pose || !in_pose) return std::nullopt;
  return (in_pose->inverse() * *from_pose).orientation * vector;
}

std::optional<Frames::Place> Frames::attached_to(const Place& place) const {
  if (place.element == nullptr) {  // a model is attached to its canonical link
    const Frames& scope = *place.scope;
    if (const std::string link = scope.owner_.attribute("canonical_link"); !link.empty()) return scope.find(link);
    for (const Element* const each : scope.elements_)
      if (each->name() == "link") return Place{&scope, each};
    for (const Element* const each : scope.elements_)
      if (each->name() == "model")
        if (const auto found = attached_to({scope.of(*each), nullptr})) return found;
    return std::nullopt;
  }
  const Element& element = *place.element;
  if (element.name() == "model") return Place{place.scope->of(element), nullptr};
  if (element.name() == "joint") return place.scope->find(element.text("child"));
  const std::string name = element.attribute("attached_to");
  return name.empty() ? Place{place.scope, nullptr} : place.scope->find(name);
}

std::string Frames::name_from_here(const Place& place) const {
  std::string name = name_of(*place.element);
  for (const Frames* scope = place.scope; scope != this && scope->outer_ != nullptr; scope = scope->outer_)
    name.insert(0, name_of(scope->owner_) + "::");
  return name;
}

std::optional<std::string> Frames::link_of(const std::string& name) const {
  std::optional<Place> place = find(name);
  for (int steps = 0; place && steps < most_steps; ++steps) {
    if (place->element == nullptr && place->scope->is_world()) return "world";
    if (place->element != nullptr && place->element->name() == "link") return name_from_here(*place);
    place = attached_to(*place);
  }
  return std::nullopt;
}

}  // namespace cohort::parsing
