// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "tests/support/files.hpp"
#include "tests/support/images.hpp"

/// Small documents that contain the elements of SDF, for the test of their effects.
namespace cohort::description::elements {

using Texts = std::map<std::string, std::string>;  // by path, such as joint/axis or mimic/@joint

inline std::string named(const std::string& element, const std::string& name, const std::string& content,
                         const std::string& attributes = "") {
  return "<" + element + " name=\"" + name + "\"" + attributes + ">" + content + "</" + element + ">";
}
inline std::string inertial() {
  return "<inertial><pose>0.1 0 0 0.1 0.2 0.3</pose><mass>2</mass>"
         "<inertia><ixx>1</ixx><ixy>0</ixy><ixz>0</ixz><iyy>1</iyy><iyz>0</iyz><izz>1</izz></inertia></inertial>";
}
inline std::string link(const std::string& name, const std::string& content = "") {
  return named("link", name, inertial() + content);
}
inline std::string placed(const std::string& name, const std::string& attributes) {
  return named("link", name, "<pose" + attributes + ">1 2 3 0.1 0.2 0.3</pose>" + inertial());
}
inline std::string shape(const std::string& geometry, const std::string& content = "") {
  return named("collision", "c", "<geometry>" + geometry + "</geometry>" + content);
}
inline std::string model(const std::string& content) { return named("model", "m", content); }
inline std::string solid(const std::string& geometry) { return model(link("a", shape(geometry))); }
inline std::string fixed(const std::string& geometry) {
  return model("<static>true</static>" + link("a", shape(geometry)));
}
inline std::string surface(const std::string& content) {
  return model(link("a", shape("<box/>", "<surface>" + content + "</surface>")));
}
inline std::string turning(const std::string& name, const std::string& type, const std::string& parent,
                           const std::string& child, const std::string& content) {
  return named("joint", name,
               "<pose>0 0 1 0.1 0.2 0.3</pose><parent>" + parent + "</parent><child>" + child + "</child>" + content,
               " type=\"" + type + "\"");
}
inline std::string axis(const std::string& name, const std::string& xyz, const std::string& content = "") {
  return "<" + name + "><xyz>" + xyz +
         "</xyz><limit><lower>-1</lower><upper>1</upper><effort>5</effort><velocity>5</velocity>"
         "<stiffness>100</stiffness><dissipation>2</dissipation></limit><dynamics><damping>1</damping>"
         "<friction>1</friction><spring_reference>1</spring_reference><spring_stiffness>1</spring_stiffness>"
         "</dynamics>" +
         content + "</" + name + ">";
}
inline std::string light(const std::string& type, const std::string& content) {
  return model(link("a", named("light", "l", content, " type=\"" + type + "\"")));
}
inline std::string sensor(const std::string& type, const std::string& content) {
  return model(link("a", named("sensor", "s", content, " type=\"" + type + "\"") + shape("<box/>") +
                             named("collision", "d", "<geometry><box/></geometry>")));
}
inline std::string scanner(const std::string& name) {
  const std::string angles = "<resolution>1</resolution><min_angle>-1</min_angle><max_angle>1</max_angle>";
  return sensor(name, "<" + name + "><scan><horizontal><samples>8</samples>" + angles + "</horizontal><vertical>" +
                          "<samples>2</samples>" + angles +
                          "</vertical></scan><range><min>0.1</min><max>9</max></range>"
                          "<noise><type>gaussian</type><mean>0.1</mean><stddev>0.1</stddev></noise></" +
                          name + ">");
}
inline std::string bare_sensor(const std::string& type) { return sensor(type, "<" + type + "/>"); }

/// Returns the content of a world for each element, used for tests of the element's parts. The longest matching path
/// counts. The element under test is the first of its name.
inline const Texts& bases() {
  static const std::string three = link("a") + link("b") + link("c");
  static const std::string revolute = turning("j", "revolute", "a", "b", axis("axis", "0 0 1"));
  static const std::string visual = model(
      link("a", named("visual", "v", "<geometry><box/></geometry><material><diffuse>1 0 0 1</diffuse></material>")));
  static const std::string screw = model(three + turning("j", "screw", "a", "b", axis("axis", "0 0 1")));
  static const std::string box = model(link("a", shape("<box><size>1 1 1</size></box>")));
  static const std::string mesh = "<mesh><uri>parts.obj</uri>";
  static const std::string spot =
      light("spot", "<spot><inner_angle>0.2</inner_angle><outer_angle>1.5</outer_angle><falloff>1</falloff></spot>");
  static const std::string included =
      "<include><uri>model://crate</uri><name>i</name><pose>1 0 0 0 0 0</pose></include>";
  static const Texts all = {
      {"sdf", box},
      {"world", box},
      {"model", model(three + named("frame", "f", "<pose>0 1 0 0 0 0</pose>") +
                      turning("j", "revolute", "f", "c", axis("axis", "0 0 1")))},
      {"include", model(link("a") + included)},
      {"frame", model(placed("b", "") + named("frame", "f", "") + placed("d", " relative_to=\"f\""))},
      {"pose", model(placed("d", "") + placed("b", ""))},
      {"link", box},
      {"inertial", box},
      {"inertial/density", model(named("link", "a", "<inertial auto=\"true\"/>" + shape("<box/>")))},
      {"joint", model(three + revolute)},
      {"joint/axis2",
       model(three + turning("j", "universal", "a", "b", axis("axis", "1 0 0") + axis("axis2", "0 1 0")))},
      {"joint/gearbox_ratio",
       model(three +
             turning("g", "gearbox", "b", "c",
                     "<gearbox_reference_body>a</gearbox_reference_body>" + axis("axis", "0 0 1")) +
             revolute + turning("k", "revolute", "a", "c", axis("axis", "0 0 1")))},
      {"joint/thread_pitch", screw},
      {"joint/screw_thread_pitch", screw},
      {"mimic", model(three + link("d") +
                      turning("f", "revolute", "a", "d",
                              axis("axis", "0 0 1",
                                   "<mimic joint=\"j\"><multiplier>2</multiplier><offset>1</offset>"
                                   "<reference>1</reference></mimic>")) +
                      revolute + turning("k", "revolute", "a", "c", axis("axis", "0 0 1")))},
      {"mimic/@axis",
       model(three + turning("j", "universal", "a", "b", axis("axis", "1 0 0") + axis("axis2", "0 1 0")) +
             turning("f", "revolute", "a", "c", axis("axis", "0 0 1", "<mimic joint=\"j\"/>")))},
      {"collision", box},
      {"collision/density", model(named("link", "a", "<inertial auto=\"true\"/>" + shape("<box/>")))},
      {"visual", visual},
      {"material", visual},
      {"geometry", box},
      {"box", box},
      {"sphere", solid("<sphere/>")},
      {"cylinder", solid("<cylinder/>")},
      {"cone", solid("<cone/>")},
      {"capsule", solid("<capsule/>")},
      {"ellipsoid", solid("<ellipsoid/>")},
      {"plane", fixed("<plane/>")},
      {"mesh", solid(mesh + "</mesh>")},
      {"mesh/submesh", solid(mesh + "<submesh><name>first</name></submesh></mesh>")},
      {"heightmap", fixed("<heightmap><uri>heights.png</uri></heightmap>")},
      {"polyline", solid("<polyline><point>0 0</point><point>1 0</point><point>1 1</point></polyline>")},
      {"surface", surface("<friction><torsional><coefficient>0.5</coefficient><patch_radius>0.1</patch_radius>"
                          "</torsional><ode><mu>0.5</mu><mu2>0.6</mu2><fdir1>1 0 0</fdir1></ode></friction>"
                          "<contact><ode><kp>1000</kp></ode></contact>")},
      {"surface/friction/bullet", surface("<friction><bullet><friction2>0.6</friction2><fdir1>1 0 0</fdir1></bullet>"
                                          "</friction>")},
      {"surface/contact/bullet", surface("<contact><bullet><kp>1000</kp></bullet></contact>")},
      {"light", light("point", "")},
      {"light/direction", spot},
      {"light/spot", spot},
      {"physics",
       "<physics type=\"ode\" default=\"true\"><max_step_size>0.01</max_step_size></physics>"
       "<physics type=\"ode\" default=\"true\"><max_step_size>0.002</max_step_size></physics>" +
           box},
      {"atmosphere", "<atmosphere type=\"adiabatic\"/>" + box},
      {"plugin", model(link("a") + link("b") + turning("j", "revolute", "a", "b", axis("axis", "0 0 1")) +
                       "<plugin name=\"p\" filename=\"gz-sim-joint-state-publisher-system\"/>")},
      {"sensor", sensor("imu", "")},
      {"noise",
       sensor("altimeter",
              "<altimeter><vertical_position><noise type=\"gaussian_quantized\"><mean>1</mean><stddev>1</stddev>"
              "<bias_mean>1</bias_mean><bias_stddev>1</bias_stddev><dynamic_bias_stddev>1</dynamic_bias_stddev>"
              "<dynamic_bias_correlation_time>1</dynamic_bias_correlation_time><precision>1</precision></noise>"
              "</vertical_position></altimeter>")},
      {"air_pressure", bare_sensor("air_pressure")},
      {"altimeter", bare_sensor("altimeter")},
      {"contact", sensor("contact", "<contact><collision>c</collision></contact>")},
      {"force_torque",
       model(link("a") + link("b") +
             turning("j", "revolute", "a", "b",
                     axis("axis", "0 0 1") +
                         named("sensor", "s", "<pose>1 0 0 1 0 0</pose><force_torque/>", " type=\"force_torque\"")))},
      {"gps", bare_sensor("gps")},
      {"imu", bare_sensor("imu")},
      {"imu/orientation_reference_frame/custom_rpy",
       sensor("imu",
              "<imu><orientation_reference_frame><custom_rpy>1 0 0</custom_rpy></orientation_reference_frame>"
              "</imu>")},
      {"lidar", scanner("lidar")},
      {"logical_camera", bare_sensor("logical_camera")},
      {"magnetometer", bare_sensor("magnetometer")},
      {"navsat", bare_sensor("navsat")},
      {"ray", scanner("ray")},
  };
  return all;
}

/// Returns alternative values of texts.
inline const Texts& values() {
  static const Texts all = {
      {"model/@canonical_link", "b"},
      {"model/@placement_frame", "f"},
      {"include/@merge", "true"},
      {"include/uri", "model://other"},
      {"include/placement_frame", "top"},
      {"frame/@attached_to", "b"},
      {"pose/@relative_to", "b"},
      {"joint/@type", "prismatic"},
      {"joint/parent", "c"},
      {"joint/child", "c"},
      {"joint/axis/xyz/@expressed_in", "a"},
      {"joint/axis2/xyz/@expressed_in", "a"},
      {"mimic/@joint", "k"},
      {"mimic/@axis", "axis2"},
      {"mesh/uri", "tetrahedron.obj"},
      {"mesh/submesh/name", "second"},
      {"heightmap/uri", "other.png"},
      {"light/@type", "spot"},
      {"material/pbr/metal/albedo_map", "wood.png"},
      {"plugin/@name", "gz::sim::systems::Imu"},
      {"plugin/@filename", "gz-sim-imu-system"},
      {"sensor/@type", "altimeter"},
      {"noise/@type", "gaussian"},
      {"contact/collision", "d"},
      {"force_torque/frame", "parent"},
      {"force_torque/measure_direction", "parent_to_child"},
      {"imu/orientation_reference_frame/localization", "ENU"},
      {"imu/orientation_reference_frame/custom_rpy/@parent_frame", "world"},
      {"lidar/noise/type", "none"},
      {"ray/noise/type", "none"},
  };
  return all;
}

/// Returns the parts whose effect these tests cannot detect, with the reason.
inline const Texts& exceptions() {
  static const Texts all = {
      {"sdf/@version", "older versions have other elements"},
      {"frame/@name", "others refer to it"},
      {"joint/gearbox_reference_body", "there is one between two joints"},
      {"pose/@rotation_format", "its value has more numbers"},
      {"inertial/pose/@rotation_format", "its value has more numbers"},
  };
  return all;
}

/// A folder with the files that the documents refer to.
class DocumentFolder : public test::ScratchFolder {
 public:
  DocumentFolder() {
    const std::filesystem::path files = std::filesystem::path(COHORT_SOURCE_DIR) / "tests/data/files";
    std::filesystem::copy(files / "tetrahedron.obj", path());
    std::filesystem::copy(files / "heights.png", path());
    std::filesystem::copy(files / "heights.png", path() / "other.png");
    test::write_file(path() / "wood.png", test::png_of(4, 2));
    test::write_file(path() / "parts.obj",
                     "o first\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.3\nv 0 0 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
                     "o second\nv 1 0 0\nv 0 2 0\nv 0 0 3\nv 0.1 0 0\nf 5 6 7\nf 5 7 8\nf 5 8 6\nf 6 8 7\n");
    for (const std::string name : {"crate", "other"}) {
      const std::filesystem::path folder = path() / "robots" / name;
      std::filesystem::create_directories(folder);
      test::write_file(folder / "model.config", named("model", name, "<sdf version=\"1.12\">model.sdf</sdf>"));
      test::write_file(folder / "model.sdf",
                       "<sdf version=\"1.12\">" +
                           named("model", name, link(name) + named("frame", "top", "<pose>0 0 1 0 0 0</pose>")) +
                           "</sdf>");
    }
  }
};

}  // namespace cohort::description::elements
