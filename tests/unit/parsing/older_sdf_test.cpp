// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/older_sdf.hpp"

#include <gtest/gtest.h>

#include <string>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/repair/oldest_sdf.hpp"

// Tests of the spellings of older versions of SDF.
namespace cohort::parsing {
namespace {

std::string in_version(const std::string& version, const std::string& content) {
  return "<sdf version='" + version + "'>" + content + "</sdf>";
}

std::string text_of(const XmlNode& node) {
  std::string text = "<" + node.name;
  for (const auto& [name, value] : node.attributes) text += " " + name + "='" + value + "'";
  text += ">" + node.text;
  for (const XmlNode& child : node.children) text += "\n" + text_of(child);
  return text + "</" + node.name + ">";
}

std::string converted(const std::string& version, const std::string& content) {
  XmlNode sdf = outline_xml(in_version(version, content)).root;
  convert_older(sdf);
  return text_of(sdf);
}

// Returns the content as `converted` writes it.
std::string newest(const std::string& content) {
  const XmlNode sdf = outline_xml(in_version("1.9", content)).root;
  return text_of(sdf);
}

std::string world(const std::string& content) { return "<world name='w'>" + content + "</world>"; }
std::string model(const std::string& content) { return "<model name='m'>" + content + "</model>"; }
std::string imu(const std::string& content) {
  return model("<link name='l'><sensor name='s' type='imu'><imu>" + content + "</imu></sensor></link>");
}
std::string joint(const std::string& content) {
  return model("<joint name='j' type='revolute'>" + content + "</joint>");
}

void expect_change(const std::string& last_version, const std::string& next_version, const std::string& older,
                   const std::string& newer) {
  EXPECT_EQ(converted(last_version, older), newest(newer));
  EXPECT_EQ(converted(next_version, older), newest(older));
}

TEST(OlderSdf, KeepsWhatNewerVersionsSpellAlike) {
  const std::string ray = model(
      "<pose>1 0 0 0 0 0</pose><link name='l'><sensor name='s' type='ray'><ray><scan><horizontal><samples>9"
      "</samples></horizontal></scan></ray></sensor></link>");
  for (const char* const version : {"1.0", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "1.8"})
    EXPECT_EQ(converted(version, ray), newest(ray)) << version;
}

TEST(OldestSdf, HasMostValuesInAttributes) {
  XmlNode oldest = outline_xml(in_version("1.0", R"(
    <world name='w'><physics type='ode'><gravity xyz='0 0 -9'/></physics>
      <light name='sun' type='directional' cast_shadows='1'><diffuse rgba='1 0 0 1'/><direction xyz='0 1 -1'/></light>
      <model name='m' static='0'><origin pose='1 2 3 0 0 0'/>
        <link name='l' gravity='1'><damping linear='0.1'/>
          <inertial mass='2'><inertia ixx='1' iyy='2' izz='3'/></inertial>
          <collision name='c'><origin pose='0 0 1 0 0 0'/><geometry><box size='1 2 3'/></geometry>
            <surface><friction><ode mu='0.5'/></friction></surface></collision>
          <visual name='v'><geometry><mesh filename='a.dae' scale='1 1 1'/></geometry></visual>
        </link>
        <joint name='j' type='revolute'><parent link='l'/><child link='k'/><axis xyz='0 0 1'><limit lower='-1'/></axis>
        </joint>
        <plugin name='p' filename='f' key='x'/></model></world>)"))
                       .root;
  EXPECT_TRUE(make_attributes_elements(oldest));
  XmlNode newer = outline_xml(in_version("1.0", R"(
    <world name='w'><physics type='ode'><gravity>0 0 -9</gravity></physics>
      <light name='sun' type='directional'><diffuse>1 0 0 1</diffuse><direction>0 1 -1</direction>
        <cast_shadows>1</cast_shadows></light>
      <model name='m'><pose>1 2 3 0 0 0</pose>
        <link name='l'><velocity_decay><linear>0.1</linear></velocity_decay>
          <inertial><inertia><ixx>1</ixx><iyy>2</iyy><izz>3</izz></inertia><mass>2</mass></inertial>
          <collision name='c'><pose>0 0 1 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry>
            <surface><friction><ode><mu>0.5</mu></ode></friction></surface></collision>
          <visual name='v'><geometry><mesh><filename>a.dae</filename><scale>1 1 1</scale></mesh></geometry></visual>
          <gravity>1</gravity></link>
        <joint name='j' type='revolute'><parent>l</parent><child>k</child><axis><limit><lower>-1</lower></limit>
          <xyz>0 0 1</xyz></axis></joint>
        <plugin name='p' filename='f' key='x'/><static>0</static></model></world>)"))
                      .root;
  EXPECT_EQ(text_of(oldest), text_of(newer));
  EXPECT_FALSE(make_attributes_elements(newer)) << "of a newer file with the wrong version";
}

TEST(OlderSdf, RenamesStepSizesUpToVersion1_3) {
  expect_change("1.3", "1.4",
                world("<physics><update_rate>50</update_rate><ode><solver><dt>0.02</dt><iters>9</iters></solver></ode>"
                      "</physics><physics><bullet><dt>0.01</dt></bullet></physics>"),
                world("<physics><ode><solver><iters>9</iters></solver></ode><real_time_update_rate>50"
                      "</real_time_update_rate><max_step_size>0.02</max_step_size></physics><physics><bullet/>"
                      "<max_step_size>0.01</max_step_size></physics>"));
  EXPECT_EQ(converted("1.2", world("<physics><update_rate>50</update_rate></physics>")),
            newest(world("<physics><real_time_update_rate>50</real_time_update_rate></physics>")));
}

TEST(OlderSdf, ExpressesAxesInTheFrameOfTheModelUpToVersion1_4) {
  const std::string older = joint("<axis><xyz>1 0 0</xyz></axis><axis2/>");
  const std::string newer =
      joint("<axis><xyz expressed_in='__model__'>1 0 0</xyz></axis><axis2><xyz expressed_in='__model__'/></axis2>");
  expect_change("1.4", "1.5", older, newer);
  expect_change("1.4", "1.5", world(older), world(newer));
}

TEST(OlderSdf, MakesAnElementOfTheStaticOfActorsUpToVersion1_4) {
  expect_change("1.4", "1.5", world("<actor name='a' static='true'/>"),
                world("<actor name='a'><static>true</static></actor>"));
}

TEST(OlderSdf, MovesFieldsFromPhysicsToTheWorldUpToVersion1_5) {
  expect_change("1.5", "1.6",
                world("<physics><gravity>0 0 -1</gravity><magnetic_field>1 0 0</magnetic_field></physics><scene/>"),
                world("<physics/><scene/><gravity>0 0 -1</gravity><magnetic_field>1 0 0</magnetic_field>"));
}

TEST(OlderSdf, GivesTheNoiseOfAnImuToEachAxisUpToVersion1_5) {
  const auto of_axes = [](const std::string& noise) {
    return "<x>" + noise + "</x><y>" + noise + "</y><z>" + noise + "</z>";
  };
  const std::string older =
      imu("<noise><type>gaussian</type><rate><mean>1</mean><stddev>2</stddev><bias_mean>3</bias_mean></rate>"
          "<accel><bias_stddev>4</bias_stddev></accel></noise>");
  const std::string newer =
      imu("<angular_velocity>" +
          of_axes("<noise type='gaussian'><mean>1</mean><stddev>2</stddev><bias_mean>3</bias_mean></noise>") +
          "</angular_velocity><linear_acceleration>" +
          of_axes("<noise type='gaussian'><bias_stddev>4</bias_stddev></noise>") + "</linear_acceleration>");
  expect_change("1.5", "1.6", older, newer);
  expect_change("1.5", "1.6", world(older), world(newer));
  EXPECT_EQ(converted("1.5", imu("")), newest(imu("<angular_velocity/><linear_acceleration/>")));
}

TEST(OlderSdf, RenamesTheFrameOfPosesUpToVersion1_6) {
  expect_change("1.6", "1.7",
                world(model("<model name='n'><link name='l'><pose frame='k'>1 0 0 0 0 0</pose></link></model>")),
                world(model("<model name='n'><link name='l'><pose relative_to='k'>1 0 0 0 0 0</pose></link></model>")));
}

TEST(OlderSdf, RenamesTheFrameOfIncludesInAllVersions) {
  for (const char* const version : {"1.0", "1.6", "1.8"})
    EXPECT_EQ(converted(version, world("<include><pose frame='k'/></include>")),
              newest(world("<include><pose relative_to='k'/></include>")));
}

TEST(OlderSdf, NamesTheFrameOfAxesUpToVersion1_6) {
  expect_change("1.6", "1.7",
                joint("<axis><xyz>0 0 1</xyz><use_parent_model_frame>1</use_parent_model_frame></axis>"
                      "<axis2><xyz>0 0 1</xyz><use_parent_model_frame>false</use_parent_model_frame></axis2>"),
                joint("<axis><xyz expressed_in='__model__'>0 0 1</xyz></axis><axis2><xyz>0 0 1</xyz></axis2>"));
  // An axis of SDF 1.4 that has the element keeps its value.
  EXPECT_EQ(converted("1.4", joint("<axis><use_parent_model_frame>0</use_parent_model_frame></axis>")),
            newest(joint("<axis/>")));
}

TEST(OlderSdf, RemovesEmptyFramesOfInertialsUpToVersion1_7) {
  expect_change("1.7", "1.8",
                model("<link name='l'><pose relative_to=''/><inertial><pose relative_to=''/></inertial></link>"),
                model("<link name='l'><pose relative_to=''/><inertial><pose/></inertial></link>"));
}

TEST(OlderSdf, KeepsTheContentOfPlugins) {
  const std::string plugin = model(
      "<plugin name='p' filename='f'><pose frame='k'/><joint><axis><xyz/>"
      "<use_parent_model_frame>1</use_parent_model_frame></axis></joint></plugin>");
  EXPECT_EQ(converted("1.4", plugin), newest(plugin));
}

}  // namespace
}  // namespace cohort::parsing
