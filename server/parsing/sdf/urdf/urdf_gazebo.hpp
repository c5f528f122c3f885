#pragma once

#include <string>
#include <string_view>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// An element of SDF that an element of <gazebo> can belong to.
enum class GazeboTarget { robot, link, collision, visual, joint };

/// Returns the value of an element of <gazebo>: its attribute `value`, or else its text.
std::string gazebo_value(const XmlNode& element);

/// Returns whether the value of an element is true, yes or 1.
bool is_true(const XmlNode& element);

/// Returns whether this element of <gazebo> is a number.
bool is_gazebo_number(std::string_view name);

/// Returns whether <gazebo> has a meaning of its own for this element. Others are elements of SDF.
bool is_gazebo_property(std::string_view name);

/// Sets the properties of a <gazebo> block that belong to an element of this kind.
void set_gazebo_properties(const XmlNode& block, GazeboTarget target, XmlNode& element);

/// Sets the text of the element at a path such as `surface/friction/ode`, whose missing parts are added. New elements
/// have the position of `where`.
void set_at(XmlNode& node, std::string_view path, const std::string& text, const XmlNode& where);

}  // namespace cohort::parsing
