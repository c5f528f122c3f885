// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/core/infinity.hpp"
#include "server/core/text.hpp"
#include "server/parsing/plugins/counterparts.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/sdf/sdf_values.hpp"

// The parameters and their defaults are documented at TrackedVehicle and TrackController of the namespace
// gz::sim::systems of https://gazebosim.org/api/sim.
namespace cohort::parsing {
namespace {

constexpr double usual_belt_velocity = 10.0;  // default for a belt (docs/gazebo.md) [m/s]
constexpr ParameterNames of_topics = {"velocity_topic",
                                      "center_of_rotation_topic",
                                      "odometry_topic",
                                      "odometry_publish_frequency",
                                      "steering_efficiency_topic",
                                      "debug"};

template <class Visit>
void for_siblings(const ModelPlugin& plugin, std::string_view name, const Visit& visit) {
  const Element* const model = plugin.element()->parent();
  for (const Element* const child : model->children()) {
    const PluginKind* const kind = child->name() == "plugin" ? plugin_kind_of(child) : nullptr;
    if (kind != nullptr && kind->name == name) visit(child);
  }
}

// Returns the link of a plugin, or of a track in one; empty if it names none.
std::string link_said_by(const Element* element) {
  const Element* const link = element->child("link");
  return link ? text_of_parameter(link) : std::string();
}

bool is_track_of(const Element* vehicle, const std::string& link) {
  for (const Element* const child : vehicle->children())
    if ((child->name() == "left_track" || child->name() == "right_track") && link_said_by(child) == link) return true;
  return false;
}

// Returns the maximum velocity in both directions; a minimum is also read if it is the opposite.
std::optional<double> greatest_velocity(Plugin& plugin) {
  const auto most = plugin.number({"max_velocity"});
  const Element* const least = plugin.element()->child("min_velocity");
  if (most && least && parse_real(text_of_parameter(least)) == -*most) plugin.all({"min_velocity"});
  return most;
}

double limit_or(double fallback, ModelPlugin& plugin, const char* name) {
  const Element* const element = plugin.first({name});
  if (!element) return fallback;
  Plugin limits(element, plugin.report());
  const double limit = greatest_velocity(limits).value_or(fallback);
  limits.warn_of_unread();
  return limit;
}

// Reads the tracks of one side; returns the smallest maximum velocity of their controllers.
double take_tracks(ModelPlugin& plugin, ModelPlugin::Values& values, const char* side, std::string_view key) {
  const std::vector<const Element*> tracks = plugin.all({side});
  if (tracks.empty()) plugin.report().problem(plugin.element(), "missing: a track", side);
  double least = infinity;
  for (const Element* track : tracks) {
    const std::string link = link_said_by(track);
    if (link.empty()) {
      plugin.report().problem(track, "missing: the link of the track", "link");
      continue;
    }
    values.set(key, link, track->child("link"));
    for_siblings(plugin, "TrackController", [&](const Element* controller) {
      if (link_said_by(controller) != link) return;
      Plugin limits(controller, plugin.report());
      least = std::min(least, greatest_velocity(limits).value_or(infinity));
    });
  }
  return least;
}

}  // namespace

void tracked_vehicle(ModelPlugin& plugin) {
  plugin.all(of_topics);
  plugin.all({"body_link", "tracks_height", "track_height"});  // unused centre and odometry
  ModelPlugin::Values values = plugin.as<TrackedDrive>();
  const double left = take_tracks(plugin, values, "left_track", "left_link");
  const double right = take_tracks(plugin, values, "right_track", "right_link");
  const double fastest = std::min({left, right, usual_belt_velocity});
  const double separation = plugin.number_or(1.0, {"tracks_separation"});
  const double efficiency = plugin.number_or(0.5, {"steering_efficiency"});
  values.set("track_separation", separation)
      .set("steering_efficiency", efficiency, plugin.first({"steering_efficiency"}))
      .set("max_velocity", fastest)
      .set("max_linear", limit_or(fastest, plugin, "linear_velocity"))
      .set("max_angular", limit_or(2.0 * fastest * efficiency / separation, plugin, "angular_velocity"))
      .finish("cmd_vel");
}

void track_controller(ModelPlugin& plugin) {
  plugin.all(of_topics);
  const double most = greatest_velocity(plugin).value_or(usual_belt_velocity);
  const std::string link = link_said_by(plugin.element());
  bool is_of_vehicle = false;  // which drives it, within its limits
  for_siblings(plugin, "TrackedVehicle",
               [&](const Element* vehicle) { is_of_vehicle = is_of_vehicle || is_track_of(vehicle, link); });
  if (is_of_vehicle) {
    plugin.all({"link"});
    return;
  }
  ModelPlugin::Values values = plugin.as<Belt>();
  values.take("link", {"link"});
  if (const auto turn = plugin.vector({"track_orientation"})) {  // roll, pitch, yaw
    const Eigen::Vector3d axis_L =
        Eigen::AngleAxisd(turn->z(), Eigen::Vector3d::UnitZ()) *
        (Eigen::AngleAxisd(turn->y(), Eigen::Vector3d::UnitY()) *
         (Eigen::AngleAxisd(turn->x(), Eigen::Vector3d::UnitX()) * Eigen::Vector3d::UnitY()));
    values.set("axis", shortest_text(axis_L.x()) + " " + shortest_text(axis_L.y()) + " " + shortest_text(axis_L.z()));
  }
  values.set("max_velocity", most).finish(link);
}

}  // namespace cohort::parsing
