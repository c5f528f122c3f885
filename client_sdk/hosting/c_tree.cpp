// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "client_sdk/hosting/c_handles.hpp"
#include "client_sdk/include/cohort/cohort_tree.h"

namespace cohort {
namespace {

static_assert(cohort_joint_fixed == static_cast<int>(JointInfo::Type::fixed));
static_assert(cohort_joint_screw == static_cast<int>(JointInfo::Type::screw));
static_assert(COHORT_WORLD == JointInfo::world);

void copy(const Vector3& from, double (&to)[3]) {  // NOLINT(modernize-avoid-c-arrays): an array of the C interface
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

CohortFramePose to_c(const FramePose& pose) {
  const auto& [p, q] = pose;
  return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

CohortAxis to_c(const AxisInfo& axis) {
  CohortAxis result{{}, axis.lower, axis.upper, axis.max_velocity, axis.max_effort};
  copy(axis.direction, result.direction);
  return result;
}

CohortLink to_c(const LinkInfo& link) {
  CohortLink result{link.name.c_str(), link.mass, {}};
  copy(link.center_of_mass, result.center_of_mass);
  return result;
}

CohortJoint to_c(const JointInfo& joint) {
  CohortJoint result{joint.name.c_str(),
                     static_cast<CohortJointType>(joint.type),
                     joint.parent,
                     joint.child,
                     to_c(joint.pose),
                     to_c(joint.frame),
                     std::min<std::size_t>(joint.axes.size(), 2),
                     {},
                     joint.thread_pitch};
  for (std::size_t i = 0; i < result.axis_count; ++i) result.axes[i] = to_c(joint.axes[i]);
  return result;
}

CohortSensor to_c(const SensorInfo& sensor) { return {sensor.name.c_str(), sensor.link, to_c(sensor.pose)}; }

template <class Info, class Entry>
bool copy_entry(const std::vector<Info>& all, std::size_t index, Entry* entry) {
  if (index >= all.size()) return false;
  *entry = to_c(all[index]);
  return true;
}

}  // namespace
}  // namespace cohort

bool cohort_link(const CohortStart* start, std::size_t index, CohortLink* link) {
  return cohort::copy_entry(start->start.tree.links, index, link);
}

bool cohort_joint(const CohortStart* start, std::size_t index, CohortJoint* joint) {
  return cohort::copy_entry(start->start.tree.joints, index, joint);
}

bool cohort_sensor(const CohortStart* start, std::size_t index, CohortSensor* sensor) {
  return cohort::copy_entry(start->start.tree.sensors, index, sensor);
}

const char* cohort_joint_device(const CohortStart* start, std::size_t joint, std::size_t index) {
  const auto& joints = start->start.tree.joints;
  if (joint >= joints.size() || index >= joints[joint].devices.size()) return nullptr;
  return joints[joint].devices[index].c_str();
}
