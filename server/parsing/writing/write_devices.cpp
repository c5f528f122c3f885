// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <type_traits>

#include "server/core/text.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/device_keys.hpp"
#include "server/parsing/writing/write_sdf_sensors.hpp"
#include "server/parsing/writing/write_values.hpp"

namespace cohort::parsing {
namespace {

template <class Member>
std::vector<std::string> texts_of_value(const ExtensionKey& key, const Member& value) {
  if constexpr (keys::List<Member>) {
    std::vector<std::string> texts;
    for (const auto& each : value) texts.push_back(text_of(each));
    return texts;
  } else if constexpr (std::is_enum_v<Member>) {
    return {word_for(key.choices, value)};
  } else if constexpr (std::is_same_v<Member, std::chrono::nanoseconds>) {
    constexpr double nanoseconds = 1e9;
    const auto count = static_cast<double>(value.count());
    return {text_of(key.unit == "Hz" ? nanoseconds / count : count / nanoseconds)};
  } else {
    return {text_of(value)};
  }
}

// Returns the contents of the elements of a key, none if it is not written: one overload for each type of row of a
// table. Those for references need the model and the folder of the file.
template <class Struct, class Member>
std::vector<std::string> texts_of(const keys::MemberKey<Struct, Member>& key, const Struct& from, const auto&...) {
  std::vector<std::string> texts = texts_of_value(key, from.*key.member);
  if (key.value == ExtensionValue::object)
    for (std::string& text : texts) text = without_scope_marks(text);
  const bool is_default = key.omits_default && texts == texts_of_value(key, Struct{}.*key.member);
  const bool is_needless = key.is_needed != nullptr && !key.is_needed(from);
  if (is_default || is_needless) texts.clear();
  return texts;
}

template <class Struct>
std::vector<std::string> texts_of(const keys::NoiseKey<Struct>& key, const Struct& from, const auto&...) {
  for (const Noise& noise : from.readout.noises)
    if (noise.quantity == key.quantities[0]) return {text_of(noise.deviation)};
  return {text_of(0.0)};
}

std::string name_of(const keys::Reference& key, std::size_t index, const Model& model) {
  if (key.to == keys::Referent::drive) return name_of(model.devices[index]);
  using enum keys::Referent;
  const bool is_link = key.to == link || key.to == root_link || key.to == belt_link;
  return without_scope_marks(is_link ? model.links[index].name : model.joints[index].name);
}

template <class Struct, class Member>
std::vector<std::string> texts_of(const keys::ReferenceKey<Struct, Member>& key, const Struct& from, const Model& model,
                                  const std::filesystem::path& folder) {
  const Member& member = from.*key.member;
  std::vector<std::string> texts;
  if constexpr (keys::List<Member>)
    for (const std::size_t index : member) texts.push_back(name_of(key, index, model));
  else if constexpr (std::is_same_v<Member, std::size_t>)
    texts.push_back(name_of(key, member, model));
  else if (member)
    texts.push_back(relative_to(folder, member->file));
  return texts;
}

// Writes the members of a struct for the keys of a kind.
template <class Kind, class Struct>
void write_values(XmlNode& element, const Struct& from, const auto&... scope) {
  keys::for_keys_of<Struct>(keys::keys_of<Kind>, [&]<class Key>(const Key& key) {
    const auto& owner = static_cast<const typename Key::Struct&>(from);
    for (const std::string& text : texts_of(key, owner, scope...)) add_key(element, key.name, text);
  });
}

template <class Kind>
XmlNode& add_element(XmlNode& parent, const std::string& name) {
  return add_named(parent, prefixed(keys::table_of<Kind>.head.name), name);
}

struct DeviceWriter {
  XmlNode& parent;  // the model
  const Model& model;
  const std::filesystem::path& folder;

  template <class Kind>
  void operator()(const Kind& device) const {
    if constexpr (keys::HasTable<Kind>) {
      XmlNode& element = add_element<Kind>(parent, device.name);
      write_values<Kind>(element, device, model, folder);
      if constexpr (keys::Senses<Kind>) {
        for (const Noise& noise : device.readout.noises)
          if (noise.quantity.empty()) write_values<Kind>(element, noise);  // others are under keys of their own
        write_values<Kind>(element, device.readout);
      }
    } else {
      write_sdf_sensor(parent, model, device);
    }
  }
};

struct EmitterWriter {
  XmlNode& parent;  // the link
  const Emitter& emitter;

  void operator()(const Light& light) const {
    const char* const kinds[] = {"point", "spot", "directional"};
    XmlNode& element = add_named(parent, "light", emitter.name);
    element.attributes.emplace_back("type", kinds[static_cast<int>(light.kind)]);
    add_pose(element, emitter.X_LE);
    add_value(element, "intensity", light.intensity);
    add_value(element, "diffuse", light.color).text += " 1";
    add_value(element, "direction", light.direction_E);
    XmlNode& attenuation = add(element, "attenuation");
    add_value(attenuation, "range", light.range);
    add_value(attenuation, "constant", light.constant);
    add_value(attenuation, "linear", light.linear);
    add_value(attenuation, "quadratic", light.quadratic);
    if (light.kind != Light::Kind::spot) return;
    XmlNode& spot = add(element, "spot");
    add_value(spot, "inner_angle", 2.0 * light.inner_angle);
    add_value(spot, "outer_angle", 2.0 * light.outer_angle);
    add_value(spot, "falloff", light.falloff);
  }
  template <class Kind>
  void operator()(const Kind& what) const {
    XmlNode& element = add_element<Kind>(parent, emitter.name);
    write_values<Kind>(element, emitter);
    write_values<Kind>(element, what);
  }
};

}  // namespace

std::string text_of(double number) { return shortest_text(number); }
std::string text_of(const Eigen::Vector2d& v) { return text_of(v.x()) + " " + text_of(v.y()); }
std::string text_of(const Eigen::Vector3d& v) { return text_of(v.x()) + " " + text_of(v.y()) + " " + text_of(v.z()); }
std::string text_of(const Pose& X) {
  const Eigen::Quaterniond& q = X.orientation;
  return text_of(X.position) + " " + text_of(q.x()) + " " + text_of(q.y()) + " " + text_of(q.z()) + " " +
         text_of(q.w());
}

std::string without_scope_marks(std::string name) {
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::", at)) name.replace(at, 2, ".");
  return name;
}

std::string relative_to(const std::filesystem::path& folder, const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal().lexically_proximate(
      std::filesystem::absolute(folder).lexically_normal());
}

void write_device(XmlNode& model_element, const Model& model, const Device& device,
                  const std::filesystem::path& folder) {
  std::visit(DeviceWriter{model_element, model, folder}, device);
}

template <class Part>
void write_link_part(XmlNode& link_element, const Part& part) {
  write_values<Part>(add_element<Part>(link_element, part.name), part);
}
template void write_link_part(XmlNode&, const GripRing&);
template void write_link_part(XmlNode&, const Fin&);
template void write_link_part(XmlNode&, const Drag&);

void write_emitter(XmlNode& link_element, const Emitter& emitter) {
  std::visit(EmitterWriter{link_element, emitter}, emitter.what);
}

}  // namespace cohort::parsing
