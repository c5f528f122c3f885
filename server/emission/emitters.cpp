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

}  // namespace

Emitters::Emitters(const description::World& description, const physics::World& world) : world_(world) {
  marker_grid_.set_cell_size(marker_cell);
  beacon_grid_.set_cell_size(beacon_cell);
  for (std::size_t body = 0; body < description.instances.size(); ++body)
    add_body(BodyId{body}, description.models[description.instances[body].model]);
}

void Emitters::add_body(BodyId body, const description::Model& model) {
  for (std::size_t i = 0; i < model.emitters.size(); ++i) add(body, i, model.emitters[i]);
  add_devices(body, model);
}

void Emitters::add(BodyId body, std::size_t place, const description::Emitter& emitter) {
  const Mount mount{body, LinkId{emitter.link}, emitter.X_LE};
  const bool is_on = emitter.is_on;
  const auto note = [&](Kind kind, const auto& emitters) {
    entries_.push_back({body, place, kind, count_of(emitters) - 1});
  };
  if (const auto* light = std::get_if<description::Light>(&emitter.what)) {
    lamps_.push_back({.mount = mount, .light = *light, .is_on = is_on});
    note(Kind::lamp, lamps_);
  } else if (const auto* sound = std::get_if<description::Sound>(&emitter.what)) {
    tones_.push_back({mount, *sound, is_on});
    note(Kind::tone, tones_);
  } else if (const auto* marker = std::get_if<description::Marker>(&emitter.what)) {
    markers_.push_back({mount, marker->color, is_on});
    note(Kind::marker, markers_);
  } else {
    const auto& source = std::get<description::ClimateSource>(emitter.what);
    climate_sources_.push_back({.mount = mount, .source = source, .is_on = is_on});
    note(Kind::climate_source, climate_sources_);
  }
}

void Emitters::change(BodyId body, std::size_t emitter, const description::EmitterChange& change) {
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), std::pair{body, emitter},
                                      [](const Entry& entry, const std::pair<BodyId, std::size_t>& key) {
                                        return std::pair{entry.body, entry.emitter} < key;
                                      });
  if (found == entries_.end() || found->body != body || found->emitter != emitter)
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

void Emitters::add_devices(BodyId body, const description::Model& model) {
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const OfDevice first{count_of(lamps_), count_of(tones_), count_of(markers_), count_of(beacons_)};
    const std::vector<description::DeviceEmitter> emitters = description::emitters_of(model.devices[device]);
    if (emitters.empty()) continue;
    for (const description::DeviceEmitter& emitter : emitters)
      add_to_device({body, LinkId{emitter.link}, emitter.X_LE}, emitter);
    devices_.push_back({body, DeviceId{device}, first});
  }
}

void Emitters::add_to_device(const Mount& mount, const description::DeviceEmitter& emitter) {
  std::visit(Overloaded{
                 [&](const description::Light& light) { lamps_.push_back({.mount = mount, .light = light}); },
                 [&](const description::Sound& sound) {
                   tones_.push_back({mount, sound});
                 },
                 [&](const description::Marker& marker) {
                   markers_.push_back({mount, marker.color});
                 },
                 [&](const description::Beacon& beacon) {
                   beacons_.push_back({mount, beacon.range, false, std::vector<double>(beacon.message_size)});
                 },
             },
             emitter.what);
}

Emitters::OfDevice Emitters::of_device(BodyId body, DeviceId device) const {
  const auto found = std::lower_bound(devices_.begin(), devices_.end(), std::pair{body, device},
                                      [](const DeviceEntry& entry, const std::pair<BodyId, DeviceId>& key) {
                                        return std::pair{entry.body, entry.device} < key;
                                      });
  if (found == devices_.end() || found->body != body || found->device != device)
    throw std::logic_error("the device is not an emitter");
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
