// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/free_bodies.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/plugins/plugin.hpp"

namespace cohort::parsing {
namespace {

template <class Visit>
bool any_word_below(const Element* element, const Visit& visit) {
  const std::string text = text_of_parameter(element);
  for (const std::string_view word : words(text))
    if (visit(std::string(word))) return true;
  return std::ranges::any_of(element->children(), [&](const Element* child) { return any_word_below(child, visit); });
}

}  // namespace

// Links that joints or couplings connect get the number of the first of them; then the numbers in use are counted.
FreeBodies::FreeBodies(const Model& model) : body_of_link_(model.links.size()) {
  for (std::size_t link = 0; link < model.links.size(); ++link) body_of_link_[link] = link;
  const auto join = [&](std::size_t parent, std::size_t child) {
    if (parent == Joint::world) return;
    const std::size_t one = body_of_link_[parent];
    const std::size_t two = body_of_link_[child];
    for (std::size_t& body : body_of_link_)
      if (body == one || body == two) body = std::min(one, two);
  };
  for (const Joint& joint : model.joints) join(joint.parent, joint.child);
  for (const Joint& joint : model.loop_joints) join(joint.parent, joint.child);
  for (const Coupling& coupling : model.couplings)
    join(model.joints[coupling.leader].child, model.joints[coupling.follower].child);
  for (std::size_t link = 0; link < body_of_link_.size(); ++link)
    body_of_link_[link] = body_of_link_[link] == link ? count_++ : body_of_link_[body_of_link_[link]];
}

Model FreeBodies::body(std::size_t number, const Model& model) const {
  if (count_ <= 1) return model;
  Model body;
  body.name = model.name;
  body.may_sleep = model.may_sleep;
  body.self_collide = model.self_collide;
  std::vector<std::size_t> place(model.links.size());
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    if (body_of_link_[link] != number) continue;
    place[link] = body.links.size();
    body.links.push_back(model.links[link]);
  }
  std::vector<std::size_t> place_of_joint(model.joints.size());
  const auto add_joint = [&](Joint joint, std::vector<Joint>& joints) {
    if (body_of_link_[joint.child] != number) return;
    if (joint.parent != Joint::world) joint.parent = place[joint.parent];
    joint.child = place[joint.child];
    joints.push_back(std::move(joint));
  };
  for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
    place_of_joint[joint] = body.joints.size();
    add_joint(model.joints[joint], body.joints);
  }
  for (const Joint& joint : model.loop_joints) add_joint(joint, body.loop_joints);
  for (Coupling coupling : model.couplings) {
    if (body_of_link_[model.joints[coupling.follower].child] != number) continue;
    coupling.follower = place_of_joint[coupling.follower];
    coupling.leader = place_of_joint[coupling.leader];
    body.couplings.push_back(coupling);
  }
  const auto add_parts = [&](const auto& parts, auto& its_parts) {
    for (const auto& part : parts) {
      if (body_of_link_[part.link] != number) continue;
      its_parts.push_back(part);
      its_parts.back().link = place[part.link];
    }
  };
  add_parts(model.emitters, body.emitters);
  add_parts(model.grip_rings, body.grip_rings);
  add_parts(model.fins, body.fins);
  add_parts(model.drags, body.drags);
  return body;
}

std::optional<std::size_t> FreeBodies::body_of_name(const Model& model, const std::string& name) const {
  for (const Joint& joint : model.joints)
    if (joint.name == name) return body_of_link_[joint.child];
  for (std::size_t link = 0; link < model.links.size(); ++link)
    if (model.links[link].name == name) return body_of_link_[link];
  return std::nullopt;
}

// Returns the body of the first link or joint that the element names; if it names none, that of the model that contains
// it.
std::size_t FreeBodies::body_of_element(const Model& model, const Element* element, const std::string& prefix) const {
  std::optional<std::size_t> found;
  any_word_below(element, [&](const std::string& word) {
    found = body_of_name(model, prefix + word);
    return found.has_value();
  });
  if (found) return *found;
  for (std::size_t link = 0; link < model.links.size(); ++link)
    if (model.links[link].name.starts_with(prefix)) return body_of_link_[link];
  return 0;
}

std::vector<std::vector<DeviceScope>> FreeBodies::scopes(const Model& model,
                                                         const std::vector<DeviceScope>& scopes) const {
  if (count_ <= 1) return {scopes};
  std::vector<std::vector<DeviceScope>> of_bodies(count_);
  for (const DeviceScope& scope : scopes) {
    std::map<std::size_t, std::set<const Element*>> devices;  // by body
    for (const Element* const child : scope.model_element->children())
      if (has_prefix(child->name()) || child->name() == "plugin")
        devices[body_of_element(model, child, scope.prefix)].insert(child);
    if (devices.empty()) of_bodies.front().push_back(scope);
    for (const auto& [body, its_own] : devices) {
      DeviceScope& added = of_bodies[body].emplace_back(scope);
      for (const auto& [other, elements] : devices)
        if (other != body) added.elsewhere.insert(elements.begin(), elements.end());
    }
  }
  return of_bodies;
}

std::vector<SensorPlace> FreeBodies::sensors_of(std::size_t number, const Model& model,
                                                const std::vector<SensorPlace>& sensors) const {
  std::vector<SensorPlace> its_sensors;
  for (const SensorPlace& sensor : sensors)
    if (count_ <= 1 || body_of_name(model, sensor.owner).value_or(0) == number) its_sensors.push_back(sensor);
  return its_sensors;
}

}  // namespace cohort::parsing
