#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/description/extension_values.hpp"
#include "server/description/read_model.hpp"
#include "server/description/text.hpp"

namespace cohort::description {
namespace {

class DeviceReader {
 public:
  /// `drives` are the treel drives of the model: name and index among the devices.
  DeviceReader(const Model& model, std::map<std::string, std::size_t> drives, const SdfReport& report)
      : model_(model), drives_(std::move(drives)), report_(report) {}

  std::optional<Device> read(const ExtensionValues& values, std::string_view kind);

 private:
  std::optional<Device> read_treel_drive(const ExtensionValues& values);
  std::optional<Device> read_velocity_motor(const ExtensionValues& values);
  std::optional<Device> read_joint_encoder(const ExtensionValues& values);
  std::optional<Device> read_treel_encoder(const ExtensionValues& values);
  std::optional<Device> read_proximity_ring(const ExtensionValues& values);

  /// The index of the link or joint that `key` names; reported if there is none.
  template <class Named>
  std::optional<std::size_t> find(const ExtensionValues& values, const char* key, const std::vector<Named>& named) {
    return find(values.text(key), values.where(key), key, named);
  }
  template <class Named>
  std::optional<std::size_t> find(const std::string& name, const sdf::ElementPtr& where, const char* kind,
                                  const std::vector<Named>& named);
  /// One that has an angle or a way: its first axis is meant.
  std::optional<std::size_t> find_moving_joint(const ExtensionValues& values);
  /// The joints of the wheels of one side; reported if they cannot be.
  std::vector<std::size_t> read_wheels(const ExtensionValues& values, const char* key, std::size_t hull);

  const Model& model_;
  std::map<std::string, std::size_t> drives_;
  const SdfReport& report_;
  std::set<std::size_t> motorised_;  // joints
  std::set<std::size_t> wheels_;     // joints
};

template <class Named>
std::optional<std::size_t> DeviceReader::find(const std::string& name, const sdf::ElementPtr& where, const char* kind,
                                              const std::vector<Named>& named) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i].name == name) return i;
    names.push_back(named[i].name);
  }
  report_.problem(where, "the model has no " + std::string(kind) + " '" + name + "'" + suggestion(name, names));
  return std::nullopt;
}

std::optional<std::size_t> DeviceReader::find_moving_joint(const ExtensionValues& values) {
  const std::optional<std::size_t> joint = find(values, "joint", model_.joints);
  if (!joint) return std::nullopt;
  const JointType type = model_.joints[*joint].type;
  if (type != JointType::fixed && type != JointType::ball) return joint;
  report_.problem(values.where("joint"),
                  "the joint '" + values.text("joint") + "' " +
                      (type == JointType::fixed ? "is fixed" : "is a ball: it has no single axis"));
  return std::nullopt;
}

std::vector<std::size_t> DeviceReader::read_wheels(const ExtensionValues& values, const char* key, std::size_t hull) {
  std::vector<std::size_t> wheels;
  const std::vector<std::string> names = values.texts(key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const sdf::ElementPtr where = values.where(key, i);
    const std::optional<std::size_t> found = find(names[i], where, "joint", model_.joints);
    if (!found) continue;
    const Joint& joint = model_.joints[*found];
    const auto problem = [&](const std::string& what) {
      report_.problem(where, "the joint '" + joint.name + "' " + what);
    };
    if (joint.type != JointType::revolute)
      problem("is not revolute, as that of a wheel is");
    else if (joint.parent != hull)
      problem("is not between '" + model_.links[hull].name + "' and a wheel");
    else if (motorised_.contains(*found))
      problem("has a motor already");
    else if (!wheels_.insert(*found).second)
      problem("is a wheel's already");
    else
      wheels.push_back(*found);
  }
  return wheels;
}

std::optional<Device> DeviceReader::read_treel_drive(const ExtensionValues& values) {
  const std::optional<std::size_t> link = find(values, "link", model_.links);
  if (!link) return std::nullopt;
  if (*link != 0) {
    report_.problem(values.where("link"), "expected the root link, '" + model_.links[0].name + "'");
    return std::nullopt;
  }
  TreelDrive drive;
  drive.name = values.name();
  drive.link = *link;
  drive.half_gauge = values.real("half_gauge");
  drive.half_contact_length = values.real("half_contact_length");
  drive.ground_height = values.real("ground_height");
  drive.wheel_radius = values.real("wheel_radius");
  drive.max_torque = values.real("max_torque");
  drive.max_velocity = values.real("max_velocity");
  drive.friction = values.real("friction");
  drive.left_wheels = read_wheels(values, "left_wheel", drive.link);
  drive.right_wheels = read_wheels(values, "right_wheel", drive.link);
  return drive;
}

std::optional<Device> DeviceReader::read_velocity_motor(const ExtensionValues& values) {
  const std::optional<std::size_t> joint = find_moving_joint(values);
  if (!joint) return std::nullopt;
  const bool is_wheel = wheels_.contains(*joint);
  if (is_wheel || !motorised_.insert(*joint).second) {
    report_.problem(values.where("joint"),
                    "the joint '" + values.text("joint") + "' " +
                        (is_wheel ? "is a wheel's of a treel_drive, which moves it" : "has a motor already"));
    return std::nullopt;
  }
  return VelocityMotor{values.name(), *joint, values.real("max_velocity"), values.real("max_effort")};
}

std::optional<Device> DeviceReader::read_joint_encoder(const ExtensionValues& values) {
  const std::optional<std::size_t> joint = find_moving_joint(values);
  if (!joint) return std::nullopt;
  return JointEncoder{values.name(), *joint};
}

std::optional<Device> DeviceReader::read_treel_encoder(const ExtensionValues& values) {
  const auto drive = drives_.find(values.text("drive"));
  if (drive != drives_.end()) return TreelEncoder{values.name(), drive->second};
  std::vector<std::string> names;
  for (const auto& [name, index] : drives_) names.push_back(name);
  report_.problem(values.where("drive"), "the model has no treel_drive '" + values.text("drive") + "'" +
                                             suggestion(values.text("drive"), names));
  return std::nullopt;
}

std::optional<Device> DeviceReader::read_proximity_ring(const ExtensionValues& values) {
  const std::optional<std::size_t> link = find(values, "link", model_.links);
  if (!link) return std::nullopt;
  ProximityRing ring;
  ring.name = values.name();
  ring.link = *link;
  ring.X_LS = values.pose("pose");
  ring.count = values.whole("count");
  ring.first_bearing = values.real("first_bearing");
  ring.spacing = values.real("spacing");
  ring.ring_radius = values.real("ring_radius");
  ring.range = values.real("range");
  ring.noise = values.real("noise");
  return ring;
}

std::optional<Device> DeviceReader::read(const ExtensionValues& values, std::string_view kind) {
  using Read = std::optional<Device> (DeviceReader::*)(const ExtensionValues&);
  constexpr std::pair<std::string_view, Read> readers[] = {
      {"treel_drive", &DeviceReader::read_treel_drive},       {"velocity_motor", &DeviceReader::read_velocity_motor},
      {"joint_encoder", &DeviceReader::read_joint_encoder},   {"treel_encoder", &DeviceReader::read_treel_encoder},
      {"proximity_ring", &DeviceReader::read_proximity_ring},
  };
  for (const auto& [name, reader] : readers)
    if (name == kind) return (this->*reader)(values);
  throw std::logic_error("no reader for the device " + std::string(kind));
}

// Commands and observations are named after their device, so two devices that command, or two that observe, cannot
// share a name.
bool commands(std::string_view kind) { return kind == "treel_drive" || kind == "velocity_motor"; }

}  // namespace

std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const Model& model, const SdfReport& report) {
  struct Found {
    sdf::ElementPtr element;
    const Extension* extension;
    const std::string& prefix;
  };
  std::vector<Found> found;
  for (const DeviceScope& scope : scopes)
    for (const auto& [element, extension] : extensions_in(scope.model_element, report))
      found.push_back({element, extension, scope.prefix});
  // An encoder may stand before the drive that it measures.
  std::map<std::string, std::size_t> drives;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i].extension->name == "treel_drive" && found[i].element->HasAttribute("name"))
      drives.emplace(found[i].prefix + found[i].element->GetAttribute("name")->GetAsString(), i);

  DeviceReader reader(model, std::move(drives), report);
  std::vector<Device> devices;
  std::set<std::pair<bool, std::string>> names;
  for (const auto& [element, extension, prefix] : found) {
    std::optional<ExtensionValues> values = ExtensionValues::read(element, *extension, report);
    if (!values) continue;
    values->put_in_scope(prefix, *extension);
    if (!names.emplace(commands(extension->name), values->name()).second)
      report.problem(element, "another device of the model has the name '" + values->name() + "'");
    if (std::optional<Device> device = reader.read(*values, extension->name)) devices.push_back(*std::move(device));
  }
  return devices;
}

}  // namespace cohort::description
