// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include "server/core/text.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_values.hpp"

namespace cohort::parsing {
namespace {

using keys::Referent;

// Finds the targets of references in devices, and reports those that are missing or already used.
class References {
 public:
  /// `drives` are the treel drives of the model: name and index among the devices.
  References(const Model& model, std::map<std::string, std::size_t> drives, const SdfReport& report, ShapeFiles& files)
      : model_(model), drives_(std::move(drives)), report_(report), files_(files) {}

  /// Returns whether each was found.
  template <class Kind>
  bool find_all(const ExtensionValues& values, Kind& device) {
    bool found = true;
    keys::for_keys_of<Kind>(keys::keys_of<Kind>, [&]<class Key>(const Key& key) {
      if constexpr (std::is_base_of_v<keys::Reference, Key>) found &= find(values, key, device.*key.member);
    });
    return found;
  }

  const Model& model() const { return model_; }

 private:
  bool find(const ExtensionValues& values, const keys::Reference& key, std::size_t& index) {
    const std::optional<std::size_t> found = find_index(key.to, values.text(key.name), values.where(key.name));
    index = found.value_or(0);
    return found.has_value();
  }
  bool find(const ExtensionValues& values, const keys::Reference& key, std::vector<std::size_t>& indices) {
    const std::vector<std::string> names = values.texts(key.name);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const auto found = find_index(key.to, names[i], values.where(key.name, i))) indices.push_back(*found);
    return indices.size() == names.size();
  }
  bool find(const ExtensionValues& values, const keys::Reference& key, std::shared_ptr<const Samples>& samples);

  std::optional<std::size_t> find_index(Referent to, const std::string& name, const Element* where);
  template <class Named>
  std::optional<std::size_t> find_named(const char* kind, const std::vector<Named>& named, const std::string& name,
                                        const Element* where) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < named.size(); ++i) {
      if (named[i].name == name) return i;
      names.push_back(named[i].name);
    }
    report_missing(kind, names, name, where);
    return std::nullopt;
  }
  void report_missing(const char* kind, const std::vector<std::string>& names, const std::string& name,
                      const Element* where) const {
    report_.problem(where, "the model has no " + std::string(kind) + " '" + name + "'" + suggestion(name, names));
  }
  std::string flaw_of_joint(Referent to, std::size_t index);

  const Model& model_;
  std::map<std::string, std::size_t> drives_;
  const SdfReport& report_;
  ShapeFiles& files_;
  std::set<std::size_t> motorised_;  // joints
  std::set<std::size_t> wheels_;     // joints
  std::set<std::size_t> belts_;      // links
};

bool References::find(const ExtensionValues& values, const keys::Reference& key,
                      std::shared_ptr<const Samples>& samples) {
  if (!values.has(key.name)) return true;
  try {
    samples = files_.samples(values.where(key.name));
    return true;
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) report_.problem(problem);
  } catch (const std::runtime_error& error) {
    report_.problem(values.where(key.name), error.what());
  }
  return false;
}

std::optional<std::size_t> References::find_index(Referent to, const std::string& name, const Element* where) {
  if (to == Referent::drive) {
    if (const auto found = drives_.find(name); found != drives_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [drive, index] : drives_) names.push_back(drive);
    report_missing("treel_drive", names, name, where);
    return std::nullopt;
  }
  if (to == Referent::link || to == Referent::root_link) {
    const std::optional<std::size_t> link = find_named("link", model_.links, name, where);
    if (to == Referent::link || !link || *link == 0) return link;
    report_.problem(where, "expected the root link, '" + model_.links[0].name + "'");
    return std::nullopt;
  }
  if (to == Referent::belt_link) {
    const std::optional<std::size_t> link = find_named("link", model_.links, name, where);
    if (!link || belts_.insert(*link).second) return link;
    report_.problem(where, "the link '" + name + "' already has a belt");
    return std::nullopt;
  }
  const auto joint = std::ranges::find(model_.joints, name, &Joint::name);
  if (joint == model_.joints.end()) {
    report_.problem(where, why_no_joint(model_, name));
    return std::nullopt;
  }
  const auto index = static_cast<std::size_t>(joint - model_.joints.begin());
  const std::string flaw = flaw_of_joint(to, index);
  if (flaw.empty()) return index;
  report_.problem(where, "the joint '" + name + "' " + flaw);
  return std::nullopt;
}

// Returns why the joint cannot be the target; empty if it can, and then marks it as used.
std::string References::flaw_of_joint(Referent to, std::size_t index) {
  const Joint& joint = model_.joints[index];
  if (to == Referent::wheel_joint) {
    if (joint.type != JointType::revolute) return "is not revolute; the joint of a wheel must be revolute";
    if (joint.parent != 0) return "does not connect '" + model_.links[0].name + "' to a wheel";
    if (motorised_.contains(index)) return "already has a motor";
    return wheels_.insert(index).second ? "" : "is already listed as the joint of a wheel";
  }
  if (to == Referent::joint) return "";
  if (const std::string_view flaw = facts_of(joint.type).flaw; !flaw.empty()) return std::string(flaw);
  if (to == Referent::moving_joint) return "";
  if (wheels_.contains(index)) return "is already driven by a treel_drive, as the joint of one of its wheels";
  return motorised_.insert(index).second ? "" : "already has a motor";
}

// Checks across keys: an overload for each kind that needs one.
template <class Kind>
void check(const Kind&, const ExtensionValues&, const SdfReport&) {}

void check_samples(const std::shared_ptr<const Samples>& samples, std::size_t count, const ExtensionValues& values,
                   const SdfReport& report) {
  if (samples && samples->count() != count)
    report.problem(values.where("samples"), "'" + values.text("samples") + "' has " + std::to_string(samples->count()) +
                                                " readings in each line, but the device has " + std::to_string(count));
}

void check(const ProximityRing& ring, const ExtensionValues& values, const SdfReport& report) {
  if (ring.cone >= std::numbers::pi)
    report.problem(values.where("cone"), "expected a cone of less than half a turn, pi");
  check_samples(ring.samples, ring.count, values, report);
  const bool takes_samples = ring.technique == ProximityTechnique::samples;
  if (takes_samples != values.has("samples"))
    report.problem(values.where("samples"), takes_samples
                                                ? "the technique 'samples' requires a sample file, <cohort:samples>"
                                                : "only the technique 'samples' uses a sample file");
}

void check(const LightSensors& sensors, const ExtensionValues& values, const SdfReport& report) {
  check_samples(sensors.samples, sensors.count, values, report);
}

void check(const Microphones& microphones, const ExtensionValues& values, const SdfReport& report) {
  for (std::size_t i = 0; i < microphones.bands.size(); ++i)
    if (microphones.bands[i].x() > microphones.bands[i].y())
      report.problem(values.where("band", i), "the minimum frequency of the band exceeds the maximum");
  check_samples(microphones.samples, microphones.places_L.size(), values, report);
}

void check_elevations(const ExtensionValues& values, const SdfReport& report) {
  constexpr double quarter_turn = 0.5 * std::numbers::pi;
  for (const char* const key : {"min_elevation", "max_elevation"})
    if (std::abs(values.real(key)) > quarter_turn)
      report.problem(values.where(key), "expected an elevation from -pi/2 to pi/2");
  if (!(values.real("min_elevation") < values.real("max_elevation")))
    report.problem(values.where("max_elevation"), "expected a value greater than the minimum elevation");
}

void check(const OmnidirectionalCamera&, const ExtensionValues& values, const SdfReport& report) {
  check_elevations(values, report);
}

void check(const PanoramicCamera& camera, const ExtensionValues& values, const SdfReport& report) {
  check_elevations(values, report);
  constexpr std::size_t least_width = 4;
  constexpr std::size_t most_pixels = 1'000'000;
  if (camera.width < least_width) report.problem(values.where("width"), "expected at least 4 columns");
  if (camera.width * camera.height > most_pixels)
    report.problem(values.where("height"), "expected at most 1 000 000 pixels");
  check_color(values, "sky", report);
}

void check(const Battery& battery, const ExtensionValues& values, const SdfReport& report) {
  if (battery.motor_efficiency > 1.0) report.problem(values.where("motor_efficiency"), "expected at most 1");
}

void check(const AckermannDrive& drive, const ExtensionValues& values, const SdfReport& report) {
  if (drive.steering_limit >= 0.5 * std::numbers::pi)
    report.problem(values.where("steering_limit"), "expected less than a quarter turn, pi/2");
}

void check(const Belt& belt, const ExtensionValues& values, const SdfReport& report) {
  if (belt.axis_L.isZero(0.0)) report.problem(values.where("axis"), "expected a direction other than 0 0 0");
  if (std::abs(belt.velocity) > belt.max_velocity)
    report.problem(values.where("velocity"), "exceeds <cohort:max_velocity>");
}

void check(const TrackedDrive& drive, const ExtensionValues& values, const SdfReport& report) {
  if (drive.steering_efficiency > 1.0) report.problem(values.where("steering_efficiency"), "expected at most 1");
}

void check(const Rotor& rotor, const ExtensionValues& values, const SdfReport& report) {
  if (rotor.min_velocity > 0.0) report.problem(values.where("min_velocity"), "expected at most 0 rad/s");
}

// Warns if the motor exceeds the limits of its joint, which apply to it.
template <class Kind>
void bind_to_joint(Kind& device, const Model& model, const ExtensionValues& values, const SdfReport& report) {
  if constexpr (requires { device.rotor_inertia; }) {
    const JointAxis& axis = model.joints[device.joint].axis;
    const auto bind = [&](double& most, double limit, const std::string& quantity) {
      if (most <= limit) return;
      report.warning(values.where("max_" + quantity),
                     "exceeds the <limit><" + quantity + "> of its joint; the limit of the joint applies");
      most = limit;
    };
    bind(device.max_effort, axis.max_effort, "effort");
    if constexpr (requires { device.max_velocity; }) bind(device.max_velocity, axis.max_velocity, "velocity");
  }
}

// Reads the keys that every sensor has.
template <class Kind>
Readout read_readout(const ExtensionValues& values) {
  Noise noise;
  read_values<Kind>(values, noise);
  Readout readout;
  if (!is_exact(noise)) readout.noises.push_back(noise);
  read_values<Kind>(values, readout);
  return readout;
}

template <class Kind>
std::optional<Device> read_device(const ExtensionValues& values, References& references, const SdfReport& report) {
  Kind device;
  device.name = values.name();
  // Noise for a single quantity overrides noise for all, so it is added later.
  if constexpr (keys::Senses<Kind>) device.readout = read_readout<Kind>(values);
  read_values<Kind>(values, device);
  if constexpr (requires { device.child_place; }) device.child_place = report.place_of(values.where("child"));
  const bool is_whole = references.find_all(values, device);
  check(device, values, report);
  if (!is_whole) return std::nullopt;
  bind_to_joint(device, references.model(), values, report);
  return device;
}

struct DeviceKind {
  std::optional<Device> (*read)(const ExtensionValues& values, References& references, const SdfReport& report);
  bool commands = false;  // its channels are commands
  bool observes = false;  // its channels are observations
};

// Returns the kinds by the names of their elements.
std::map<std::string_view, DeviceKind> device_kinds() {
  std::map<std::string_view, DeviceKind> kinds;
  keys::for_kinds_in(keys::devices, [&]<class Kind>(std::type_identity<Kind>) {
    const Extension& head = keys::table_of<Kind>.head;
    const bool commands = head.topic == "actuators" || std::is_same_v<Kind, RangeAndBearing>;  // which sends, too
    kinds[head.name] = {&read_device<Kind>, commands, keys::Senses<Kind>};
  });
  return kinds;
}

}  // namespace

std::chrono::nanoseconds to_time(double seconds) {
  constexpr double nanoseconds = 1e9;
  constexpr double longest = 9e9;  // 285 years, which fits into nanoseconds [s]
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::round(std::min(seconds, longest) * nanoseconds)));
}

void check_color(const ExtensionValues& values, std::string_view key, const SdfReport& report) {
  const Eigen::Vector3d& color = values.vector(key);
  if (color.minCoeff() < 0.0 || color.maxCoeff() > 1.0)
    report.problem(values.where(key), "expected red, green and blue from 0 to 1");
}

std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const std::vector<Counterpart>& of_plugins,
                                 const Model& model, const SdfReport& report, ShapeFiles& files) {
  struct Found {
    const Element* element;
    const Extension* extension;
    const std::string& prefix;
  };
  std::vector<Found> found;
  for (const DeviceScope& scope : scopes)
    for (const auto& [element, extension] : extensions_in(scope.model_element, report))
      if (!scope.elsewhere.contains(element)) found.push_back({element, extension, scope.prefix});
  // An encoder may precede the drive that it measures.
  std::map<std::string, std::size_t> drives;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i].extension->name == "treel_drive" && found[i].element->has_attribute("name"))
      drives.emplace(found[i].prefix + found[i].element->attribute("name"), i);

  static const std::map<std::string_view, DeviceKind> kinds = device_kinds();
  References references(model, std::move(drives), report, files);
  std::vector<Device> devices;
  // Commands and observations are named after their device, so two devices with commands, or two with observations,
  // cannot share a name.
  std::set<std::pair<bool, std::string>> names;
  const auto add = [&](const ExtensionValues& values, const Extension& extension) {
    const DeviceKind& kind = kinds.at(extension.name);
    const std::size_t before = report.count();
    const bool is_new = (!kind.commands || names.emplace(true, values.name()).second) &&
                        (!kind.observes || names.emplace(false, values.name()).second);
    if (!is_new) report.problem(values.element(), "another device of the model has the name '" + values.name() + "'");
    std::optional<Device> device = kind.read(values, references, report);
    if (report.forgive(values.element(), before, "it is ignored")) return;
    if (device) devices.push_back(*std::move(device));
  };
  for (const auto& [element, extension, prefix] : found) {
    std::optional<ExtensionValues> values = ExtensionValues::read(element, *extension, report);
    if (!values) continue;
    values->put_in_scope(prefix, *extension);
    add(*values, *extension);
  }
  for (const Counterpart& counterpart : of_plugins)
    if (counterpart.link.empty()) add(counterpart.values, *counterpart.extension);
  return devices;
}

}  // namespace cohort::parsing
