// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/world.hpp"
#include "server/geometry/scene/corner_grid.hpp"
#include "server/physics/world/physics_world.hpp"

namespace cohort::emission {

/// The body, the link and the pose of an emitter.
struct Mount {
  BodyId body;
  LinkId link;
  Pose X_LE;
};

struct Lamp {
  Mount mount;
  description::Light light;                  ///< current colour and intensity
  double usual_intensity = light.intensity;  ///< initial intensity
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_W = Eigen::Vector3d::Zero();  ///< unit direction of a spot or directional light
};

struct Tone {
  Mount mount;
  description::Sound sound;  ///< current frequency and intensity
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

struct Marker {
  Mount mount;
  Eigen::Vector3d color = Eigen::Vector3d::Zero();  ///< current colour; black is invisible
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

struct ClimateSource {
  Mount mount;
  description::ClimateSource source;          ///< current temperature and humidity
  description::ClimateSource usual = source;  ///< initial values
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

/// A sender of messages to nearby robots.
struct Beacon {
  Mount mount;
  double range = 0.0;  ///< [m]
  bool is_sending = false;
  std::vector<double> message;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

/// The emitters of robots and objects, which others perceive from a distance. Actuators change emitters, and sensors
/// read them; between these, `update` computes the poses at the new boundary. Emitters of a body that is not in the
/// world are off, and those of a released body become those of the next body in its slot. Changes and `update` are for
/// one thread; between them, any thread may call the other functions.
class Emitters {
 public:
  /// Creates the emitters of all instances, from their models and devices. Keeps references to both arguments.
  Emitters(const description::World& description, const physics::World& world);

  /// Adds a new body with one of the description's models. Add bodies in the same order as to the world.
  void add_body(BodyId body, const description::Model& model);
  /// Updates the poses and the active emitters at this boundary.
  void update(WorkerPool& workers);

  /// Returns the indices of the active lamps at the last `update`.
  std::span<const std::uint32_t> lit_lamps() const { return lit_lamps_; }
  std::span<const std::uint32_t> sounding_tones() const { return sounding_tones_; }
  const Lamp& lamp(std::uint32_t index) const { return lamps_[index]; }
  const Tone& tone(std::uint32_t index) const { return tones_[index]; }
  const Marker& marker(std::uint32_t index) const { return markers_[index]; }
  std::span<const Lamp> lamps() const { return lamps_; }
  std::span<const Tone> tones() const { return tones_; }
  std::span<const Marker> markers() const { return markers_; }
  std::span<const ClimateSource> climate_sources() const { return climate_sources_; }
  bool is_in_world(const Mount& mount) const { return world_.is_active(mount.body); }

  /// Calls `visit(index)` for each lit marker that may be within `range` of a point, in an order that depends only on
  /// the state.
  template <class Visit>
  void for_each_marker_near(const Eigen::Vector3d& p_W, double range, Visit&& visit) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(range);
    marker_grid_.for_each_overlap({p_W - reach, p_W + reach}, visit);
  }

  const Beacon& beacon(std::uint32_t index) const { return beacons_[index]; }
  /// Calls `visit(index)` likewise for each sending beacon that may reach a point.
  template <class Visit>
  void for_each_beacon_near(const Eigen::Vector3d& p_W, Visit&& visit) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(longest_range_);
    beacon_grid_.for_each_overlap({p_W - reach, p_W + reach}, visit);
  }

  /// The index of the first emitter of each kind of a device; the other emitters follow it.
  struct OfDevice {
    std::uint32_t lamp = 0;
    std::uint32_t tone = 0;
    std::uint32_t marker = 0;
    std::uint32_t beacon = 0;
  };
  /// Returns the emitters of a device. Throws std::logic_error if it has none.
  OfDevice of_device(BodyId body, DeviceId device) const;
  /// Changes an emitter of a body, by its index in the model. Throws std::invalid_argument if there is none.
  void change(BodyId body, std::size_t emitter, const description::EmitterChange& change);
  void set_lamp(std::uint32_t lamp, const Eigen::Vector3d& color) { lamps_[lamp].light.color = color; }
  void set_tone(std::uint32_t tone, double frequency, double intensity);
  void set_marker(std::uint32_t marker, const Eigen::Vector3d& color) { markers_[marker].color = color; }
  void set_beacon(std::uint32_t beacon, bool is_sending, std::span<const double> message);

  /// Adds all state except poses to the hash.
  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// Restores newly constructed emitters. Restore the world before, and call `update` afterwards. Throws SnapshotError
  /// if the snapshot does not match.
  void restore(SnapshotReader& reader);

 private:
  struct Firsts : OfDevice {
    std::uint32_t climate_source = 0;
  };
  struct DeviceEntry {
    std::uint32_t slot = 0;  // the slot of its body
    DeviceId device;
    OfDevice first;
  };
  enum class Kind : std::uint8_t { lamp, tone, marker, climate_source };
  struct Entry {
    std::uint32_t slot = 0;  // the slot of its body
    std::size_t emitter = 0;
    Kind kind = Kind::lamp;
    std::uint32_t index = 0;  // index among those of its kind
  };
  Firsts counts() const;
  // These set the next emitters and advance `next`.
  Entry set(const Mount& mount, std::size_t place, const description::Emitter& emitter, Firsts& next);
  void set(const Mount& mount, const description::DeviceEmitter& emitter, Firsts& next);
  std::size_t emitter_count() const;
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit);

  const physics::World& world_;
  std::vector<Lamp> lamps_;
  std::vector<Tone> tones_;
  std::vector<Marker> markers_;
  std::vector<ClimateSource> climate_sources_;
  std::vector<Beacon> beacons_;
  std::vector<Firsts> firsts_;        // by slot
  std::vector<Entry> entries_;        // ascending by slot, then emitter
  std::vector<DeviceEntry> devices_;  // ascending by slot, then device

  std::vector<std::uint32_t> lit_lamps_;
  std::vector<std::uint32_t> sounding_tones_;
  std::vector<std::uint32_t> lit_markers_;
  std::vector<geometry::Bounds> marker_bounds_;  // by index
  geometry::CornerGrid marker_grid_;
  std::vector<std::uint32_t> sending_beacons_;
  std::vector<geometry::Bounds> beacon_bounds_;  // by index
  geometry::CornerGrid beacon_grid_;
  double longest_range_ = 0.0;  // greatest range of the sending beacons [m]
};

}  // namespace cohort::emission
