// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/world_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/description/world.hpp"
#include "server/parsing/model/not_supported.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/sdf/sdf_values.hpp"
#include "server/parsing/world/mass_ratio.hpp"
#include "server/parsing/world/model_size.hpp"
#include "server/parsing/world/physics_settings.hpp"
#include "server/parsing/world/read_breakable_joints.hpp"
#include "server/parsing/world/stand_on_plane.hpp"
#include "server/parsing/world/swinging_chains.hpp"
#include "server/placement/place.hpp"

namespace cohort::parsing {
namespace {

const Eigen::Vector3d sdf_gravity{0.0, 0.0, -9.8};  // SDF's default

// Returns whether a world can have at most one.
bool is_once(const Extension& extension) {
  return extension.name == "physics" || extension.name == "air" || extension.name == "water";
}

}  // namespace

World WorldReader::read(LoneModel lone, const std::vector<LaterObject>& later) {
  const SdfFile& file = files_.world();
  if (!file.elements) throw InputError(std::move(problems_));
  if (lone != LoneModel::none && file.model() != nullptr) {
    read_model_alone(file);
    if (lone == LoneModel::on_plane && problems_.empty()) stand_on_plane(world_);
    return finished();
  }
  if (const std::size_t count = children_of(file.elements->root(), "world").size(); count != 1) {
    // A misspelt <world> has been reported.
    if (problems_.empty())
      problems_.push_back({file.shown, file.tree.line, "", "expected one <world>, not " + std::to_string(count)});
    throw InputError(std::move(problems_));
  }
  const Element& world = *file.first("world");
  read_settings(world);
  read_models(world, file);
  read_lights(world, file);
  read_extensions(world);
  for (const LaterObject& object : later) add_later(object);
  if (problems_.empty()) placement::check_instances(world_, problems_);
  return finished();
}

World WorldReader::read_model_file() {
  const SdfFile& file = files_.world();
  if (file.elements && file.model() == nullptr)
    problems_.push_back({file.shown, file.tree.line, "", "expected one <model> or <robot>"});
  if (!file.elements || file.model() == nullptr) throw InputError(std::move(problems_));
  read_model_alone(file);
  return finished();
}

World WorldReader::finished() {
  if (!problems_.empty()) throw InputError(std::move(problems_));
  world_.replaced_meshes = shape_files_.replaced_meshes();
  placement::set_robots(world_);
  warn_of_mass_ratio(world_);
  warn_of_sizes(world_);
  warn_of_swinging_chains(world_);
  return std::move(world_);
}

void WorldReader::read_model_alone(const SdfFile& file) {
  world_.name = name_of(*file.model());
  world_.gravity = sdf_gravity;
  add_instance(world_.name, shared_model(file, file.model()->flag("static")), {});
}

void WorldReader::read_settings(const Element& world) {
  world_.name = name_of(world);
  world_.gravity = world.vector("gravity");
  world_.magnetic_field = world.vector("magnetic_field");
  if (const Element* const wind = find(&world, {"wind", "linear_velocity"}); is_written(wind)) read_wind(world, *wind);
  check_numbers(&world, report_);
  warn_of_unsupported(&world, report_);

  if (const auto step = read_step(world, report_)) world_.step = *step;
}

// Without its plugin, Gazebo applies the velocity of the wind to rotors and fins, and no force to links.
void WorldReader::read_wind(const Element& world, const Element& velocity) {
  world_.air.wind = velocity.vector();
  if (world_.air.wind.isZero(0.0) || !SdfReport::is_foreign(&velocity) || has_wind_effects(world)) return;
  world_.air.wind_force = 0.0;
  report_.warning(&velocity,
                  "the wind exerts no force on links without the plugin 'gz::sim::systems::WindEffects', as "
                  "in Gazebo; it only acts on rotors, fins and drag");
}

void WorldReader::read_models(const Element& world, const SdfFile& file) {
  std::map<std::string, const Include*> includes;
  for (const Include& include : file.includes) includes.emplace(include.name, &include);
  auto next = file.includes.begin();
  const auto add_placed_before = [&](std::size_t place) {
    for (; next != file.includes.end() && next->place <= place; ++next)
      if (next->X_WM) add_included_model(*next, *next->X_WM);
  };
  const ModelReading how = reading(false, file);
  std::size_t place = 0;
  for (const Element* const child : world.children()) {
    const bool is_frame = child->name() == "frame";
    if (!is_frame && child->name() != "model") continue;
    add_placed_before(place++);
    if (!child->has_attribute("name")) continue;
    const std::string name = name_of(*child);
    const auto include = includes.find(name);
    if (include != includes.end())
      add_included_model(*include->second, resolved_pose(*child, *file.frames, how));
    else if (!is_frame && !names_.contains(name))
      read_inline_model(*child, file);
    else if (!is_frame)
      report_.problem(child, "another model has the name '" + name + "'");
  }
  add_placed_before(place);
}

// A light of the world becomes an object with only the light, so that events can switch and move it like any other.
void WorldReader::read_lights(const Element& world, const SdfFile& file) {
  const ModelReading how = reading(true, file);
  for (const Element* const element : children_of(world, "light")) {
    Emitter light = read_light(*element, *file.frames, how);
    Model model;
    model.name = light.name;
    model.is_static = true;
    model.links.push_back({"link", {}, {}, {}});
    const Pose X_WM = light.X_LE;
    light.X_LE = {};
    model.emitters.push_back(std::move(light));
    world_.models.push_back(std::move(model));
    if (!add_instance(name_of(*element), world_.models.size() - 1, X_WM))
      report_.problem(element, "another object has the name '" + name_of(*element) + "'");
  }
}

void WorldReader::read_inline_model(const Element& element, const SdfFile& file) {
  const ModelReading how = reading(element.flag("static"), file);
  const std::size_t model = add_models(read_model(*file.frames->of(element), how));
  add_instance(name_of(element), model, resolved_pose(element, *file.frames, how));
}

void WorldReader::add_part(const SdfFile& unread, const std::string& name, const Pose& X_WM) {
  const auto [entry, is_new] = parts_.emplace(&unread, std::nullopt);
  if (is_new) {
    const SdfFile& part = files_.load_part(unread);
    if (part.model() != nullptr) {
      check_numbers(&part.elements->root(), report_);
      entry->second = add_models(read_model(*part.model_frames, reading(part.model()->flag("static"), part)));
      add_instance(name, *entry->second, X_WM);
    }
    files_.let_go(part);
  } else if (entry->second) {
    add_instance(name, add_models(renamed(*entry->second, name)), X_WM);
  }
}

// Returns a model that was read, with all of its bodies.
std::vector<Model> WorldReader::renamed(std::size_t model, const std::string& name) const {
  const std::size_t count = count_of_bodies(model);
  const std::size_t length = world_.models[model].name.size();
  std::vector<Model> bodies;
  for (std::size_t body = model; body < model + count; ++body) {
    bodies.push_back(world_.models[body]);
    bodies.back().name = name + bodies.back().name.substr(length);
  }
  return bodies;
}

void WorldReader::add_included_model(const Include& include, const Pose& X_WM) {
  if (include.is_part) return add_part(*include.file, include.name, X_WM);
  add_instance(include.name, shared_model(*include.file, include.is_static), X_WM);
}

std::size_t WorldReader::shared_model(const SdfFile& file, bool is_static) {
  const auto [entry, is_new] = shared_.emplace(std::pair{&file, is_static}, world_.models.size());
  if (is_new) {
    check_numbers(&file.elements->root(), report_);
    add_models(read_model(*file.model_frames, reading(is_static, file)));
  }
  return entry->second;
}

std::size_t WorldReader::count_of_bodies(std::size_t model) const {
  const auto several = bodies_.find(model);
  return several == bodies_.end() ? 1 : several->second;
}

std::size_t WorldReader::add_models(std::vector<Model> bodies) {
  const std::size_t first = world_.models.size();
  if (bodies.size() > 1) bodies_.emplace(first, bodies.size());
  for (Model& body : bodies) world_.models.push_back(std::move(body));
  return first;
}

void WorldReader::read_extensions(const Element& world) {
  const auto extensions = extensions_in(&world, report_);
  std::set<std::string_view> given;
  read_world_plugins(&world, world_, report_);  // `cohort:` elements have priority
  for (const auto& [element, extension] : extensions) {
    if (is_once(*extension) && !given.insert(extension->name).second)
      report_.problem(element, "<" + prefixed(extension->name) + "> is given twice");
    if (extension->name == "population") {
      if (auto population = read_population(element, *extension, report_)) add_population(*std::move(population));
    } else {
      read_setting(element, *extension);
    }
  }
  placement::add_populations(world_, seed_, names_, problems_);
  // References are resolved last, when all materials and objects are known. If something could not be read, there may
  // be more of them.
  const bool all_is_read = problems_.empty();
  for (const auto& [element, extension] : extensions) read_reference(element, *extension, all_is_read);
}

// Does nothing for an element that is no setting of the world.
void WorldReader::read_setting(const Element* element, const Extension& extension) {
  const std::string_view name = extension.name;
  if (name != "physics" && name != "climate" && name != "air" && name != "water") return;
  const auto values = ExtensionValues::read(element, extension, report_);
  if (!values) return;
  if (name == "physics") {
    world_.physics = with_values(world_.physics, *values);
  } else if (name == "climate") {
    world_.climate = {values->real("temperature"), values->real("humidity")};
  } else if (name == "air") {
    world_.air.density = values->real("density");
    world_.air.wind_force = values->real("force_approximation_scaling_factor");
  } else {
    world_.water = Water{values->real("level"), values->real("density"), values->vector("current")};
  }
}

// Reads an element that names a material or an object; always checks its keys.
void WorldReader::read_reference(const Element* element, const Extension& extension, bool all_is_read) {
  const bool is_pair = extension.name == "material_pair";
  if (!is_pair && extension.name != "breakable_joint") return;
  const auto values = ExtensionValues::read(element, extension, report_);
  if (!values || !all_is_read) return;
  if (is_pair)
    add_material_pair(*values);
  else
    add_breakable_joint(*values);
}

std::optional<std::uint32_t> WorldReader::find_material(const ExtensionValues& values, const char* key) const {
  const std::vector<std::string> named(world_.materials.begin() + 1, world_.materials.end());
  const auto found = std::find(named.begin(), named.end(), values.text(key));
  if (found != named.end()) return static_cast<std::uint32_t>(found - named.begin() + 1);
  report_.problem(values.where(key),
                  "no collision has the material '" + values.text(key) + "'" + suggestion(values.text(key), named));
  return std::nullopt;
}

void WorldReader::add_material_pair(const ExtensionValues& values) {
  const std::optional<std::uint32_t> first = find_material(values, "first");
  const std::optional<std::uint32_t> second = find_material(values, "second");
  if (!first || !second) return;
  for (const MaterialPair& other : world_.material_pairs)
    if (std::minmax(other.first, other.second) == std::minmax(*first, *second))
      report_.problem(values.element(), "there is already a <cohort:material_pair> for '" + values.text("first") +
                                            "' and '" + values.text("second") + "'");
  world_.material_pairs.push_back(
      {*first, *second, values.real("friction"), values.real("restitution"), values.real("rolling_resistance")});
}

void WorldReader::add_breakable_joint(const ExtensionValues& values) {
  const std::vector<BreakableJoint>& others = world_.breakable_joints;
  if (std::any_of(others.begin(), others.end(), [&](const auto& other) { return other.name == values.name(); }))
    return report_.problem(values.element(), "another breakable joint has the name '" + values.name() + "'");
  if (auto joint = read_breakable_joint(values, world_, report_)) world_.breakable_joints.push_back(*std::move(joint));
}

template <class Report>
const SdfFile* WorldReader::find_model(const std::string& uri, const Report& problem) {
  const SdfFile* file = nullptr;
  try {
    file = &files_.model(uri);
  } catch (const std::runtime_error& error) {
    problem(error.what());
    return nullptr;
  }
  if (!file->elements) return nullptr;
  if (file->model() == nullptr) {
    problem("'" + file->shown.string() + "' has no <model>");
    return nullptr;
  }
  return file;
}

void WorldReader::add_later(const LaterObject& object) {
  const auto problem = [&](std::string message) {
    problems_.push_back({object.where.file, object.where.line, object.where.element, std::move(message)});
  };
  const SdfFile* const file = find_model(object.uri, problem);
  if (file == nullptr) return;
  const std::size_t model = shared_model(*file, file->model()->flag("static"));
  if (count_of_bodies(model) > 1)
    return problem("the model has several root links, which are separate bodies; an event can add only one body");
  if (object.is_model_only) {
    world_.spawnable_models.push_back({object.uri, model});
    return;
  }
  if (!add_instance(object.name, model, object.X_WM))
    return problem("another object has the name '" + object.name + "'");
  world_.instances.back().is_present = false;
}

void WorldReader::add_population(WrittenPopulation written) {
  const auto problem = [&](std::string message) { report_.problem(written.uri_element, std::move(message)); };
  const SdfFile* const file = find_model(written.uri, problem);
  if (file == nullptr) return;
  Population& population = written.population;
  population.model = shared_model(*file, file->model()->flag("static"));
  population.bodies = count_of_bodies(population.model);
  // If a shape is invalid, so is the space that it occupies.
  if (problems_.empty()) world_.populations.push_back(std::move(population));
}

bool WorldReader::add_instance(const std::string& name, std::size_t model, const Pose& X_WM) {
  for (std::size_t body = model; body < model + count_of_bodies(model); ++body) {
    const std::string own = name + world_.models[body].name.substr(world_.models[model].name.size());
    if (!names_.insert(own).second) return false;
    world_.instances.push_back({own, body, X_WM});
  }
  return true;
}

}  // namespace cohort::parsing
