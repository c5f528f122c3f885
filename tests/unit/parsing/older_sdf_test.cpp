#include "server/parsing/sdf/repair/older_sdf.hpp"

#include <gtest/gtest.h>

#include <string>

#include "server/parsing/files/xml_outline.hpp"

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
