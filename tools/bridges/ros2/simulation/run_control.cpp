// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/simulation/run_control.hpp"

namespace cohort::ros2 {

using wire::ResultCode;

wire::Reply RunControl::ask(const wire::Operation& operation, std::chrono::milliseconds at_most) {
  if (auto reply = client_.ask(operation, at_most, stop_)) return std::move(*reply);
  wire::Reply failed;
  failed.operation = wire::code_of(operation);
  failed.result = ResultCode::operation_failed;
  if (stop_)
    failed.error_message = "the bridge has ended";
  else if (client_.server_is_gone())
    failed.error_message = "the server is gone";
  else
    failed.error_message = "the request was not completed within " + std::to_string(at_most.count() / 1000) + " s";
  return failed;
}

messages::ros::simulation::Result result_of(const wire::Reply& reply) {
  // Cohort's own result codes have no number in ROS 2.
  const bool is_ours = reply.result >= ResultCode::malformed;
  return {static_cast<std::uint8_t>(is_ours ? ResultCode::operation_failed : reply.result), reply.error_message};
}

}  // namespace cohort::ros2
