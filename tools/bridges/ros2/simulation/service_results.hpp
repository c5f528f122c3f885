// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/ros_simulation_services.hpp"

/// The results of requests to the server in the format of the services.
namespace cohort::ros2 {

/// Returns the result of a request that has succeeded, with the server's message.
messages::ros::simulation::Result result_of(const ControlReply& reply);

/// Returns the result of a request that has failed. A reason that has no number in ROS 2 is OPERATION_FAILED. The
/// number of an invalid pose differs between services.
messages::ros::simulation::Result result_of(
    const ControlError& error,
    std::uint8_t invalid_pose = messages::ros::simulation::SetEntityState::Response::invalid_pose);

}  // namespace cohort::ros2
