#include <algorithm>
#include <stdexcept>

#include "server/parsing/model/device_reader.hpp"
#include "server/parsing/model/read_model.hpp"

namespace cohort::parsing {

std::optional<std::size_t> DeviceReader::find_moving_joint(const ExtensionValues& values) {
  const std::optional<std::size_t> joint = find(values, "joint", model_.joints);
  if (!joint) return std::nullopt;
  const JointType type = model_.joints[*joint].type;
  if (type != JointType::fixed && type != JointType::ball) return joint;
  report_.problem(values.where("joint"),
                  "the joint '" + values.text("joint") + "' " +
                      (type == JointType::fixed ? "is fixed" : "is a ball: it has no single axis"));
  return std::nullopt;
}

std::shared_ptr<const Samples> DeviceReader::find_samples(const ExtensionValues& values, std::size_t count) {
  if (!values.has("samples")) return nullptr;
  const sdf::ElementPtr where = values.where("samples");
  try {
    std::shared_ptr<const Samples> samples = files_.samples(where);
    if (samples->count() == count) return samples;
    report_.problem(where, "'" + values.text("samples") + "' has " + std::to_string(samples->count()) +
                               " readings at each place, the device has " + std::to_string(count));
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) report_.problem(problem);
  } catch (const std::runtime_error& error) {
    report_.problem(where, error.what());
  }
  return nullptr;
}

bool DeviceReader::takes_motor(std::size_t joint, const ExtensionValues& values) {
  const bool is_wheel = wheels_.contains(joint);
  if (!is_wheel && motorised_.insert(joint).second) return true;
  report_.problem(values.where("joint"),
                  "the joint '" + values.text("joint") + "' " +
                      (is_wheel ? "is a wheel's of a treel_drive, which moves it" : "has a motor already"));
  return false;
}

std::vector<std::size_t> DeviceReader::take_wheels(const ExtensionValues& values, const char* key, std::size_t hull) {
  std::vector<std::size_t> wheels;
  const std::vector<std::string> names = values.texts(key);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const sdf::ElementPtr where = values.where(key, i);
    const std::optional<std::size_t> found = find(names[i], where, "joint", model_.joints);
    if (!found) continue;
    const Joint& joint = model_.joints[*found];
    const auto problem = [&](const std::string& what) {
      report_.problem(where, "the joint '" + joint.name + "' " + what);
    };
    if (joint.type != JointType::revolute)
      problem("is not revolute, as that of a wheel is");
    else if (joint.parent != hull)
      problem("is not between '" + model_.links[hull].name + "' and a wheel");
    else if (motorised_.contains(*found))
      problem("has a motor already");
    else if (!wheels_.insert(*found).second)
      problem("is a wheel's already");
    else
      wheels.push_back(*found);
  }
  return wheels;
}

namespace {

const DeviceKind& kind_of(const Extension& extension) {
  for (const std::span<const DeviceKind> kinds : {actuator_kinds(), sensor_kinds()})
    for (const DeviceKind& kind : kinds)
      if (kind.name == extension.name) return kind;
  throw std::logic_error("no reader for the device " + std::string(extension.name));
}

}  // namespace

std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const Model& model, const SdfReport& report,
                                 ShapeFiles& files) {
  struct Found {
    sdf::ElementPtr element;
    const Extension* extension;
    const std::string& prefix;
  };
  std::vector<Found> found;
  for (const DeviceScope& scope : scopes)
    for (const auto& [element, extension] : extensions_in(scope.model_element, report))
      found.push_back({element, extension, scope.prefix});
  // An encoder may stand before the drive that it measures.
  std::map<std::string, std::size_t> drives;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i].extension->name == "treel_drive" && found[i].element->HasAttribute("name"))
      drives.emplace(found[i].prefix + found[i].element->GetAttribute("name")->GetAsString(), i);

  DeviceReader reader(model, std::move(drives), report, files);
  std::vector<Device> devices;
  // Commands and observations are named after their device: two devices that command, or two that observe, cannot
  // share a name.
  std::set<std::pair<bool, std::string>> names;
  for (const auto& [element, extension, prefix] : found) {
    std::optional<ExtensionValues> values = ExtensionValues::read(element, *extension, report);
    if (!values) continue;
    values->put_in_scope(prefix, *extension);
    const DeviceKind& kind = kind_of(*extension);
    const bool is_new = (!kind.commands || names.emplace(true, values->name()).second) &&
                        (!kind.observes || names.emplace(false, values->name()).second);
    if (!is_new) report.problem(element, "another device of the model has the name '" + values->name() + "'");
    std::optional<Device> device = kind.read(*values, reader);
    if (!device) continue;
    if (Readout* const readout = readout_of(*device)) {
      // What is said of a single quantity holds before what is said of all.
      Readout common = read_readout(*values);
      common.noises.insert(common.noises.end(), readout->noises.begin(), readout->noises.end());
      *readout = std::move(common);
    }
    devices.push_back(*std::move(device));
  }
  return devices;
}

}  // namespace cohort::parsing
