// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/recorded_values.hpp"

#include <algorithm>
#include <utility>

namespace cohort::view {
namespace {

using recording::Boundary;
using recording::Commands;
using recording::Roster;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds longest_part{400};  // wall time that is spent on samples before an answer
constexpr std::uint32_t ticks_between_looks = 16;
constexpr std::size_t points_of_sweep = 4000;  // points of a value, as many as the page asks for
constexpr std::size_t most_swept = 600;        // values; of more, only those that are asked for

std::string topic_of_observations(const std::string& robot) { return "/" + robot + recording::observation_topic_end; }

// The values of the messages of a recording, in their order.
class RecordReader {
 public:
  RecordReader(const recording::McapReader& reader, const HistoryRequest& request,
               const std::map<std::uint32_t, std::string>& names)
      : reader_(reader), request_(request), collector_(request) {
    for (const char* topic : {Roster::topic, Boundary::topic, Commands::topic}) add_channel(topic);
    const bool are_observed =
        std::ranges::any_of(request.names, [](const std::string& name) { return !name.starts_with(commanded_prefix); });
    for (const std::uint32_t robot : request.robots) {
      const auto name = names.find(robot);
      if (name == names.end() || !are_observed) continue;
      if (const auto channel = add_channel(topic_of_observations(name->second))) observed_[*channel] = robot;
    }
  }

  const std::vector<recording::ChannelId>& channels() const { return channels_; }
  const HistoryCollector& collector() const { return collector_; }

  void take(const recording::Message& message) {
    const std::string& topic = reader_.channels().at(message.channel).topic;
    const std::chrono::nanoseconds time(message.log_time);
    if (const auto observed = observed_.find(message.channel); observed != observed_.end()) {
      take_observation(observed->second, time, message.data);
    } else if (topic == Roster::topic) {
      take_roster(messages::decode<Roster>(message.data));
    } else if (topic == Boundary::topic) {
      for (const auto& [robot, values] : commanded_) collector_.add(robot, time, {}, values);
    } else if (topic == Commands::topic) {
      take_commands(recording::decode_commands(message.data));
    }
  }

 private:
  std::optional<recording::ChannelId> add_channel(const std::string& topic) {
    const recording::Channel* const channel = reader_.channel(topic);
    if (channel == nullptr) return std::nullopt;
    channels_.push_back(channel->id);
    return channel->id;
  }
  void take_roster(const Roster& roster) {
    commanded_.clear();
    for (const std::uint32_t id : request_.robots) {
      if (id >= roster.robots.size()) continue;
      const recording::RecordedRobot& robot = roster.robots[id];
      if (robot.kind >= roster.kinds.size()) throw messages::CdrError("a robot has an unknown kind");
      const recording::RecordedKind& kind = roster.kinds[robot.kind];
      collector_.set_channels(id, kind.observation, kind.command);
      commanded_[id] = robot.command;
    }
  }
  void take_commands(const Commands& commands) {
    for (std::size_t i = 0; i < commands.robots.size(); ++i) {
      const auto found = commanded_.find(commands.robots[i]);
      if (found == commanded_.end()) continue;
      if (commands.places[i] >= found->second.size())
        throw messages::CdrError("a command is for a channel that its robot does not have");
      found->second[commands.places[i]] = commands.values[i];
    }
  }
  void take_observation(std::uint32_t robot, std::chrono::nanoseconds time, recording::ByteView data) {
    messages::CdrReader reader(data);
    reader.get<messages::ros::Time>();
    std::vector<double> values(reader.left() / sizeof(double));
    for (double& value : values) reader.read(value);
    collector_.add(robot, time, values, {});
  }

  const recording::McapReader& reader_;
  const HistoryRequest& request_;
  HistoryCollector collector_;
  std::vector<recording::ChannelId> channels_;
  std::map<recording::ChannelId, std::uint32_t> observed_;  // robots
  std::map<std::uint32_t, std::vector<double>> commanded_;  // by robot
};

void add_names(std::vector<std::string>& names, const std::vector<recording::RecordedChannel>& channels,
               std::string_view prefix) {
  for (const recording::RecordedChannel& channel : channels)
    for (std::uint32_t i = 0; i < channel.size && names.size() <= most_swept; ++i)
      names.push_back(std::string(prefix) + channel.name + (channel.size == 1 ? "" : "[" + std::to_string(i) + "]"));
}

// Takes the values at the boundary where a replay is, and at the following ones, as long as that does not take too
// long after `from`. Returns the time where it is to be continued, or nothing if it is at the end.
std::optional<std::chrono::nanoseconds> collect(recording::Replay& replay, const HistoryRequest& request,
                                                HistoryCollector& collector, std::chrono::nanoseconds from,
                                                const HistoryThread::IsCancelled& is_cancelled) {
  std::uint32_t known = 0;  // robots
  Clock::time_point begin = Clock::now();
  for (std::uint32_t ticks = 0;; ++ticks) {
    const Simulation& simulation = replay.simulation();
    const std::chrono::nanoseconds time = replay.recorded().log_time;
    if (time > request.to) return std::nullopt;
    if (replay.recorded().begins) known = 0;
    if (known != simulation.robot_count()) {
      known = simulation.robot_count();
      for (const std::uint32_t robot : request.robots)
        if (robot < known) {
          const RobotKind& kind = simulation.kinds()[simulation.kind_of(robot)];
          collector.set_channels(robot, kind.observation, kind.command);
        }
    }
    if (time < from) begin = Clock::now();
    for (const std::uint32_t robot : request.robots)
      if (robot < known && simulation.is_present(robot))
        collector.add(robot, time, simulation.observation(robot), simulation.command(robot));
    const bool is_late = ticks % ticks_between_looks == 0 && Clock::now() - begin > longest_part;
    if (time < request.to && (is_late || is_cancelled())) return time + std::chrono::nanoseconds(1);
    if (!replay.advance()) return std::nullopt;
  }
}

}  // namespace

// A replay of the whole recording, and what it has so far.
struct RecordedValues::Sweep {
  explicit Sweep(const HistoryRequest& of) : request(of), collector(request) {}

  const HistoryRequest request;
  HistoryCollector collector;
  std::optional<recording::Replay> replay{};  // nothing at the end
  Nanoseconds next{0};
  std::string problem{};
};

RecordedValues::~RecordedValues() = default;

RecordedValues::RecordedValues(const recording::Recording& recording) : recording_(recording) {
  for (const recording::Block& block : recording.reader().blocks()) end_ = std::max(end_, Nanoseconds(block.end_time));
}

Answer RecordedValues::read(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) {
  read_rosters();
  HistoryRequest clamped = request;
  clamped.from = std::max(clamped.from, recording_.worlds().front().log_time);
  clamped.to = std::max(clamped.from, std::min(clamped.to, end_));
  if (!may_have(request)) return {false, "no robot has such a channel"};
  if (are_recorded(request)) return read_records(clamped, is_cancelled);
  return is_as_coarse_as_sweep(clamped) ? sweep(clamped, is_cancelled) : replay(clamped, is_cancelled);
}

// A robot keeps its name and its id. Without rosters that can be read, a replay has the values.
void RecordedValues::read_rosters() {
  if (std::exchange(has_rosters_, true)) return;
  const recording::Channel* const channel = recording_.reader().channel(Roster::topic);
  if (channel == nullptr) return;
  try {
    recording::MessageStream messages = recording_.reader().messages({.channels = {channel->id}});
    while (const auto message = messages.next()) {
      rosters_.emplace_back(message->log_time);
      const auto roster = messages::decode<Roster>(message->data);
      std::vector<std::vector<std::string>> values(roster.kinds.size());
      for (std::size_t kind = 0; kind < values.size(); ++kind) {
        add_names(values[kind], roster.kinds[kind].observation, "");
        add_names(values[kind], roster.kinds[kind].command, commanded_prefix);
      }
      for (std::uint32_t id = 0; id < roster.robots.size(); ++id) {
        names_[id] = roster.robots[id].name;
        values_[id] = values.at(roster.robots[id].kind);
      }
    }
  } catch (const std::exception&) {
    rosters_.clear();
  }
}

// False if no robot has any of the values, so that no replay looks for them.
bool RecordedValues::may_have(const HistoryRequest& request) const {
  return rosters_.empty() || std::ranges::any_of(request.robots, [&](std::uint32_t robot) {
           const auto known = values_.find(robot);
           return known != values_.end() && (known->second.size() > most_swept ||
                                             std::ranges::any_of(request.names, [&](const std::string& name) {
                                               return std::ranges::find(known->second, name) != known->second.end();
                                             }));
         });
}

bool RecordedValues::are_recorded(const HistoryRequest& request) const {
  if (rosters_.empty()) return false;
  const auto is_commanded = [](const std::string& name) { return name.starts_with(commanded_prefix); };
  return std::ranges::all_of(request.names, is_commanded) ||
         std::ranges::all_of(request.robots, [&](std::uint32_t robot) {
           const auto name = names_.find(robot);
           return name == names_.end() || recording_.reader().channel(topic_of_observations(name->second)) != nullptr;
         });
}

// From the last roster before, which has the commands of its time.
Answer RecordedValues::read_records(const HistoryRequest& request,
                                    const HistoryThread::IsCancelled& is_cancelled) const {
  Nanoseconds start = rosters_.front();
  for (const Nanoseconds roster : rosters_)
    if (roster <= request.from) start = std::max(start, roster);
  RecordReader records(recording_.reader(), request, names_);
  std::string problem;
  try {
    recording::MessageStream messages =
        recording_.reader().messages({.channels = records.channels(),
                                      .from = recording::Timestamp(std::max(start, Nanoseconds(0))),
                                      .to = recording::Timestamp(std::max(request.to, Nanoseconds(0))),
                                      .order = recording::Order::file});
    while (const auto message = messages.next()) {
      if (is_cancelled()) break;
      records.take(*message);
    }
  } catch (const std::exception& error) {
    problem = error.what();
  }
  return records.collector().answer(problem);
}

// Where a replay can begin that is to come to a time, unless the present one is nearer.
void RecordedValues::start_before(Nanoseconds time) {
  Nanoseconds start = recording_.worlds().front().log_time;
  for (const auto& world : recording_.worlds())
    if (world.log_time <= time) start = std::max(start, world.log_time);
  for (const Nanoseconds snapshot : recording_.snapshots())
    if (snapshot <= time) start = std::max(start, snapshot);
  if (replay_) {
    const Nanoseconds reached = replay_->recorded().log_time;
    if (start <= reached && reached < time) return;
  }
  replay_.reset();
  replay_.emplace(recording_, 1);
  if (!replay_->seek(start)) replay_.reset();
}

Answer RecordedValues::replay(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) {
  HistoryCollector collector(request);
  std::string problem;
  std::optional<Nanoseconds> next;
  try {
    start_before(request.from);
    if (replay_) next = collect(*replay_, request, collector, request.from, is_cancelled);
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!next) replay_.reset();  // it holds a world
  return collector.answer(problem, next);
}

bool RecordedValues::is_as_coarse_as_sweep(const HistoryRequest& request) const {
  if (sweep_ != nullptr && request.from == sweep_->next && request.to == end_) return true;  // continues it
  constexpr double tolerance = 0.9;
  const auto interval = [](Nanoseconds from, Nanoseconds to, std::size_t points) {
    return static_cast<double>((to - from).count()) / static_cast<double>(points);
  };
  return interval(request.from, request.to, request.points) >=
         tolerance * interval(recording_.worlds().front().log_time, end_, points_of_sweep);
}

// Robots and values that were asked for before remain, unless they are too many.
void RecordedValues::begin_sweep(const HistoryRequest& request) {
  HistoryRequest wanted = request;
  wanted.from = recording_.worlds().front().log_time;
  wanted.to = end_;
  wanted.points = points_of_sweep;
  const auto add = [](auto& to, const auto& values) {
    for (const auto& value : values)
      if (std::ranges::find(to, value) == to.end()) to.push_back(value);
  };
  std::vector<std::uint32_t> robots = request.robots;
  std::vector<std::string> names = request.names;
  if (sweep_ != nullptr) add(robots, sweep_->request.robots);
  if (robots.size() <= HistoryRequest::most_robots) wanted.robots = robots;
  for (const std::uint32_t robot : wanted.robots)
    if (const auto known = values_.find(robot); known != values_.end()) add(names, known->second);
  if (wanted.robots.size() * names.size() <= most_swept) wanted.names = std::move(names);
  sweep_ = std::make_unique<Sweep>(wanted);
  sweep_->next = wanted.from;
  sweep_->replay.emplace(recording_, 1);
  if (!sweep_->replay->seek(wanted.from)) sweep_->replay.reset();
}

Answer RecordedValues::sweep(const HistoryRequest& request, const HistoryThread::IsCancelled& is_cancelled) {
  const auto has_all = [](const auto& all, const auto& wanted) {
    return std::ranges::all_of(wanted, [&](const auto& each) { return std::ranges::find(all, each) != all.end(); });
  };
  try {
    if (sweep_ == nullptr || !has_all(sweep_->request.robots, request.robots) ||
        !has_all(sweep_->request.names, request.names))
      begin_sweep(request);
    if (sweep_->replay && sweep_->next <= request.to) {
      const auto next = collect(*sweep_->replay, sweep_->request, sweep_->collector, request.from, is_cancelled);
      if (next)
        sweep_->next = *next;
      else
        sweep_->replay.reset();  // it holds a world
    }
  } catch (const std::exception& error) {
    if (sweep_ == nullptr) throw;
    sweep_->replay.reset();
    sweep_->problem = error.what();
  }
  HistoryCollector collector(request);
  sweep_->collector.copy_to(collector);
  const bool is_part = sweep_->replay && sweep_->next <= request.to;
  return collector.answer(sweep_->problem, is_part ? std::optional(sweep_->next) : std::nullopt);
}

}  // namespace cohort::view
