// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/core/pose.hpp"
#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"

/// Values of SDF in texts. A number ends at the first character that cannot belong to it, as in other programs: "3 m"
/// is 3. check_numbers reports the rest of the text.
namespace cohort::parsing {

/// Returns the number with which a word begins; nothing if there is none.
std::optional<double> leading_number(std::string_view word);

/// Returns the whole number with which a text begins, also in hexadecimal; 0 if there is none.
long long leading_whole(std::string_view text);

/// Returns whether a text is true; "true" may have capital letters.
bool is_true(std::string_view text);

/// Returns whether SDF allows this text as a value of the rule. For a pose, use `written_pose`.
bool allows(const ValueRule& rule, std::string_view text);

/// Returns whether a text means the same as the default value of the rule.
bool is_standard(const ValueRule& rule, std::string_view text);

/// Returns the pose that a <pose> contains, by its attributes `degrees` and `rotation_format`; the identity if it has
/// no text, nothing if it is no pose. A quaternion of unit length is taken as it is written, others are normalised.
/// Angles are roll, pitch and yaw about fixed axes, x first (http://sdformat.org/tutorials?tut=specify_pose).
std::optional<Pose> written_pose(const XmlNode& pose);

/// Returns the rotation by roll, pitch and yaw [rad].
Eigen::Quaterniond rotation_of(double roll, double pitch, double yaw);

/// Returns whether a squared norm is 1, except for rounding.
bool is_unit(double squared_norm);

}  // namespace cohort::parsing
