// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/scene_maker.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "server/viewing/scene_models.hpp"

namespace cohort::viewing {
namespace {

constexpr double full_orientation = 32767.0;

void append(std::vector<float>& to, const Eigen::Vector3d& vector) {
  for (const double part : vector) to.push_back(static_cast<float>(part));
}

std::int16_t packed(double part) {
  return static_cast<std::int16_t>(std::lround(std::clamp(part, -1.0, 1.0) * full_orientation));
}

void append(std::vector<std::int16_t>& to, const Eigen::Quaterniond& orientation) {
  for (const double part : orientation.coeffs()) to.push_back(std::isfinite(part) ? packed(part) : std::int16_t{0});
}

std::uint8_t byte_of(double part) { return static_cast<std::uint8_t>(std::lround(std::clamp(part, 0.0, 1.0) * 255.0)); }

}  // namespace

SceneMaker::SceneMaker(const Simulation& simulation, std::uint32_t revision)
    : simulation_(simulation),
      revision_(revision),
      objects_(simulation.objects().size()),
      place_in_model_(objects_),
      first_of_link_(simulation.description().models.size()) {
  const auto& models = simulation.description().models;
  std::vector<std::vector<std::uint32_t>> bodies_of_model(models.size());
  std::size_t count = 0;
  for (std::uint32_t body = 0; body < objects_; ++body) {
    const std::size_t model = simulation.world().model_of(BodyId{body});
    place_in_model_[body] = static_cast<std::uint32_t>(bodies_of_model[model].size());
    bodies_of_model[model].push_back(body);
    count += models[model].links.size();
  }
  links_.reserve(count);
  for (std::size_t model = 0; model < models.size(); ++model) {
    first_of_link_[model].reserve(models[model].links.size());
    for (std::uint32_t link = 0; link < models[model].links.size(); ++link) {
      first_of_link_[model].push_back(static_cast<std::uint32_t>(links_.size()));
      for (const std::uint32_t body : bodies_of_model[model]) links_.push_back({BodyId{body}, LinkId{link}});
    }
  }
  choose_lamps();
}

bool SceneMaker::is_outdated() const { return simulation_.objects().size() != objects_; }

// LEDs are also lamps for light sensors; they are shown only once.
void SceneMaker::choose_lamps() {
  const emission::Emitters& emitters = simulation_.emitters();
  std::vector<char> is_led(emitters.lamps().size(), 0);
  const description::World& world = simulation_.description();
  for (const std::size_t instance : world.robots) {
    if (simulation_.world().slot_of(BodyId{instance}) == physics::World::released) continue;
    const auto& devices = world.models[world.instances[instance].model].devices;
    for (std::size_t device = 0; device < devices.size(); ++device) {
      const auto lamps = std::ranges::count_if(description::emitters_of(devices[device]), [](const auto& emitter) {
        return std::holds_alternative<description::Light>(emitter.what);
      });
      if (lamps == 0) continue;
      const std::uint32_t first = emitters.of_device(BodyId{instance}, DeviceId{device}).lamp;
      std::fill_n(is_led.begin() + first, lamps, char{1});
    }
  }
  lamps_.reserve(is_led.size());
  for (std::uint32_t lamp = 0; lamp < is_led.size(); ++lamp)
    if (is_led[lamp] == 0) lamps_.push_back(lamp);
}

messages::SceneEmitter SceneMaker::emitter(const emission::Mount& mount) const {
  return {.entity = mount.body.value, .link = place_of(mount), .position = vector_of(mount.X_LE.position)};
}

void SceneMaker::add_entities(messages::Scene& scene) const {
  scene.entities.reserve(objects_);
  for (std::uint32_t body = 0; body < objects_; ++body)
    scene.entities.push_back(
        {simulation_.objects().name(body), static_cast<std::uint32_t>(simulation_.world().model_of(BodyId{body}))});
  const auto& robots = simulation_.description().robots;
  for (std::uint32_t robot = 0; robot < robots.size(); ++robot) scene.entities[robots[robot]].robot = robot;
  for (const description::Team& team : simulation_.experiment().teams)
    for (const std::uint32_t robot : team.robots) scene.entities[robots[robot]].team = team.name;
}

void SceneMaker::add_emitters(messages::Scene& scene) const {
  const emission::Emitters& emitters = simulation_.emitters();
  scene.lamps.reserve(lamps_.size());
  for (const std::uint32_t index : lamps_) {
    const emission::Lamp& lamp = emitters.lamp(index);
    messages::SceneEmitter shown = emitter(lamp.mount);
    if (lamp.light.kind != description::Light::Kind::point)
      shown.direction = vector_of(lamp.mount.X_LE.orientation * lamp.light.direction_E);
    shown.range = static_cast<float>(lamp.light.range);
    scene.lamps.push_back(shown);
  }
  scene.tones.reserve(emitters.tones().size());
  for (const emission::Tone& tone : emitters.tones()) {
    scene.tones.push_back(emitter(tone.mount));
    scene.tones.back().range = static_cast<float>(tone.sound.range);
  }
  scene.leds.reserve(emitters.markers().size());
  for (const emission::Marker& marker : emitters.markers()) scene.leds.push_back(emitter(marker.mount));
}

messages::Scene SceneMaker::scene() const {
  const description::World& world = simulation_.description();
  messages::Scene scene;
  scene.revision = revision_;
  scene.world = world.name;
  scene.step_ns = world.step.count();
  add_models(simulation_, scene);
  add_entities(scene);
  add_emitters(scene);
  return scene;
}

messages::SceneFrame SceneMaker::frame(std::uint32_t run, std::uint64_t state_hash) const {
  messages::SceneFrame frame;
  frame.revision = revision_;
  frame.run = run;
  frame.tick = simulation_.tick();
  frame.time_ns = simulation_.time().count();
  frame.state_hash = state_hash;
  for (std::uint32_t body = 0; body < objects_; ++body) {
    if (!simulation_.objects().is_present(body)) frame.absent.push_back(body);
    if (simulation_.objects().is_quarantined(body)) frame.quarantined.push_back(body);
  }
  frame.positions.reserve(3 * links_.size());
  frame.orientations.reserve(4 * links_.size());
  for (const PlacedLink& placed : links_) {
    const Pose X_WL = simulation_.world().link_pose(placed.body, placed.link);
    append(frame.positions, X_WL.position);
    append(frame.orientations, X_WL.orientation);
  }
  return frame;
}

messages::SceneSignals SceneMaker::signals() const {
  const emission::Emitters& emitters = simulation_.emitters();
  messages::SceneSignals signals;
  signals.revision = revision_;
  signals.lamps.reserve(4 * lamps_.size());
  for (const std::uint32_t index : lamps_) {
    const emission::Lamp& lamp = emitters.lamp(index);
    append(signals.lamps, lamp.light.color);
    const bool shines = lamp.is_on && emitters.is_in_world(lamp.mount);
    signals.lamps.push_back(shines ? static_cast<float>(lamp.light.intensity) : 0.0f);
  }
  signals.tones.reserve(2 * emitters.tones().size());
  for (const emission::Tone& tone : emitters.tones()) {
    const bool sounds = tone.is_on && emitters.is_in_world(tone.mount);
    signals.tones.push_back(static_cast<float>(tone.sound.frequency));
    signals.tones.push_back(sounds ? static_cast<float>(tone.sound.intensity) : 0.0f);
  }
  signals.leds.reserve(3 * emitters.markers().size());
  for (const emission::Marker& marker : emitters.markers()) {
    const bool shines = marker.is_on && emitters.is_in_world(marker.mount);
    for (const double part : marker.color) signals.leds.push_back(shines ? byte_of(part) : std::uint8_t{0});
  }
  return signals;
}

messages::SceneContacts SceneMaker::contacts() const {
  const double step = std::chrono::duration<double>(simulation_.description().step).count();
  const auto found = simulation_.world().contacts();
  messages::SceneContacts contacts;
  contacts.revision = revision_;
  contacts.positions.reserve(3 * found.size());
  contacts.forces.reserve(3 * found.size());
  contacts.entities.reserve(2 * found.size());
  for (const physics::Contact& contact : found) {
    append(contacts.positions, contact.position_W);
    append(contacts.forces, contact.normal_W * (contact.impulse / step));
    contacts.entities.push_back(contact.body_a.value);
    contacts.entities.push_back(contact.body_b.value);
  }
  const gripping::Grippers& grippers = simulation_.grippers();
  for (std::uint32_t gripper = 0; gripper < grippers.size(); ++gripper) {
    if (!grippers.is_gripping(gripper)) continue;
    append(contacts.grips, grippers.place(gripper));
    contacts.grips.push_back(static_cast<float>(grippers.force(gripper)));
  }
  return contacts;
}

messages::SceneRobot SceneMaker::robot(std::uint32_t robot) const {
  const auto observation = simulation_.observation(robot);
  const auto command = simulation_.command(robot);
  return {revision_,
          robot,
          simulation_.tick(),
          simulation_.time().count(),
          {observation.begin(), observation.end()},
          {command.begin(), command.end()}};
}

}  // namespace cohort::viewing
