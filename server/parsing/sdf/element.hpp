// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"

namespace cohort::parsing {

/// An element of SDF: a node of the tree of a file, with its rule and its parent. If a value is not written or cannot
/// be read, the default value of SDF applies. An element lives as long as its ElementTree; pointers to it stay valid
/// until then.
class Element {
 public:
  /// `rule` is null for an element that SDF does not know.
  Element(const XmlNode& node, const ElementRule* rule, const Element* parent)
      : node_(node), rule_(rule), parent_(parent) {}
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  const std::string& name() const { return node_.name; }
  const XmlNode& node() const { return node_; }
  const ElementRule* rule() const { return rule_; }
  const Element* parent() const { return parent_; }
  /// Returns the elements below this, in document order.
  const std::vector<const Element*>& children() const { return children_; }
  /// Returns the first child of this name; nullptr if there is none.
  const Element* child(std::string_view name) const;
  /// Returns the next sibling of the same name; nullptr if there is none.
  const Element* next_alike() const;

  bool has_attribute(std::string_view name) const { return node_.attribute(name) != nullptr; }
  /// Returns the text of an attribute, or its default value.
  std::string attribute(std::string_view name) const;

  /// Returns whether a value is written.
  bool is_set() const { return !node_.text.empty(); }
  /// Returns the value as it is written, with single spaces between its words, or the default value.
  std::string text() const;
  double real() const;
  bool flag() const;
  unsigned count() const;
  Eigen::Vector3d vector() const;
  /// Returns red, green, blue and opacity, from 0 to 1, in single precision as in SDF.
  Eigen::Vector4d color() const;

  /// These functions return the value of the child of this name, or its default value if it is not written.
  std::string text(std::string_view name) const;
  double real(std::string_view name) const;
  bool flag(std::string_view name) const;
  Eigen::Vector3d vector(std::string_view name) const;

 private:
  friend class ElementTree;
  const ValueRule& value_rule(std::string_view child) const;

  const XmlNode& node_;
  const ElementRule* rule_;
  const Element* parent_;
  std::vector<const Element*> children_;
};

/// The elements of a tree of SDF.
class ElementTree {
 public:
  /// `sdf` must outlive this, unchanged.
  explicit ElementTree(const XmlNode& sdf) { add(sdf, &sdf_rule(), nullptr); }

  const Element& root() const { return elements_.front(); }

 private:
  const Element* add(const XmlNode& node, const ElementRule* rule, const Element* parent);

  std::deque<Element> elements_;
};

/// Returns the descendant at this path; nullptr if there is none.
const Element* find(const Element* element, std::initializer_list<const char*> path);

/// Returns whether the element exists and its value is written.
inline bool is_written(const Element* element) { return element != nullptr && element->is_set(); }

/// Returns the children of this name.
std::vector<const Element*> children_of(const Element& parent, std::string_view name);

/// Returns the attribute `name`.
inline std::string name_of(const Element& element) { return element.attribute("name"); }

}  // namespace cohort::parsing
