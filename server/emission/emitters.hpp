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

/// Where an emitter is.
struct Mount {
  BodyId body;
  LinkId link;
  Pose X_LE;
};

struct Lamp {
  Mount mount;
  description::Light light;                  ///< colour and intensity as they are now
  double usual_intensity = light.intensity;  ///< at first
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_W = Eigen::Vector3d::Zero();  ///< of a spot or directional light, unit
};

struct Tone {
  Mount mount;
  description::Sound sound;  ///< frequency and intensity as they are now
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

struct Marker {
  Mount mount;
  Eigen::Vector3d color = Eigen::Vector3d::Zero();  ///< as it is now; black is not seen
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

struct ClimateSource {
  Mount mount;
  description::ClimateSource source;          ///< temperature and humidity as they are now
  description::ClimateSource usual = source;  ///< at first
  bool is_on = true;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

/// What sends messages to those around.
struct Beacon {
  Mount mount;
  double range = 0.0;  ///< [m]
  bool is_sending = false;
  std::vector<double> message;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

/// What robots and objects let others perceive from afar. Actuators change emitters, sensors read them; in between
/// `update` takes the poses of a new boundary. Emitters of a body that is not in the world are off. An emitter's index
/// is its place among those of its kind and never another one's. Changes and `update` belong to one thread; all else
/// may run from any thread in between.
class Emitters {
 public:
  /// Those of all instances: of their models and of their devices. Keeps references to both.
  Emitters(const description::World& description, const physics::World& world);

  /// A body has come, of one of the description's models.
  void add_body(BodyId body, const description::Model& model);
  /// Takes the poses of this boundary and what is on.
  void update(WorkerPool& workers);

  /// Those that are on, by index, as of the last `update`.
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

  /// Calls `visit(index)` for each lit marker that may be within `range` of a point, in an order that depends on the
  /// state alone.
  template <class Visit>
  void for_each_marker_near(const Eigen::Vector3d& p_W, double range, Visit&& visit) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(range);
    marker_grid_.for_each_overlap({p_W - reach, p_W + reach}, visit);
  }

  const Beacon& beacon(std::uint32_t index) const { return beacons_[index]; }
  /// The same of the beacons that are sending and may reach a point.
  template <class Visit>
  void for_each_beacon_near(const Eigen::Vector3d& p_W, Visit&& visit) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(longest_range_);
    beacon_grid_.for_each_overlap({p_W - reach, p_W + reach}, visit);
  }

  /// Of the emitters that a device of a body has, the first of each kind; they are in a row.
  struct OfDevice {
    std::uint32_t lamp = 0;
    std::uint32_t tone = 0;
    std::uint32_t marker = 0;
    std::uint32_t beacon = 0;
  };
  /// Throws std::logic_error for a device that emits nothing.
  OfDevice of_device(BodyId body, DeviceId device) const;
  /// Of an emitter of a body's model, by its index there. Throws std::invalid_argument if there is none.
  void change(BodyId body, std::size_t emitter, const description::EmitterChange& change);
  void set_lamp(std::uint32_t lamp, const Eigen::Vector3d& color) { lamps_[lamp].light.color = color; }
  void set_tone(std::uint32_t tone, double frequency, double intensity);
  void set_marker(std::uint32_t marker, const Eigen::Vector3d& color) { markers_[marker].color = color; }
  void set_beacon(std::uint32_t beacon, bool is_sending, std::span<const double> message);

  /// Adds all that can change, but for poses.
  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// Into one as it is after its construction, after the world is restored; `update` comes next. Throws SnapshotError
  /// if the snapshot is of something else.
  void restore(SnapshotReader& reader);

 private:
  struct DeviceEntry {
    BodyId body;
    DeviceId device;
    OfDevice first;
  };
  enum class Kind : std::uint8_t { lamp, tone, marker, climate_source };
  struct Entry {
    BodyId body;
    std::size_t emitter = 0;
    Kind kind = Kind::lamp;
    std::uint32_t index = 0;  // among those of its kind
  };
  void add(BodyId body, std::size_t place, const description::Emitter& emitter);
  void add_devices(BodyId body, const description::Model& model);
  void add_to_device(const Mount& mount, const description::DeviceEmitter& emitter);
  std::size_t emitter_count() const;
  template <class Self, class Visit>
  static void visit_state(Self& self, Visit&& visit);

  const physics::World& world_;
  std::vector<Lamp> lamps_;
  std::vector<Tone> tones_;
  std::vector<Marker> markers_;
  std::vector<ClimateSource> climate_sources_;
  std::vector<Beacon> beacons_;
  std::vector<Entry> entries_;        // ascending by body, then emitter
  std::vector<DeviceEntry> devices_;  // ascending by body, then device

  std::vector<std::uint32_t> lit_lamps_;
  std::vector<std::uint32_t> sounding_tones_;
  std::vector<std::uint32_t> lit_markers_;
  std::vector<geometry::Bounds> marker_bounds_;  // by index
  geometry::CornerGrid marker_grid_;
  std::vector<std::uint32_t> sending_beacons_;
  std::vector<geometry::Bounds> beacon_bounds_;  // by index
  geometry::CornerGrid beacon_grid_;
  double longest_range_ = 0.0;  // of the beacons that are sending [m]
};

}  // namespace cohort::emission
