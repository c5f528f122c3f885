// SPDX-License-Identifier: Apache-2.0
#include "tools/view/film/camera_path.hpp"

#include <gtest/gtest.h>

#include "server/description/input_error.hpp"
#include "tests/support/files.hpp"

namespace cohort::film {
namespace {

constexpr const char* three_points = R"(follow: explorers
path:
  - {time: 1, position: [0, 0, 2], target: [1, 0, 0]}
  - {time: 2, position: [1, 0, 2], target: [1, 0, 0]}
  - {time: 4, position: [1, 5, 3], target: [1, 0, 0]}
)";

CameraPath path_of(const std::string& text) { return parse_camera_path(text, "camera.yaml"); }

TEST(CameraPath, PassesThroughItsPointsAndStaysAtItsEnds) {
  const CameraPath path = path_of(three_points);
  EXPECT_EQ(path.follow(), "explorers");
  EXPECT_EQ(path.at(0.0).position, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(path.at(1.0).position, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(path.at(2.0).position, Eigen::Vector3d(1, 0, 2));
  EXPECT_EQ(path.at(4.0).position, Eigen::Vector3d(1, 5, 3));
  EXPECT_EQ(path.at(9.0).position, Eigen::Vector3d(1, 5, 3));
  EXPECT_TRUE(path.at(1.3).target.isApprox(Eigen::Vector3d(1, 0, 0)));
}

TEST(CameraPath, MovesWithoutJumpsAndNeverOvershoots) {
  const CameraPath path = path_of(three_points);
  constexpr double step = 1e-3;
  for (double time = 0.9; time < 4.1; time += step) {
    const Eigen::Vector3d here = path.at(time).position;
    const Eigen::Vector3d there = path.at(time + step).position;
    for (int axis = 0; axis < 3; ++axis) EXPECT_GE(there[axis], here[axis] - 1e-12) << time;
    EXPECT_LT((there - here).norm(), 5e-3) << time;
    EXPECT_LE(there.x(), 1.0 + 1e-12);
  }
  const auto velocity = [&](double time) -> Eigen::Vector3d {
    return (path.at(time + 1e-6).position - path.at(time - 1e-6).position) / 2e-6;
  };
  for (const double time : {1.0, 2.0, 4.0})
    EXPECT_LT((velocity(time - 2e-6) - velocity(time + 2e-6)).norm(), 1e-3) << time;
}

TEST(CameraPath, OfOnePointIsAFixedCamera) {
  const CameraPath path = path_of("path: [{time: 0, position: [1, 2, 3], target: [0, 0, 0]}]");
  EXPECT_FALSE(path.follow());
  for (const double time : {-1.0, 0.0, 7.0}) EXPECT_EQ(path.at(time).position, Eigen::Vector3d(1, 2, 3));
}

struct Mistake {
  std::string text;
  std::string message;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.text; }
class MistakeInACameraPath : public ::testing::TestWithParam<Mistake> {};

TEST_P(MistakeInACameraPath, IsReportedWithItsPlace) {
  try {
    path_of(GetParam().text);
    FAIL() << "it was accepted";
  } catch (const description::InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, MistakeInACameraPath,
    ::testing::Values(
        Mistake{"path: [", "camera.yaml:"}, Mistake{"", "not YAML: this file is empty"},
        Mistake{"follow: x", "path: missing: a list of {time, position, target}"},
        Mistake{"pth: []", "pth: unknown key; did you mean 'path'?"},
        Mistake{"path: []", "path: expected a list of 1 to 10000 points"},
        Mistake{"path: [3]", "camera.yaml:1: path[0]: expected 'KEY: VALUE' lines"},
        Mistake{"path:\n- {time: 0, position: [1, 2], target: [0, 0, 0]}",
                "camera.yaml:2: path[0].position: expected a point [x, y, z] in metres"},
        Mistake{"path:\n- {time: 0, position: [1, 2, nan], target: [0, 0, 0]}", "path[0].position: expected a point"},
        Mistake{"path:\n- {time: 0, position: [1, 2, 3], target: [1, 2, 3]}", "path[0].target: expected another point"},
        Mistake{"path:\n- {time: 0, position: [1, 2, 3]}", "path[0].target: missing: a point [x, y, z] in metres"},
        Mistake{"path:\n- {time: 1, position: [1, 2, 3], target: [0, 0, 0]}\n"
                "- {time: 1, position: [1, 2, 3], target: [0, 0, 0]}",
                "camera.yaml:3: path[1].time: expected a time after 1"}));

TEST(CameraPath, ThatCannotBeReadIsReported) {
  const test::ScratchFolder folder;
  EXPECT_THROW(read_camera_path(folder / "none.yaml"), std::runtime_error);
  test::write_file(folder / "large.yaml", std::string((1 << 20) + 1, ' '));
  EXPECT_THROW(read_camera_path(folder / "large.yaml"), std::runtime_error);
}

}  // namespace
}  // namespace cohort::film
