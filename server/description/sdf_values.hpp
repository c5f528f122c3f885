#pragma once

#include <ignition/math/Pose3.hh>
#include <ignition/math/Vector3.hh>
#include <initializer_list>
#include <sdf/Element.hh>

#include "server/core/pose.hpp"
#include "server/description/sdf_report.hpp"

namespace cohort::description {

Eigen::Vector3d to_eigen(const ignition::math::Vector3d& v);
Pose to_pose(const ignition::math::Pose3d& X);

/// The descendant at this path, nullptr if it is not there. (Element::GetElement would add it.)
sdf::ElementPtr find(sdf::ElementPtr element, std::initializer_list<const char*> path);

/// Checks that every number below `element`, except in what is not simulated, is a number and
/// nothing else: libsdformat reads "1,5" as 1, "3 m" as 3 and an empty element as its default.
void check_numbers(const sdf::ElementPtr& element, const SdfReport& report);

}  // namespace cohort::description
