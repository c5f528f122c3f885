// SPDX-License-Identifier: Apache-2.0
#include "server/recording/difference.hpp"

#include <algorithm>
#include <bit>
#include <set>
#include <span>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::recording {
namespace {

constexpr std::size_t most_listed = 20;

bool is_same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

// A list of differences, with the first differing value of each thing that has several.
class Differences {
 public:
  using List = std::vector<QuantityDifference>;

  void begin(std::string object) { object_ = std::move(object); }
  void add(const std::string& quantity, const std::string& detail, std::string first, std::string second) {
    list_.push_back({object_, quantity, detail, std::move(first), std::move(second)});
  }
  /// Returns true if the values are equal.
  bool compare(const std::string& quantity, const std::string& detail, double first, double second) {
    if (is_same(first, second)) return true;
    add(quantity, detail, shortest_text(first), shortest_text(second));
    return false;
  }
  template <class Values>
  void compare_all(const std::string& quantity, std::initializer_list<const char*> names, const Values& first,
                   const Values& second) {
    int i = 0;
    for (const char* name : names) {
      if (!compare(quantity, name, first[i], second[i])) return;
      ++i;
    }
  }
  void compare_channels(const std::string& quantity, const std::vector<cohort::Channel>& channels,
                        std::span<const double> first, std::span<const double> second) {
    std::size_t i = 0;
    for (const cohort::Channel& channel : channels) {
      for (std::uint32_t k = 0; k < channel.size && i < std::min(first.size(), second.size()); ++k, ++i)
        if (!compare(quantity, channel.size == 1 ? channel.name : channel.name + "[" + std::to_string(k) + "]",
                     first[i], second[i]))
          return;
    }
  }
  List take() { return std::exchange(list_, {}); }

 private:
  std::string object_;
  List list_;
};

void compare_object(const Simulation& first, const Simulation& second, std::uint32_t object, Differences& found) {
  const bool is_present = first.objects().is_present(object);
  if (is_present != second.objects().is_present(object)) {
    const auto text = [](bool present) { return present ? "in the world" : "not in the world"; };
    return found.add("presence", "", text(is_present), text(!is_present));
  }
  if (!is_present) return;
  const Pose a = first.object_pose(object);
  const Pose b = second.object_pose(object);
  found.compare_all("pose", {"x", "y", "z"}, a.position, b.position);
  found.compare_all("pose", {"qx", "qy", "qz", "qw"}, a.orientation.coeffs(), b.orientation.coeffs());
  const physics::Twist twist_a = first.world().link_twist(BodyId{object}, LinkId{0});
  const physics::Twist twist_b = second.world().link_twist(BodyId{object}, LinkId{0});
  found.compare_all("velocity", {"x", "y", "z"}, twist_a.linear_W, twist_b.linear_W);
  found.compare_all("velocity", {"about x", "about y", "about z"}, twist_a.angular_W, twist_b.angular_W);

  const description::Model& model = first.description().models[first.world().model_of(BodyId{object})];
  const description::Model& other = second.description().models[second.world().model_of(BodyId{object})];
  for (std::size_t joint = 0; joint < std::min(model.joints.size(), other.joints.size()); ++joint) {
    const std::string& name = model.joints[joint].name;
    const physics::JointState joint_a = first.world().joint_state(BodyId{object}, JointId{joint});
    const physics::JointState joint_b = second.world().joint_state(BodyId{object}, JointId{joint});
    found.compare("joint", name + " position", joint_a.position, joint_b.position);
    found.compare("joint", name + " velocity", joint_a.velocity, joint_b.velocity);
  }
}

void compare_robot(const Simulation& first, const Simulation& second, std::uint32_t robot, Differences& found) {
  const RobotKind& kind = first.kinds()[first.kind_of(robot)];
  found.compare_channels("command", kind.command, first.command(robot), second.command(robot));
  found.compare_channels("observation", kind.observation, first.observation(robot), second.observation(robot));
}

std::string text_of(const physics::Contact& contact, const Simulation& simulation) {
  return simulation.objects().name(contact.body_a.value) + " and " + simulation.objects().name(contact.body_b.value);
}

void compare_contacts(const Simulation& first, const Simulation& second, Differences& found) {
  const std::span<const physics::Contact> a = first.world().contacts();
  const std::span<const physics::Contact> b = second.world().contacts();
  found.begin("");
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    if (i >= a.size() || i >= b.size() || a[i].body_a != b[i].body_a || a[i].body_b != b[i].body_b)
      return found.add("contact", "", i < a.size() ? text_of(a[i], first) : "none",
                       i < b.size() ? text_of(b[i], second) : "none");
    const std::string who = text_of(a[i], first);
    if (!found.compare("contact", who + ", impulse", a[i].impulse, b[i].impulse)) return;
    if (!found.compare("contact", who + ", distance", a[i].distance, b[i].distance)) return;
  }
}

// Returns the value that acts from this tick on, new or unchanged. -0.0 and 0.0 are different.
std::string value_at(const Commands& changes, std::uint32_t robot, std::uint32_t place, const Simulation& simulation) {
  for (std::size_t i = 0; i < changes.robots.size(); ++i)
    if (changes.robots[i] == robot && changes.places[i] == place) return shortest_text(changes.values[i]);
  return shortest_text(simulation.command(robot)[place]);
}

std::string channel_at(const std::vector<cohort::Channel>& channels, std::uint32_t place) {
  for (const cohort::Channel& channel : channels) {
    if (place < channel.size)
      return channel.size == 1 ? channel.name : channel.name + "[" + std::to_string(place) + "]";
    place -= channel.size;
  }
  return "";
}

// Adds the first differing value of each robot whose new commands differ.
void compare_commands(const Commands& first, const Commands& second, const Simulation& simulation, Differences& found) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> changed;  // robot and place, from both recordings
  for (const Commands* each : {&first, &second})
    for (std::size_t i = 0; i < each->robots.size(); ++i)
      if (each->robots[i] < simulation.robot_count() && each->places[i] < simulation.command(each->robots[i]).size())
        changed.emplace(each->robots[i], each->places[i]);
  std::optional<std::uint32_t> told;
  for (const auto& [robot, place] : changed) {
    const std::string a = value_at(first, robot, place, simulation);
    const std::string b = value_at(second, robot, place, simulation);
    if (a == b || told == robot) continue;
    told = robot;
    found.begin(simulation.robot_name(robot));
    found.add("command", channel_at(simulation.kinds()[simulation.kind_of(robot)].command, place), a, b);
  }
}

void compare_actions(const RecordedTick& first, const RecordedTick& second, Differences& found) {
  found.begin("");
  for (std::size_t i = 0; i < std::max(first.actions.size(), second.actions.size()); ++i) {
    const auto action = [&](const RecordedTick& tick) {
      return i < tick.actions.size() ? tick.actions[i] : ActionTaken{0, "none", {}};
    };
    if (action(first).action != action(second).action)
      return found.add("action", "", action(first).text, action(second).text);
  }
}

bool has_same_state(const RecordedTick& first, const RecordedTick& second) {
  const auto is_same_action = [](const ActionTaken& a, const ActionTaken& b) { return a.action == b.action; };
  return first.tick == second.tick && first.state_hash == second.state_hash &&
         std::ranges::equal(first.actions, second.actions, is_same_action);
}

bool has_same_commands(const RecordedTick& first, const RecordedTick& second) {
  return first.commands.robots == second.commands.robots && first.commands.places == second.commands.places &&
         std::ranges::equal(first.commands.values, second.commands.values, is_same);
}

std::string end_text(const Recording& shorter, const RecordedTick& last) {
  return shorter.file().string() + " ends at tick " + std::to_string(last.tick) + ", and the other recording is longer";
}

Parting parting_at(const Recording& first, const Recording& second, const RecordedTick& first_tick,
                   const RecordedTick& second_tick, unsigned threads) {
  Parting parting{first_tick.tick, first_tick.log_time, {}, 0};
  Replay first_replay(first, threads);
  Replay second_replay(second, threads);
  first_replay.seek(first_tick.log_time);
  second_replay.seek(second_tick.log_time);
  Differences inputs;
  compare_actions(first_tick, second_tick, inputs);
  parting.differences = inputs.take();
  if (parting.differences.empty())
    parting.differences = differences(first_replay.simulation(), second_replay.simulation());
  if (parting.differences.empty()) {
    compare_commands(first_tick.commands, second_tick.commands, first_replay.simulation(), inputs);
    parting.differences = inputs.take();
  }
  for (const auto& [recording, replay] : {std::pair(&first, &first_replay), std::pair(&second, &second_replay)})
    if (replay->recorded().state_hash && !replay->is_identical())
      parting.differences.insert(parting.differences.begin(),
                                 {"", "state", recording->file().string() + ", recorded and replayed",
                                  "differ: the file was recorded by another build, or modified", ""});
  if (parting.differences.size() > most_listed) {
    parting.more = parting.differences.size() - most_listed;
    parting.differences.resize(most_listed);
  }
  return parting;
}

}  // namespace

std::vector<QuantityDifference> differences(const Simulation& first, const Simulation& second) {
  Differences found;
  const std::uint32_t objects = std::min(first.objects().size(), second.objects().size());
  for (std::uint32_t object = 0; object < objects; ++object) {
    found.begin(first.objects().name(object));
    if (first.objects().name(object) != second.objects().name(object)) {
      found.add("presence", "", first.objects().name(object), second.objects().name(object));
      continue;
    }
    compare_object(first, second, object, found);
  }
  found.begin("");
  if (first.objects().size() != second.objects().size())
    found.add("presence", "objects", std::to_string(first.objects().size()), std::to_string(second.objects().size()));
  for (std::uint32_t robot = 0; robot < std::min(first.robot_count(), second.robot_count()); ++robot) {
    found.begin(first.robot_name(robot));
    if (first.kinds()[first.kind_of(robot)].model == second.kinds()[second.kind_of(robot)].model)
      compare_robot(first, second, robot, found);
  }
  compare_contacts(first, second, found);
  return found.take();
}

Comparison compare(const Recording& first, const Recording& second, unsigned threads,
                   const std::function<bool(std::chrono::nanoseconds)>& progress) {
  Comparison result;
  TickStream first_ticks = first.ticks();
  TickStream second_ticks = second.ticks();
  std::optional<RecordedTick> a = first_ticks.next();
  std::optional<RecordedTick> b = second_ticks.next();
  while (a && b) {
    std::optional<RecordedTick> next_a = first_ticks.next();
    std::optional<RecordedTick> next_b = second_ticks.next();
    // The last boundary of a run has no commands.
    const bool both_go_on = next_a.has_value() == next_b.has_value();
    if (!has_same_state(*a, *b) || (both_go_on && !has_same_commands(*a, *b))) {
      result.parting = parting_at(first, second, *a, *b, threads);
      return result;
    }
    ++result.boundaries;
    if (!both_go_on) result.ends = end_text(next_a ? second : first, *a);
    if (!both_go_on || !progress(a->log_time)) return result;
    a = std::move(next_a);
    b = std::move(next_b);
  }
  return result;
}

}  // namespace cohort::recording
