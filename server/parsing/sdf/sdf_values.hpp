#pragma once

#include <ignition/math/Pose3.hh>
#include <ignition/math/Vector3.hh>
#include <initializer_list>
#include <optional>
#include <sdf/Element.hh>
#include <string>

#include "server/core/pose.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

Eigen::Vector3d to_eigen(const ignition::math::Vector3d& v);
Pose to_pose(const ignition::math::Pose3d& X);

/// Returns the pose of an element exactly as written: `X` without rounding errors from resolving frames. A quaternion
/// is normalised only if needed, so that one written by Cohort stays unchanged.
Pose written_pose(const ignition::math::Pose3d& X, const sdf::ElementPtr& posed);
/// Does the same; `is_quaternion` tells whether the rotation is written as a quaternion.
Pose written_pose(const ignition::math::Pose3d& X, bool is_quaternion);

/// Returns a direction as it is written in an element, if that is a unit vector except for rounding errors.
std::optional<Eigen::Vector3d> written_unit_vector(const sdf::ElementPtr& element);

/// Returns the descendant at this path; nullptr if there is none. (Element::GetElement would add it.)
sdf::ElementPtr find(sdf::ElementPtr element, std::initializer_list<const char*> path);

/// Returns whether the element is written with a value. An element that libsdformat has added for a default does not
/// count.
bool is_written(const sdf::ElementPtr& element);

/// Returns the value of an element as text, or nothing. Below <plugin>, and in elements unknown to SDF, libsdformat
/// keeps the text as the default of the value.
std::string written_text(const sdf::ElementPtr& element);

/// Checks that every number below `element`, except in unsupported elements, is nothing but a number. (libsdformat
/// reads "1,5" as 1, "3 m" as 3 and an empty element as its default.)
void check_numbers(const sdf::ElementPtr& element, const SdfReport& report);

}  // namespace cohort::parsing
