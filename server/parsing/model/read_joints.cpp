#include <cmath>
#include <sdf/Error.hh>
#include <sdf/JointAxis.hh>

#include "server/core/angle.hpp"
#include "server/parsing/model/read_model.hpp"

namespace cohort::parsing {
namespace {

// libsdformat treats lengths below 1e-6 as zero, and then uses the z axis.
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
    case sdf::JointType::BALL: return JointType::ball;
    case sdf::JointType::UNIVERSAL:
    case sdf::JointType::REVOLUTE2: return JointType::universal;
    case sdf::JointType::SCREW: return JointType::screw;
    default:
      report.problem(joint.Element(), "the joint type '" + joint.Element()->Get<std::string>("type") +
                                          "' is not supported; expected fixed, revolute, continuous, prismatic, ball, "
                                          "universal, revolute2, screw or gearbox");
      return std::nullopt;
  }
}

void read_dynamics(const sdf::JointAxis& sdf_axis, const SdfReport& report, JointAxis& axis) {
  axis.damping = sdf_axis.Damping();
  axis.friction = sdf_axis.Friction();
  axis.spring_stiffness = sdf_axis.SpringStiffness();
  axis.spring_reference = sdf_axis.SpringReference();
  // NaN passes, since check_numbers has reported it.
  const auto check = [&](const char* name, bool is_wrong, const char* expected) {
    if (is_wrong) report.problem(find(sdf_axis.Element(), {"dynamics", name}), std::string("expected ") + expected);
  };
  const auto is_out_of_range = [](double value) { return value < 0.0 || std::isinf(value); };
  check("damping", is_out_of_range(axis.damping), "a damping >= 0");
  check("friction", is_out_of_range(axis.friction), "a friction >= 0");
  check("spring_stiffness", is_out_of_range(axis.spring_stiffness), "a stiffness >= 0");
  check("spring_reference", std::abs(axis.spring_reference) > greatest_angle, "a position from -1e6 to 1e6");
}

void read_limits(const sdf::JointAxis& sdf_axis, const SdfReport& report, JointAxis& axis) {
  if (sdf_axis.Lower() > -no_limit) axis.lower = sdf_axis.Lower();
  if (sdf_axis.Upper() < no_limit) axis.upper = sdf_axis.Upper();
  if (axis.lower > axis.upper)
    report.problem(sdf_axis.Element()->FindElement("limit"), "the lower limit exceeds the upper limit");
}

// Reads stiffness and dissipation of limits. The default of SDF is practically rigid, and is rigid here.
void read_give_of_limits(const sdf::JointAxis& sdf_axis, const SdfReport& report, JointAxis& axis) {
  constexpr double rigid = 1e8;
  const sdf::ElementPtr dissipation = find(sdf_axis.Element(), {"limit", "dissipation"});
  const bool is_soft = sdf_axis.Stiffness() < rigid;
  if (is_soft && !(sdf_axis.Stiffness() > 0.0))
    report.problem(find(sdf_axis.Element(), {"limit", "stiffness"}), "expected a stiffness > 0");
  if (sdf_axis.Dissipation() < 0.0 || std::isinf(sdf_axis.Dissipation()))
    report.problem(dissipation, "expected a dissipation >= 0");
  if (!is_soft) {
    if (is_written(dissipation) && dissipation->GetExplicitlySetInFile() && sdf_axis.Dissipation() != 1.0)
      report.warning(dissipation, "<dissipation> is ignored, because limits are rigid unless <stiffness> is below 1e8");
    return;
  }
  axis.limit_stiffness = sdf_axis.Stiffness();
  axis.limit_damping = sdf_axis.Dissipation();
}

// Reads the limits of motors. Negative values mean no limit; so does 0, which exporters write for unknown values.
void read_motor_limits(const sdf::JointAxis& sdf_axis, JointAxis& axis) {
  const auto read = [](double limit, double& most) {
    if (limit > 0.0 && limit < no_limit) most = limit;
  };
  read(sdf_axis.Effort(), axis.max_effort);
  read(sdf_axis.MaxVelocity(), axis.max_velocity);
}

// Reads the thread pitch, which SDF gives in radians per metre for a left-handed thread; its default is 1.
double read_thread_pitch(const sdf::Joint& sdf_joint, const SdfReport& report) {
  const double radians_a_metre = sdf_joint.ThreadPitch();
  if (radians_a_metre == 0.0 || !std::isfinite(radians_a_metre)) {
    report.problem(find(sdf_joint.Element(), {"thread_pitch"}), "expected a thread pitch in rad/m other than 0");
    return 1.0;
  }
  return -2.0 * M_PI / radians_a_metre;
}

// Reads an axis; returns nothing, with a report, if it has no direction. `place` is 0 for <axis>, 1 for <axis2>.
std::optional<JointAxis> read_axis(const sdf::Joint& sdf_joint, unsigned place, const SdfReport& report) {
  const sdf::JointAxis* const sdf_axis = sdf_joint.Axis(place);
  if (sdf_axis == nullptr) {
    const std::string name = place == 0 ? "axis" : "axis2";
    report.problem(sdf_joint.Element(), "missing: the direction of the axis, <" + name + "><xyz>", name);
    return std::nullopt;
  }
  const sdf::ElementPtr element = sdf_axis->Element();
  if (const sdf::ElementPtr xyz = element->FindElement("xyz");
      xyz && xyz->Get<ignition::math::Vector3d>().Length() < shortest_axis) {
    report.problem(xyz, "expected a direction that is not zero");
    return std::nullopt;
  }
  ignition::math::Vector3d direction;
  const sdf::Errors errors = sdf_axis->ResolveXyz(direction);
  if (!errors.empty()) {
    report.problem(element, errors.front().Message());
    return std::nullopt;
  }
  JointAxis axis;
  axis.direction = to_eigen(direction).normalized();
  if (sdf_axis->XyzExpressedIn().empty())
    if (const auto written = written_unit_vector(element->FindElement("xyz"))) axis.direction = *written;
  read_dynamics(*sdf_axis, report, axis);
  read_motor_limits(*sdf_axis, axis);
  if (sdf_joint.Type() != sdf::JointType::CONTINUOUS) read_limits(*sdf_axis, report, axis);
  read_give_of_limits(*sdf_axis, report, axis);
  return axis;
}

void read_universal(const sdf::Joint& sdf_joint, const SdfReport& report, Joint& joint) {
  const std::optional<JointAxis> first = read_axis(sdf_joint, 0, report);
  const std::optional<JointAxis> second = read_axis(sdf_joint, 1, report);
  if (!first || !second) return;
  joint.axis = *first;
  joint.second_axis = *second;
  constexpr double parallel = 1e-6;  // sine of the angle between them
  if (first->direction.cross(second->direction).norm() < parallel)
    report.problem(find(sdf_joint.Element(), {"axis2"}), "expected a direction that is not parallel to <axis>");
}

// Reads a ball joint, which turns about every axis: it has no direction, and no angle about a single axis.
void read_ball(const sdf::Joint& sdf_joint, const SdfReport& report, Joint& joint) {
  const sdf::JointAxis* const sdf_axis = sdf_joint.Axis(0);
  if (sdf_axis == nullptr) return;
  JointAxis read;
  read_dynamics(*sdf_axis, report, read);
  read_limits(*sdf_axis, report, read);
  read_give_of_limits(*sdf_axis, report, read);
  joint.axis.damping = read.damping;
  joint.axis.friction = read.friction;
  if (read.spring_stiffness > 0.0)
    report.warning(find(sdf_axis->Element(), {"dynamics", "spring_stiffness"}),
                   "the spring is ignored, because a ball joint cannot have one");
  if (std::isfinite(read.lower) || std::isfinite(read.upper))
    report.warning(find(sdf_axis->Element(), {"limit"}), "<limit> is ignored, because a ball joint cannot have limits");
}

void read_axes(const sdf::Joint& sdf_joint, const SdfReport& report, Joint& joint) {
  switch (joint.type) {
    case JointType::fixed: return;
    case JointType::ball: return read_ball(sdf_joint, report, joint);
    case JointType::universal: return read_universal(sdf_joint, report, joint);
    case JointType::screw: joint.thread_pitch = read_thread_pitch(sdf_joint, report); [[fallthrough]];
    case JointType::revolute:
    case JointType::prismatic:
      if (const std::optional<JointAxis> axis = read_axis(sdf_joint, 0, report)) joint.axis = *axis;
  }
}

}  // namespace

std::vector<Joint> read_joints(const sdf::Model& sdf_model, const std::vector<Link>& links, const std::string& scope,
                               const ModelReading& reading) {
  std::vector<Joint> joints;
  for (std::uint64_t i = 0; i < sdf_model.JointCount(); ++i) {
    const sdf::Joint& sdf_joint = *sdf_model.JointByIndex(i);
    const sdf::ElementPtr element = sdf_joint.Element();
    if (sdf_joint.Type() == sdf::JointType::GEARBOX) continue;  // it couples two others
    const std::optional<JointType> type = read_type(sdf_joint, reading.report);
    if (!type || !reading.frames_resolve) continue;

    // Parent and child can be frames that are attached to links.
    std::string parent_name;
    std::string child_name;
    sdf::Errors errors = sdf_joint.ResolveParentLink(parent_name);
    const sdf::Errors more = sdf_joint.ResolveChildLink(child_name);
    errors.insert(errors.end(), more.begin(), more.end());
    const bool to_world = parent_name == "world";
    const std::optional<std::size_t> parent = to_world ? Joint::world : index_of(links, scope + parent_name);
    const std::optional<std::size_t> child = index_of(links, scope + child_name);
    if (!errors.empty() || !parent || !child || parent == child) {
      reading.report.problem(
          element, errors.empty()
                       ? "expected two different links of this model, or one link and the world, as parent and child"
                       : errors.front().Message());
      continue;
    }

    Joint joint;
    joint.name = scope + sdf_joint.Name();
    joint.type = *type;
    joint.parent = *parent;
    joint.child = *child;
    const bool is_in_child = sdf_joint.PoseRelativeTo().empty() && sdf_joint.ChildLinkName() == child_name;
    joint.X_LJ = is_in_child ? written_pose(sdf_joint.RawPose(), sdf_joint.Element())
                             : resolved_pose(sdf_joint, reading, child_name);
    read_axes(sdf_joint, reading.report, joint);
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace cohort::parsing
