// SPDX-License-Identifier: Apache-2.0
#include "server/emission/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "server/core/overloaded.hpp"
#include "server/core/state_visitors.hpp"

namespace cohort::emission {
namespace {

constexpr std::size_t emitters_a_chunk = 256;
// A typical range of cameras, so that a query reads few cells [m].
constexpr double marker_cell = 0.5;
constexpr double beacon_cell = 1.0;

std::uint32_t count_of(const auto& emitters) { return static_cast<std::uint32_t>(emitters.size()); }

// Sets an emitter that exists, or adds the next one.
template <class Emitter>
void put(std::vector<Emitter>& emitters, std::uint32_t index, Emitter emitter) {
  if (index == emitters.size())
    emitters.push_back(std::move(emitter));
  else
    emitters[index] = std::move(emitter);
}

}  // namespace

Emitters::Emitters(const description::World& description, const physics::World& world) : world_(world) {
  marker_grid_.set_cell_size(marker_cell);
  beacon_grid_.set_cell_size(beacon_cell);
  for (std::size_t body = 0; body < description.instances.size(); ++body)
    add_body(BodyId{body}, description.models[description.instances[body].model]);
}

void Emitters::add_body(BodyId body, const description::Model& model) {
  const std::uint32_t slot = world_.slot_of(body);
  const bool is_new = slot == firsts_.size();
  if (is_new) firsts_.push_back(counts());
  Firsts next = firsts_[slot];
  for (std::size_t i = 0; i < model.emitters.size(); ++i) {
    const description::Emitter& emitter = model.emitters[i];
    const Entry entry = set({body, LinkId{emitter.link}, emitter.X_LE}, i, emitter, next);
    if (is_new) entries_.push_back(entry);
  }
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const std::vector<description::DeviceEmitter> emitters = description::emitters_of(model.devices[device]);
    if (emitters.empty()) continue;
    if (is_new) devices_.push_back({slot, DeviceId{device}, next});
    for (const description::DeviceEmitter& emitter : emitters)
      set({body, LinkId{emitter.link}, emitter.X_LE}, emitter, next);
  }
}

Emitters::Firsts Emitters::counts() const {
  return {{count_of(lamps_), count_of(tones_), count_of(markers_), count_of(beacons_)}, count_of(climate_sources_)};
}

Emitters::Entry Emitters::set(const Mount& mount, std::size_t place, const description::Emitter& emitter,
                              Firsts& next) {
  const bool is_on = emitter.is_on;
  const auto entry = [&](Kind kind, std::uint32_t index) {
    return Entry{world_.slot_of(mount.body), place, kind, index};
  };
  if (const auto* light = std::get_if<description::Light>(&emitter.what)) {
    put(lamps_, next.lamp, {.mount = mount, .light = *light, .is_on = is_on});
    return entry(Kind::lamp, next.lamp++);
  }
  if (const auto* sound = std::get_if<description::Sound>(&emitter.what)) {
    put(tones_, next.tone, {mount, *sound, is_on});
    return entry(Kind::tone, next.tone++);
  }
  if (const auto* marker = std::get_if<description::Marker>(&emitter.what)) {
    put(markers_, next.marker, {mount, marker->color, is_on});
    return entry(Kind::marker, next.marker++);
  }
  const auto& source = std::get<description::ClimateSource>(emitter.what);
  put(climate_sources_, next.climate_source, {.mount = mount, .source = source, .is_on = is_on});
  return entry(Kind::climate_source, next.climate_source++);
}

void Emitters::set(const Mount& mount, const description::DeviceEmitter& emitter, Firsts& next) {
  std::visit(Overloaded{
                 [&](const description::Light& light) { put(lamps_, next.lamp++, {.mount = mount, .light = light}); },
                 [&](const description::Sound& sound) {
                   put(tones_, next.tone++, {mount, sound});
                 },
                 [&](const description::Marker& marker) {
                   put(markers_, next.marker++, {mount, marker.color});
                 },
                 [&](const description::Beacon& beacon) {
                   put(beacons_, next.beacon++, {mount, beacon.range, false, std::vector<double>(beacon.message_size)});
                 },
             },
             emitter.what);
}

void Emitters::change(BodyId body, std::size_t emitter, const description::EmitterChange& change) {
  const std::pair key(world_.slot_of(body), emitter);
  const auto key_of = [](const Entry& entry) { return std::pair(entry.slot, entry.emitter); };
  const auto found = std::ranges::lower_bound(entries_, key, {}, key_of);
  if (found == entries_.end() || key_of(*found) != key)
    throw std::invalid_argument("the object does not have this emitter");
  const auto set = [](auto& value, const auto& to) {
    if (to) value = *to;
  };
  switch (found->kind) {
    case Kind::lamp: {
      Lamp& lamp = lamps_[found->index];
      set(lamp.is_on, change.is_on);
      set(lamp.light.intensity, change.intensity);
      set(lamp.light.color, change.color);
      break;
    }
    case Kind::tone: {
      Tone& tone = tones_[found->index];
      set(tone.is_on, change.is_on);
      set(tone.sound.intensity, change.intensity);
      set(tone.sound.frequency, change.frequency);
      break;
    }
    case Kind::marker: {
      Marker& marker = markers_[found->index];
      set(marker.is_on, change.is_on);
      set(marker.color, change.color);
      break;
    }
    case Kind::climate_source: {
      ClimateSource& source = climate_sources_[found->index];
      set(source.is_on, change.is_on);
      set(source.source.temperature, change.temperature);
      set(source.source.humidity, change.humidity);
      break;
    }
  }
}

Emitters::OfDevice Emitters::of_device(BodyId body, DeviceId device) const {
  const std::pair key(world_.slot_of(body), device);
  const auto key_of = [](const DeviceEntry& entry) { return std::pair(entry.slot, entry.device); };
  const auto found = std::ranges::lower_bound(devices_, key, {}, key_of);
  if (found == devices_.end() || key_of(*found) != key) throw std::logic_error("the device is not an emitter");
  return found->first;
}

void Emitters::set_tone(std::uint32_t tone, double frequency, double intensity) {
  tones_[tone].sound.frequency = frequency;
  tones_[tone].sound.intensity = intensity;
}

void Emitters::set_beacon(std::uint32_t beacon, bool is_sending, std::span<const double> message) {
  beacons_[beacon].is_sending = is_sending;
  std::ranges::copy(message, beacons_[beacon].message.begin());
}

void Emitters::update(WorkerPool& workers) {
  const auto place = [&](auto& emitters, const auto& more) {
    workers.for_each_chunk(emitters.size(), emitters_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!is_in_world(emitters[i].mount)) continue;
        const Pose X_WE =
            world_.link_pose(emitters[i].mount.body, LinkId{emitters[i].mount.link}) * emitters[i].mount.X_LE;
        emitters[i].p_W = X_WE.position;
        more(emitters[i], X_WE);
      }
    });
  };
  const auto no_more = [](const auto&, const Pose&) {};
  place(lamps_, [](Lamp& lamp, const Pose& X_WE) { lamp.direction_W = X_WE.orientation * lamp.light.direction_E; });
  place(tones_, no_more);
  place(markers_, no_more);
  place(climate_sources_, no_more);
  place(beacons_, no_more);

  const auto collect = [&](std::vector<std::uint32_t>& found, const auto& emitters, const auto& emits) {
    found.clear();
    for (std::uint32_t i = 0; i < emitters.size(); ++i)
      if (emits(emitters[i]) && is_in_world(emitters[i].mount)) found.push_back(i);
  };
  collect(lit_lamps_, lamps_, [](const Lamp& lamp) {
    return lamp.is_on && lamp.light.intensity > 0.0 && (lamp.light.color.array() > 0.0).any();
  });
  collect(sounding_tones_, tones_, [](const Tone& tone) { return tone.is_on && tone.sound.intensity > 0.0; });
  collect(lit_markers_, markers_,
          [](const Marker& marker) { return marker.is_on && (marker.color.array() > 0.0).any(); });
  collect(sending_beacons_, beacons_, [](const Beacon& beacon) { return beacon.is_sending; });
  const auto build = [](geometry::CornerGrid& grid, const std::vector<std::uint32_t>& those, const auto& emitters,
                        std::vector<geometry::Bounds>& bounds) {
    bounds.resize(emitters.size());
    for (const std::uint32_t index : those) bounds[index] = {emitters[index].p_W, emitters[index].p_W};
    grid.build(those, bounds);
  };
  build(marker_grid_, lit_markers_, markers_, marker_bounds_);
  build(beacon_grid_, sending_beacons_, beacons_, beacon_bounds_);
  longest_range_ = 0.0;
  for (const std::uint32_t index : sending_beacons_) longest_range_ = std::max(longest_range_, beacons_[index].range);
}

template <class Self, class Visit>
void Emitters::visit_state(Self& self, Visit&& visit) {
  for (auto& lamp : self.lamps_) {
    visit(lamp.is_on);
    for (int i = 0; i < 3; ++i) visit(lamp.light.color[i]);
    visit.unusual(lamp.light.intensity, lamp.usual_intensity);
  }
  for (auto& tone : self.tones_) {
    visit(tone.is_on);
    visit(tone.sound.frequency);
    visit(tone.sound.intensity);
  }
  for (auto& marker : self.markers_) {
    visit(marker.is_on);
    for (int i = 0; i < 3; ++i) visit(marker.color[i]);
  }
  for (auto& source : self.climate_sources_) {
    visit(source.is_on);
    visit.unusual(source.source.temperature, source.usual.temperature);
    visit.unusual(source.source.humidity, source.usual.humidity);
  }
  for (auto& beacon : self.beacons_) {
    visit(beacon.is_sending);
    for (auto& value : beacon.message) visit(value);
  }
}

std::size_t Emitters::emitter_count() const {
  return lamps_.size() + tones_.size() + markers_.size() + climate_sources_.size() + beacons_.size();
}

void Emitters::hash(StateHash& hash) const { visit_state(*this, StateHasher{hash}); }

void Emitters::save(SnapshotWriter& writer) const {
  writer.add_count(emitter_count());
  visit_state(*this, StateSaver{writer});
}

void Emitters::restore(SnapshotReader& reader) {
  reader.expect_count(emitter_count(), "emitters");
  visit_state(*this, StateRestorer{reader});
}

}  // namespace cohort::emission
