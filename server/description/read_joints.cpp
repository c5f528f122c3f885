#include <cmath>
#include <sdf/Error.hh>
#include <sdf/JointAxis.hh>

#include "server/description/read_model.hpp"

namespace cohort::description {
namespace {

// libsdformat takes 1e-6 for zero, and then the z axis for the direction.
constexpr double shortest_axis = 1e-5;

// SDF writes "no limit" as a number this large.
constexpr double no_limit = 1e16;

std::optional<std::size_t> index_of(const std::vector<Link>& links, const std::string& name) {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == name) return i;
  return std::nullopt;
}

std::optional<JointType> read_type(const sdf::Joint& joint, const SdfReport& report) {
  switch (joint.Type()) {
    case sdf::JointType::FIXED: return JointType::fixed;
    case sdf::JointType::REVOLUTE:
    case sdf::JointType::CONTINUOUS: return JointType::revolute;
    case sdf::JointType::PRISMATIC: return JointType::prismatic;
    default:
      report.problem(joint.Element(), "the joint type '" + joint.Element()->Get<std::string>("type") +
                                          "' is not supported; expected fixed, revolute, continuous or prismatic");
      return std::nullopt;
  }
}

void read_axis(const sdf::Joint& sdf_joint, const SdfReport& report, Joint& joint) {
  const sdf::JointAxis* const axis = sdf_joint.Axis(0);
  if (axis == nullptr) {
    report.problem(sdf_joint.Element(), "missing: the direction of the axis, <axis><xyz>", "axis");
    return;
  }
  if (const sdf::ElementPtr xyz = axis->Element()->FindElement("xyz");
      xyz && xyz->Get<ignition::math::Vector3d>().Length() < shortest_axis) {
    report.problem(xyz, "expected a direction that is not zero");
    return;
  }
  ignition::math::Vector3d direction;
  const sdf::Errors errors = axis->ResolveXyz(direction);
  if (!errors.empty()) {
    report.problem(axis->Element(), errors.front().Message());
    return;
  }
  joint.axis.direction = to_eigen(direction).normalized();
  joint.axis.damping = axis->Damping();
  if (joint.axis.damping < 0.0 || std::isinf(joint.axis.damping))
    report.problem(find(axis->Element(), {"dynamics", "damping"}), "expected a damping >= 0");
  if (sdf_joint.Type() == sdf::JointType::CONTINUOUS) return;
  if (axis->Lower() > -no_limit) joint.axis.lower = axis->Lower();
  if (axis->Upper() < no_limit) joint.axis.upper = axis->Upper();
  if (joint.axis.lower > joint.axis.upper) {
    const sdf::ElementPtr limit = axis->Element()->FindElement("limit");
    report.problem(limit, "the lower limit exceeds the upper limit");
  }
}

}  // namespace

std::vector<Joint> read_joints(const sdf::Model& sdf_model, const std::vector<Link>& links,
                               const ModelReading& reading) {
  std::vector<Joint> joints;
  for (std::uint64_t i = 0; i < sdf_model.JointCount(); ++i) {
    const sdf::Joint& sdf_joint = *sdf_model.JointByIndex(i);
    const sdf::ElementPtr element = sdf_joint.Element();
    if (sdf_joint.ParentLinkName() == "world") {
      reading.report.problem(find(element, {"parent"}),
                             "a joint to the world is not supported; a model that does not move is <static>");
      continue;
    }
    const std::optional<JointType> type = read_type(sdf_joint, reading.report);
    if (!type || !reading.frames_resolve) continue;

    // Parent and child may be frames that are attached to links.
    std::string parent_name;
    std::string child_name;
    sdf::Errors errors = sdf_joint.ResolveParentLink(parent_name);
    const sdf::Errors more = sdf_joint.ResolveChildLink(child_name);
    errors.insert(errors.end(), more.begin(), more.end());
    const std::optional<std::size_t> parent = index_of(links, parent_name);
    const std::optional<std::size_t> child = index_of(links, child_name);
    if (!errors.empty() || !parent || !child || parent == child) {
      reading.report.problem(element, errors.empty() ? "expected two different links of this model as parent and child"
                                                     : errors.front().Message());
      continue;
    }

    Joint joint;
    joint.name = sdf_joint.Name();
    joint.type = *type;
    joint.parent = *parent;
    joint.child = *child;
    joint.X_LJ = resolved_pose(sdf_joint, reading, child_name);
    if (joint.type != JointType::fixed) read_axis(sdf_joint, reading.report, joint);
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace cohort::description
