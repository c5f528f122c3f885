// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_simulation_messages.hpp"

/// Services of the ROS 2 package simulation_interfaces 2.1 that control the run and the entities of its world.
namespace cohort::messages::ros::simulation {

struct GetSimulatorFeatures {
  struct Request {
    static constexpr const char* type = "simulation_interfaces/srv/GetSimulatorFeatures_Request";
    static constexpr auto fields = std::tuple();
    bool operator==(const Request&) const = default;
  };
  struct Response {
    SimulatorFeatures features{};
    static constexpr const char* type = "simulation_interfaces/srv/GetSimulatorFeatures_Response";
    static constexpr auto fields = std::tuple(field("features", &Response::features));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetSimulatorFeatures";
};

struct GetSimulationState {
  struct Request {
    static constexpr const char* type = "simulation_interfaces/srv/GetSimulationState_Request";
    static constexpr auto fields = std::tuple();
    bool operator==(const Request&) const = default;
  };
  struct Response {
    SimulationState state{};
    Result result{};
    static constexpr const char* type = "simulation_interfaces/srv/GetSimulationState_Response";
    static constexpr auto fields = std::tuple(field("state", &Response::state), field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetSimulationState";
};

struct SetSimulationState {
  struct Request {
    SimulationState state{};
    static constexpr const char* type = "simulation_interfaces/srv/SetSimulationState_Request";
    static constexpr auto fields = std::tuple(field("state", &Request::state));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr std::uint8_t already_in_target_state = 101;
    static constexpr std::uint8_t state_transition_error = 102;
    static constexpr std::uint8_t incorrect_transition = 103;
    static constexpr const char* type = "simulation_interfaces/srv/SetSimulationState_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/SetSimulationState";
};

struct ResetSimulation {
  struct Request {
    std::uint8_t scope = 0;
    static constexpr std::uint8_t scope_default = 0;
    static constexpr std::uint8_t scope_time = 1;
    static constexpr std::uint8_t scope_state = 2;
    static constexpr std::uint8_t scope_spawned = 4;
    static constexpr std::uint8_t scope_all = 255;
    static constexpr const char* type = "simulation_interfaces/srv/ResetSimulation_Request";
    static constexpr auto fields = std::tuple(field("scope", &Request::scope));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr const char* type = "simulation_interfaces/srv/ResetSimulation_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/ResetSimulation";
};

/// Steps a paused simulation; replies when the steps are done.
struct StepSimulation {
  struct Request {
    std::uint64_t steps = 1;
    static constexpr const char* type = "simulation_interfaces/srv/StepSimulation_Request";
    static constexpr auto fields = std::tuple(field("steps", &Request::steps));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr const char* type = "simulation_interfaces/srv/StepSimulation_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/StepSimulation";
};

/// Its result codes are those of SpawnResult.
struct SpawnEntity {
  struct Request {
    std::string name{};
    bool allow_renaming = false;
    Resource entity_resource{};
    std::string entity_namespace{};
    PoseStamped initial_pose{};
    static constexpr const char* type = "simulation_interfaces/srv/SpawnEntity_Request";
    static constexpr auto fields = std::tuple(
        field("name", &Request::name), field("allow_renaming", &Request::allow_renaming),
        field("entity_resource", &Request::entity_resource), field("entity_namespace", &Request::entity_namespace),
        field("initial_pose", &Request::initial_pose));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::string entity_name{};
    static constexpr const char* type = "simulation_interfaces/srv/SpawnEntity_Response";
    static constexpr auto fields =
        std::tuple(field("result", &Response::result), field("entity_name", &Response::entity_name));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/SpawnEntity";
};

struct SpawnEntities {
  struct Request {
    std::vector<EntityToSpawn> spawn_requests{};
    static constexpr const char* type = "simulation_interfaces/srv/SpawnEntities_Request";
    static constexpr auto fields = std::tuple(field("spawn_requests", &Request::spawn_requests));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<SpawnResult> results{};
    static constexpr std::uint8_t entities_spawn_failed = 150;
    static constexpr const char* type = "simulation_interfaces/srv/SpawnEntities_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("results", &Response::results));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/SpawnEntities";
};

struct DeleteEntity {
  struct Request {
    std::string entity{};
    static constexpr const char* type = "simulation_interfaces/srv/DeleteEntity_Request";
    static constexpr auto fields = std::tuple(field("entity", &Request::entity));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr const char* type = "simulation_interfaces/srv/DeleteEntity_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/DeleteEntity";
};

struct GetEntities {
  struct Request {
    EntityFilters filters{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntities_Request";
    static constexpr auto fields = std::tuple(field("filters", &Request::filters));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<std::string> entities{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntities_Response";
    static constexpr auto fields =
        std::tuple(field("result", &Response::result), field("entities", &Response::entities));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetEntities";
};

struct GetEntitiesStates {
  struct Request {
    EntityFilters filters{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntitiesStates_Request";
    static constexpr auto fields = std::tuple(field("filters", &Request::filters));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<std::string> entities{};
    std::vector<EntityState> states{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntitiesStates_Response";
    static constexpr auto fields = std::tuple(
        field("result", &Response::result), field("entities", &Response::entities), field("states", &Response::states));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetEntitiesStates";
};

struct GetEntityState {
  struct Request {
    std::string entity{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityState_Request";
    static constexpr auto fields = std::tuple(field("entity", &Request::entity));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    EntityState state{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityState_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("state", &Response::state));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetEntityState";
};

struct SetEntityState {
  struct Request {
    std::string entity{};
    EntityState state{};
    bool set_pose = false;
    bool set_twist = false;
    bool set_acceleration = false;
    static constexpr const char* type = "simulation_interfaces/srv/SetEntityState_Request";
    static constexpr auto fields = std::tuple(
        field("entity", &Request::entity), field("state", &Request::state), field("set_pose", &Request::set_pose),
        field("set_twist", &Request::set_twist), field("set_acceleration", &Request::set_acceleration));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr std::uint8_t invalid_pose = 101;
    static constexpr const char* type = "simulation_interfaces/srv/SetEntityState_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  /// The request of versions 1.x, in releases up to Kilted.
  struct FormerRequest {
    std::string entity{};
    EntityState state{};
    static constexpr const char* type = "simulation_interfaces/srv/SetEntityState_Request";
    static constexpr auto fields =
        std::tuple(field("entity", &FormerRequest::entity), field("state", &FormerRequest::state));
    bool operator==(const FormerRequest&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/SetEntityState";
};

}  // namespace cohort::messages::ros::simulation
