# SPDX-License-Identifier: Apache-2.0

"""The interface for authors of controllers: derive one class from Controller or TeamController."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy

from cohort.channels import Channels
from cohort.kinematic_tree import KinematicTree


class ParameterError(ValueError):
    """The error that a parameter of a team is missing or invalid.

    Attributes:
        name: name of the parameter; the message contains it too.
        problem: description of the problem.
    """

    def __init__(self, name: str, problem: str) -> None:
        super().__init__(f"parameter '{name}': {problem}")
        self.name = name
        self.problem = problem


class Parameters:
    """The parameters of a controller, from the key `parameters` of its team in the experiment.

    Keys of nested maps are joined by '.'. Read every parameter in `Controller.start`: a parameter that is not read is
    reported as an error in the experiment, and the controller does not start.
    """

    def __init__(self, values: dict[str, list[str]]) -> None:
        self._values = values
        self.asked: set[str] = set()

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __contains__(self, name: str) -> bool:
        self.asked.add(name)
        return name in self._values

    def _single(self, name: str, expected: str, fallback: object) -> str | None:
        self.asked.add(name)
        if name not in self._values:
            if fallback is None:
                raise ParameterError(name, "required by the controller, but not given")
            return None
        values = self._values[name]
        if len(values) != 1:
            raise ParameterError(name, f"expected {expected}, not {values}")
        return values[0]

    def real(self, name: str, fallback: float | None = None) -> float:
        """Returns a finite number. Raises ParameterError if it is not one, or is missing and there is no fallback."""
        text = self._single(name, "a number", fallback)
        return fallback if text is None and fallback is not None else _number(name, text or "", "a number")

    def reals(self, name: str) -> list[float]:
        """Returns a list of finite numbers, empty if the parameter is missing."""
        self.asked.add(name)
        return [_number(name, each, "a number or a list of numbers") for each in self._values.get(name, [])]

    def flag(self, name: str, fallback: bool | None = None) -> bool:
        """Returns a bool, written as `true` or `false` in the experiment."""
        text = self._single(name, "true or false", fallback)
        if text is None:
            return bool(fallback)
        if text not in ("true", "false"):
            raise ParameterError(name, f"expected true or false, not '{text}'")
        return text == "true"

    def text(self, name: str, fallback: str | None = None) -> str:
        """Returns one string."""
        text = self._single(name, "a single value", fallback)
        return fallback or "" if text is None else text

    def texts(self, name: str) -> list[str]:
        """Returns a list of strings, empty if the parameter is missing."""
        self.asked.add(name)
        return list(self._values.get(name, []))


def _number(name: str, text: str, expected: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or "_" in text:
        raise ParameterError(name, f"expected {expected}, not '{text}'")
    return number


class Start:
    """The information that a controller receives at its start.

    Attributes:
        robot: id in this run.
        name: scoped name, such as `explorers/sbot_7`.
        model: name of the robot's model, such as `sbot`.
        team: name of the robot's team in the experiment.
        controller: name of the team's controller in the experiment.
        parameters: the team's parameters in the experiment, a `Parameters`.
        reason: `first`, `takeover`, `reset`, `restored`, or `check`, which only tests the start: no step follows.
        tick: tick of the next observation.
        seed: random seed for the controller; derived from the experiment's seed and the robot's name.
        step: simulated time between ticks [s].
        period: number of ticks from one observation to the next.
        observation_channels, command_channels: the robot's `Channels`, with units and bounds.
        tree: the robot's links, joints and sensors, a `KinematicTree` (cohort.kinematic_tree).
    """

    def __init__(self, facts: dict[str, Any]) -> None:
        self.robot: int = facts["robot"]
        self.name: str = facts["name"]
        self.model: str = facts["model"]
        self.team: str = facts["team"]
        self.controller: str = facts["controller"]
        self.parameters = Parameters(facts["parameters"])
        self.reason: str = facts["reason"]
        self.tick: int = facts["tick"]
        self.seed: int = facts["seed"]
        self.step: float = facts["step_ns"] * 1e-9
        self.period: int = facts["period"]
        self.observation_channels = Channels(facts["observation_channels"])
        self.command_channels = Channels(facts["command_channels"])
        self.tree = KinematicTree(*facts["tree"])

    @property
    def seconds_per_step(self) -> float:
        """Simulated time from one step of the controller to the next [s]."""
        return self.step * self.period

    def observation(self, name: str) -> int | slice:
        """Returns the index of an observation channel: an int, or a slice if the channel has several values.

        Raises ChannelError if there is none.
        """
        return self.observation_channels.index(name)

    def observations(self, pattern: str, count: int | None = None) -> slice | numpy.ndarray:
        """Returns the indices of the values of all observation channels whose names match a pattern.

        An example of a pattern is `proximity/*/reading`. The result is a slice if the indices are consecutive. Raises
        ChannelError if no channel matches, or if `count` is given and is not the number of matches.
        """
        return self.observation_channels.indices(pattern, count)

    def command(self, name: str) -> int | slice:
        """Returns the index of a command channel, like `observation`. Raises ChannelError if there is none."""
        return self.command_channels.index(name)

    def commands(self, pattern: str, count: int | None = None) -> slice | numpy.ndarray:
        """Returns the indices of the values of all matching command channels, like `observations`."""
        return self.command_channels.indices(pattern, count)


class Controller:
    """A controller of one robot. Derive a class from it, and pass the class to a run or name its file in an experiment.

    Each robot has its own object, created without arguments. One thread calls all of them. An exception ends the run
    with its message. For bit-identical runs, commands must depend only on the arguments of the last `start` and of all
    steps since. So do not use a clock, a random device, or state that robots share. While controllers are called,
    functions such as `math.sin` are those of Cohort, with bit-identical results on every machine. The results of
    NumPy's functions depend on the processor; use `cohort.math` for arrays.

        class Wanderer(cohort.Controller):
            def start(self, start):
                self.left_eye = start.observation("proximity/0/reading")
                self.right_eye = start.observation("proximity/14/reading")
                self.left = start.command("treel/left/velocity")
                self.right = start.command("treel/right/velocity")

            def step(self, observation, command):
                command[self.left] = 0.2 * (1.0 - observation[self.right_eye])
                command[self.right] = 0.2 * (1.0 - observation[self.left_eye])

    Attributes, while it drives a robot:
        robot: the `Start` of the last call of `start`.
        tick: the current tick.
        time: simulated time since tick 0 [s].

    Attribute of the class:
        stateless: True if the controller has no state between steps, so that it needs no `save`.
    """

    stateless: bool = False
    robot: Start
    tick: int = 0
    time: float = 0.0

    def start(self, start: Start) -> None:
        """Looks up channels and reads parameters. Called before the first step and each time the run restarts."""

    def step(self, observation: numpy.ndarray, command: numpy.ndarray) -> None:
        """Computes a command from an observation.

        Both are arrays [value] of float64 in SI units, at the same address in every step, and valid only during the
        step. `observation` is read-only. At the start of each step, `command` contains neutral values. Written values
        are clamped to the range of their channel, and the server rejects NaN.
        """
        raise NotImplementedError("the controller does not define step(self, observation, command)")

    def save(self) -> bytes | None:
        """Returns the state accumulated since `start` as bytes, at most 1 MiB. Called when a snapshot is taken.

        If a class does not override `save`, it returns b"" if the class is `stateless`, and otherwise None. With None,
        the controller restarts, with a warning, when the run continues from the snapshot.
        """
        return b"" if self.stateless else None

    def load(self, state: bytes) -> None:
        """Restores the state that `save` of the same class returned. Called immediately after `start`."""


class TeamController:
    """A controller of all robots of a process, called once per tick, for policies that are evaluated in batches.

    Derive a class from it, and use this class like one derived from `Controller`. The commands may depend on all robots
    of the process, and therefore on the distribution of the robots over processes.

        class Everybody(cohort.TeamController):
            def start(self, robots):
                self.near = robots[0].observations("proximity/*/reading")
                self.tracks = robots[0].commands("treel/*/velocity")

            def step(self, observations, commands):
                commands[:, self.tracks] = 0.2 * (1.0 - observations[:, self.near].max(axis=1, keepdims=True))

    Attributes, while it drives robots:
        robots: the list of `Start` of the last call of `start`, in ascending order of ids. All robots have the same
            model.
        asked: indices of the `robots` that are due at this tick: a slice of all, or an array of int.
        tick: the current tick.
        time: simulated time since tick 0 [s].

    Attribute of the class:
        stateless: as in `Controller`.
    """

    stateless: bool = False
    robots: list[Start] = []
    asked: slice | numpy.ndarray = slice(None)
    tick: int = 0
    time: float = 0.0

    def start(self, robots: list[Start]) -> None:
        """Looks up channels and reads parameters; `robots` is a list of `Start`. Called like `Controller.start`."""

    def step(self, observations: numpy.ndarray, commands: numpy.ndarray) -> None:
        """Computes commands [robot, value] from observations [robot, value], for the robots that are due at this tick.

        Acts like `Controller.step` in all other respects.
        """
        raise NotImplementedError("the controller does not define step(self, observations, commands)")

    def save(self) -> bytes | None:
        """Returns the state of all robots as bytes, like `Controller.save`.

        The state can be restored only for the same group of robots.
        """
        return b"" if self.stateless else None

    def load(self, state: bytes) -> None:
        """Restores the state that `save` of the same class returned, like `Controller.load`."""
