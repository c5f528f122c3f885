#include "server/simulation/action.hpp"

#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "server/core/snapshot.hpp"

namespace cohort {
namespace {

// Each kind's members in the order in which they are written; a kind's number is its place in the variant.
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
  // At the end of a kind that had no such member at first.
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
  if (!is_known) throw SnapshotError("there is no kind " + std::to_string(kind));
  return action;
}

}  // namespace

std::vector<std::byte> to_bytes(const Action& action) {
  SnapshotWriter bytes;
  bytes.add(static_cast<std::uint8_t>(action.index()));
  std::visit([&](const auto& kind) { visit_members(kind, Writer{bytes}); }, action);
  return bytes.bytes();
}

Action action_from_bytes(std::span<const std::byte> bytes) {
  try {
    SnapshotReader reader(bytes);
    std::uint8_t kind = 0;
    reader.read(kind);
    Action action = empty_action(kind, std::make_index_sequence<std::variant_size_v<Action>>());
    std::visit([&](auto& empty) { visit_members(empty, Reader{reader}); }, action);
    if (!reader.is_at_end()) throw SnapshotError("they go on after its end");
    return action;
  } catch (const SnapshotError& error) {
    throw std::invalid_argument(std::string("these bytes are no action: ") + error.what());
  }
}

}  // namespace cohort
