// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/models/robot_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/geometry/shapes/shapes.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

// Channels that differ in nothing but the number in their names.
struct ChannelGroup {
  Channel channel;
  std::string before;  ///< the number
  std::string after;
  std::size_t first = 0;
  std::size_t last = 0;
  bool has_number = false;

  std::string name() const {
    return last == first ? channel.name : fmt::format("{}{}..{}{}", before, first, last, after);
  }
  bool takes(const ChannelGroup& next) const {
    return has_number && next.has_number && next.first == last + 1 && next.before == before && next.after == after &&
           next.channel.unit == channel.unit && next.channel.size == channel.size &&
           next.channel.lower == channel.lower && next.channel.upper == channel.upper;
  }
};

ChannelGroup group_of(const Channel& channel) {
  ChannelGroup group{.channel = channel, .before = {}, .after = {}};
  const std::string& name = channel.name;
  const std::size_t begin = name.find('/');
  const std::size_t end = begin == std::string::npos ? begin : name.find('/', begin + 1);
  if (end == std::string::npos) return group;
  const auto number = parse_whole(std::string_view(name).substr(begin + 1, end - begin - 1));
  if (!number) return group;
  group.before = name.substr(0, begin + 1);
  group.after = name.substr(end);
  group.first = group.last = *number;
  group.has_number = true;
  return group;
}

// In the order of each group's first channel.
std::vector<ChannelGroup> grouped(const std::vector<Channel>& channels) {
  std::vector<ChannelGroup> groups;
  for (const Channel& channel : channels) {
    ChannelGroup next = group_of(channel);
    const auto taker = std::ranges::find_if(groups, [&](const ChannelGroup& group) { return group.takes(next); });
    if (taker != groups.end())
      taker->last = next.first;
    else
      groups.push_back(std::move(next));
  }
  return groups;
}

std::string range_of(const Channel& channel) {
  const bool has_lower = std::isfinite(channel.lower);
  const bool has_upper = std::isfinite(channel.upper);
  if (has_lower && has_upper) return fmt::format("{:.6g} to {:.6g}", channel.lower, channel.upper);
  if (has_lower) return fmt::format("from {:.6g}", channel.lower);
  return has_upper ? fmt::format("up to {:.6g}", channel.upper) : "any value";
}

std::string channels_text(const char* title, const std::vector<Channel>& channels, std::size_t size) {
  if (channels.empty()) return fmt::format("{}: none\n", title);
  std::string text = fmt::format("{}, {}:\n", title, counted(size, "value"));
  const std::vector<ChannelGroup> groups = grouped(channels);
  std::size_t width = 0;
  std::size_t unit_width = 0;
  for (const ChannelGroup& group : groups) {
    width = std::max(width, group.name().size());
    unit_width = std::max(unit_width, group.channel.unit.size());
  }
  for (const ChannelGroup& group : groups) {
    const Channel& channel = group.channel;
    text += fmt::format("  {:<{}}  {:<{}}  {}{}\n", group.name(), width, channel.unit, unit_width, range_of(channel),
                        channel.size == 1 ? "" : fmt::format(", {} values", channel.size));
  }
  return text;
}

std::string size_of(const description::Model& model) {
  std::optional<geometry::Bounds> bounds;
  for (const description::Link& link : model.links)
    for (const description::Collision& collision : link.collisions) {
      const geometry::Bounds each = geometry::bounds_of(collision.shape, link.X_ML * collision.X_LC);
      if (bounds)
        bounds->include(each);
      else
        bounds = each;
    }
  if (!bounds) return "has no collisions";
  const Eigen::Vector3d size = bounds->upper - bounds->lower;
  if (!size.allFinite()) return "unbounded";
  return fmt::format("{:.3g} x {:.3g} x {:.3g} m (bounding box of its collisions)", size.x(), size.y(), size.z());
}

std::string mass_of(const description::Model& model) {
  double mass = 0.0;
  for (const description::Link& link : model.links) mass += link.inertial.mass;
  return model.is_static ? "static" : fmt::format("{:.6g} kg", mass);
}

std::string indented(std::string_view text) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    lines += line.empty() ? "\n" : fmt::format("  {}\n", line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// The comment in front of the root element of an XML file.
std::string_view heading_comment(std::string_view text) {
  const std::size_t begin = text.find("<!--");
  std::size_t root = text.find('<');
  while (root != std::string_view::npos && root + 1 < text.size() && text[root + 1] == '?')
    root = text.find('<', root + 1);
  if (begin == std::string_view::npos || begin != root) return {};
  const std::size_t end = text.find("-->", begin);
  return end == std::string_view::npos ? std::string_view() : trimmed(text.substr(begin + 4, end - begin - 4));
}

// The comments at the beginning of the model file and of the files in its folder that it includes.
std::string notes_on(const fs::path& file, const description::KeptFiles& kept) {
  std::string text;
  const fs::path folder = fs::weakly_canonical(file).parent_path();
  for (const description::KeptFile& each : kept.files) {
    if (fs::weakly_canonical(each.path).parent_path() != folder) continue;
    const std::string_view comment = heading_comment(each.bytes);
    if (!comment.empty())
      text += fmt::format("notes in {}:\n{}", fs::path(each.path).filename().string(), indented(comment));
  }
  return text;
}

std::string as_shell_word(const std::string& word) {
  return word.find_first_of(" \t\"'\\$&;()<>|*?") == std::string::npos ? word : fmt::format("'{}'", word);
}

}  // namespace

std::string robot_sheet(const fs::path& file, const std::string& named, parsing::Xacro xacro) {
  const description::Experiment experiment = parsing::read_experiment(file, {}, {}, installed_model_folders(), xacro);
  const description::World& world = experiment.world;
  if (parsing::kind_of_file(file) != parsing::FileKind::sdf || !parsing::holds_lone_model(file))
    throw std::invalid_argument(
        fmt::format("{} does not contain exactly one model; 'cohort check {}' describes the file", file.string(),
                    as_shell_word(named)));
  const Simulation simulation(experiment, 1);
  std::string text;
  std::uint32_t robot = 0;
  for (const description::Instance& instance : world.instances) {
    const description::Model& model = world.models[instance.model];
    if (model.is_static && !text.empty()) continue;  // the plane under it
    text += fmt::format("{}, {}\n  size  {}\n  mass  {}\n", instance.name, counted(model.joints.size(), "joint"),
                        size_of(model), mass_of(model));
    if (!model.is_robot()) {
      text += "no channels: it has no motors and no sensors\n";
      continue;
    }
    const RobotKind& kind = simulation.kinds()[simulation.kind_of(robot++)];
    text += channels_text("commands", kind.command, kind.command_size);
    text += channels_text("observations", kind.observation, kind.observation_size);
  }
  text += notes_on(file, *experiment.inputs);
  return text + fmt::format("run it: cohort run {} --view --control\n", as_shell_word(named));
}

}  // namespace cohort::tool
