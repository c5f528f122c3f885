// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// An element of SDF that an element of <gazebo> can belong to.
enum class GazeboTarget { robot, link, collision, visual, joint };

enum class GazeboKind { number, flag, inverted_flag, text };

/// An element of <gazebo>, and the path of the element of SDF that it sets. Without a path it sets nothing.
struct GazeboProperty {
  std::string_view name;
  GazeboTarget target;
  GazeboKind kind;
  std::string_view path;
};

/// Returns the elements for which <gazebo> has a meaning of its own.
std::span<const GazeboProperty> gazebo_properties();

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
