// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_simulation_messages.hpp"

/// Services of the ROS 2 package simulation_interfaces 2.1 that query entities, places and worlds.
namespace cohort::messages::ros::simulation {

struct GetEntityInfo {
  struct Request {
    std::string entity{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityInfo_Request";
    static constexpr auto fields = std::tuple(field("entity", &Request::entity));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    EntityInfo info{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityInfo_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("info", &Response::info));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetEntityInfo";
};

struct SetEntityInfo {
  struct Request {
    std::string entity{};
    EntityInfo info{};
    static constexpr const char* type = "simulation_interfaces/srv/SetEntityInfo_Request";
    static constexpr auto fields = std::tuple(field("entity", &Request::entity), field("info", &Request::info));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr const char* type = "simulation_interfaces/srv/SetEntityInfo_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/SetEntityInfo";
};

struct GetEntityBounds {
  struct Request {
    std::string entity{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityBounds_Request";
    static constexpr auto fields = std::tuple(field("entity", &Request::entity));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    Bounds bounds{};
    static constexpr const char* type = "simulation_interfaces/srv/GetEntityBounds_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("bounds", &Response::bounds));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetEntityBounds";
};

struct GetNamedPoses {
  struct Request {
    TagsFilter tags{};
    static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoses_Request";
    static constexpr auto fields = std::tuple(field("tags", &Request::tags));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<NamedPose> poses{};
    static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoses_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("poses", &Response::poses));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoses";
};

struct GetNamedPoseBounds {
  struct Request {
    std::string name{};
    static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoseBounds_Request";
    static constexpr auto fields = std::tuple(field("name", &Request::name));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    Bounds bounds{};
    static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoseBounds_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("bounds", &Response::bounds));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetNamedPoseBounds";
};

struct GetSpawnables {
  struct Request {
    std::vector<std::string> sources{};
    static constexpr const char* type = "simulation_interfaces/srv/GetSpawnables_Request";
    static constexpr auto fields = std::tuple(field("sources", &Request::sources));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<Spawnable> spawnables{};
    static constexpr const char* type = "simulation_interfaces/srv/GetSpawnables_Response";
    static constexpr auto fields =
        std::tuple(field("result", &Response::result), field("spawnables", &Response::spawnables));
    bool operator==(const Response&) const = default;
  };
  /// The reply of versions 1.x, in releases up to Kilted.
  struct FormerResponse {
    Result result{};
    std::vector<FormerSpawnable> spawnables{};
    static constexpr const char* type = "simulation_interfaces/srv/GetSpawnables_Response";
    static constexpr auto fields =
        std::tuple(field("result", &FormerResponse::result), field("spawnables", &FormerResponse::spawnables));
    bool operator==(const FormerResponse&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetSpawnables";
};

struct LoadWorld {
  struct Request {
    Resource world_resource{};
    bool fail_on_unsupported_element = false;
    bool ignore_missing_or_unsupported_assets = false;
    static constexpr const char* type = "simulation_interfaces/srv/LoadWorld_Request";
    static constexpr auto fields =
        std::tuple(field("world_resource", &Request::world_resource),
                   field("fail_on_unsupported_element", &Request::fail_on_unsupported_element),
                   field("ignore_missing_or_unsupported_assets", &Request::ignore_missing_or_unsupported_assets));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    WorldResource world{};
    static constexpr std::uint8_t unsupported_format = 101;
    static constexpr std::uint8_t no_resource = 102;
    static constexpr std::uint8_t resource_parse_error = 103;
    static constexpr std::uint8_t missing_assets = 104;
    static constexpr std::uint8_t unsupported_assets = 105;
    static constexpr std::uint8_t unsupported_elements = 106;
    static constexpr const char* type = "simulation_interfaces/srv/LoadWorld_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("world", &Response::world));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/LoadWorld";
};

struct UnloadWorld {
  struct Request {
    static constexpr const char* type = "simulation_interfaces/srv/UnloadWorld_Request";
    static constexpr auto fields = std::tuple();
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    static constexpr std::uint8_t no_world_loaded = 101;
    static constexpr const char* type = "simulation_interfaces/srv/UnloadWorld_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/UnloadWorld";
};

struct GetCurrentWorld {
  struct Request {
    static constexpr const char* type = "simulation_interfaces/srv/GetCurrentWorld_Request";
    static constexpr auto fields = std::tuple();
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    WorldResource world{};
    static constexpr std::uint8_t no_world_loaded = 101;
    static constexpr const char* type = "simulation_interfaces/srv/GetCurrentWorld_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("world", &Response::world));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetCurrentWorld";
};

struct GetAvailableWorlds {
  struct Request {
    std::vector<std::string> additional_sources{};
    TagsFilter filter{};
    bool offline_only = false;
    bool continue_on_error = false;
    static constexpr const char* type = "simulation_interfaces/srv/GetAvailableWorlds_Request";
    static constexpr auto fields = std::tuple(
        field("additional_sources", &Request::additional_sources), field("filter", &Request::filter),
        field("offline_only", &Request::offline_only), field("continue_on_error", &Request::continue_on_error));
    bool operator==(const Request&) const = default;
  };
  struct Response {
    Result result{};
    std::vector<WorldResource> worlds{};
    static constexpr std::uint8_t default_sources_failed = 101;
    static constexpr const char* type = "simulation_interfaces/srv/GetAvailableWorlds_Response";
    static constexpr auto fields = std::tuple(field("result", &Response::result), field("worlds", &Response::worlds));
    bool operator==(const Response&) const = default;
  };
  static constexpr const char* type = "simulation_interfaces/srv/GetAvailableWorlds";
};

}  // namespace cohort::messages::ros::simulation
