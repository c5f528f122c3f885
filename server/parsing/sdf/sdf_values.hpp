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

/// The pose that an element has, as it is written there: `X` without what resolving frames would do to its last bits. A
/// quaternion is normalised only if it needs it, so that one that was written by us is the same again.
Pose written_pose(const ignition::math::Pose3d& X, const sdf::ElementPtr& posed);
/// The same, if its rotation is written as a quaternion or not.
Pose written_pose(const ignition::math::Pose3d& X, bool is_quaternion);

/// A direction as it is written in an element, if that is a unit vector to the last bits but a few.
std::optional<Eigen::Vector3d> written_unit_vector(const sdf::ElementPtr& element);

/// The descendant at this path, nullptr if it is not there. (Element::GetElement would add it.)
sdf::ElementPtr find(sdf::ElementPtr element, std::initializer_list<const char*> path);

/// Whether the element is there with a value: what is not written has none, even where libsdformat has added the
/// element.
bool is_written(const sdf::ElementPtr& element);

/// The value of an element as text, or nothing. Below <plugin>, and where SDF does not know the element, libsdformat
/// has what is written as the default of the value.
std::string written_text(const sdf::ElementPtr& element);

/// Checks that every number below `element`, except in what is not simulated, is a number and
/// nothing else: libsdformat reads "1,5" as 1, "3 m" as 3 and an empty element as its default.
void check_numbers(const sdf::ElementPtr& element, const SdfReport& report);

}  // namespace cohort::parsing
