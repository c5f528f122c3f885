// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/ros_type_hash.hpp"

#include <gtest/gtest.h>

#include "tests/support/every_ros_message.hpp"

namespace cohort::messages {
namespace {

// As nodes of ROS 2 Jazzy tell them.
TEST(RosTypeHash, IsThatOfRosForItsMessages) {
  EXPECT_EQ(type_hash<ros::Time>(), "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197");
  EXPECT_EQ(type_hash<ros::Clock>(), "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564");
  EXPECT_EQ(type_hash<ros::String>(), "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
  EXPECT_EQ(type_hash<ros::Twist>(), "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a");
  EXPECT_EQ(type_hash<ros::TwistStamped>(), "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64");
  EXPECT_EQ(type_hash<ros::Odometry>(), "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
  EXPECT_EQ(type_hash<ros::LaserScan>(), "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828");
  EXPECT_EQ(type_hash<ros::Range>(), "RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a");
  EXPECT_EQ(type_hash<ros::Imu>(), "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b");
  EXPECT_EQ(type_hash<ros::TFMessage>(), "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
}

TEST(RosTypeHash, KnowsMessagesWithoutFieldsAndWithBounds) {
  EXPECT_EQ(type_hash<ros::Empty>(), "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312");
  EXPECT_EQ(type_hash<ros::ParticipantEntitiesInfo>(),
            "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e");
}

struct SetBool {
  struct Request {
    bool data = false;
    static constexpr const char* type = "std_srvs/srv/SetBool_Request";
    static constexpr auto fields = std::tuple(field("data", &Request::data));
  };
  struct Response {
    bool success = false;
    std::string message{};
    static constexpr const char* type = "std_srvs/srv/SetBool_Response";
    static constexpr auto fields =
        std::tuple(field("success", &Response::success), field("message", &Response::message));
  };
  static constexpr const char* type = "std_srvs/srv/SetBool";
};

TEST(RosTypeHash, IsThatOfRosForAService) {
  EXPECT_EQ(type_hash<SetBool>(), "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a");
  EXPECT_EQ(type_hash<SetBool::Request>(), "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e");
}

}  // namespace
}  // namespace cohort::messages
