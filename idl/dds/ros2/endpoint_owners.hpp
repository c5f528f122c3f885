// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/dds/ros2/opaque_topic.hpp"

/// RTPS requires the announcement of an endpoint to contain the GUID of its participant. Cyclone omits it, because the
/// endpoint's GUID starts with it. rmw_fastrtps on Fast DDS 3 then assigns the endpoint to no node.
namespace cohort::ros2 {

/// Makes the domain of a topic announce the participants of endpoints that are created from now on.
void announce_owners(const OpaqueTopic& topic);

}  // namespace cohort::ros2
