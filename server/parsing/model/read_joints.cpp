// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "server/core/angle.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

// A shorter axis has no direction.
constexpr double shortest_axis = 1e-5;

// SDF writes "no limit" as a number this large.
constexpr double no_limit = 1e16;

std::optional<std::size_t> index_of(const std::vector<Link>& links, const std::string& name) {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == name) return i;
  return std::nullopt;
}

std::optional<JointType> read_type(const Element& joint, const SdfReport& report) {
  const std::string type = joint.attribute("type");
  if (type == "continuous") return JointType::revolute;
  if (type == "revolute2") return JointType::universal;
  if (const auto known = description::joint_type_named(type)) return known;
  report.problem(&joint, "the joint type '" + type +
                             "' is not supported; expected fixed, revolute, continuous, prismatic, ball, universal, "
                             "revolute2, screw or gearbox");
  return std::nullopt;
}

// Returns a number in a part of an axis, such as <dynamics>.
double number_in(const Element& axis, const char* part, const char* name, double by_default) {
  const Element* const found = find(&axis, {part, name});
  return found != nullptr ? found->real() : by_default;
}

void read_dynamics(const Element& element, const SdfReport& report, JointAxis& axis) {
  axis.damping = number_in(element, "dynamics", "damping", 0.0);
  axis.friction = number_in(element, "dynamics", "friction", 0.0);
  axis.spring_stiffness = number_in(element, "dynamics", "spring_stiffness", 0.0);
  axis.spring_reference = number_in(element, "dynamics", "spring_reference", 0.0);
  // NaN passes, since check_numbers has reported it.
  const auto check = [&](const char* name, bool is_wrong, const char* expected) {
    if (is_wrong) report.problem(find(&element, {"dynamics", name}), std::string("expected ") + expected);
  };
  const auto is_out_of_range = [](double value) { return value < 0.0 || std::isinf(value); };
  check("damping", is_out_of_range(axis.damping), "a damping >= 0");
  check("friction", is_out_of_range(axis.friction), "a friction >= 0");
  check("spring_stiffness", is_out_of_range(axis.spring_stiffness), "a stiffness >= 0");
  check("spring_reference", std::abs(axis.spring_reference) > greatest_angle, "a position from -1e6 to 1e6");
}

void read_limits(const Element& element, const SdfReport& report, JointAxis& axis) {
  const double lower = number_in(element, "limit", "lower", -no_limit);
  const double upper = number_in(element, "limit", "upper", no_limit);
  if (lower > -no_limit) axis.lower = lower;
  if (upper < no_limit) axis.upper = upper;
  if (axis.lower > axis.upper &&
      report.flaw(element.child("limit"), "the lower limit exceeds the upper limit", "the limits are exchanged"))
    std::swap(axis.lower, axis.upper);
}

// Reads stiffness and dissipation of limits. The default of SDF is practically rigid, and is rigid here.
void read_give_of_limits(const Element& element, const SdfReport& report, JointAxis& axis) {
  constexpr double rigid = 1e8;
  const Element* const dissipation = find(&element, {"limit", "dissipation"});
  const double stiffness = number_in(element, "limit", "stiffness", rigid);
  const double damping = number_in(element, "limit", "dissipation", 1.0);
  const bool is_soft = stiffness < rigid;
  if (is_soft && !(stiffness > 0.0)) report.problem(find(&element, {"limit", "stiffness"}), "expected a stiffness > 0");
  if (damping < 0.0 || std::isinf(damping)) report.problem(dissipation, "expected a dissipation >= 0");
  if (!is_soft) {
    if (is_written(dissipation) && damping != 1.0)
      report.warning(dissipation, "<dissipation> is ignored, because limits are rigid unless <stiffness> is below 1e8");
    return;
  }
  axis.limit_stiffness = stiffness;
  axis.limit_damping = damping;
}

// Reads the limits of motors. Negative values mean no limit; so does 0, which exporters write for unknown values.
void read_motor_limits(const Element& element, JointAxis& axis) {
  const auto read = [](double limit, double& most) {
    if (limit > 0.0 && limit < no_limit) most = limit;
  };
  read(number_in(element, "limit", "effort", 0.0), axis.max_effort);
  read(number_in(element, "limit", "velocity", 0.0), axis.max_velocity);
}

// Reads the thread pitch, which SDF gives in radians per metre for a left-handed thread; its default is 1.
double read_thread_pitch(const Element& joint, const SdfReport& report) {
  const double radians_a_metre = joint.real("thread_pitch");
  if (radians_a_metre == 0.0 || !std::isfinite(radians_a_metre)) {
    report.problem(joint.child("thread_pitch"), "expected a thread pitch in rad/m other than 0");
    return 1.0;
  }
  return -2.0 * M_PI / radians_a_metre;
}

// Reads an axis; returns nothing, with a report, if it has no direction. `place` is 0 for <axis>, 1 for <axis2>.
std::optional<JointAxis> read_axis(const Element& joint, unsigned place, const Frames& frames,
                                   const SdfReport& report) {
  const std::string name = place == 0 ? "axis" : "axis2";
  const Element* const element = joint.child(name);
  if (element == nullptr) {
    report.problem(&joint, "missing: the direction of the axis, <" + name + "><xyz>", name);
    return std::nullopt;
  }
  if (element->vector("xyz").norm() < shortest_axis) {
    report.problem(element->child("xyz"), "expected a direction that is not zero");
    return std::nullopt;
  }
  const std::optional<Eigen::Vector3d> direction = direction_of(*element, frames);
  if (!direction) {
    report.problem(element, "expressed_in refers to a frame '" + element->child("xyz")->attribute("expressed_in") +
                                "' that does not exist");
    return std::nullopt;
  }
  JointAxis axis;
  axis.direction = *direction;
  read_dynamics(*element, report, axis);
  read_motor_limits(*element, axis);
  if (joint.attribute("type") != "continuous") read_limits(*element, report, axis);
  read_give_of_limits(*element, report, axis);
  return axis;
}

void read_universal(const Element& element, const Frames& frames, const SdfReport& report, Joint& joint) {
  const std::optional<JointAxis> first = read_axis(element, 0, frames, report);
  const std::optional<JointAxis> second = read_axis(element, 1, frames, report);
  if (!first || !second) return;
  joint.axis = *first;
  joint.second_axis = *second;
  constexpr double parallel = 1e-6;  // sine of the angle between them
  if (first->direction.cross(second->direction).norm() < parallel)
    report.problem(element.child("axis2"), "expected a direction that is not parallel to <axis>");
}

// Reads a ball joint, which turns about every axis: it has no direction, and no angle about a single axis.
void read_ball(const Element& element, const SdfReport& report, Joint& joint) {
  const Element* const axis = element.child("axis");
  if (axis == nullptr) return;
  JointAxis read;
  read_dynamics(*axis, report, read);
  read_limits(*axis, report, read);
  read_give_of_limits(*axis, report, read);
  joint.axis.damping = read.damping;
  joint.axis.friction = read.friction;
  if (read.spring_stiffness > 0.0)
    report.warning(find(axis, {"dynamics", "spring_stiffness"}),
                   "the spring is ignored, because a ball joint cannot have one");
  if (std::isfinite(read.lower) || std::isfinite(read.upper))
    report.warning(axis->child("limit"), "<limit> is ignored, because a ball joint cannot have limits");
}

void read_axes(const Element& element, const Frames& frames, const SdfReport& report, Joint& joint) {
  switch (joint.type) {
    case JointType::fixed: return;
    case JointType::ball: return read_ball(element, report, joint);
    case JointType::universal: return read_universal(element, frames, report, joint);
    case JointType::screw: joint.thread_pitch = read_thread_pitch(element, report); [[fallthrough]];
    case JointType::revolute:
    case JointType::prismatic:
      if (const std::optional<JointAxis> axis = read_axis(element, 0, frames, report)) joint.axis = *axis;
  }
}

}  // namespace

std::optional<Eigen::Vector3d> direction_of(const Element& axis, const Frames& frames) {
  const Element* const xyz = axis.child("xyz");
  if (const auto written = written_unit_vector(xyz); written && xyz->attribute("expressed_in").empty()) return written;
  const Eigen::Vector3d v = axis.vector("xyz");
  // Normalised twice: hashes of older versions stay.
  const Eigen::Vector3d direction = (v / std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z())).normalized();
  const std::string frame = xyz != nullptr ? xyz->attribute("expressed_in") : "";
  return frame.empty() ? direction : frames.direction(direction, frame, name_of(*axis.parent()));
}

std::vector<Joint> read_joints(const Frames& frames, const std::vector<Link>& links, const std::string& scope,
                               const ModelReading& reading) {
  std::vector<Joint> joints;
  for (const Element* const element : children_of(frames.owner(), "joint")) {
    if (element->attribute("type") == "gearbox") continue;  // it couples two others
    const std::optional<JointType> type = read_type(*element, reading.report);
    if (!type || !reading.frames_resolve) continue;

    // Parent and child can be frames that are attached to links.
    const std::string parent_name = element->child("parent")->text();
    const std::string child_name = element->child("child")->text();
    const std::string parent_link = frames.link_of(parent_name).value_or(parent_name);
    const std::string child_link = frames.link_of(child_name).value_or(child_name);
    const std::optional<std::size_t> parent =
        parent_link == "world" ? Joint::world : index_of(links, scope + parent_link);
    const std::optional<std::size_t> child = index_of(links, scope + child_link);
    if (!parent || !child || parent == child) {
      reading.report.problem(
          element, "expected two different links of this model, or one link and the world, as parent and child");
      continue;
    }

    Joint joint;
    joint.name = scope + name_of(*element);
    joint.type = *type;
    joint.parent = *parent;
    joint.child = *child;
    const bool is_in_child = relative_to(*element).empty() && child_name == child_link;
    const Element* const pose = element->child("pose");
    if (!is_in_child)
      joint.X_LJ = resolved_pose(*element, frames, reading, child_link);
    else if (pose != nullptr)
      joint.X_LJ = written_pose(pose->node()).value_or(Pose{});
    read_axes(*element, frames, reading.report, joint);
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace cohort::parsing
