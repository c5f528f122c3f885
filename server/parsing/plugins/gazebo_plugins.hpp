#pragma once

#include <sdf/Element.hh>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/world.hpp"
#include "server/parsing/plugins/plugin.hpp"

/// Plugins of Gazebo that have a counterpart here, so that what was made for Gazebo drives as it is.
namespace cohort::parsing {

/// A row of the register. A plugin without a function needs none: what it does happens here in any case.
struct PluginKind {
  std::string_view name;  ///< of its class in Gazebo
  void (*in_model)(ModelPlugin&) = nullptr;
  void (*in_world)(Plugin&, World&) = nullptr;
};
std::span<const PluginKind> plugin_kinds();

/// nullptr if there is none for a <plugin>. It is found by its attribute `filename`, as of any generation of Gazebo, or
/// by the class in its `name`.
const PluginKind* plugin_kind_of(const sdf::ElementPtr& plugin);

/// Warns of a <plugin> that is not in the register, once in a file.
void warn_of_unknown_plugin(const sdf::ElementPtr& plugin, const SdfReport& report);

/// Warns of the plugins of a static model that would make a conveyor of it.
void warn_of_static_belts(const sdf::ElementPtr& model_element, const SdfReport& report);

/// What the plugins of a model, or of one inside of it, are here, whose links and joints are read. What a `cohort:`
/// device of `model_element` drives, a plugin does not. Plugins that are in `elsewhere` belong to another body.
/// `names`: those that plugins of the whole model have given away.
std::vector<Counterpart> read_model_plugins(const sdf::ElementPtr& model_element, const std::string& prefix,
                                            const std::set<sdf::ElementPtr>& elsewhere, const Model& model,
                                            std::set<std::string>& names, const SdfReport& report);

/// Does to the air and the water what the plugins of the world say.
void read_world_plugins(const sdf::ElementPtr& world_element, World& world, const SdfReport& report);

}  // namespace cohort::parsing
