// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/service_results.hpp"

#include <gtest/gtest.h>

#include <string>

#include "client_sdk/src/control/control_values.hpp"

namespace cohort::ros2 {
namespace {

using messages::ros::simulation::Result;
using messages::ros::simulation::SpawnResult;
using wire::OperationCode;
using wire::ResultCode;

// As a client receives the server's `result`.
ControlError error_of(std::uint32_t result, OperationCode operation) {
  return ControlError("why", from_wire(static_cast<ResultCode>(result), operation));
}

TEST(Ros2ServiceResults, HaveTheNumberThatTheServerHasSent) {
  for (const std::uint32_t result : {0u, 2u, 3u, 4u, 101u, 102u, 104u, 106u, 107u, 108u, 109u})
    EXPECT_EQ(result_of(error_of(result, OperationCode::spawn_entity), SpawnResult::invalid_pose).result, result);
  for (const std::uint32_t result : {0u, 2u, 3u, 4u, 101u})
    EXPECT_EQ(result_of(error_of(result, OperationCode::set_entity_state)).result, result);
}

TEST(Ros2ServiceResults, AreFailuresIfRos2HasNoNumberForThem) {
  const auto last = static_cast<std::uint32_t>(ResultCode::invalid_selection);
  for (auto result = static_cast<std::uint32_t>(ResultCode::malformed); result <= last; ++result)
    EXPECT_EQ(result_of(error_of(result, OperationCode::spawn_entity)).result, Result::operation_failed) << result;
}

TEST(Ros2ServiceResults, HaveTheServersText) {
  EXPECT_EQ(result_of(error_of(2, OperationCode::delete_entity)).error_message, "why");
  EXPECT_EQ(result_of(ControlError("interrupted", ControlResult::interrupted)).error_message, "the bridge has ended");
  ControlReply reply;
  reply.message = "paused at tick 3";
  EXPECT_EQ(result_of(reply), (Result{Result::ok, "paused at tick 3"}));
}

}  // namespace
}  // namespace cohort::ros2
