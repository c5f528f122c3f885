#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tests/support/images.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Compares the effect of each element and attribute of SDF with the mark that it has in the rules. Each test takes one
// shared definition, and reads a small document with and without each of its parts.
namespace cohort::description::elements {
namespace {

using parsing::Effect;
using parsing::ElementRule;
using parsing::ValueRule;
using parsing::ValueType;
using parsing::XmlNode;
using Texts = std::map<std::string, std::string>;  // by path, such as joint/axis or mimic/@joint

std::string named(const std::string& element, const std::string& name, const std::string& content,
                  const std::string& attributes = "") {
  return "<" + element + " name=\"" + name + "\"" + attributes + ">" + content + "</" + element + ">";
}
std::string inertial() {
  return "<inertial><pose>0.1 0 0 0.1 0.2 0.3</pose><mass>2</mass>"
         "<inertia><ixx>1</ixx><ixy>0</ixy><ixz>0</ixz><iyy>1</iyy><iyz>0</iyz><izz>1</izz></inertia></inertial>";
}
std::string link(const std::string& name, const std::string& content = "") {
  return named("link", name, inertial() + content);
}
std::string placed(const std::string& name, const std::string& attributes) {
  return named("link", name, "<pose" + attributes + ">1 2 3 0.1 0.2 0.3</pose>" + inertial());
}
std::string shape(const std::string& geometry, const std::string& content = "") {
  return named("collision", "c", "<geometry>" + geometry + "</geometry>" + content);
}
std::string model(const std::string& content) { return named("model", "m", content); }
std::string solid(const std::string& geometry) { return model(link("a", shape(geometry))); }
std::string fixed(const std::string& geometry) { return model("<static>true</static>" + link("a", shape(geometry))); }
std::string surface(const std::string& content) {
  return model(link("a", shape("<box/>", "<surface>" + content + "</surface>")));
}
std::string turning(const std::string& name, const std::string& type, const std::string& parent,
                    const std::string& child, const std::string& content) {
  return named("joint", name,
               "<pose>0 0 1 0.1 0.2 0.3</pose><parent>" + parent + "</parent><child>" + child + "</child>" + content,
               " type=\"" + type + "\"");
}
std::string axis(const std::string& name, const std::string& xyz, const std::string& content = "") {
  return "<" + name + "><xyz>" + xyz +
         "</xyz><limit><lower>-1</lower><upper>1</upper><effort>5</effort><velocity>5</velocity>"
         "<stiffness>100</stiffness><dissipation>2</dissipation></limit><dynamics><damping>1</damping>"
         "<friction>1</friction><spring_reference>1</spring_reference><spring_stiffness>1</spring_stiffness>"
         "</dynamics>" +
         content + "</" + name + ">";
}
std::string light(const std::string& type, const std::string& content) {
  return model(link("a", named("light", "l", content, " type=\"" + type + "\"")));
}
std::string sensor(const std::string& type, const std::string& content) {
  return model(link("a", named("sensor", "s", content, " type=\"" + type + "\"") + shape("<box/>") +
                             named("collision", "d", "<geometry><box/></geometry>")));
}
std::string scanner(const std::string& name) {
  const std::string angles = "<resolution>1</resolution><min_angle>-1</min_angle><max_angle>1</max_angle>";
  return sensor(name, "<" + name + "><scan><horizontal><samples>8</samples>" + angles + "</horizontal><vertical>" +
                          "<samples>2</samples>" + angles +
                          "</vertical></scan><range><min>0.1</min><max>9</max></range>"
                          "<noise><type>gaussian</type><mean>0.1</mean><stddev>0.1</stddev></noise></" +
                          name + ">");
}
std::string noisy(const std::string& type, const std::string& name) { return sensor(type, "<" + name + "/>"); }

/// The content of a world with an element, for the parts below it. The longest path counts; the element is the first of
/// its name.
const Texts& bases() {
  static const std::string three = link("a") + link("b", "") + link("c", "");
  static const std::string first = turning("j", "revolute", "a", "b", axis("axis", "0 0 1"));
  static const std::string paint = "<material><diffuse>1 0 0 1</diffuse></material>";
  static const std::string image = "<pbr><metal><albedo_map>wood.png</albedo_map></metal></pbr>";
  static const std::string visual = named("visual", "v", "<geometry><box/></geometry>" + paint);
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
      {"joint", model(three + first)},
      {"joint/axis2",
       model(three + turning("j", "universal", "a", "b", axis("axis", "1 0 0") + axis("axis2", "0 1 0")))},
      {"joint/gearbox_ratio",
       model(three +
             turning("g", "gearbox", "b", "c",
                     "<gearbox_reference_body>a</gearbox_reference_body>" + axis("axis", "0 0 1")) +
             first + turning("k", "revolute", "a", "c", axis("axis", "0 0 1")))},
      {"joint/thread_pitch", screw},
      {"joint/screw_thread_pitch", screw},
      {"mimic", model(three + link("d") +
                      turning("f", "revolute", "a", "d",
                              axis("axis", "0 0 1",
                                   "<mimic joint=\"j\"><multiplier>2</multiplier><offset>1</offset>"
                                   "<reference>1</reference></mimic>")) +
                      first + turning("k", "revolute", "a", "c", axis("axis", "0 0 1")))},
      {"collision", box},
      {"collision/density", model(named("link", "a", "<inertial auto=\"true\"/>" + shape("<box/>")))},
      {"visual", model(link("a", visual))},
      {"material", model(link("a", visual))},
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
      {"air_pressure", noisy("air_pressure", "air_pressure")},
      {"altimeter", noisy("altimeter", "altimeter")},
      {"contact", sensor("contact", "<contact><collision>c</collision></contact>")},
      {"force_torque",
       model(link("a") + link("b") +
             turning("j", "revolute", "a", "b",
                     axis("axis", "0 0 1") +
                         named("sensor", "s", "<pose>1 0 0 1 0 0</pose><force_torque/>", " type=\"force_torque\"")))},
      {"gps", noisy("gps", "gps")},
      {"imu", noisy("imu", "imu")},
      {"imu/orientation_reference_frame/custom_rpy",
       sensor("imu",
              "<imu><orientation_reference_frame><custom_rpy>1 0 0</custom_rpy></orientation_reference_frame>"
              "</imu>")},
      {"lidar", scanner("lidar")},
      {"logical_camera", noisy("logical_camera", "logical_camera")},
      {"magnetometer", noisy("magnetometer", "magnetometer")},
      {"navsat", noisy("navsat", "navsat")},
      {"ray", scanner("ray")},
  };
  return all;
}

/// Other values of texts.
const Texts& values() {
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

/// Parts with an effect that is not seen here, and the reason.
const Texts& exceptions() {
  static const Texts all = {
      {"sdf/@version", "older versions have other elements"},
      {"frame/@name", "others refer to it"},
      {"joint/gearbox_reference_body", "there is one between two joints"},
      {"pose/@rotation_format", "its value has more numbers"},
      {"inertial/pose/@rotation_format", "its value has more numbers"},
  };
  return all;
}

std::string other_number(double number, const ValueRule& rule) {
  const bool is_whole = rule.type == ValueType::integer || rule.type == ValueType::count;
  double other = number == 0.0 ? 0.25 : number / 2.0;
  if (is_whole) other = number < 2.0 ? number + 1.0 : std::floor(number / 2.0);
  return shortest_text(std::clamp(other, rule.least, rule.greatest));
}

std::string other_value(const ValueRule& rule, const std::string& value, const std::string& path) {
  if (const auto known = values().find(path); known != values().end()) return known->second;
  switch (rule.type) {
    case ValueType::none: return "";
    case ValueType::text: return "other";
    case ValueType::flag: return parsing::is_true(value) ? "false" : "true";
    default: break;
  }
  std::string other;
  for (const std::string_view word : words(value))
    other += (other.empty() ? "" : " ") + other_number(parse_real(word).value(), rule);
  return other;
}

/// Something below a shared definition.
struct Part {
  std::string path;
  Effect effect = Effect::full;
  const ValueRule* value = nullptr;      ///< of an attribute, and of an element with a full effect
  const ElementRule* element = nullptr;  ///< written with all of its content
};

void add_parts(const ElementRule& rule, const std::string& path, std::vector<Part>& parts) {
  for (const auto& attribute : rule.attributes)
    parts.push_back({path + "/@" + attribute.name, attribute.effect, &attribute.value});
  for (const auto& child : rule.children) {
    const ElementRule& of_child = *child.element;
    const std::string child_path = path + "/" + of_child.name;
    if (child.effect != Effect::full || (of_child.is_shared && of_child.name == "noise"))
      parts.push_back({child_path, child.effect, &of_child.value, &of_child});
    else if (!of_child.is_shared && of_child.value.type != ValueType::none)
      parts.push_back({child_path, child.effect, &of_child.value});
    if (child.effect == Effect::full && !of_child.is_shared) add_parts(of_child, child_path, parts);
  }
}

void add_definitions(const ElementRule& rule, std::set<const ElementRule*>& seen,
                     std::vector<const ElementRule*>& all) {
  if (rule.is_shared && !seen.insert(&rule).second) return;
  if (rule.is_shared) all.push_back(&rule);
  for (const auto& child : rule.children)
    if (child.effect == Effect::full) add_definitions(*child.element, seen, all);
}

std::vector<const ElementRule*> definitions() {
  std::set<const ElementRule*> seen;
  std::vector<const ElementRule*> all;
  add_definitions(parsing::sdf_rule(), seen, all);
  return all;
}

// Returns an element with other values for everything in it.
XmlNode full_element(const ElementRule& rule, const std::string& path) {
  XmlNode node = {rule.name, 0, nullptr, {}, other_value(rule.value, rule.value.standard, path), {}};
  for (const auto& attribute : rule.attributes)
    node.attributes.emplace_back(attribute.name,
                                 other_value(attribute.value, attribute.value.standard, path + "/@" + attribute.name));
  for (const auto& child : rule.children)
    if (!child.element->is_shared || child.presence == parsing::Presence::once)
      node.children.push_back(full_element(*child.element, path + "/" + child.element->name));
  return node;
}

XmlNode* first_of(XmlNode& node, const std::string& name) {
  if (node.name == name) return &node;
  for (XmlNode& child : node.children)
    if (XmlNode* const found = first_of(child, name)) return found;
  return nullptr;
}

std::string base_of(std::string path) {
  while (!bases().contains(path) && !path.empty())
    path.resize(path.rfind('/') == std::string::npos ? 0 : path.rfind('/'));
  return path.empty() ? "" : bases().at(path);
}

XmlNode document(const std::string& content) {
  return parsing::outline_xml("<sdf version=\"1.12\" xmlns:cohort=\"https://cohort-sim.org/sdf/1\"><world name=\"w\">" +
                              content + "</world></sdf>")
      .root;
}

XmlNode& add_first(XmlNode& parent, const std::string& name) {
  XmlNode child;
  child.name = name;
  return *parent.children.insert(parent.children.begin(), std::move(child));
}

// Returns the parent of a part, which is made together with its own parents if necessary.
XmlNode& parent_of(const std::string& path, XmlNode& root) {
  std::size_t start = path.find('/');
  XmlNode* node = first_of(root, path.substr(0, start));
  for (std::size_t end; (end = path.find('/', start + 1)) != std::string::npos; start = end) {
    const std::string name = path.substr(start + 1, end - start - 1);
    if (node->child(name) == nullptr) add_first(*node, name);
    node = parsing::child_of(*node, name);
  }
  return *node;
}

// Writes another value of the part. An attribute or element that is not written yet becomes the first.
void change(const Part& part, XmlNode& root) {
  XmlNode& parent = parent_of(part.path, root);
  const std::string name = part.path.substr(part.path.rfind('/') + 1);
  if (name.front() == '@') {
    const std::string* const old = parent.attribute(name.substr(1));
    parsing::set_attribute(parent, name.substr(1),
                           other_value(*part.value, old ? *old : part.value->standard, part.path));
  } else if (part.element != nullptr) {
    parent.children.insert(parent.children.begin(),
                           full_element(*part.element, part.element->is_shared ? name : part.path));
    if (parent.name == "sensor" && part.effect == Effect::told) parsing::set_attribute(parent, "type", name);
  } else {
    XmlNode* child = parsing::child_of(parent, name);
    const std::string old = child != nullptr ? child->text : part.value->standard;
    if (child == nullptr) child = &add_first(parent, name);
    child->text = other_value(*part.value, old, part.path);
  }
}

/// What users see of a document.
struct Outcome {
  bool is_refused = false;
  std::string world;              ///< as exported and shown
  std::vector<Problem> messages;  ///< warnings, or the errors
};

class Elements : public Description, public ::testing::WithParamInterface<const ElementRule*> {
 protected:
  Elements() {
    const std::string parts =
        "o first\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.3\nv 0 0 0\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
        "o second\nv 1 0 0\nv 0 2 0\nv 0 0 3\nv 0.1 0 0\nf 5 6 7\nf 5 7 8\nf 5 8 6\nf 6 8 7\n";
    write("parts.obj", parts);
    write("wood.png", test::png_of(4, 2));
    for (const auto& [from, to] : {std::pair{"tetrahedron.obj", "tetrahedron.obj"},
                                   {"heights.png", "heights.png"},
                                   {"heights.png", "other.png"}})
      std::filesystem::copy(source / "tests/data/files" / from, folder_ / to);
    for (const char* const name : {"crate", "other"})
      write_model(name, link(name) + named("frame", "top", "<pose>0 0 1 0 0 0</pose>"));
  }

  Outcome read_document(const XmlNode& root) const {
    Outcome outcome;
    try {
      const std::filesystem::path file = folder_ / "world.sdf";
      parsing::InputFiles input;
      input.trust(file);
      input.add(file, parsing::xml_text(root));
      const World world = parsing::read_world(input, file, 1);
      World shown = world;
      shown.models = {};
      for (const Model& each : world.models) shown.models.push_back(with_visuals(each, outcome.world));
      outcome.world += parsing::xml_text(parsing::sdf_of(shown, folder_));
      outcome.messages = world.warnings;
    } catch (const InputError& error) {
      outcome.is_refused = true;
      outcome.messages = error.problems();
    }
    return outcome;
  }
  void check(const Part& part) const;

 private:
  // Returns a model with visuals as collisions, which are exported; adds their appearance to `text`.
  static Model with_visuals(Model model, std::string& text) {
    for (Link& link : model.links)
      for (const Visual& visual : link.visuals) {
        link.collisions.push_back({"visual", visual.X_LV, visual.shape, {}});
        for (const double channel : visual.color) text += shortest_text(channel) + " ";
        if (visual.texture != nullptr) text += visual.texture->bytes;
      }
    return model;
  }
};

std::string messages_only(const std::vector<Problem>& problems) {
  std::string texts;
  for (const Problem& problem : problems) texts += problem.message + "\n";
  return texts;
}

void Elements::check(const Part& part) const {
  ASSERT_NE(base_of(part.path), "") << "no document for " << part.path;
  XmlNode root = document(base_of(part.path));
  parent_of(part.path, root);
  const Outcome without = read_document(root);
  ASSERT_FALSE(without.is_refused) << texts_of(without.messages) << parsing::xml_text(root);
  change(part, root);
  const Outcome with = read_document(root);
  const std::string told = messages_only(with.messages);
  SCOPED_TRACE(part.path + "\n" + told + parsing::xml_text(root));
  if (part.effect == Effect::told) {
    EXPECT_TRUE(with.is_refused || with.messages.size() > without.messages.size());
    return;
  }
  ASSERT_FALSE(with.is_refused);
  const std::string name = part.path.substr(part.path.rfind('/') + 1);
  const std::string shown = name.front() == '@' ? "'" + name.substr(1) + "' of <" : "<" + name + ">";
  EXPECT_EQ(with.world != without.world, part.effect == Effect::full);
  const bool is_passed_over = part.effect == Effect::full || part.effect == Effect::appearance;
  if (is_passed_over) {
    EXPECT_EQ(told, messages_only(without.messages));
    return;
  }
  EXPECT_EQ(with.messages.size(), without.messages.size() + 1);
  EXPECT_NE(told.find(shown), std::string::npos);
  EXPECT_NE(told.find(part.effect == Effect::none ? "no effect in Cohort: " : "is not supported and is ignored"),
            std::string::npos);
}

TEST_P(Elements, HaveTheEffectsThatTheRulesName) {
  std::vector<Part> parts;
  add_parts(*GetParam(), GetParam()->name, parts);
  for (const Part& part : parts)
    if (!exceptions().contains(part.path)) check(part);
}

INSTANTIATE_TEST_SUITE_P(Of, Elements, ::testing::ValuesIn(definitions()),
                         [](const auto& each) { return each.param->name; });

}  // namespace
}  // namespace cohort::description::elements
