// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "server/parsing/sdf/frames.hpp"

namespace cohort::parsing {
namespace {

bool is_reserved(const std::string& name) {
  return name == "world" || (name.size() >= 4 && name.starts_with("__") && name.ends_with("__"));
}

bool is_named_part(const Element& element) {
  constexpr std::string_view kinds[] = {"collision", "visual", "sensor", "light"};
  return std::ranges::find(kinds, element.name()) != std::end(kinds);
}

std::string already_used(const std::string& name) {
  return "the name '" + name + "' is already used; names must be unique within their parent element";
}

// Names of parts of a link or of sensors of a joint.
void check_parts(const Element& around, std::vector<Frames::Flaw>& flaws) {
  std::set<std::pair<std::string, std::string>> names;
  for (const Element* const part : around.children()) {
    const std::string name = name_of(*part);
    if (!is_named_part(*part) || name.empty()) continue;
    if (is_reserved(name)) flaws.emplace_back(part, "the name '" + name + "' is reserved; choose another name");
    if (!names.emplace(part->name(), name).second) flaws.emplace_back(part, already_used(name));
  }
}

}  // namespace

/// Steps from frame to frame.
class Frames::Steps {
 public:
  using IsEnd = std::function<bool(const Place&)>;
  using Next = std::function<std::optional<Place>(const Place&)>;

  Steps(IsEnd is_end, Next next) : is_end_(std::move(is_end)), next_(std::move(next)) {}

  /// Returns whether the steps from a place reach an end. Takes no step twice.
  bool end(Place place) {
    std::set<Key> passed;
    while (!is_end_(place) && !ending_.contains({place.scope, place.element})) {
      const std::optional<Place> next = next_(place);
      if (!passed.insert({place.scope, place.element}).second || !next) return false;
      place = *next;
    }
    ending_.merge(passed);
    return true;
  }

 private:
  using Key = std::pair<const Frames*, const Element*>;

  IsEnd is_end_;
  Next next_;
  std::set<Key> ending_;
};

std::vector<Frames::Flaw> Frames::flaws() const {
  std::vector<Flaw> found;
  check(found);
  if (found.empty()) check_resolution(found);
  return found;
}

void Frames::check(std::vector<Flaw>& flaws) const {
  check_names(flaws);
  check_references(flaws);
  for (const auto* const element : elements_)
    if (const Frames* const inner = of(*element)) inner->check(flaws);
}

void Frames::check_names(std::vector<Flaw>& flaws) const {
  for (const Element* const element : elements_) {
    const std::string name = name_of(*element);
    if (name.empty()) continue;  // reported elsewhere
    if (is_reserved(name)) flaws.emplace_back(element, "the name '" + name + "' is reserved; choose another name");
    const Element& first = *by_name_.at(name);
    const bool is_model_of_world = is_world() && element->name() == "model" && first.name() == "model";
    if (&first != element && !is_model_of_world)
      flaws.emplace_back(element, first.name() == element->name()
                                      ? already_used(name)
                                      : "another element of the " + owner_.name() + " has the name '" + name +
                                            "'; names must be unique within a " + owner_.name());
    if (element->name() == "link" || element->name() == "joint") check_parts(*element, flaws);
  }
  if (is_world()) check_parts(owner_, flaws);
}

void Frames::check_reference(const Element& element, const std::string& attribute, const std::string& name,
                             std::vector<Flaw>& flaws) const {
  if (name.empty()) return;
  if (!is_named_part(element) && name == name_of(element))
    flaws.emplace_back(&element, "'" + name + "' refers to itself; expected another frame");
  else if (!find(name))
    flaws.emplace_back(&element, attribute + " refers to a frame '" + name + "' that does not exist");
}

void Frames::check_references(std::vector<Flaw>& flaws) const {
  if (outer_ == nullptr && !relative_to(owner_).empty())
    flaws.emplace_back(owner_.child("pose"), "the pose of a model at the top level cannot have 'relative_to'");
  if (const std::string link = owner_.attribute("canonical_link"); !link.empty() && !find(link))
    flaws.emplace_back(&owner_, "there is no link or frame '" + link + "' in the model");
  if (const std::string frame = owner_.attribute("placement_frame"); !frame.empty() && !find(frame))
    flaws.emplace_back(&owner_, "there is no link or frame '" + frame + "' in the model");
  for (const Element* const element : elements_) {
    check_reference(*element, "relative_to", relative_to(*element), flaws);
    if (element->name() == "frame") check_reference(*element, "attached_to", element->attribute("attached_to"), flaws);
    if (element->name() == "joint") check_joint(*element, flaws);
    if (element->name() != "link") continue;
    for (const Element* const part : element->children())
      if (is_named_part(*part)) check_reference(*part, "relative_to", relative_to(*part), flaws);
  }
  if (!is_world()) return;
  for (const Element* const light : children_of(owner_, "light"))
    check_reference(*light, "relative_to", relative_to(*light), flaws);
}

void Frames::check_joint(const Element& joint, std::vector<Flaw>& flaws) const {
  const std::string name = name_of(joint);
  const std::string parent = joint.text("parent");
  const std::string child = joint.text("child");
  if (parent.empty() || child.empty()) return;  // reported elsewhere
  const auto flaw = [&](std::string message) { flaws.emplace_back(&joint, std::move(message)); };
  if (parent == name || child == name)
    return flaw("the joint '" + name + "' refers to itself; expected a link or another frame");
  if (child == "world") return flaw("the child of the joint '" + name + "' must be a link of the model");
  if (parent == child) return flaw("expected two different links as parent and child");
  for (const std::string& end : {parent, child})
    if (end != "world" && !find(end)) return flaw("there is no link or frame '" + end + "' in the model");
}

// All names are right, so what cannot be resolved is a cycle.
void Frames::check_resolution(std::vector<Flaw>& flaws) const {
  Steps posed([this](const Place& place) { return place.element == nullptr && place.scope == this; },
              [](const Place& place) { return place.scope->posed_in(place); });
  Steps attached(
      [](const Place& place) {
        return place.element == nullptr ? place.scope->is_world() : place.element->name() == "link";
      },
      [](const Place& place) { return place.scope->attached_to(place); });
  for (const Element* const element : elements_) {
    const bool is_attached = element->name() == "frame" && !element->attribute("attached_to").empty();
    if (posed.end({this, element}) && (!is_attached || attached.end({this, element}))) continue;
    flaws.emplace_back(element, "frames refer to each other in a cycle");
    return;
  }
  for (const Element* const element : elements_)
    if (const Frames* const inner = of(*element)) inner->check_resolution(flaws);
}

}  // namespace cohort::parsing
