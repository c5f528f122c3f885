// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_geometry_messages.hpp"

/// Messages of the ROS 2 package simulation_interfaces 2.1: services and topics to control any simulator.
namespace cohort::messages::ros::simulation {

/// The location of a text, or the text itself.
struct Resource {
  std::string uri{};
  std::string resource_string{};
  static constexpr const char* type = "simulation_interfaces/msg/Resource";
  static constexpr auto fields =
      std::tuple(field("uri", &Resource::uri), field("resource_string", &Resource::resource_string));
  bool operator==(const Resource&) const = default;
};

/// The result of a service. Codes above 100 are specific to the service.
struct Result {
  std::uint8_t result = 0;
  std::string error_message{};
  static constexpr std::uint8_t feature_unsupported = 0;
  static constexpr std::uint8_t ok = 1;
  static constexpr std::uint8_t not_found = 2;
  static constexpr std::uint8_t incorrect_state = 3;
  static constexpr std::uint8_t operation_failed = 4;
  static constexpr const char* type = "simulation_interfaces/msg/Result";
  static constexpr auto fields =
      std::tuple(field("result", &Result::result), field("error_message", &Result::error_message));
  bool operator==(const Result&) const = default;
};

/// A box as two corners, a convex hull as its points, or a sphere as its centre and a second point whose x is the
/// radius.
struct Bounds {
  std::uint8_t type_of_bounds = 0;
  std::vector<Vector3> points{};
  static constexpr std::uint8_t empty = 0;
  static constexpr std::uint8_t box = 1;
  static constexpr std::uint8_t convex_hull = 2;
  static constexpr std::uint8_t sphere = 3;
  static constexpr const char* type = "simulation_interfaces/msg/Bounds";
  static constexpr auto fields = std::tuple(field("type", &Bounds::type_of_bounds), field("points", &Bounds::points));
  bool operator==(const Bounds&) const = default;
};

struct EntityCategory {
  std::uint8_t category = 0;
  static constexpr std::uint8_t object = 0;
  static constexpr std::uint8_t robot = 1;
  static constexpr std::uint8_t human = 2;
  static constexpr std::uint8_t dynamic_object = 4;
  static constexpr std::uint8_t static_object = 5;
  static constexpr const char* type = "simulation_interfaces/msg/EntityCategory";
  static constexpr auto fields = std::tuple(field("category", &EntityCategory::category));
  bool operator==(const EntityCategory&) const = default;
};

struct TagsFilter {
  std::vector<std::string> tags{};
  std::uint8_t filter_mode = 0;
  static constexpr std::uint8_t any = 0;
  static constexpr std::uint8_t all = 1;
  static constexpr const char* type = "simulation_interfaces/msg/TagsFilter";
  static constexpr auto fields =
      std::tuple(field("tags", &TagsFilter::tags), field("filter_mode", &TagsFilter::filter_mode));
  bool operator==(const TagsFilter&) const = default;
};

/// `filter` is a regular expression of names. An empty field selects everything.
struct EntityFilters {
  std::string filter{};
  std::vector<EntityCategory> categories{};
  TagsFilter tags{};
  Bounds bounds{};
  static constexpr const char* type = "simulation_interfaces/msg/EntityFilters";
  static constexpr auto fields =
      std::tuple(field("filter", &EntityFilters::filter), field("categories", &EntityFilters::categories),
                 field("tags", &EntityFilters::tags), field("bounds", &EntityFilters::bounds));
  bool operator==(const EntityFilters&) const = default;
};

struct EntityInfo {
  EntityCategory category{};
  std::string description{};
  std::vector<std::string> tags{};
  static constexpr const char* type = "simulation_interfaces/msg/EntityInfo";
  static constexpr auto fields =
      std::tuple(field("category", &EntityInfo::category), field("description", &EntityInfo::description),
                 field("tags", &EntityInfo::tags));
  bool operator==(const EntityInfo&) const = default;
};

struct EntityState {
  Header header{};
  Pose pose{};
  Twist twist{};
  Accel acceleration{};
  static constexpr const char* type = "simulation_interfaces/msg/EntityState";
  static constexpr auto fields =
      std::tuple(field("header", &EntityState::header), field("pose", &EntityState::pose),
                 field("twist", &EntityState::twist), field("acceleration", &EntityState::acceleration));
  bool operator==(const EntityState&) const = default;
};

struct NamedPose {
  std::string name{};
  std::string description{};
  std::vector<std::string> tags{};
  Pose pose{};
  static constexpr const char* type = "simulation_interfaces/msg/NamedPose";
  static constexpr auto fields =
      std::tuple(field("name", &NamedPose::name), field("description", &NamedPose::description),
                 field("tags", &NamedPose::tags), field("pose", &NamedPose::pose));
  bool operator==(const NamedPose&) const = default;
};

struct SimulationState {
  std::uint8_t state = 0;
  static constexpr std::uint8_t stopped = 0;
  static constexpr std::uint8_t playing = 1;
  static constexpr std::uint8_t paused = 2;
  static constexpr std::uint8_t quitting = 3;
  static constexpr std::uint8_t no_world = 4;
  static constexpr std::uint8_t loading_world = 5;
  static constexpr const char* type = "simulation_interfaces/msg/SimulationState";
  static constexpr auto fields = std::tuple(field("state", &SimulationState::state));
  bool operator==(const SimulationState&) const = default;
};

struct SimulatorFeatures {
  std::vector<std::uint16_t> features{};
  std::vector<std::string> spawn_formats{};
  std::string custom_info{};
  static constexpr std::uint16_t spawning = 0;
  static constexpr std::uint16_t deleting = 1;
  static constexpr std::uint16_t named_poses = 2;
  static constexpr std::uint16_t pose_bounds = 3;
  static constexpr std::uint16_t entity_tags = 4;
  static constexpr std::uint16_t entity_bounds = 5;
  static constexpr std::uint16_t entity_bounds_box = 6;
  static constexpr std::uint16_t entity_bounds_convex = 7;
  static constexpr std::uint16_t entity_categories = 8;
  static constexpr std::uint16_t spawning_resource_string = 9;
  static constexpr std::uint16_t entity_state_getting = 10;
  static constexpr std::uint16_t entity_state_setting = 11;
  static constexpr std::uint16_t entity_info_getting = 12;
  static constexpr std::uint16_t entity_info_setting = 13;
  static constexpr std::uint16_t spawnables = 14;
  static constexpr std::uint16_t simulation_reset = 20;
  static constexpr std::uint16_t simulation_reset_time = 21;
  static constexpr std::uint16_t simulation_reset_state = 22;
  static constexpr std::uint16_t simulation_reset_spawned = 23;
  static constexpr std::uint16_t simulation_state_getting = 24;
  static constexpr std::uint16_t simulation_state_setting = 25;
  static constexpr std::uint16_t simulation_state_pause = 26;
  static constexpr std::uint16_t step_simulation_single = 31;
  static constexpr std::uint16_t step_simulation_multiple = 32;
  static constexpr std::uint16_t step_simulation_action = 33;
  static constexpr std::uint16_t world_loading = 40;
  static constexpr std::uint16_t world_resource_string = 41;
  static constexpr std::uint16_t world_tags = 42;
  static constexpr std::uint16_t world_unloading = 43;
  static constexpr std::uint16_t world_info_getting = 44;
  static constexpr std::uint16_t available_worlds = 45;
  static constexpr std::uint16_t spawning_entities = 50;
  static constexpr const char* type = "simulation_interfaces/msg/SimulatorFeatures";
  static constexpr auto fields = std::tuple(field("features", &SimulatorFeatures::features),
                                            field("spawn_formats", &SimulatorFeatures::spawn_formats),
                                            field("custom_info", &SimulatorFeatures::custom_info));
  bool operator==(const SimulatorFeatures&) const = default;
};

struct Spawnable {
  Resource entity_resource{};
  std::string description{};
  Bounds spawn_bounds{};
  static constexpr const char* type = "simulation_interfaces/msg/Spawnable";
  static constexpr auto fields =
      std::tuple(field("entity_resource", &Spawnable::entity_resource), field("description", &Spawnable::description),
                 field("spawn_bounds", &Spawnable::spawn_bounds));
  bool operator==(const Spawnable&) const = default;
};

/// The message of versions 1.x, in releases up to Kilted.
struct FormerSpawnable {
  std::string uri{};
  std::string description{};
  Bounds spawn_bounds{};
  static constexpr const char* type = "simulation_interfaces/msg/Spawnable";
  static constexpr auto fields =
      std::tuple(field("uri", &FormerSpawnable::uri), field("description", &FormerSpawnable::description),
                 field("spawn_bounds", &FormerSpawnable::spawn_bounds));
  bool operator==(const FormerSpawnable&) const = default;
};

/// With `allow_renaming`, `name` may be changed to a free one.
struct EntityToSpawn {
  std::string name{};
  bool allow_renaming = false;
  Resource entity_resource{};
  std::string entity_namespace{};
  PoseStamped initial_pose{};
  static constexpr const char* type = "simulation_interfaces/msg/SpawnEntity";
  static constexpr auto fields = std::tuple(
      field("name", &EntityToSpawn::name), field("allow_renaming", &EntityToSpawn::allow_renaming),
      field("entity_resource", &EntityToSpawn::entity_resource),
      field("entity_namespace", &EntityToSpawn::entity_namespace), field("initial_pose", &EntityToSpawn::initial_pose));
  bool operator==(const EntityToSpawn&) const = default;
};

struct SpawnResult {
  Result result{};
  std::string entity_name{};
  static constexpr std::uint8_t name_not_unique = 101;
  static constexpr std::uint8_t name_invalid = 102;
  static constexpr std::uint8_t unsupported_format = 103;
  static constexpr std::uint8_t no_resource = 104;
  static constexpr std::uint8_t namespace_invalid = 105;
  static constexpr std::uint8_t resource_parse_error = 106;
  static constexpr std::uint8_t missing_assets = 107;
  static constexpr std::uint8_t unsupported_assets = 108;
  static constexpr std::uint8_t invalid_pose = 109;
  static constexpr const char* type = "simulation_interfaces/msg/SpawnResult";
  static constexpr auto fields =
      std::tuple(field("result", &SpawnResult::result), field("entity_name", &SpawnResult::entity_name));
  bool operator==(const SpawnResult&) const = default;
};

struct WorldResource {
  std::string name{};
  Resource world_resource{};
  std::string description{};
  std::vector<std::string> tags{};
  static constexpr const char* type = "simulation_interfaces/msg/WorldResource";
  static constexpr auto fields =
      std::tuple(field("name", &WorldResource::name), field("world_resource", &WorldResource::world_resource),
                 field("description", &WorldResource::description), field("tags", &WorldResource::tags));
  bool operator==(const WorldResource&) const = default;
};

}  // namespace cohort::messages::ros::simulation
