#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/sdf/extension_values.hpp"
#include "server/description/model.hpp"
#include "server/parsing/sdf/sdf_report.hpp"
#include "server/parsing/model/shape_files.hpp"
#include "server/core/text.hpp"

namespace cohort::parsing {

/// What the readers of devices share: the links and joints of the model by name, and what other devices have taken.
class DeviceReader {
 public:
  /// `drives` are the treel drives of the model: name and index among the devices.
  DeviceReader(const Model& model, std::map<std::string, std::size_t> drives, const SdfReport& report,
               ShapeFiles& files)
      : model_(model), drives_(std::move(drives)), report_(report), files_(files) {}

  const Model& model() const { return model_; }
  const std::map<std::string, std::size_t>& drives() const { return drives_; }
  const SdfReport& report() const { return report_; }

  /// The index of the link or joint that `key` names; reported if there is none.
  template <class Named>
  std::optional<std::size_t> find(const ExtensionValues& values, const char* key, const std::vector<Named>& named) {
    return find(values.text(key), values.where(key), key, named);
  }
  template <class Named>
  std::optional<std::size_t> find(const std::string& name, const sdf::ElementPtr& where, const char* kind,
                                  const std::vector<Named>& named) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < named.size(); ++i) {
      if (named[i].name == name) return i;
      names.push_back(named[i].name);
    }
    report_.problem(where, "the model has no " + std::string(kind) + " '" + name + "'" + suggestion(name, names));
    return std::nullopt;
  }
  /// The link that the key `link` names.
  std::optional<std::size_t> find_link(const ExtensionValues& values) { return find(values, "link", model_.links); }
  /// The joint that the key `joint` names, one that has an angle or a way: its first axis is meant.
  std::optional<std::size_t> find_moving_joint(const ExtensionValues& values);

  /// What the file of the key `samples` holds, with as many readings as the device; null if there is no such key, and
  /// reported if the file cannot be.
  std::shared_ptr<const Samples> find_samples(const ExtensionValues& values, std::size_t count);

  /// False, and reported, if the joint is a wheel's or has a motor; then it has one.
  bool takes_motor(std::size_t joint, const ExtensionValues& values);
  /// The joints of the wheels of one side; reported if they cannot be.
  std::vector<std::size_t> take_wheels(const ExtensionValues& values, const char* key, std::size_t hull);

 private:
  const Model& model_;
  std::map<std::string, std::size_t> drives_;
  const SdfReport& report_;
  ShapeFiles& files_;
  std::set<std::size_t> motorised_;  // joints
  std::set<std::size_t> wheels_;     // joints
};

/// How a kind of device is read. Nothing if it cannot be; the report then has it.
struct DeviceKind {
  std::string_view name;  ///< of its extension
  std::optional<Device> (*read)(const ExtensionValues& values, DeviceReader& reader);
  bool commands = false;  ///< its channels are commands
  bool observes = true;   ///< its channels are observations
};

std::span<const DeviceKind> actuator_kinds();
std::span<const DeviceKind> sensor_kinds();

/// To the nearest nanosecond; what is too long for those is 285 years.
std::chrono::nanoseconds to_time(double seconds);

/// The keys that every sensor has.
Readout read_readout(const ExtensionValues& values);

}  // namespace cohort::parsing
