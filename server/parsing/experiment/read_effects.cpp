// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_effects.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>

#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"

namespace cohort::parsing {
namespace {

/// Reads the effect of a kind of event on one object; returns nothing, and reports it, if the effect is impossible.
using ReadEffect = std::optional<Effect> (*)(const ScheduleEntry& entry, const World& world, std::size_t object);

std::optional<Effect> read_add(const ScheduleEntry&, const World&, std::size_t) { return SetPresence{true, true}; }
std::optional<Effect> read_remove(const ScheduleEntry&, const World&, std::size_t) { return SetPresence{false, true}; }
std::optional<Effect> read_disable(const ScheduleEntry&, const World&, std::size_t) { return SetPresence{false}; }
std::optional<Effect> read_enable(const ScheduleEntry&, const World&, std::size_t) { return SetPresence{true}; }

std::optional<Effect> read_move(const ScheduleEntry& entry, const World&, std::size_t) {
  if (!entry.values().has("pose")) return std::nullopt;
  return PlaceAt{entry.values().pose("pose")};
}

// Returns whether the object can move; reports it if not.
bool can_be_pushed(const ScheduleEntry& entry, const World& world, std::size_t object) {
  const Model& model = world.models[world.instances[object].model];
  const char* const why = model.why_fixed();
  if (why == nullptr) return true;
  entry.problem("objects", "'" + world.instances[object].name + "' " + why);
  return false;
}

std::optional<Effect> read_set_velocity(const ScheduleEntry& entry, const World& world, std::size_t object) {
  const KeyValues& values = entry.values();
  if (!values.has("linear") || !values.has("angular") || !can_be_pushed(entry, world, object)) return std::nullopt;
  return SetVelocity{values.vector("linear"), values.vector("angular")};
}

std::optional<Effect> read_apply_force(const ScheduleEntry& entry, const World& world, std::size_t object) {
  const KeyValues& values = entry.values();
  const std::optional<std::chrono::nanoseconds> duration = entry.time("for");
  const Model& model = world.models[world.instances[object].model];
  if (!values.has("force") || !values.has("torque") || !duration) return std::nullopt;
  if (model.is_static) {
    entry.problem("objects", "'" + world.instances[object].name + "' is static");
    return std::nullopt;
  }
  std::size_t link = 0;
  if (values.has("link")) {
    std::vector<std::string> names;
    for (const Link& each : model.links) names.push_back(each.name);
    link = static_cast<std::size_t>(std::find(names.begin(), names.end(), values.text("link")) - names.begin());
    if (link == names.size()) {
      entry.problem("link", "'" + world.instances[object].name + "' has no link '" + values.text("link") + "'" +
                                suggestion(values.text("link"), names));
      return std::nullopt;
    }
  }
  return ApplyForce{link, values.vector("force"), values.vector("torque"), *duration};
}

// ---- Emitters ----

/// A key that changes something of some kinds of emitters.
struct EmitterKey {
  const char* name;
  bool (*fits)(const Emitter& emitter);
  const char* owner;
};

template <class... Kinds>
bool is_any_of(const Emitter& emitter) {
  return (std::holds_alternative<Kinds>(emitter.what) || ...);
}

constexpr EmitterKey emitter_keys[] = {
    {"on", &is_any_of<Light, Sound, Marker, ClimateSource>, "any emitter"},
    {"intensity", &is_any_of<Light, Sound>, "a light or a sound"},
    {"frequency", &is_any_of<Sound>, "a sound"},
    {"color", &is_any_of<Light, Marker>, "a light or a marker"},
    {"temperature", &is_any_of<ClimateSource>, "a climate_source"},
    {"humidity", &is_any_of<ClimateSource>, "a climate_source"},
};

EmitterChange read_change(const ScheduleEntry& entry) {
  const KeyValues& values = entry.values();
  EmitterChange change;
  if (values.has("on")) change.is_on = values.flag("on");
  if (values.has("intensity")) change.intensity = values.real("intensity");
  if (values.has("frequency")) change.frequency = values.real("frequency");
  if (values.has("color")) {
    change.color = values.vector("color");
    if ((change.color->array() < 0.0).any() || (change.color->array() > 1.0).any())
      entry.problem("color", "expected red, green and blue from 0 to 1");
  }
  if (values.has("temperature")) change.temperature = values.real("temperature");
  if (values.has("humidity")) change.humidity = values.real("humidity");
  return change;
}

void check_change(const ScheduleEntry& entry, const std::vector<const Emitter*>& chosen) {
  bool has_any = false;
  for (const EmitterKey& key : emitter_keys) {
    if (!entry.is_written(key.name)) continue;
    has_any = true;
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Emitter* emitter) { return key.fits(*emitter); }))
      entry.problem(key.name, std::string("applies to ") + key.owner + ", but no such emitter is selected");
  }
  if (!has_any) entry.problem("missing: a value to change, such as 'on: false'");
}

std::vector<std::pair<std::size_t, Effect>> read_set_emitter(const ScheduleEntry& entry, const World& world,
                                                             const std::vector<std::size_t>& objects) {
  if (objects.empty()) return {};
  const std::vector<std::string> selectors = entry.values().texts("emitter");
  std::vector<char> selects(selectors.size(), 0);
  std::vector<std::pair<std::size_t, Effect>> effects;
  std::vector<const Emitter*> chosen;
  std::vector<std::string> names;
  const EmitterChange change = read_change(entry);
  for (const std::size_t object : objects) {
    const std::vector<Emitter>& emitters = world.models[world.instances[object].model].emitters;
    SetEmitters effect{{}, change};
    for (std::size_t i = 0; i < emitters.size(); ++i) {
      bool is_chosen = false;
      for (std::size_t selector = 0; selector < selectors.size(); ++selector) {
        if (!matches(emitters[i].name, selectors[selector])) continue;
        is_chosen = true;
        selects[selector] = 1;
      }
      names.push_back(emitters[i].name);
      if (!is_chosen) continue;
      effect.emitters.push_back(i);
      chosen.push_back(&emitters[i]);
    }
    if (!effect.emitters.empty()) effects.emplace_back(object, std::move(effect));
  }
  if (names.empty()) {
    entry.problem("objects", "none of the objects has an emitter (light, sound, marker or climate_source)");
    return {};
  }
  for (std::size_t i = 0; i < selectors.size(); ++i)
    if (selects[i] == 0)
      entry.problem("emitter",
                    "none of the objects has an emitter '" + selectors[i] + "'" + suggestion(selectors[i], names));
  if (!chosen.empty()) check_change(entry, chosen);
  return effects;
}

// A new kind of event needs its keys in experiment_keys.cpp, a line here, and its effect in the simulation.
constexpr std::pair<std::string_view, ReadEffect> effects[] = {
    {"add", &read_add},
    {"remove", &read_remove},
    {"disable", &read_disable},
    {"enable", &read_enable},
    {"move", &read_move},
    {"set_velocity", &read_set_velocity},
    {"apply_force", &read_apply_force},
};

}  // namespace

std::vector<std::pair<std::size_t, Effect>> read_effects(std::string_view kind, const ScheduleEntry& entry,
                                                         const World& world, const std::vector<std::size_t>& objects) {
  if (kind == "set_emitter") return read_set_emitter(entry, world, objects);
  const auto* const reader =
      std::find_if(std::begin(effects), std::end(effects), [&](const auto& each) { return each.first == kind; });
  if (reader == std::end(effects)) throw std::logic_error("nothing reads " + std::string(kind));
  std::vector<std::pair<std::size_t, Effect>> found;
  for (const std::size_t object : objects)
    if (const std::optional<Effect> effect = reader->second(entry, world, object)) found.emplace_back(object, *effect);
  return found;
}

}  // namespace cohort::parsing
