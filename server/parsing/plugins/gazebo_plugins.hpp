// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/world.hpp"
#include "server/parsing/plugins/plugin.hpp"

/// Gazebo plugins that have an equivalent in Cohort, so that models made for Gazebo work unchanged.
namespace cohort::parsing {

/// An entry of the list of plugins. A plugin without a function needs no conversion, since Cohort always has its
/// effect.
struct PluginKind {
  std::string_view name;  ///< name of its class in Gazebo
  void (*in_model)(ModelPlugin&) = nullptr;
  void (*in_world)(Plugin&, World&) = nullptr;
};
std::span<const PluginKind> plugin_kinds();

/// Returns the entry for a <plugin>; nullptr if there is none. It is found by the attribute `filename`, of any
/// generation of Gazebo, or by the class in `name`.
const PluginKind* plugin_kind_of(const Element* plugin);

/// Warns of a <plugin> that is not in the list, once for each file.
void warn_of_unknown_plugin(const Element* plugin, const SdfReport& report);

/// Warns of plugins of a static model that would make it a conveyor.
void warn_of_static_belts(const Element* model_element, const SdfReport& report);

/// Converts the plugins of a model or a nested model whose links and joints have been read. Plugins do not drive
/// objects that `cohort:` devices of `model_element` already drive. Plugins in `elsewhere` belong to another body.
/// `names`: names that the plugins of the whole model have used.
std::vector<Counterpart> read_model_plugins(const Element* model_element, const std::string& prefix,
                                            const std::set<const Element*>& elsewhere, const Model& model,
                                            std::set<std::string>& names, const SdfReport& report);

/// Returns whether the world has the plugin by which wind exerts forces on links in Gazebo.
bool has_wind_effects(const Element& world_element);

/// Applies the plugins of the world to air and water.
void read_world_plugins(const Element* world_element, World& world, const SdfReport& report);

}  // namespace cohort::parsing
