#include "server/description/read_model.hpp"

#include <algorithm>
#include <utility>

#include "server/description/extension_values.hpp"
#include "server/description/not_supported.hpp"

namespace cohort::description {
namespace {

bool every_link_has_one_parent(const sdf::Model& sdf_model, const Model& model, const SdfReport& report) {
  std::vector<const Joint*> joint_above(model.links.size(), nullptr);
  bool valid = true;
  for (const Joint& joint : model.joints) {
    const Joint*& above = joint_above[joint.child];
    if (above != nullptr) {
      report.problem(sdf_model.JointByName(joint.name)->Element(), "the link '" + model.links[joint.child].name +
                                                                       "' is the child of joint '" + above->name +
                                                                       "' already; closed loops are not supported");
      valid = false;
    }
    above = &joint;
  }
  return valid;
}

// Puts parents before children and otherwise keeps the order of the document. False if the links are not one tree.
bool order_links(const sdf::Model& sdf_model, Model& model, const SdfReport& report) {
  const std::size_t count = model.links.size();
  std::vector<std::size_t> parent(count, count);  // `count` is none
  for (const Joint& joint : model.joints)
    if (joint.parent != Joint::world) parent[joint.child] = joint.parent;

  std::vector<std::size_t> order;  // old indices
  std::vector<std::size_t> place(count, count);
  const auto put = [&](std::size_t link) {
    place[link] = order.size();
    order.push_back(link);
  };
  std::vector<std::size_t> roots;
  for (std::size_t link = 0; link < count; ++link)
    if (parent[link] == count) roots.push_back(link);
  if (roots.size() > 1) {
    std::string names;
    for (const std::size_t root : roots) names += (names.empty() ? "'" : ", '") + model.links[root].name + "'";
    report.problem(sdf_model.Element(),
                   "the links " + names + " have no joint to a parent link; a model that moves has one such root");
    return false;
  }
  for (const std::size_t root : roots) put(root);
  for (std::size_t before = count; before != order.size();) {
    before = order.size();
    for (std::size_t link = 0; link < count; ++link)
      if (place[link] == count && place[parent[link]] != count) {
        put(link);
        break;
      }
  }
  if (order.size() != count) {
    const auto in_loop = std::find_if(model.joints.begin(), model.joints.end(),
                                      [&](const Joint& joint) { return place[joint.child] == count; });
    report.problem(sdf_model.JointByName(in_loop->name)->Element(), "is part of a loop of joints");
    return false;
  }

  std::vector<Link> links;
  links.reserve(order.size());
  for (const std::size_t link : order) links.push_back(std::move(model.links[link]));
  model.links = std::move(links);
  for (Joint& joint : model.joints) {
    if (joint.parent != Joint::world) joint.parent = place[joint.parent];
    joint.child = place[joint.child];
  }
  return true;
}

}  // namespace

Model read_model(const sdf::Model& sdf_model, const ModelReading& reading) {
  const sdf::ElementPtr element = sdf_model.Element();
  Model model;
  model.name = sdf_model.Name();
  model.is_static = reading.is_static;
  model.self_collide = sdf_model.SelfCollide();
  warn_of_unsupported(element, reading.report);

  for (std::uint64_t i = 0; i < sdf_model.ModelCount(); ++i)
    reading.report.problem(sdf_model.ModelByIndex(i)->Element(),
                           "a model inside of a model is not supported, except by <include merge=\"true\">");
  for (std::uint64_t i = 0; i < sdf_model.LinkCount(); ++i)
    model.links.push_back(read_link(*sdf_model.LinkByIndex(i), reading));
  if (sdf_model.LinkCount() == 0 && model.is_static) reading.report.problem(element, "expected at least one <link>");

  if (model.is_static) {
    if (!extensions_in(element, reading.report).empty())
      reading.report.warning(element, "is static: its devices are ignored, and it is not a robot");
    return model;
  }
  model.joints = read_joints(sdf_model, model.links, reading);
  const bool is_tree =
      reading.frames_resolve && sdf_model.ModelCount() == 0 && model.joints.size() == sdf_model.JointCount() &&
      every_link_has_one_parent(sdf_model, model, reading.report) && order_links(sdf_model, model, reading.report);
  // Devices name links and joints: with some of those missing, each device would be reported for it.
  if (is_tree) model.devices = read_devices(element, model, reading.report);
  return model;
}

}  // namespace cohort::description
