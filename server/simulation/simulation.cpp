#include "server/simulation/simulation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "server/physics/make_world.hpp"

namespace cohort {
namespace {

constexpr std::size_t robots_a_chunk = 32;

std::size_t total_size(const std::vector<Channel>& channels) {
  std::size_t size = 0;
  for (const Channel& channel : channels) size += channel.size;
  return size;
}

std::vector<double> neutral_values(const RobotKind& kind) {
  std::vector<double> values;
  for (const Channel& channel : kind.command) values.insert(values.end(), channel.size, channel.neutral);
  return values;
}

}  // namespace

Simulation::Simulation(const description::Experiment& experiment, unsigned threads)
    : experiment_(experiment),
      workers_(threads),
      world_(physics::make_world(experiment_.world, workers_)),
      breakable_joints_(experiment_.world, *world_),
      emitters_(experiment_.world, *world_),
      grippers_(experiment_.world, *world_),
      actions_(experiment_.world, *world_),
      lamp_view_(*world_, emitters_),
      objects_(experiment_, *world_),
      schedule_(experiment_, *world_, objects_, emitters_, actions_),
      spawned_models_(experiment_) {
  const description::World& world = experiment_.world;
  kind_of_model_.assign(world.models.size(), none);
  robot_of_body_.assign(world.instances.size(), none);
  note_ground();

  robots_.resize(world.robots.size());
  for (const description::Team& team : experiment.teams)
    for (const std::uint32_t robot : team.robots) robots_[robot].policy = team.policy;
  for (std::uint32_t robot = 0; robot < robots_.size(); ++robot) build_robot(robot);
  body_hashes_.resize(world.instances.size());
  scratch_.resize(workers_.threads());
  begin_tick();
  sense();
}

Simulation::~Simulation() = default;

void Simulation::build_robot(std::uint32_t id) {
  const description::World& world = experiment_.world;
  Robot& robot = robots_[id];
  robot.body = static_cast<std::uint32_t>(world.robots[id]);
  robot_of_body_[robot.body] = id;
  const description::Instance& instance = world.robot(id);
  const description::Model& model = world.robot_model(id);

  RobotKind kind{model.name, {}, {}, 0, 0};
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    if (auto sensor = sensing::make_sensor(
            {*world_, emitters_, world, grippers_, lamp_view_, robot.body, device, experiment_.seed})) {
      if (sensor->needs_record()) world_->record(robot.body);
      rings_.resize(lamp_view_.ring_count(), {id, robot.sensors.size()});
      const std::vector<Channel> channels = sensor->channels();
      kind.observation.insert(kind.observation.end(), channels.begin(), channels.end());
      const description::Readout* readout = description::readout_of(model.devices[device]);
      robot.sensors.push_back(
          {std::move(sensor),
           sensing::SignalChain(readout != nullptr ? *readout : description::Readout{}, channels, experiment_.seed,
                                instance.name, description::name_of(model.devices[device]), world.step),
           total_size(channels)});
    }
    if (auto actuator =
            actuation::make_actuator({*world_, emitters_, world, grippers_, actions_, robot.body, device})) {
      const std::vector<Channel> channels = actuator->channels();
      kind.command.insert(kind.command.end(), channels.begin(), channels.end());
      robot.actuators.push_back(std::move(actuator));
      robot.actuator_sizes.push_back(total_size(channels));
    }
  }
  std::uint32_t& known = kind_of_model_[instance.model];
  if (known == none) {
    known = static_cast<std::uint32_t>(kinds_.size());
    kind.observation_size = total_size(kind.observation);
    kind.command_size = total_size(kind.command);
    kinds_.push_back(std::move(kind));
  }
  robot.kind = known;
  robot.observation_offset = observations_.size();
  observations_.resize(observations_.size() + kinds_[known].observation_size);
  robot.command = neutral_values(kinds_[known]);
}

bool Simulation::is_due(std::uint32_t robot, std::uint64_t tick) const {
  const description::Policy& policy = robots_[robot].policy;
  return tick >= policy.phase && (tick - policy.phase) % policy.period == 0;
}

std::span<const double> Simulation::observation(std::uint32_t robot) const {
  return {observations_.data() + robots_[robot].observation_offset, kinds_[robots_[robot].kind].observation_size};
}

std::optional<CommandFault> Simulation::check_command(std::uint32_t robot, std::span<const double> values) const {
  const RobotKind& kind = kinds_[robots_[robot].kind];
  if (values.size() != kind.command_size) return wrong_size(robot, values.size());
  std::size_t i = 0;
  for (const Channel& channel : kind.command) {
    for (std::uint32_t k = 0; k < channel.size; ++k, ++i) {
      const bool can_act = values[i] >= channel.lower && values[i] <= channel.upper && std::isfinite(values[i]);
      if (!can_act) return unfit(robot, channel, values[i]);
    }
  }
  return std::nullopt;
}

CommandFault Simulation::wrong_size(std::uint32_t robot, std::size_t size) const {
  std::ostringstream text;
  text << "the command of " << robot_name(robot) << " has " << size << " values, expected "
       << kinds_[robots_[robot].kind].command_size;
  return {CommandFault::Reason::wrong_size, "", text.str()};
}

CommandFault Simulation::unfit(std::uint32_t robot, const Channel& channel, double value) const {
  std::ostringstream text;
  text << robot_name(robot) << ": " << channel.name << " is " << value << " " << channel.unit << ", expected "
       << channel.lower << " to " << channel.upper;
  const bool finite = std::isfinite(value);
  return {finite ? CommandFault::Reason::out_of_range : CommandFault::Reason::not_finite, channel.name, text.str()};
}

bool Simulation::set_command(std::uint32_t robot, std::span<const double> values) {
  std::vector<double>& command = robots_[robot].command;
  // As they are hashed: 0.0 and -0.0 differ.
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  if (std::ranges::equal(command, values, {}, bits, bits)) return false;
  note_change();
  std::ranges::copy(values, command.begin());
  return true;
}

bool Simulation::set_neutral_command(std::uint32_t robot) {
  return set_command(robot, neutral_values(kinds_[robots_[robot].kind]));
}

void Simulation::step() {
  note_change();
  for (Robot& robot : robots_) {
    const bool is_exhausted = std::any_of(robot.sensors.begin(), robot.sensors.end(),
                                          [](const SensorOfRobot& each) { return each.sensor->is_exhausted(); });
    if (is_exhausted) robot.command = neutral_values(kinds_[robot.kind]);
    std::span<const double> values = robot.command;
    for (std::size_t i = 0; i < robot.actuators.size(); ++i) {
      robot.actuators[i]->apply(values.first(robot.actuator_sizes[i]));
      values = values.subspan(robot.actuator_sizes[i]);
    }
  }
  schedule_.push(tick_);
  world_->step();
  ++tick_;
  name_quarantined();
  count_touches();
  happened_ = breakable_joints_.broken();
  actions_.finish_step();
  handle_actions();
  begin_tick();
  sense();
}

void Simulation::on_action(const std::string& name, ActionHandler handler) {
  const auto all = actions_.all();
  if (std::none_of(all.begin(), all.end(), [&](const auto& action) { return action.name == name; }))
    throw std::invalid_argument("no robot has an action '" + name + "'");
  handlers_.emplace_back(name, std::move(handler));
}

void Simulation::handle_actions() {
  for (const actuation::ActionOfRobot& action : actions_.all()) {
    bool is_handled = false;
    for (std::size_t i = 0; i < handlers_.size(); ++i) {  // NOLINT(modernize-loop-convert): a handler may add one
      const auto& [name, handler] = handlers_[i];
      if (name != action.name || !world_->is_active(action.body)) continue;
      handler(action.robot, action.value);
      is_handled = true;
    }
    if (is_handled && action.begins) happened_.push_back(action.name + " of '" + robot_name(action.robot) + "'");
  }
}

void Simulation::begin_tick() {
  const std::vector<std::string> events = schedule_.begin_tick(tick_);
  happened_.insert(happened_.end(), events.begin(), events.end());
  objects_.record(tick_);
  schedule_.check_stops();
}

std::uint32_t Simulation::add_object(const std::string& name, std::size_t model, const Pose& X_WM) {
  note_change();
  const std::uint32_t object = objects_.add(name, model, X_WM);
  emitters_.add_body(object, model);
  grippers_.note_model(model);
  note_added();
  return object;
}

// The world has bodies that the description does not list.
void Simulation::note_added() {
  robot_of_body_.resize(world_->body_count(), none);
  note_ground();
  body_hashes_.resize(world_->body_count());
}

void Simulation::note_ground() {
  const geometry::Scene& scene = world_->scene();
  is_ground_.resize(world_->body_count(), 0);
  for (; solids_noted_ < scene.size(); ++solids_noted_)
    if (geometry::is_ground(scene.solid(solids_noted_).shape)) is_ground_[scene.solid(solids_noted_).body] = 1;
}

void Simulation::name_quarantined() {
  quarantined_.clear();
  for (const physics::Quarantine& event : world_->quarantined()) {
    const bool broke = event.reason == physics::Quarantine::Reason::not_finite;
    quarantined_.push_back("'" + objects_.name(event.body) +
                           (broke ? "': its state is no longer finite" : "' has left the world"));
  }
  if (experiment_.world.physics.strict && !quarantined_.empty()) throw std::runtime_error(quarantined_[0]);
}

void Simulation::sense_one(SensorOfRobot& each, std::uint64_t tick, bool is_due, std::span<double> values,
                           std::vector<double>& scratch) {
  if (each.readout.is_immediate()) {
    if (!each.readout.measures_at(tick, is_due)) return;
    // What wanders goes on between the ticks at which the robot is asked, whose readings stay.
    scratch.resize(values.size());
    const std::span<double> measured = is_due ? values : std::span<double>(scratch);
    each.sensor->sense(tick, measured);
    each.readout.disturb(tick, measured);
    return;
  }
  if (each.readout.measures_at(tick, is_due)) {
    scratch.resize(values.size());
    each.sensor->sense(tick, scratch);
    each.readout.disturb(tick, scratch);
    each.readout.take(tick, scratch);
  }
  if (is_due) each.readout.report(tick, values);
}

void Simulation::look_at_lamps() {
  asking_rings_.assign(rings_.size(), 0);
  for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
    const auto& [robot, sensor] = rings_[ring];
    if (is_present(robot) && robots_[robot].sensors[sensor].readout.measures_at(tick_, is_due(robot, tick_)))
      asking_rings_[ring] = 1;
  }
  lamp_view_.update(asking_rings_, workers_);
}

void Simulation::sense() {
  note_change();
  emitters_.update(workers_);
  look_at_lamps();
  workers_.for_each_chunk(robots_.size(), robots_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t id = begin; id < end; ++id) {
      if (!is_present(static_cast<std::uint32_t>(id))) continue;
      Robot& robot = robots_[id];
      const bool is_asked = is_due(static_cast<std::uint32_t>(id), tick_);
      std::span<double> values(observations_.data() + robot.observation_offset, kinds_[robot.kind].observation_size);
      const bool was_asked = tick_ == 0 || is_due(static_cast<std::uint32_t>(id), tick_ - 1);
      for (SensorOfRobot& each : robot.sensors) {
        if (each.sensor->has_memory()) each.sensor->remember(tick_, was_asked);
        sense_one(each, tick_, is_asked, values.first(each.size), scratch_[worker]);
        values = values.subspan(each.size);
      }
    }
  });
}

void Simulation::count_touches() {
  std::vector<char> touches_obstacle(robots_.size(), 0);
  std::vector<char> touches_robot(robots_.size(), 0);
  const auto note = [&](std::uint32_t body, std::uint32_t other) {
    const std::uint32_t robot = robot_of_body_[body];
    if (robot == none || is_ground_[other]) return;
    (robot_of_body_[other] == none ? touches_obstacle : touches_robot)[robot] = 1;
  };
  for (const physics::Contact& contact : world_->contacts()) {
    note(contact.body_a, contact.body_b);
    note(contact.body_b, contact.body_a);
  }
  for (std::uint32_t robot = 0; robot < robots_.size(); ++robot)
    if (is_present(robot)) ++touches_.robot_ticks;
  for (const char touched : touches_obstacle) touches_.obstacles += static_cast<std::uint64_t>(touched);
  for (const char touched : touches_robot) touches_.robots += static_cast<std::uint64_t>(touched);
}

Pose Simulation::robot_pose(std::uint32_t robot) const { return world_->link_pose(robots_[robot].body, 0); }

}  // namespace cohort
