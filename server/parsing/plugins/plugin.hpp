// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// The names of one parameter in different versions of a simulator.
using ParameterNames = std::initializer_list<const char*>;

/// A <plugin> of Gazebo. It records which of its parameters were read.
class Plugin {
 public:
  Plugin(const Element* element, const SdfReport& report) : element_(element), report_(report) {}

  const Element* element() const { return element_; }
  const SdfReport& report() const { return report_; }

  /// Returns the parameters with one of these names, in document order.
  std::vector<const Element*> all(ParameterNames names);
  /// Returns the first of them; nullptr if there is none.
  const Element* first(ParameterNames names);
  /// Returns the value of the first of them; reports an invalid value.
  std::optional<double> number(ParameterNames names, ExtensionValue kind = ExtensionValue::positive);
  double number_or(double fallback, ParameterNames names, ExtensionValue kind = ExtensionValue::positive) {
    return number(names, kind).value_or(fallback);
  }
  std::optional<Eigen::Vector3d> vector(ParameterNames names);
  std::string text_or(const std::string& fallback, ParameterNames names);

  /// Warns of parameters that were not read.
  void warn_of_unread() const;

 private:
  template <class Value>
  std::optional<Value> value(ParameterNames names, ExtensionValue kind);

  const Element* element_;
  const SdfReport& report_;
  std::set<std::string, std::less<>> asked_;
};

/// Returns why the tree of a model has no joint of this name: the joint closes a loop, or does not exist. `scope`: the
/// prefix of its names, which the message omits.
std::string why_no_joint(const Model& model, const std::string& name, const std::string& scope = "");

/// Returns the value of a parameter; empty if it has none.
std::string text_of_parameter(const Element* parameter);

/// The equivalent of a plugin of a model: a `cohort:` element.
struct Counterpart {
  const Extension* extension = nullptr;
  ExtensionValues values;
  std::string link;  ///< link that contains the element; empty if the model contains it
};

/// A plugin of a model whose links and joints have been read, during its conversion.
class ModelPlugin : public Plugin {
 public:
  /// `prefix` is the prefix of all names in the model, which may be nested. `names` are those that plugins have used.
  ModelPlugin(const Element* element, const std::string& prefix, const Model& model, std::set<std::string>& names,
              const SdfReport& report)
      : Plugin(element, report), prefix_(prefix), model_(model), names_(names) {}

  /// Values of keys, for one counterpart.
  class Values {
   public:
    Values(ModelPlugin& plugin, const Extension& extension) : plugin_(plugin), extension_(extension) {}
    /// Sets the key from the parameters with one of these names, or else to `fallback`; reports a required key if both
    /// are missing.
    Values& take(std::string_view key, ParameterNames names, const std::string& fallback = "");
    Values& set(std::string_view key, const std::string& text, const Element* where = nullptr);
    Values& set(std::string_view key, double value, const Element* where = nullptr);
    Values& set(std::string_view key, const Pose& X);
    /// Adds a device of this name, or of a similar name if another device from a plugin has this one. It is in `link`,
    /// or in the model if `link` is empty.
    void finish(std::string name, const std::string& link = "");

   private:
    ModelPlugin& plugin_;
    const Extension& extension_;
    std::vector<ForeignValue> values_;
  };
  template <class Kind>
  Values as();

  /// Returns the joint that the parameter names; nullptr, with a report, if the model has none.
  const Joint* joint(const Element* parameter) const;
  /// Returns every joint that the parameters of these names name, with the parameter.
  std::vector<std::pair<const Joint*, const Element*>> joints(ParameterNames names);
  const Model& model() const { return model_; }
  /// Returns whether a joint belongs to this model, and not to a nested or an outer one.
  bool has_joint(const Joint& joint) const {
    return joint.name.starts_with(prefix_) && joint.name.find("::", prefix_.size()) == std::string::npos;
  }
  bool has_link(const Link& link, const std::string& name) const { return link.name == prefix_ + name; }
  std::string without_scope(const std::string& name) const { return name.substr(prefix_.size()); }

  /// Returns the equivalents of the plugin.
  std::vector<Counterpart>& counterparts() { return counterparts_; }

 private:
  std::vector<Counterpart> counterparts_;
  std::string prefix_;
  const Model& model_;
  std::set<std::string>& names_;
};

}  // namespace cohort::parsing
