# SPDX-License-Identifier: Apache-2.0

"""A simulation in this process."""

from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy
from numpy.typing import ArrayLike

from cohort import _native, _plots
from cohort import math as portable
from cohort.channels import Channels
from cohort.experiment import Experiment
from cohort.view import View

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_GREATEST_ANGLE = 1e6  # as in files [rad]


def _vector(values, name, size=3):
    array = numpy.asarray(values, dtype=numpy.float64)
    if array.shape != (size,) or not numpy.isfinite(array).all():
        raise ValueError(f"{name} is {values!r}, expected {size} finite numbers")
    return array


def _orientation(yaw, orientation):
    if orientation is not None:
        return _vector(orientation, "orientation", 4)
    if not abs(yaw) <= _GREATEST_ANGLE:
        raise ValueError(f"yaw is {yaw!r}, expected an angle from -1e6 to 1e6 rad")
    return numpy.array([portable.cos(yaw / 2), 0.0, 0.0, portable.sin(yaw / 2)])


class Robot:
    """A robot of a simulation. Its arrays contain the current state."""

    def __init__(self, simulation: Simulation, robot: int) -> None:
        self._simulation = simulation
        self._native = simulation._native
        self.id: int = robot
        self.name: str = self._native.robot_name(robot)
        self.model: str = self._native.robot_model(robot)
        self.object: int = self._native.robot_object(robot)
        self.observation_channels = Channels(self._native.observation_channels(robot))
        self.command_channels = Channels(self._native.command_channels(robot))

    @property
    def observation(self) -> numpy.ndarray:
        """Observation at the last tick at which the robot was due: an array [value] in SI units, read-only."""
        return self._native.observations[self.id, : self.observation_channels.size]

    @property
    def command(self) -> numpy.ndarray:
        """Command of the robot: an array [value] in SI units, writable."""
        return self._native.commands[self.id, : self.command_channels.size]

    @property
    def pose(self) -> numpy.ndarray:
        """Pose of its root link in the world frame, x y z [m] and a quaternion w x y z: an array [7]."""
        return self._native.object_poses[self.object]

    @property
    def velocity(self) -> numpy.ndarray:
        """Velocity of the origin of its root link in the world frame [m/s, rad/s]: an array [6]."""
        return self._native.object_velocities[self.object]

    def __repr__(self) -> str:
        return f"<cohort.Robot {self.id} {self.name} ({self.model})>"


class Simulation:
    """One world that advances tick by tick in this process. The program commands all robots.

        simulation = cohort.Simulation("obstacle_avoidance", seed=1)
        left = simulation.robots[0].command_channels.index("treel/left/velocity")
        simulation.commands[:, left] = 0.1
        simulation.step(100)
        print(simulation.poses[:, :2])

    Arrays are float64 in SI units. Results depend only on the experiment and the commands, not on the number of
    threads. Only one Python thread may use a simulation at a time; calls from other threads raise RuntimeError. Steps
    release Python's global interpreter lock. A simulation cannot be used after a fork. It does not run the controllers
    of the experiment; use `Experiment.run` for that.

    Args:
        experiment: an `Experiment`, or a file for `Experiment.read`.
        seed, duration: values that replace those of the experiment.
        threads: number of threads that step the world.
    """

    def __init__(
        self,
        experiment: Experiment | str | os.PathLike,
        seed: int | None = None,
        duration: float | None = None,
        threads: int = 1,
    ) -> None:
        if not isinstance(experiment, Experiment):
            experiment = Experiment.read(experiment, seed, duration)
        elif duration is not None:
            raise ValueError("duration cannot be used with an Experiment; pass it to Experiment.read")
        elif seed is not None:
            experiment = experiment.with_seed(seed)
        if threads < 1:
            raise ValueError(f"threads is {threads}, expected at least 1")
        self._experiment = experiment
        self._native = _native.Simulation(experiment._native, threads)
        self._robots: list[Robot] = []
        self._view: View | None = None

    @property
    def experiment(self) -> Experiment:
        """The `Experiment` of the simulation."""
        return self._experiment

    @property
    def tick(self) -> int:
        """Number of steps since the start."""
        return self._native.tick

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._native.time

    @property
    def state_hash(self) -> int:
        """Hash of the state that determines the rest of the run: a 64-bit integer, the one that `cohort run` prints."""
        return self._native.state_hash

    @property
    def robots(self) -> list[Robot]:
        """Robots of the simulation: a list of `Robot` in the order of their ids."""
        for robot in range(len(self._robots), self._native.robot_count):
            self._robots.append(Robot(self, robot))
        return self._robots

    @property
    def observations(self) -> numpy.ndarray:
        """Observations of all robots: an array [robot, value], read-only.

        After each step, the array contains the observations of the current tick. It is valid until robots are added,
        or until `reset` or `restore`. Rows of robots with fewer values are padded with zeros.
        """
        return self._native.observations

    @property
    def commands(self) -> numpy.ndarray:
        """Commands of all robots: an array [robot, value], writable. A value stays in effect until it is changed."""
        return self._native.commands

    @property
    def poses(self) -> numpy.ndarray:
        """Poses of all robots' root links in the world frame, x y z [m], quaternion w x y z: an array [robot, 7]."""
        return self._native.object_poses[[each.object for each in self.robots]]

    @property
    def velocities(self) -> numpy.ndarray:
        """Velocities of all robots' root links, linear [m/s] and angular [rad/s]: an array [robot, 6]."""
        return self._native.object_velocities[[each.object for each in self.robots]]

    @property
    def objects(self) -> list[str]:
        """Scoped names of all objects, including robots, in the order of `object_poses`."""
        return self._native.object_names

    @property
    def object_poses(self) -> numpy.ndarray:
        """Poses of all objects, like `poses`: an array [object, 7]."""
        return self._native.object_poses

    @property
    def object_velocities(self) -> numpy.ndarray:
        """Velocities of all objects, like `velocities`: an array [object, 6]."""
        return self._native.object_velocities

    @property
    def objects_present(self) -> numpy.ndarray:
        """True for objects that are in the world, neither removed nor still to be added: an array [object] of bool."""
        return self._native.objects_present

    def pose(self, name: str) -> numpy.ndarray:
        """Returns the pose of an object, an array [7]."""
        return self._native.object_poses[self._native.object_called(name)]

    def contacts(self) -> dict[str, numpy.ndarray]:
        """Returns the contacts of the last step: a dictionary of arrays with one row per contact point.

        `objects` [n, 2] are indices into `Simulation.objects`. `position` [n, 3] is in the world frame [m]. `normal`
        [n, 3] is the unit vector from the second object to the first. `distance` [n] is negative if the objects
        overlap [m]. `impulse` [n] is the impulse along the normal over the step [N s].
        """
        return self._native.contacts()

    @property
    def stop_reason(self) -> str | None:
        """The stop condition of the experiment that is met, or None."""
        return self._native.stop_reason

    @property
    def is_over(self) -> bool:
        """True if a stop condition is met or the experiment's duration has passed."""
        return self._native.is_over

    @property
    def happened(self) -> list[str]:
        """Descriptions of the events at this tick, a list of sentences: invalid states and events of the experiment."""
        return self._native.happened

    def step(self, ticks: int = 1) -> None:
        """Steps the world by `ticks`, with the same `commands` in each of them.

        Raises ValueError if a command is invalid, before the first step; the message names the robot and the channel.
        After Ctrl-C, the simulation remains at the tick that it has reached, and can continue from there.
        """
        self._native.step(ticks, False)

    def run(self, until: float | None = None, each: Callable[[Simulation], object] | None = None) -> None:
        """Steps the world to the end of the experiment.

        Args:
            until: simulated time [s] at which to stop, if the experiment does not end earlier.
            each: function that is called with the simulation before each step, to write commands.
        """
        end = math.inf if until is None else until
        if until is None and self._experiment.duration == 0:
            raise ValueError("the experiment has no end; specify `until`")
        while not self.is_over and self.time < end - self._experiment.step / 2:
            if each is None:
                left = min(end, self._experiment.duration or end) - self.time
                self._native.step(max(1, round(left / self._experiment.step)), True)
            else:
                each(self)
                self._native.step(1, True)

    def reset(self, seed: int | None = None) -> None:
        """Restarts the run, with `seed` or with the same seed. Reads no file."""
        if seed is not None:
            self._experiment = self._experiment.with_seed(seed)
        self._native.reset(self._experiment._native)
        self._robots = []

    def save(self) -> bytes:
        """Returns a snapshot of the run as bytes, for `restore` with the same experiment."""
        return self._native.save()

    def restore(self, snapshot: bytes) -> None:
        """Continues from a snapshot that `save` returned.

        Raises `cohort.SnapshotError` if the snapshot does not match the experiment; then nothing changes.
        """
        self._native.restore(snapshot)
        self._robots = []

    def spawn(
        self,
        model: str | os.PathLike,
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        *,
        orientation: ArrayLike | None = None,
        name: str = "",
        team: str = "",
        allow_renaming: bool = False,
    ) -> str:
        """Adds a new object to the world, at rest, and returns its scoped name.

        Args:
            model: name of a model in the world, path of an SDF, URDF or YAML file, or the text of such a file.
            position: position of the model in the world frame [m].
            yaw: rotation about the vertical axis [rad].
            orientation: quaternion w x y z, which replaces `yaw`.
            name: scoped name; the name of the model by default.
            team: team that a robot joins.
            allow_renaming: True to append a number if the name is taken.

        Raises ValueError with the reason if it fails; then nothing changes. The functions below do the same.
        """
        text = ""
        if isinstance(model, os.PathLike) or (isinstance(model, str) and "<" not in model and "\n" not in model):
            path = pathlib.Path(model)
            if path.suffix in (".sdf", ".urdf", ".xml", ".yaml"):
                text = path.read_text(encoding="utf-8")
        else:
            text = model
        pose = _orientation(yaw, orientation)
        return self._native.spawn(
            "" if text else os.fspath(model), text, name, _vector(position, "position"), pose, allow_renaming, team
        )

    def remove(self, name: str) -> None:
        """Removes an object from the world permanently."""
        self._native.remove(name)

    def set_pose(
        self, name: str, position: ArrayLike, yaw: float = 0.0, *, orientation: ArrayLike | None = None
    ) -> None:
        """Moves an object to a pose and stops it; joint positions stay unchanged. Arguments are those of `spawn`."""
        self._native.set_pose(name, _vector(position, "position"), _orientation(yaw, orientation))

    def set_velocity(
        self, name: str, linear: ArrayLike = (0.0, 0.0, 0.0), angular: ArrayLike = (0.0, 0.0, 0.0)
    ) -> None:
        """Sets the velocity of an object in the world frame [m/s, rad/s]."""
        self._native.set_velocity(name, _vector(linear, "linear"), _vector(angular, "angular"))

    def set_light(
        self, name: str, on: bool = True, intensity: float | None = None, color: ArrayLike | None = None
    ) -> None:
        """Switches lights on or off: one light (`object/light`), all lights of an object, or a light of the world."""
        self._native.set_light(name, on, intensity, None if color is None else _vector(color, "color"))

    def apply_force(
        self,
        name: str,
        force: ArrayLike = (0.0, 0.0, 0.0),
        torque: ArrayLike = (0.0, 0.0, 0.0),
        duration: float = 0.0,
        link: str = "",
    ) -> None:
        """Applies a force and a torque at the centre of mass of a link, in the world frame, from now on.

        Args:
            name: name of the object.
            force, torque: force [N] and torque [N m].
            duration: duration in simulated time [s]; 0: one step.
            link: name of the link; the root link by default.
        """
        self._native.apply_force(name, link, _vector(force, "force"), _vector(torque, "torque"), duration)

    def plot(self, paths: ArrayLike | None = None, *, radius: float = 0.06, axes: Axes | None = None) -> Axes:
        """Draws the world from above at the current tick, and returns the `matplotlib.axes.Axes`.

        A robot is drawn as a circle with a line along its x axis, and any other object as a square at its position. An
        object whose pose is the origin of the world, such as the ground, is not drawn.

        Args:
            paths: positions, an array [step, robot, 2 or more], such as copies of `poses` after several steps.
            radius: radius of the circles [m].
            axes: axes on which to draw; those of a new figure by default.

        Requires the package matplotlib. Raises ValueError if `paths` has another shape.
        """
        return _plots.plot(self, paths, radius, axes)

    def view(self, port: int | None = None, open: bool = False) -> View:
        """Shows the simulation in a browser while this program steps it, and returns the `View`.

            simulation.view(open=True)
            simulation.run(until=60)

        Serves the page of `cohort view` at 127.0.0.1 until the view is closed or the simulation is deleted. Viewers see
        at most 30 states per second, and always the last state after each call. They cannot change the simulation, so
        the view does not affect the state hash. In Jupyter, a view at the end of a cell displays itself. A simulation
        has one view; while that is open, this method returns it again.

        Args:
            port: TCP port of the page; by default 8080, or any free port if that is taken. 0: any free port.
            open: True to open the page in a browser; has no effect in Jupyter.

        Raises FileNotFoundError if the page was not built, RuntimeError if the port is taken, and ValueError if the
        simulation has an open view at another port.
        """
        if self._view is None or self._view.closed:
            self._view = View(self._native, str(self._experiment.name), port)
        elif port and port != self._view.port:
            raise ValueError(f"the simulation already has a view at {self._view.url}; close that view first")
        if open:
            self._view.open()
        return self._view

    def __repr__(self) -> str:
        return f"<cohort.Simulation {self._experiment.name}: tick {self.tick}, {self._native.robot_count} robots>"
