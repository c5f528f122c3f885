// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "idl/dds/dds.hpp"
#include "idl/dds/ros2/discovery_info.hpp"

/// Internal to this folder.
namespace cohort::ros2 {

struct ParticipantState {
  std::unique_ptr<wire::ParticipantState> dds;
  ParticipantInfo info;  ///< the node and its endpoints

  dds_entity_t handle() const { return dds->participant.handle(); }
};

Gid to_gid(const dds_guid_t& guid);
/// Returns the user data of a QoS, without a trailing NUL.
std::string user_data_of(const dds_qos_t* qos);

}  // namespace cohort::ros2
