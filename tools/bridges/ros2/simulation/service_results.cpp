// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/service_results.hpp"

namespace cohort::ros2 {
namespace {

using messages::ros::simulation::Result;
using messages::ros::simulation::SpawnResult;

std::uint8_t number_of(ControlResult result, std::uint8_t invalid_pose) {
  switch (result) {
    case ControlResult::feature_unsupported: return Result::feature_unsupported;
    case ControlResult::not_found: return Result::not_found;
    case ControlResult::incorrect_state: return Result::incorrect_state;
    case ControlResult::name_not_unique: return SpawnResult::name_not_unique;
    case ControlResult::name_invalid: return SpawnResult::name_invalid;
    case ControlResult::no_resource: return SpawnResult::no_resource;
    case ControlResult::invalid_model: return SpawnResult::resource_parse_error;
    case ControlResult::missing_file: return SpawnResult::missing_assets;
    case ControlResult::unsupported_model: return SpawnResult::unsupported_assets;
    case ControlResult::invalid_pose: return invalid_pose;
    default: return Result::operation_failed;
  }
}

}  // namespace

Result result_of(const ControlReply& reply) { return {Result::ok, reply.message}; }

Result result_of(const ControlError& error, std::uint8_t invalid_pose) {
  const bool is_interrupted = error.result == ControlResult::interrupted;
  return {number_of(error.result, invalid_pose), is_interrupted ? "the bridge has ended" : error.what()};
}

}  // namespace cohort::ros2
