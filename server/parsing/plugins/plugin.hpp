#pragma once

#include <initializer_list>
#include <optional>
#include <sdf/Element.hh>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// Names that a parameter has had in the generations of a simulator.
using ParameterNames = std::initializer_list<const char*>;

/// A <plugin> of Gazebo. It keeps which of its parameters were asked for.
class Plugin {
 public:
  Plugin(const sdf::ElementPtr& element, const SdfReport& report) : element_(element), report_(report) {}

  const sdf::ElementPtr& element() const { return element_; }
  const SdfReport& report() const { return report_; }

  /// The parameters with one of these names, in the order of the document.
  std::vector<sdf::ElementPtr> all(ParameterNames names);
  /// The first of them; nullptr if there is none.
  sdf::ElementPtr first(ParameterNames names);
  /// Of the first of them; what is no such value is reported.
  std::optional<double> number(ParameterNames names, ExtensionValue kind = ExtensionValue::positive);
  double number_or(double fallback, ParameterNames names, ExtensionValue kind = ExtensionValue::positive) {
    return number(names, kind).value_or(fallback);
  }
  std::optional<Eigen::Vector3d> vector(ParameterNames names);
  std::string text_or(const std::string& fallback, ParameterNames names);

  /// Warns of parameters that nobody asked for.
  void warn_of_unread() const;

 private:
  template <class Value>
  std::optional<Value> value(ParameterNames names, ExtensionValue kind);

  sdf::ElementPtr element_;
  const SdfReport& report_;
  std::set<std::string, std::less<>> asked_;
};

/// Its value; empty if it has none.
std::string text_of_parameter(const sdf::ElementPtr& parameter);

/// What a plugin of a model is here: an element of ours.
struct Counterpart {
  const Extension* extension = nullptr;
  ExtensionValues values;
  std::string link;  ///< in which the element stands, if not in the model
};

/// A plugin of a model whose links and joints are read, while it is turned into what it is here.
class ModelPlugin : public Plugin {
 public:
  /// Of a model, or of one inside of it: `prefix` is that of all names there. `names` are those that plugins have given
  /// away.
  ModelPlugin(const sdf::ElementPtr& element, const std::string& prefix, const Model& model,
              std::set<std::string>& names, const SdfReport& report)
      : Plugin(element, report), prefix_(prefix), model_(model), names_(names) {}

  /// Values of keys, for one counterpart.
  class Values {
   public:
    Values(ModelPlugin& plugin, const Extension& extension) : plugin_(plugin), extension_(extension) {}
    /// Those of the parameters with one of these names, and if there are none `fallback`; if that is empty, and the key
    /// is required, it is missing.
    Values& take(std::string_view key, ParameterNames names, const std::string& fallback = "");
    Values& set(std::string_view key, const std::string& text, const sdf::ElementPtr& where = nullptr);
    Values& set(std::string_view key, double value, const sdf::ElementPtr& where = nullptr);
    Values& set(std::string_view key, const Pose& X);
    /// As a device of this name, or nearly, since no other one of a plugin has it. In `link`, or else in the model.
    void finish(std::string name, const std::string& link = "");

   private:
    ModelPlugin& plugin_;
    const Extension& extension_;
    std::vector<ForeignValue> values_;
  };
  template <class Kind>
  Values as();

  /// Nullptr, and reported, if the model has none of the name that the parameter says.
  const Joint* joint(const sdf::ElementPtr& parameter) const;
  /// Every joint that the parameters of these names say, with where.
  std::vector<std::pair<const Joint*, sdf::ElementPtr>> joints(ParameterNames names);
  const Model& model() const { return model_; }
  /// Whether a joint is one of this model, and not of one inside of it or around it.
  bool has_joint(const Joint& joint) const {
    return joint.name.starts_with(prefix_) && joint.name.find("::", prefix_.size()) == std::string::npos;
  }
  bool has_link(const Link& link, const std::string& name) const { return link.name == prefix_ + name; }
  std::string without_scope(const std::string& name) const { return name.substr(prefix_.size()); }

  /// What it became.
  std::vector<Counterpart>& counterparts() { return counterparts_; }

 private:
  std::vector<Counterpart> counterparts_;
  std::string prefix_;
  const Model& model_;
  std::set<std::string>& names_;
};

}  // namespace cohort::parsing
