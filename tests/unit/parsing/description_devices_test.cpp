// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "server/parsing/files/sample_file.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

/// Tests of reading cameras, techniques and samples of sensors, and colours of links.
namespace cohort::description {
namespace {

class Devices : public Description {
 protected:
  static std::string model_with(const std::string& device) {
    return "<model name=\"m\">" + links("a") + "\n" + device + "\n</model>";
  }
  static std::string ring(const std::string& keys, const std::string& line_break = "") {
    return "<cohort:proximity_ring name=\"r\"><cohort:link>a</cohort:link><cohort:count>2</cohort:count>"
           "<cohort:first_bearing>0</cohort:first_bearing><cohort:spacing>1</cohort:spacing>"
           "<cohort:ring_radius>0.05</cohort:ring_radius><cohort:range>0.2</cohort:range>" +
           line_break + keys + "</cohort:proximity_ring>";
  }
  void write_samples(const std::string& name = "s.csv") const {
    write(name, "distance [m],angle [rad],reading_0 [1],reading_1 [mV]\n0.1,0,0.5,2\n0.2,0,0.25,1\n");
  }
};

TEST_F(Devices, UseOneRayWithoutATechnique) {
  write_samples();
  const auto read_ring = [&](const std::string& keys) {
    return std::get<ProximityRing>(read(model_with(ring(keys))).models[0].devices[0]);
  };
  EXPECT_EQ(read_ring("").technique, ProximityTechnique::ray);
  const ProximityRing five = read_ring("<cohort:technique>five_rays</cohort:technique><cohort:cone>0.5</cohort:cone>");
  EXPECT_EQ(five.technique, ProximityTechnique::five_rays);
  EXPECT_EQ(five.cone, 0.5);
  const ProximityRing sampled =
      read_ring("<cohort:technique>samples</cohort:technique><cohort:samples>s.csv</cohort:samples>");
  EXPECT_EQ(sampled.technique, ProximityTechnique::samples);
  ASSERT_NE(sampled.samples, nullptr);
  EXPECT_EQ(sampled.samples->units[1], "mV");
  EXPECT_EQ(sampled.samples->readings[2], 0.25);
}

TEST_F(Devices, RejectInvalidTechniques) {
  write_samples();
  const std::string path = "world/model[m]/cohort:proximity_ring[r]";
  const auto expect_flaw = [&](const std::string& keys, const std::string& child, const std::string& message) {
    SCOPED_TRACE(keys);
    const std::filesystem::path world = write_world(model_with(ring(keys)));
    expect_only_flaw({"", 3, path + child, message}, world);
  };
  expect_flaw("<cohort:technique>five_ray</cohort:technique>", "/cohort:technique", "did you mean 'five_rays'?");
  expect_flaw("<cohort:cone>3.2</cohort:cone>", "/cohort:cone", "less than half a turn");
  expect_flaw("<cohort:technique>samples</cohort:technique>", "", "requires a sample file");
  expect_flaw("<cohort:samples>s.csv</cohort:samples>", "/cohort:samples", "only the technique 'samples'");
}

TEST_F(Devices, RejectInvalidSamples) {
  write_samples();
  const auto problems_with = [&](const std::string& file, const std::string& count) {
    std::string device =
        ring("<cohort:technique>samples</cohort:technique><cohort:samples>" + file + "</cohort:samples>");
    const std::string two = "<cohort:count>2<";
    device.replace(device.find(two), two.size(), "<cohort:count>" + count + "<");
    const std::filesystem::path world = write_world(model_with(device));
    return problems_of([&] { parsing::read_world(world, 1); });
  };
  EXPECT_TRUE(problems_with("s.csv", "2").empty());
  const std::vector<Problem> three = problems_with("s.csv", "3");
  ASSERT_EQ(three.size(), 1u);
  EXPECT_NE(three[0].message.find("has 2 readings in each line, but the device has 3"), std::string::npos);
  const std::vector<Problem> none = problems_with("none.csv", "2");
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0].line, 3);
  write("bad.csv", "distance [m],angle [rad],reading_0 [1],reading_1 [1]\n0.1,0,x,2\n");
  const std::vector<Problem> bad = problems_with("bad.csv", "2");
  ASSERT_EQ(bad.size(), 1u);
  EXPECT_EQ(bad[0].file, folder_ / "bad.csv");
  EXPECT_EQ(bad[0].line, 2);
}

TEST_F(Devices, CheckTheElevationsOfCameras) {
  const std::string place = "<cohort:link>a</cohort:link><cohort:pose>0 0 0.1 0 0 0</cohort:pose>";
  const World world =
      read(model_with("<cohort:omnidirectional_camera name=\"c\">" + place +
                      "<cohort:range>1.5</cohort:range><cohort:max_elevation>0.3</cohort:max_elevation>"
                      "<cohort:bearing_noise>0.01</cohort:bearing_noise></cohort:omnidirectional_camera>"
                      "<cohort:panorama name=\"p\">" +
                      place +
                      "<cohort:width>90</cohort:width><cohort:height>20</cohort:height><cohort:rate>5</cohort:rate></"
                      "cohort:panorama>"));
  const auto& camera = std::get<OmnidirectionalCamera>(world.models[0].devices[0]);
  EXPECT_EQ(camera.range, 1.5);
  EXPECT_EQ(camera.capacity, 32u);
  EXPECT_EQ(camera.max_elevation, 0.3);
  EXPECT_EQ(camera.X_LS.position.z(), 0.1);
  EXPECT_EQ(camera.readout.noises.size(), 2u) << "on bearing and elevation";
  const auto& panorama = std::get<PanoramicCamera>(world.models[0].devices[1]);
  EXPECT_EQ(panorama.width, 90u);
  EXPECT_EQ(panorama.sky, Eigen::Vector3d(0.6, 0.75, 0.95));
  EXPECT_TRUE(std::isinf(panorama.range));
  EXPECT_EQ(panorama.readout.period, std::chrono::milliseconds(200));

  const auto expect_flaw = [&](const std::string& keys, const std::string& child, const std::string& message) {
    SCOPED_TRACE(keys);
    const std::filesystem::path file = write_world(
        model_with("<cohort:panorama name=\"p\"><cohort:link>a</cohort:link>" + keys + "</cohort:panorama>"));
    expect_only_flaw({"", 3, "world/model[m]/cohort:panorama[p]" + child, message}, file);
  };
  const std::string size = "<cohort:width>90</cohort:width><cohort:height>20</cohort:height>";
  expect_flaw(size + "<cohort:min_elevation>-1.6</cohort:min_elevation>", "/cohort:min_elevation", "from -pi/2");
  expect_flaw(size + "<cohort:min_elevation>0.9</cohort:min_elevation>", "", "greater than the minimum elevation");
  expect_flaw(size + "<cohort:sky>0 0 2</cohort:sky>", "/cohort:sky", "from 0 to 1");
  expect_flaw("<cohort:width>3</cohort:width><cohort:height>20</cohort:height>", "/cohort:width", "at least 4");
  expect_flaw("<cohort:width>10000</cohort:width><cohort:height>101</cohort:height>", "/cohort:height",
              "at most 1 000 000");
}

TEST_F(Devices, TakeTheColorOfALinkFromItsFirstVisual) {
  const auto visual = [](const std::string& name, const std::string& material) {
    return "<visual name=\"" + name + "\"><geometry><box><size>1 1 1</size></box></geometry>" + material + "</visual>";
  };
  const auto color = [&](const std::string& visuals) {
    return read(static_model_sdf("<link name=\"l\">" + visuals + "</link>")).models[0].links[0].color;
  };
  EXPECT_EQ(color(""), default_color());
  EXPECT_EQ(color(visual("v", "")), default_color());
  EXPECT_EQ(color(visual("v", "<material><diffuse>0.1 0.2 0.7 1</diffuse></material>") +
                  visual("w", "<material><diffuse>1 1 1 1</diffuse></material>")),
            Eigen::Vector3d(0.1, 0.2, 0.7));
}

}  // namespace
}  // namespace cohort::description
