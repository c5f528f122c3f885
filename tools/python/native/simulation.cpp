// SPDX-License-Identifier: Apache-2.0
#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "client_sdk/python/hosting/unlocked.hpp"
#include "tools/python/native/array_simulation.hpp"
#include "tools/python/native/arrays.hpp"
#include "tools/python/native/channels.hpp"
#include "tools/python/native/live_view.hpp"
#include "tools/python/native/one_user.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

/// A simulation owned by Python, its current user, and its view.
class Held {
 public:
  Held(std::shared_ptr<const description::Experiment> experiment, unsigned threads)
      : arrays(std::move(experiment), threads) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() { close_view(); }

  ArraySimulation arrays;
  mutable OneUser user;

  /// Calls `get` with the simulation, which is not stepped meanwhile, and returns its result.
  template <class Get>
  auto read(const Get& get) const {
    const OneUser::Turn turn(user);
    return get(arrays.simulation());
  }

  /// Exclusive use of the simulation, by Python or by the view. Starts and ends with Python's global lock held.
  class Turn {
   public:
    explicit Turn(Held& held) : turn_(held.user), view_(held.view_) {
      if (view_ != nullptr) view_->begin_turn();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    ~Turn() {
      if (view_ != nullptr) view_->end_turn();
    }
    /// Shows the changes of the simulation, if it is time.
    void show() {
      if (view_ != nullptr) view_->changed();
    }

   private:
    OneUser::Turn turn_;
    std::shared_ptr<LiveView> view_;
  };

  /// Opens a view. Throws std::runtime_error if the port is taken.
  std::shared_ptr<LiveView> open_view(const std::string& page, std::optional<std::uint16_t> port) {
    const OneUser::Turn turn(user);
    close_view();
    return view_ = std::make_shared<LiveView>(arrays, view::read_page(page), port);
  }

  /// Calls `get` with a robot. Throws std::invalid_argument if there is no such robot.
  template <class Get>
  auto read_robot(std::uint32_t robot, const Get& get) const {
    return read([&](const Simulation& simulation) {
      if (robot >= simulation.robot_count())
        throw std::invalid_argument("unknown robot " + std::to_string(robot) + ", expected an id below " +
                                    std::to_string(simulation.robot_count()));
      return get(simulation, robot, simulation.kinds()[simulation.kind_of(robot)]);
    });
  }
  std::uint32_t object_called(const std::string& name) const {
    return read([&](const Simulation& simulation) {
      const auto object = simulation.objects().find(name);
      if (!object) throw std::invalid_argument("unknown object '" + name + "'");
      return *object;
    });
  }

 private:
  void close_view() {
    if (view_ != nullptr) view_->close();
  }

  std::shared_ptr<LiveView> view_;
};

Pose pose_of(const Vector3d& position, const Vector4d& wxyz) {
  Eigen::Quaterniond orientation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double norm = orientation.norm();
  if (!position.allFinite() || !std::isfinite(norm) || norm == 0.0)
    throw std::invalid_argument("invalid pose: expected a finite position [m] and a nonzero quaternion (w, x, y, z)");
  orientation.coeffs() /= norm;
  return {position, orientation};
}

void append(std::vector<double>& values, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  values.insert(values.end(), {pose.position.x(), pose.position.y(), pose.position.z(), q.w(), q.x(), q.y(), q.z()});
}

void append(std::vector<double>& values, const Vector3d& vector) {
  values.insert(values.end(), {vector.x(), vector.y(), vector.z()});
}

// Steps at most `ticks` times, optionally until the run is over. Checks for Ctrl-C from time to time; the simulation
// then stays at the boundary that it has reached.
std::uint64_t step_simulation(Held& held, std::uint64_t ticks, bool stop_when_over) {
  Held::Turn turn(held);
  constexpr auto look_every = std::chrono::milliseconds(50);
  auto looked = std::chrono::steady_clock::now();
  held.arrays.command();
  std::uint64_t done = 0;
  while (done < ticks && !(stop_when_over && held.arrays.is_over())) {
    {
      const Unlocked unlocked;
      do {
        held.arrays.step();
        turn.show();
        ++done;
      } while (done < ticks && !Unlocked::must_end() && !(stop_when_over && held.arrays.is_over()) &&
               std::chrono::steady_clock::now() - looked < look_every);
    }
    looked = std::chrono::steady_clock::now();
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }
  return done;
}

Array object_poses(const Held& held) {
  const OneUser::Turn turn(held.user);
  const Simulation& simulation = held.arrays.simulation();
  const std::size_t count = simulation.objects().size();
  std::vector<double> values;
  values.reserve(count * 7);
  for (std::uint32_t object = 0; object < count; ++object) append(values, simulation.object_pose(object));
  return owned_array(std::move(values), {count, 7});
}

Array object_velocities(const Held& held) {
  const OneUser::Turn turn(held.user);
  const Simulation& simulation = held.arrays.simulation();
  const std::size_t count = simulation.objects().size();
  std::vector<double> values;
  values.reserve(count * 6);
  for (std::uint32_t object = 0; object < count; ++object) {
    const physics::Twist twist = simulation.world().link_twist(BodyId{object}, LinkId{0});
    append(values, twist.linear_W);
    append(values, twist.angular_W);
  }
  return owned_array(std::move(values), {count, 6});
}

nb::dict contacts(const Held& held) {
  const OneUser::Turn turn(held.user);
  const auto contacts = held.arrays.simulation().world().contacts();
  std::vector<std::uint32_t> objects;
  std::vector<double> positions, normals, distances, impulses;
  for (const physics::Contact& contact : contacts) {
    objects.insert(objects.end(), {contact.body_a.value, contact.body_b.value});
    append(positions, contact.position_W);
    append(normals, contact.normal_W);
    distances.push_back(contact.distance);
    impulses.push_back(contact.impulse);
  }
  const std::size_t count = contacts.size();
  nb::dict arrays;
  arrays["objects"] = owned_array(std::move(objects), {count, 2});
  arrays["position"] = owned_array(std::move(positions), {count, 3});
  arrays["normal"] = owned_array(std::move(normals), {count, 3});
  arrays["distance"] = owned_array(std::move(distances), {count});
  arrays["impulse"] = owned_array(std::move(impulses), {count});
  return arrays;
}

nb::list object_names(const Held& held) {
  const OneUser::Turn turn(held.user);
  const Objects& objects = held.arrays.simulation().objects();
  nb::list names;
  for (std::uint32_t object = 0; object < objects.size(); ++object) names.append(objects.name(object));
  return names;
}

nb::ndarray<nb::numpy, bool, nb::c_contig> objects_present(const Held& held) {
  const OneUser::Turn turn(held.user);
  const Objects& objects = held.arrays.simulation().objects();
  auto* present = new bool[objects.size()];
  for (std::uint32_t object = 0; object < objects.size(); ++object) present[object] = objects.is_present(object);
  const nb::capsule owner(present, [](void* array) noexcept { delete[] static_cast<bool*>(array); });
  return {present, {objects.size()}, owner};
}

// The array keeps its data alive, also after it was replaced by another one.
template <class Value>
nb::ndarray<nb::numpy, Value, nb::c_contig> shared_array(const std::shared_ptr<std::vector<double>>& values,
                                                         std::size_t rows, std::size_t columns) {
  auto* kept = new std::shared_ptr<std::vector<double>>(values);
  const nb::capsule owner(
      kept, [](void* pointer) noexcept { delete static_cast<std::shared_ptr<std::vector<double>>*>(pointer); });
  return {values->data(), {rows, columns}, owner};
}

std::string act(Held& held, const Action& action) {
  const Held::Turn turn(held);
  return held.arrays.act(action);
}

std::string spawn(Held& held, const std::string& model, const std::string& text, const std::string& name,
                  const Vector3d& position, const Vector4d& orientation, bool allow_renaming, const std::string& team) {
  SpawnObject spawn{.name = name,
                    .model = model,
                    .X_WM = pose_of(position, orientation),
                    .allow_renaming = allow_renaming,
                    .team = team};
  if (!text.empty()) spawn.model = held.arrays.experiment().read_model(text);
  const Held::Turn turn(held);
  const std::uint32_t before = held.arrays.simulation().objects().size();
  held.arrays.act(spawn);
  return held.arrays.simulation().objects().name(before);
}

std::string apply_force(Held& held, const std::string& name, const std::string& link, const Vector3d& force,
                        const Vector3d& torque, double seconds) {
  const double step = std::chrono::duration<double>(held.arrays.experiment().world.step).count();
  if (!(seconds >= 0.0 && seconds <= 1e6))
    throw std::invalid_argument("duration is " + std::to_string(seconds) + ", expected 0 (one step) to 1e6 s");
  const std::int64_t steps = std::max<std::int64_t>(1, std::llround(seconds / step));
  return act(held, ApplyForce{name, link, force, torque, held.arrays.experiment().world.step * steps});
}

nb::bytes save(Held& held) {
  const Held::Turn turn(held);
  const std::vector<std::byte> bytes = held.arrays.simulation().save();
  return nb::bytes(bytes.data(), bytes.size());
}

// Computes the hash, which the simulation caches, so it excludes other readers.
std::uint64_t state_hash(Held& held) {
  const Held::Turn turn(held);
  return held.arrays.simulation().state_hash();
}

void restore(Held& held, const nb::bytes& bytes) {
  const Held::Turn turn(held);
  const auto* data = static_cast<const std::byte*>(bytes.data());
  const Unlocked unlocked;
  held.arrays.restore({data, bytes.size()});
}

void reset_simulation(Held& held, std::shared_ptr<const description::Experiment> experiment) {
  const Held::Turn turn(held);
  const Unlocked unlocked;
  held.arrays.reset(std::move(experiment));
}

std::unique_ptr<Held> make(std::shared_ptr<const description::Experiment> experiment, unsigned threads) {
  const Unlocked unlocked;
  return std::make_unique<Held>(std::move(experiment), threads);
}

}  // namespace

void add_simulation(nb::module_& module) {
  const auto simulation = [](const auto& get) { return [get](const Held& held) { return held.read(get); }; };
  const auto of_robot = [](const auto& get) {
    return [get](const Held& held, std::uint32_t robot) { return held.read_robot(robot, get); };
  };
  nb::class_<LiveView>(module, "LiveView")
      .def_prop_ro("port", &LiveView::port)
      .def_prop_ro("is_closed", &LiveView::is_closed)
      .def("close", &LiveView::close, nb::call_guard<Unlocked>());
  nb::class_<Held>(module, "Simulation")
      .def(nb::new_(&make), nb::arg("experiment"), nb::arg("threads"))
      .def("step", &step_simulation, nb::arg("ticks"), nb::arg("stop_when_over"))
      .def("reset", &reset_simulation, nb::arg("experiment"))
      .def("save", &save)
      .def("open_view", &Held::open_view, nb::arg("page"), nb::arg("port").none())
      .def("restore", &restore, nb::arg("snapshot"))
      .def_prop_ro("tick", simulation([](const Simulation& of) { return of.tick(); }))
      .def_prop_ro("time",
                   simulation([](const Simulation& of) { return std::chrono::duration<double>(of.time()).count(); }))
      .def_prop_ro("state_hash", &state_hash)
      .def_prop_ro("stop_reason", simulation([](const Simulation& of) { return of.stop_reason(); }))
      .def_prop_ro("happened", simulation([](const Simulation& of) {
                     std::vector<std::string> all = of.quarantined();
                     all.insert(all.end(), of.happened().begin(), of.happened().end());
                     return all;
                   }))
      .def_prop_ro("quarantined", simulation([](const Simulation& of) { return of.quarantined(); }))
      .def_prop_ro("robot_count", simulation([](const Simulation& of) { return of.robot_count(); }))
      .def_prop_ro("is_over",
                   [](const Held& held) {
                     const OneUser::Turn turn(held.user);
                     return held.arrays.is_over();
                   })
      .def_prop_ro("threads", [](const Held& held) { return held.arrays.threads(); })
      .def_prop_ro(
          "observations",
          [](const Held& held) {
            const OneUser::Turn turn(held.user);
            return shared_array<const double>(held.arrays.observations(), held.arrays.simulation().robot_count(),
                                              held.arrays.observation_size());
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "commands",
          [](const Held& held) {
            const OneUser::Turn turn(held.user);
            return shared_array<double>(held.arrays.commands(), held.arrays.simulation().robot_count(),
                                        held.arrays.command_size());
          },
          nb::rv_policy::automatic)
      .def("robot_name",
           of_robot([](const Simulation& of, std::uint32_t robot, const RobotKind&) { return of.robot_name(robot); }))
      .def("robot_model", of_robot([](const Simulation&, std::uint32_t, const RobotKind& kind) { return kind.model; }))
      .def("robot_object", of_robot([](const Simulation& of, std::uint32_t robot, const RobotKind&) {
             return of.body_of(robot).value;
           }))
      .def("observation_channels", of_robot([](const Simulation&, std::uint32_t, const RobotKind& kind) {
             return channel_tuples(kind.observation);
           }))
      .def("command_channels", of_robot([](const Simulation&, std::uint32_t, const RobotKind& kind) {
             return channel_tuples(kind.command);
           }))
      .def_prop_ro("object_names", &object_names)
      .def_prop_ro("objects_present", &objects_present, nb::rv_policy::automatic)
      .def("object_called", &Held::object_called)
      .def_prop_ro("object_poses", &object_poses, nb::rv_policy::automatic)
      .def_prop_ro("object_velocities", &object_velocities, nb::rv_policy::automatic)
      .def("contacts", &contacts)
      .def("spawn", &spawn)
      .def("remove", [](Held& held, const std::string& name) { return act(held, RemoveObject{name}); })
      .def("set_pose",
           [](Held& held, const std::string& name, const Vector3d& position, const Vector4d& orientation) {
             return act(held, SetPose{name, pose_of(position, orientation)});
           })
      .def("set_velocity",
           [](Held& held, const std::string& name, const Vector3d& linear, const Vector3d& angular) {
             return act(held, SetVelocity{name, linear, angular});
           })
      .def("set_light",
           [](Held& held, const std::string& name, bool on, std::optional<double> intensity,
              std::optional<Vector3d> color) {
             return act(held, SetLight{name, on, intensity, color});
           })
      .def("apply_force", &apply_force);
}

}  // namespace cohort::python
