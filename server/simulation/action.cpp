// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/action.hpp"

#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "server/core/snapshot.hpp"

namespace cohort {
namespace {

// The members of each kind, in their order in the bytes. A kind's number is its place in the variant, except for a
// spawn, whose number says what its model is. Older recordings have its place in the variant, and either a name or a
// text.
constexpr std::uint8_t spawn_of_name_or_text = 0;
constexpr std::uint8_t spawn_of_name = 0x80;
constexpr std::uint8_t spawn_of_text = 0x81;

template <class Self, class Visit>
void visit_members(Self& self, Visit&& visit) {
  using Kind = std::remove_const_t<Self>;
  visit(self.name);
  if constexpr (std::is_same_v<Kind, SpawnObject>) {
    visit(self.model);
    visit(self.X_WM);
    visit(self.allow_renaming);
    visit.if_any(self.team);
  } else if constexpr (std::is_same_v<Kind, SetPose>) {
    visit(self.X_WM);
  } else if constexpr (std::is_same_v<Kind, SetVelocity>) {
    visit(self.linear_W);
    visit(self.angular_W);
  } else if constexpr (std::is_same_v<Kind, SetLight>) {
    visit(self.on);
    visit(self.intensity);
    visit(self.color);
  } else if constexpr (std::is_same_v<Kind, ApplyForce>) {
    visit(self.link);
    visit(self.force_W);
    visit(self.torque_W);
    visit(self.duration);
  } else {
    static_assert(std::is_same_v<Kind, RemoveObject>);
  }
}

struct Writer {
  SnapshotWriter& bytes;

  void operator()(const std::string& text) const {
    bytes.add_count(text.size());
    bytes.add_all(text.data(), text.size());
  }
  void operator()(const ModelChoice& model) const {
    const auto* const parsed = std::get_if<description::ParsedModelPtr>(&model);
    (*this)(parsed == nullptr ? std::get<std::string>(model) : (*parsed)->text);
  }
  void operator()(double number) const { bytes.add(number); }
  void operator()(bool flag) const { bytes.add(static_cast<std::uint8_t>(flag)); }
  void operator()(const Eigen::Vector3d& vector) const { bytes.add_all(vector.data(), 3); }
  void operator()(const Pose& pose) const {
    (*this)(pose.position);
    bytes.add_all(pose.orientation.coeffs().data(), 4);
  }
  void operator()(std::chrono::nanoseconds time) const { bytes.add(static_cast<std::int64_t>(time.count())); }
  template <class Value>
  void operator()(const std::optional<Value>& value) const {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  // Adds a member at the end of a kind that did not have it in earlier versions.
  void if_any(const std::string& text) const {
    if (!text.empty()) (*this)(text);
  }
};

struct Reader {
  SnapshotReader& bytes;

  void operator()(std::string& text) const {
    text.resize(bytes.read_count(1));
    bytes.read_all(text.data(), text.size());
  }
  void operator()(ModelChoice& model) const { (*this)(model.emplace<std::string>()); }
  void operator()(double& number) const { bytes.read(number); }
  void operator()(bool& flag) const {
    std::uint8_t byte = 0;
    bytes.read(byte);
    if (byte > 1) throw SnapshotError("a flag is neither 0 nor 1");
    flag = byte == 1;
  }
  void operator()(Eigen::Vector3d& vector) const { bytes.read_all(vector.data(), 3); }
  void operator()(Pose& pose) const {
    (*this)(pose.position);
    bytes.read_all(pose.orientation.coeffs().data(), 4);
  }
  void operator()(std::chrono::nanoseconds& time) const {
    std::int64_t count = 0;
    bytes.read(count);
    time = std::chrono::nanoseconds(count);
  }
  template <class Value>
  void operator()(std::optional<Value>& value) const {
    bool is_there = false;
    (*this)(is_there);
    if (is_there) (*this)(value.emplace());
  }
  void if_any(std::string& text) const {
    if (!bytes.is_at_end()) (*this)(text);
  }
};

template <std::size_t... Kinds>
Action empty_action(std::size_t kind, std::index_sequence<Kinds...>) {
  Action action;
  const bool is_known = ((kind == Kinds && (action.emplace<Kinds>(), true)) || ...);
  if (!is_known) throw SnapshotError("unknown action kind " + std::to_string(kind));
  return action;
}

std::uint8_t number_of(const Action& action) {
  const auto* const spawn = std::get_if<SpawnObject>(&action);
  if (spawn == nullptr) return static_cast<std::uint8_t>(action.index());
  return std::holds_alternative<std::string>(spawn->model) ? spawn_of_name : spawn_of_text;
}

void read_text(ModelChoice& model, const description::ModelReader& read_model) {
  if (!read_model) throw std::invalid_argument("the model is given as text, which this experiment does not accept");
  model = read_model(std::get<std::string>(model));
}

// Reads a recorded name or text. Names do not contain these characters, except on purpose.
void read_name_or_text(ModelChoice& model, const description::ModelReader& read_model) {
  if (std::get<std::string>(model).find_first_of("<:\n{") == std::string::npos) return;
  try {
    read_text(model, read_model);
  } catch (const std::invalid_argument&) {
    // it is a name
  }
}

}  // namespace

std::vector<std::byte> to_bytes(const Action& action) {
  SnapshotWriter bytes;
  bytes.add(number_of(action));
  std::visit([&](const auto& kind) { visit_members(kind, Writer{bytes}); }, action);
  return bytes.bytes();
}

Action action_from_bytes(std::span<const std::byte> bytes, const description::ModelReader& read_model) {
  std::uint8_t number = 0;
  Action action;
  try {
    SnapshotReader reader(bytes);
    reader.read(number);
    const bool is_spawn = number == spawn_of_name || number == spawn_of_text;
    action = empty_action(is_spawn ? 0 : number, std::make_index_sequence<std::variant_size_v<Action>>());
    std::visit([&](auto& empty) { visit_members(empty, Reader{reader}); }, action);
    if (!reader.is_at_end()) throw SnapshotError("extra bytes at the end");
  } catch (const SnapshotError& error) {
    throw std::invalid_argument(std::string("invalid action: ") + error.what());
  }
  if (number == spawn_of_text) read_text(std::get<SpawnObject>(action).model, read_model);
  if (number == spawn_of_name_or_text) read_name_or_text(std::get<SpawnObject>(action).model, read_model);
  return action;
}

}  // namespace cohort
