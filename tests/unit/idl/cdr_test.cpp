// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "idl/messages/experiment_files.hpp"
#include "tests/support/any_message.hpp"
#include "tests/support/every_ros_message.hpp"

namespace cohort::messages {
namespace {

using namespace std::chrono_literals;

Bytes bytes_of_hex(std::string_view hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); ++i) {
    if (hex[i] == ' ') continue;
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    ++i;
  }
  return bytes;
}

TEST(Cdr, NumbersAreAlignedToTheirSizesAfterTheEncapsulation) {
  CdrWriter writer;
  writer.add(std::uint8_t{1});
  writer.add(std::uint16_t{0x0203});
  writer.add(true);
  writer.add(1.0);
  writer.add(std::string("ab"));
  writer.add(std::vector<float>{});
  writer.add(std::vector<double>{2.0});
  EXPECT_EQ(writer.bytes(), bytes_of_hex("00010000 01 00 0302 01 000000 000000000000f03f 03000000 616200 00 00000000 "
                                         "01000000 0000000000000040"));
  CdrReader reader(writer.bytes());
  EXPECT_EQ(reader.get<std::uint8_t>(), 1);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x0203);
  EXPECT_EQ(reader.get<bool>(), true);
  EXPECT_EQ(reader.get<double>(), 1.0);
  EXPECT_EQ(reader.get<std::string>(), "ab");
  EXPECT_TRUE(reader.get<std::vector<float>>().empty());
  EXPECT_EQ(reader.get<std::vector<double>>(), std::vector<double>{2.0});
  EXPECT_EQ(reader.left(), 0U);
}

TEST(Cdr, AMessageWithoutFieldsIsOneByte) {
  EXPECT_EQ(encode(ros::Empty{}), bytes_of_hex("00010000 00"));
  EXPECT_EQ(decode<ros::Empty>(bytes_of_hex("00010000 00")), ros::Empty{});
  EXPECT_THROW(decode<ros::Empty>(bytes_of_hex("00010000")), CdrError);
}

struct Grown {
  std::uint32_t first = 0;
  std::string second{"default"};
  std::vector<double> third{1.0};
  static constexpr const char* type = "test_msgs/msg/Grown";
  static constexpr std::size_t least_fields = 1;
  static constexpr auto fields =
      std::tuple(field("first", &Grown::first), field("second", &Grown::second), field("third", &Grown::third));
};

TEST(Cdr, AnEarlierVersionOfAGrownMessageHasDefaultValues) {
  const auto first = decode<Grown>(bytes_of_hex("00010000 07000000"));
  EXPECT_EQ(first.first, 7U);
  EXPECT_EQ(first.second, "default");
  EXPECT_EQ(first.third, std::vector<double>{1.0});
  const auto second = decode<Grown>(bytes_of_hex("00010000 07000000 02000000 6100"));
  EXPECT_EQ(second.second, "a");
  EXPECT_EQ(second.third, std::vector<double>{1.0});
  EXPECT_TRUE(decode<Grown>(bytes_of_hex("00010000 07000000 02000000 6100 0000 00000000")).third.empty());
  EXPECT_THROW(decode<Grown>(bytes_of_hex("00010000")), CdrError);
  EXPECT_THROW(decode<Grown>(bytes_of_hex("00010000 07000000 02000000 61")), CdrError);
}

TEST(Cdr, BytesAndCharactersAreNotAligned) {
  CdrWriter writer;
  writer.add('a');
  writer.add(std::byte{7});
  writer.add(std::array{std::byte{8}, std::byte{9}});
  EXPECT_EQ(writer.bytes(), bytes_of_hex("00010000 61 07 08 09"));
  CdrReader reader(writer.bytes());
  EXPECT_EQ(reader.get<char>(), 'a');
  EXPECT_EQ(reader.get<std::byte>(), std::byte{7});
  EXPECT_EQ((reader.get<std::array<std::byte, 2>>()), (std::array{std::byte{8}, std::byte{9}}));
}

// A std_msgs/Header as Fast DDS and Cyclone DDS write it.
TEST(Cdr, AHeaderHasTheBytesOfRos) {
  const ros::Header header{{1, 2}, "map"};
  EXPECT_EQ(encode(header), bytes_of_hex("00010000 01000000 02000000 04000000 6d617000"));
}

TEST(Cdr, RefusesMessagesThatAreTooShortOrOfAnotherKind) {
  EXPECT_THROW(decode<ros::Clock>(bytes_of_hex("000100")), CdrError);
  EXPECT_THROW(decode<ros::Clock>(bytes_of_hex("00000000 00000001 00000002")), CdrError);  // big-endian
  EXPECT_THROW(decode<ros::Clock>(bytes_of_hex("00010000 01000000 020000")), CdrError);
  EXPECT_THROW(decode<ros::JointState>(bytes_of_hex("00010000 01000000 02000000 01000000 00 000000 ffffffff")),
               CdrError);
  const ros::Clock clock{{1, 2}};
  EXPECT_EQ(decode<ros::Clock>(bytes_of_hex("00010000 01000000 02000000 0000")), clock);
}

template <class Message>
class RosMessages : public testing::Test {};
template <class Tuple>
struct TypesOf;
template <class... Each>
struct TypesOf<std::tuple<Each...>> {
  using List = testing::Types<Each...>;
};
using All = TypesOf<decltype(std::tuple_cat(
    test::StandardMessages(), test::SimulationMessages(), test::CohortMessages(),
    std::tuple<ExperimentFiles, ros::ParticipantEntitiesInfo, ros::HumbleParticipantEntitiesInfo,
               ros::simulation::SetEntityState::FormerRequest>()))>::List;
TYPED_TEST_SUITE(RosMessages, All);

TYPED_TEST(RosMessages, AreDecodedAsEncodedAndRefusedIfTruncated) {
  test::AnyMessage any;
  for (int i = 0; i < 20; ++i) {
    TypeParam message;
    any.fill(message);
    const Bytes bytes = encode(message);
    EXPECT_EQ(decode<TypeParam>(bytes), message);
    // A message that has grown may end with any field of an earlier version.
    std::size_t versions = 1;
    if constexpr (GrownMessage<TypeParam>)
      versions += std::tuple_size_v<decltype(TypeParam::fields)> - TypeParam::least_fields;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      try {
        decode<TypeParam>(ByteView(bytes).first(size));
        --versions;
      } catch (const CdrError&) {
      }
    }
    EXPECT_EQ(versions, 1u);
  }
}

// Any bytes give a message or an error.
TYPED_TEST(RosMessages, TakeAnyBytes) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes(4 + random() % 100);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() % 8 == 0 ? random() : random() % 4);
    bytes[0] = std::byte{0};
    bytes[1] = std::byte{1};
    try {
      decode<TypeParam>(bytes);
    } catch (const CdrError&) {
    }
  }
}

TEST(RosSchema, HasEachNestedMessageOnceInTheOrderOfRosbag2) {
  const std::string line = "\n" + std::string(80, '=') + "\nMSG: ";
  EXPECT_EQ(messages::schema_text(messages::definition<ros::TFMessage>()),
            "geometry_msgs/TransformStamped[] transforms\n" + line +
                "geometry_msgs/TransformStamped\n"
                "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n" +
                line +
                "geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n" +
                line + "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + line +
                "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
                "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + line +
                "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
  EXPECT_EQ(messages::definition<ros::Imu>().text,
            "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
            "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
            "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n");
  EXPECT_EQ(messages::definition<ros::NavSatStatus>().text, "int8 status\nuint16 service\n");
}

struct Bounded {
  std::string name{};
  std::vector<std::int16_t> few{};
  std::vector<std::byte> bytes{};
  static constexpr const char* type = "test_msgs/msg/Bounded";
  static constexpr auto fields =
      std::tuple(field("name", &Bounded::name, 8), field("few", &Bounded::few, 3), field("bytes", &Bounded::bytes));
};

TEST(RosSchema, HasTheMaximumLengthsOfTextsAndLists) {
  EXPECT_EQ(messages::definition<Bounded>().text, "string<=8 name\nint16[<=3] few\nbyte[] bytes\n");
  EXPECT_EQ(messages::definition<ros::Empty>().text, "");
}

TEST(RosTime, IsSecondsAndNanosecondsAlsoBeforeTheEpochAndAtItsEnds) {
  EXPECT_EQ(ros::time(1'500'000'000ns), (ros::Time{1, 500'000'000}));
  EXPECT_EQ(ros::time(-1ns), (ros::Time{-1, 999'999'999}));
  EXPECT_EQ(ros::time(std::chrono::nanoseconds::max()), (ros::Time{2'147'483'647, 999'999'999}));
  EXPECT_EQ(ros::time(std::chrono::nanoseconds::min()), (ros::Time{-2'147'483'648, 0}));
  for (const auto time : {-1ns, 0ns, 1ns, 1'999'999'999ns}) EXPECT_EQ(ros::nanoseconds(ros::time(time)), time);
}

}  // namespace
}  // namespace cohort::messages
