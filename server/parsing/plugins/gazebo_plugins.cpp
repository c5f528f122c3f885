// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/plugins/gazebo_plugins.hpp"

#include <algorithm>
#include <cctype>

#include "server/parsing/plugins/counterparts.hpp"

namespace cohort::parsing {
namespace {

// In the order of docs/gazebo.md.
constexpr PluginKind known_plugins[] = {
    {"DiffDrive", diff_drive},
    {"AckermannSteering", ackermann_steering},
    {"TrackedVehicle", tracked_vehicle},
    {"TrackController", track_controller},
    {"JointController", joint_controller},
    {"JointPositionController", joint_position_controller},
    {"JointStatePublisher", joint_state_publisher},
    {"MulticopterMotorModel", multicopter_motor_model},
    {"Thruster", thruster},
    {"LiftDrag", lift_drag},
    {"Hydrodynamics", hydrodynamics},
    {"DetachableJoint", detachable_joint},
    {"LinearBatteryPlugin", linear_battery},
    {"Buoyancy", nullptr, buoyancy},
    {"WindEffects", nullptr, wind_effects},
    // Plugins of Gazebo:
    {"Physics"},
    {"UserCommands"},
    {"SceneBroadcaster"},
    {"Sensors"},
    {"Imu"},
    {"Contact"},
    {"Altimeter"},
    {"AirPressure"},
    {"Magnetometer"},
    {"ForceTorque"},
    {"LogicalCamera"},
    {"NavSat"},
    {"PosePublisher"},
    {"OdometryPublisher"},
    {"LogRecord"},
    // Plugins of gazebo_ros and classic Gazebo, by their files:
    {"gazebo_ros_init"},
    {"gazebo_ros_factory"},
    {"gazebo_ros_state"},
    {"gazebo_ros_force_system"},
    {"gazebo_ros_properties"},
    {"gazebo_ros_api"},
    {"gazebo_ros_paths"},
    {"gazebo_ros_p3d"},
    {"gazebo_ros_imu"},
    {"gazebo_ros_imu_sensor"},
    {"gazebo_ros_ray_sensor"},
    {"gazebo_ros_laser"},
    {"gazebo_ros_gpu_laser"},
    {"gazebo_ros_bumper"},
    {"gazebo_ros_ft_sensor"},
    {"gazebo_ros_camera"},
};

constexpr const char* plugin_is_ignored = "the plugin is ignored";

// Returns the common part of all spellings of a name: `libignition-gazebo6-diff-drive-system.so`,
// `gz-sim-diff-drive-system`, `libgazebo_ros_diff_drive.so` and `DiffDrive` give "diffdrive".
std::string plain(std::string_view name) {
  if (const std::size_t end = name.find(".so"); end != std::string_view::npos) name = name.substr(0, end);
  if (const std::size_t slash = name.rfind('/'); slash != std::string_view::npos) name = name.substr(slash + 1);
  if (name.starts_with("lib")) name.remove_prefix(3);
  for (const std::string_view maker : {"gz-sim", "ignition-gazebo", "gazebo_ros_", "gazebo_"}) {
    if (!name.starts_with(maker)) continue;
    name.remove_prefix(maker.size());
    while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) != 0) name.remove_prefix(1);
    break;
  }
  std::string letters;
  for (const char each : name)
    if (std::isalnum(static_cast<unsigned char>(each)) != 0)
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  for (const std::string_view kind : {"system", "plugin"})
    if (letters.ends_with(kind)) letters.resize(letters.size() - kind.size());
  return letters;
}

const PluginKind* find_plugin(std::string_view name) {
  const auto found =
      std::ranges::find(known_plugins, plain(name), [](const PluginKind& kind) { return plain(kind.name); });
  return found == std::end(known_plugins) ? nullptr : found;
}

std::string attribute_of(const Element* plugin, const char* name) { return plugin->attribute(name); }

template <class Visit>
void for_plugins(const Element* element, const Visit& visit) {
  for (const Element* const child : element->children())
    if (child->name() == "plugin")
      if (const PluginKind* const kind = plugin_kind_of(child)) visit(child, *kind);
}

// Returns whether the device drives the object that a key names; a link usually only carries the device.
bool names_what_is_driven(const Extension& extension, std::string_view key) {
  return (key != "link" && key != "child_link") || extension.name == "belt";
}

// Returns the texts in `cohort:` actuators of a model, which include the names of joints and links.
std::set<std::string> words_of_actuators(const Element* model_element) {
  std::set<std::string> words;
  for (const Element* const child : model_element->children()) {
    const Extension* const extension =
        has_prefix(child->name()) ? find_extension(without_prefix(child->name()), "model") : nullptr;
    if (extension == nullptr || extension->topic != "actuators") continue;
    for (const Element* const key : child->children())
      if (names_what_is_driven(*extension, without_prefix(key->name()))) words.insert(text_of_parameter(key));
  }
  return words;
}

bool drives_one_of(const Counterpart& counterpart, const std::set<std::string>& driven) {
  if (counterpart.extension->topic != "actuators") return false;
  return std::ranges::any_of(counterpart.extension->keys, [&](const ExtensionKey& key) {
    const bool is_name = key.value == ExtensionValue::name || key.value == ExtensionValue::object;
    if (!is_name || !names_what_is_driven(*counterpart.extension, key.name)) return false;
    const std::vector<std::string> texts = counterpart.values.texts(key.name);
    return std::ranges::any_of(texts, [&](const std::string& text) { return driven.contains(text); });
  });
}

}  // namespace

std::span<const PluginKind> plugin_kinds() { return known_plugins; }

const PluginKind* plugin_kind_of(const Element* plugin) {
  const std::string name = attribute_of(plugin, "name");
  constexpr std::string_view before_class = "::systems::";
  const std::size_t place = name.find(before_class);
  const PluginKind* const by_class =
      place == std::string::npos ? nullptr : find_plugin(name.substr(place + before_class.size()));
  return by_class != nullptr ? by_class : find_plugin(attribute_of(plugin, "filename"));
}

void warn_of_unknown_plugin(const Element* plugin, const SdfReport& report) {
  if (plugin_kind_of(plugin) == nullptr)
    report.warning_once(plugin,
                        "the plugin '" + attribute_of(plugin, "filename") + "' is not supported and is ignored");
}

void warn_of_static_belts(const Element* model_element, const SdfReport& report) {
  for_plugins(model_element, [&](const Element* element, const PluginKind& kind) {
    if (kind.in_model == track_controller)
      report.warning(
          element,
          "is ignored because the model is static; for a belt, replace <static> with a fixed joint to the world");
  });
}

std::vector<Counterpart> read_model_plugins(const Element* model_element, const std::string& prefix,
                                            const std::set<const Element*>& elsewhere, const Model& model,
                                            std::set<std::string>& names, const SdfReport& report) {
  const std::set<std::string> driven = words_of_actuators(model_element);
  std::vector<Counterpart> counterparts;
  for_plugins(model_element, [&](const Element* element, const PluginKind& kind) {
    if (kind.in_model == nullptr || elsewhere.contains(element)) return;
    ModelPlugin plugin(element, prefix, model, names, report);
    const std::size_t before = report.count();
    kind.in_model(plugin);
    if (report.forgive(element, before, plugin_is_ignored)) return;
    plugin.warn_of_unread();
    for (Counterpart& counterpart : plugin.counterparts())
      if (!drives_one_of(counterpart, driven)) counterparts.push_back(std::move(counterpart));
  });
  return counterparts;
}

bool has_wind_effects(const Element& world_element) {
  bool has = false;
  for_plugins(&world_element,
              [&](const Element*, const PluginKind& kind) { has = has || kind.in_world == wind_effects; });
  return has;
}

void read_world_plugins(const Element* world_element, World& world, const SdfReport& report) {
  for_plugins(world_element, [&](const Element* element, const PluginKind& kind) {
    if (kind.in_world == nullptr) return;
    Plugin plugin(element, report);
    const std::size_t before = report.count();
    kind.in_world(plugin, world);
    report.forgive(element, before, plugin_is_ignored);
    plugin.warn_of_unread();
  });
}

}  // namespace cohort::parsing
