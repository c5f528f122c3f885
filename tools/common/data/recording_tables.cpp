// SPDX-License-Identifier: Apache-2.0
#include "tools/common/data/recording_tables.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "idl/messages/ros_messages.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"

namespace cohort::data {
namespace {

using Type = Column::Type;
using namespace recording;

double seconds(Timestamp time) { return std::chrono::duration<double>(time).count(); }

// A table that is begun when its first row comes.
class LazyTable {
 public:
  LazyTable(TableSink& sink, std::string name, std::vector<Column> columns)
      : sink_(sink), name_(std::move(name)), columns_(std::move(columns)) {}

  void add(std::span<const Cell> row) {
    if (writer_ == nullptr) writer_ = sink_.begin(name_, columns_);
    writer_->add(row);
    ++rows_;
  }
  std::uint64_t finish() {
    if (writer_ != nullptr) writer_->finish();
    return rows_;
  }

 private:
  TableSink& sink_;
  std::string name_;
  std::vector<Column> columns_;
  std::unique_ptr<TableWriter> writer_;
  std::uint64_t rows_ = 0;
};

const std::vector<Column> when = {{"run", Type::whole}, {"time", Type::real, "s"}};

std::vector<Column> with_time(std::vector<Column> columns) {
  columns.insert(columns.begin(), when.begin(), when.end());
  return columns;
}

std::vector<Column> columns_of(const std::vector<RecordedChannel>& channels) {
  std::vector<Column> columns = with_time({{"robot", Type::text}, {"team", Type::text}});
  for (const RecordedChannel& channel : channels) {
    const std::string name = ros_field_name(channel.name);
    for (std::uint32_t i = 0; i < channel.size; ++i)
      columns.push_back({channel.size == 1 ? name : name + "_" + std::to_string(i), Type::real, channel.unit});
  }
  return columns;
}

std::size_t size_of(const std::vector<RecordedChannel>& channels) {
  std::size_t size = 0;
  for (const RecordedChannel& channel : channels) size += channel.size;
  return size;
}

class RecordingTables {
 public:
  RecordingTables(const Recording& recording, const Selection& selection, TableSink& sink)
      : recording_(recording), selection_(selection), sink_(sink) {}

  std::uint64_t write() {
    // The robots are described before the selected data.
    MessageStream stream = recording_.reader().messages({.to = selection_.to, .order = Order::file});
    while (const std::optional<Message> message = stream.next()) {
      try {
        read(*message);
      } catch (const messages::CdrError& error) {
        throw McapError(recording_.file(), 0, std::string("a message is not in Cohort's format: ") + error.what());
      }
    }
    std::uint64_t rows = 0;
    for (auto& [name, table] : tables_) rows += table.finish();
    return rows;
  }

 private:
  void read(const Message& message) {
    const std::string& topic = recording_.reader().channels().at(message.channel).topic;
    if (topic == WorldBegins::topic) run_ = messages::decode<WorldBegins>(message.data).run;
    if (topic == Roster::topic) return read_roster(messages::decode<Roster>(message.data));
    const bool is_before = std::chrono::nanoseconds(message.log_time) < selection_.from;
    // They count from then on.
    if (topic == Commands::topic && is_before) return take_commands(decode_commands(message.data), nullptr);
    if (is_before) return;
    const std::vector<Cell> time = {std::uint64_t{run_}, seconds(message.publish_time)};
    if (topic == Boundary::topic) {
      const auto boundary = messages::decode<Boundary>(message.data);
      add("ticks", {{"tick", Type::whole}, {"state_hash", Type::text}}, time,
          {boundary.tick, fmt::format("{:016x}", boundary.state_hash)});
    } else if (topic == RecordedEvent::topic) {
      const auto event = messages::decode<RecordedEvent>(message.data);
      add("events", {{"tick", Type::whole}, {"kind", Type::text}, {"text", Type::text}, {"count", Type::whole}}, time,
          {event.tick, event.kind, event.text, event.count});
    } else if (topic == RecordedMiss::topic) {
      const auto miss = messages::decode<RecordedMiss>(message.data);
      add("misses",
          {{"tick", Type::whole},
           {"frame_tick", Type::whole},
           {"robot", Type::text},
           {"team", Type::text},
           {"on_late", Type::text},
           {"waited", Type::real, "s"}},
          time,
          {miss.tick, miss.frame_tick, robot(miss.robot).name, robot(miss.robot).team, miss.on_late, miss.waited});
    } else if (topic == ActionTaken::topic) {
      const auto action = messages::decode<ActionTaken>(message.data);
      add("actions", {{"tick", Type::whole}, {"text", Type::text}}, time, {action.tick, action.text});
    } else if (topic == Commands::topic) {
      take_commands(decode_commands(message.data), &time);
    } else if (topic == "/tf") {
      add_poses(messages::decode<ros::TFMessage>(message.data), time);
    } else if (topic.ends_with(observation_topic_end)) {
      add_observation(topic, message.data, time);
    }
  }

  void read_roster(Roster roster) {
    roster_ = std::move(roster);
    robot_of_topic_.clear();
    team_of_robot_.clear();
    for (std::uint32_t id = 0; id < roster_.robots.size(); ++id) {
      if (roster_.robots[id].kind >= roster_.kinds.size()) throw messages::CdrError("a robot has an unknown kind");
      team_of_robot_[roster_.robots[id].name] = roster_.robots[id].team;
      robot_of_topic_["/" + roster_.robots[id].name + observation_topic_end] = id;
      commanded_[id] = roster_.robots[id].command;
      if (commanded_[id].size() != size_of(roster_.kinds[roster_.robots[id].kind].command))
        throw messages::CdrError("a robot's command has the wrong number of values");
    }
  }

  const RecordedRobot& robot(std::uint32_t id) const {
    if (id >= roster_.robots.size()) throw messages::CdrError("a message belongs to a robot that is not in the roster");
    return roster_.robots[id];
  }
  // Returns the team of a robot, or of the robot that the frame is a part of; empty if it is of neither.
  std::string team_of(const std::string& frame) const {
    for (std::size_t end = frame.size(); end != std::string::npos && end > 0; end = frame.rfind('/', end - 1))
      if (const auto found = team_of_robot_.find(frame.substr(0, end)); found != team_of_robot_.end())
        return found->second;
    return "";
  }
  bool is_selected(const RecordedRobot& robot) const {
    return selection_.robots.empty() || selection_.robots.contains(robot.name);
  }

  void add(const std::string& name, const std::vector<Column>& columns, std::vector<Cell> row,
           const std::vector<Cell>& cells) {
    row.insert(row.end(), cells.begin(), cells.end());
    table(name, [&] { return with_time(columns); }).add(row);
  }
  template <class Columns>
  LazyTable& table(const std::string& name, Columns&& columns) {
    const auto known = tables_.find(name);
    if (known != tables_.end()) return known->second;
    return tables_.try_emplace(name, sink_, name, columns()).first->second;
  }

  void add_values(const std::string& table_of, const RecordedRobot& robot, const std::vector<RecordedChannel>& channels,
                  std::span<const double> values, std::vector<Cell> row) {
    row.emplace_back(robot.name);
    row.emplace_back(robot.team);
    row.insert(row.end(), values.begin(), values.end());
    table(table_of + "_" + roster_.kinds[robot.kind].model, [&] { return columns_of(channels); }).add(row);
  }

  // A row for each robot of which something changed, with all that it is commanded from then on. `time`: null for no
  // rows.
  void take_commands(const Commands& commands, const std::vector<Cell>* time) {
    for (std::size_t i = 0; i < commands.robots.size();) {
      const std::uint32_t id = commands.robots[i];
      const RecordedRobot& each = robot(id);
      std::vector<double>& values = commanded_[id];
      for (; i < commands.robots.size() && commands.robots[i] == id; ++i) {
        if (commands.places[i] >= values.size())
          throw messages::CdrError("a command is for a channel that its robot does not have");
        values[commands.places[i]] = commands.values[i];
      }
      if (time != nullptr && is_selected(each))
        add_values("commands", each, roster_.kinds[each.kind].command, values, *time);
    }
  }

  void add_poses(const ros::TFMessage& message, const std::vector<Cell>& time) {
    for (const ros::TransformStamped& each : message.transforms) {
      if (each.header.frame_id != "world") continue;  // a part of a robot, in the robot's frame
      const auto& p = each.transform.translation;
      const auto& q = each.transform.rotation;
      add("trajectories",
          {{"object", Type::text},
           {"team", Type::text},
           {"x", Type::real, "m"},
           {"y", Type::real, "m"},
           {"z", Type::real, "m"},
           {"qx", Type::real, "1"},
           {"qy", Type::real, "1"},
           {"qz", Type::real, "1"},
           {"qw", Type::real, "1"}},
          time, {each.child_frame_id, team_of(each.child_frame_id), p.x, p.y, p.z, q.x, q.y, q.z, q.w});
    }
  }

  void add_observation(const std::string& topic, ByteView data, const std::vector<Cell>& time) {
    const auto found = robot_of_topic_.find(topic);
    if (found == robot_of_topic_.end()) return;  // another robot's
    const RecordedRobot& each = robot(found->second);
    if (!is_selected(each)) return;
    const std::vector<RecordedChannel>& channels = roster_.kinds[each.kind].observation;
    messages::CdrReader reader(data);
    reader.get<ros::Time>();
    const std::size_t size = size_of(channels);
    if (size > reader.left() / sizeof(double)) throw messages::CdrError("an observation has too few values");
    std::vector<double> values(size);
    for (double& value : values) reader.read(value);
    add_values("observations", each, channels, values, time);
  }

  const Recording& recording_;
  const Selection& selection_;
  TableSink& sink_;
  std::uint32_t run_ = 0;
  Roster roster_;
  std::map<std::string, std::uint32_t> robot_of_topic_;
  std::map<std::string, std::string> team_of_robot_;
  std::map<std::uint32_t, std::vector<double>> commanded_;  // by robot
  std::map<std::string, LazyTable> tables_;
};

}  // namespace

std::uint64_t write_tables(const Recording& recording, const Selection& selection, TableSink& sink) {
  return RecordingTables(recording, selection, sink).write();
}

}  // namespace cohort::data
