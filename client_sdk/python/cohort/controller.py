"""What the author of a controller writes against: one class that derives from Controller."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy

from cohort.channels import Channels


class ParameterError(ValueError):
    """A parameter of a team is missing, or is not what it should be.

    Attributes:
        name: of the parameter; the message names it too.
        problem: what is wrong with it.
    """

    def __init__(self, name: str, problem: str) -> None:
        super().__init__(f"parameter '{name}': {problem}")
        self.name = name
        self.problem = problem


class Parameters:
    """What the experiment gives a controller under `parameters`.

    Keys of nested maps are joined by '.'. Every parameter has to be asked for in `Controller.start`: one that is left
    over is a mistake of the experiment, and the controller does not start.
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
                raise ParameterError(name, "the experiment has none")
            return None
        values = self._values[name]
        if len(values) != 1:
            raise ParameterError(name, f"expected {expected}, not {values}")
        return values[0]

    def real(self, name: str, fallback: float | None = None) -> float:
        """Returns a finite number. Raises ParameterError if it is something else, or missing without a fallback."""
        text = self._single(name, "a number", fallback)
        return fallback if text is None and fallback is not None else _number(name, text or "", "a number")

    def reals(self, name: str) -> list[float]:
        """Returns a list of finite numbers, which is empty if the experiment has none of that name."""
        self.asked.add(name)
        return [_number(name, each, "a number or a list of numbers") for each in self._values.get(name, [])]

    def flag(self, name: str, fallback: bool | None = None) -> bool:
        """Returns True or False, which the experiment writes as `true` or `false`."""
        text = self._single(name, "true or false", fallback)
        if text is None:
            return bool(fallback)
        if text not in ("true", "false"):
            raise ParameterError(name, f"expected true or false, not '{text}'")
        return text == "true"

    def text(self, name: str, fallback: str | None = None) -> str:
        """Returns a single text."""
        text = self._single(name, "a text", fallback)
        return fallback or "" if text is None else text

    def texts(self, name: str) -> list[str]:
        """Returns a list of texts, which is empty if the experiment has none of that name."""
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
    """What a controller is told before its first step, and again after each reset, restore and takeover.

    Attributes:
        robot: its id in this run.
        name: its scoped name, such as `explorers/sbot_7`.
        model: its model, such as `sbot`.
        team: its team in the experiment.
        controller: what the experiment names as the controller of the team.
        parameters: what the experiment gives the team, a `Parameters`.
        reason: `first`, `takeover`, `reset`, `restored`, or `check`: mistakes are looked for, and no step will follow.
        tick: of the first observation to come.
        seed: for random numbers of the controller; fixed by the experiment's seed and the robot's name.
        step: simulated time between ticks [s].
        period: ticks from one observation to the next.
        observation_channels, command_channels: `Channels`, with units and bounds.
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

    @property
    def seconds_per_step(self) -> float:
        """Simulated time from one step of the controller to the next [s]."""
        return self.step * self.period

    def observation(self, name: str) -> int | slice:
        """Returns the index of an observation channel: an int, or a slice if it has several values.

        Raises ChannelError if there is none.
        """
        return self.observation_channels.index(name)

    def observations(self, pattern: str, count: int | None = None) -> slice | numpy.ndarray:
        """Returns the index of the values of all observation channels that match, such as `proximity/*/reading`.

        A slice where the values are in a row. Raises ChannelError if none match, or not `count` of them.
        """
        return self.observation_channels.indices(pattern, count)

    def command(self, name: str) -> int | slice:
        """Returns the index of a command channel. Raises ChannelError if there is none."""
        return self.command_channels.index(name)

    def commands(self, pattern: str, count: int | None = None) -> slice | numpy.ndarray:
        """Returns the index of the values of all command channels that match."""
        return self.command_channels.indices(pattern, count)


class Controller:
    """Drives one robot. Derive from it, and give the class to a run, or name its file in an experiment.

    Every robot has an object of its own, made without arguments. One thread calls all of them. An exception ends the
    run with its message. For runs with the same bits, `step` depends on nothing but what `start` and the steps since
    gave: no clock, no random device, nothing that robots share. Functions such as `math.sin` are those of Cohort,
    with the same bits on every machine; those of NumPy depend on the processor (`cohort.math` has functions for
    arrays that do not).

        class Wanderer(cohort.Controller):
            def start(self, start):
                self.left_eye = start.observation("proximity/0/reading")
                self.right_eye = start.observation("proximity/14/reading")
                self.left = start.command("treel/left/velocity")
                self.right = start.command("treel/right/velocity")

            def step(self, observation, command):
                command[self.left] = 0.2 * (1.0 - observation[self.right_eye])
                command[self.right] = 0.2 * (1.0 - observation[self.left_eye])

    Attributes, as long as it drives a robot:
        robot: what `start` was told last, a `Start`.
        tick: the present tick.
        time: simulated time since tick 0 [s].
    """

    robot: Start
    tick: int = 0
    time: float = 0.0

    def start(self, start: Start) -> None:
        """Looks channels up and asks for parameters. Called before the first step, and when the world begins again."""

    def step(self, observation: numpy.ndarray, command: numpy.ndarray) -> None:
        """Turns an observation into a command.

        Both are arrays [value] of float64 in SI units, at the same address in every step, and valid during the step.
        `observation` is read-only. `command` has its neutral values at first; what is written is brought into the range
        of its channel, and NaN is refused by the run.
        """
        raise NotImplementedError("a controller needs a step(self, observation, command)")

    def save(self) -> bytes | None:
        """Returns what it remembers of the steps since `start` as bytes, at most 1 MiB, when a snapshot is taken.

        b"" if it remembers nothing. A class without `save` returns None: it is started anew from a snapshot.
        """
        return None

    def load(self, state: bytes) -> None:
        """Takes the bytes that `save` of the same class returned, right after `start`, and goes on from there."""


class TeamController:
    """Drives all robots of a process by one call for each tick: for policies that are computed for many at once.

    Derive from it, and use the class as one that derives from `Controller`. What it computes may depend on all robots
    that the same process drives, and so on how robots are spread over processes.

        class Everybody(cohort.TeamController):
            def start(self, robots):
                self.near = robots[0].observations("proximity/*/reading")
                self.tracks = robots[0].commands("treel/*/velocity")

            def step(self, observations, commands):
                commands[:, self.tracks] = 0.2 * (1.0 - observations[:, self.near].max(axis=1, keepdims=True))

    Attributes, as long as it drives robots:
        robots: what `start` was told last, a list of `Start` by ascending ids. All are of one model.
        asked: which rows of `robots` are asked at this tick: a slice of all, or an array of int.
        tick: the present tick.
        time: simulated time since tick 0 [s].
    """

    robots: list[Start] = []
    asked: slice | numpy.ndarray = slice(None)
    tick: int = 0
    time: float = 0.0

    def start(self, robots: list[Start]) -> None:
        """Looks channels up and asks for parameters; `robots` is a list of `Start`. Called as `Controller.start`."""

    def step(self, observations: numpy.ndarray, commands: numpy.ndarray) -> None:
        """Turns observations [robot, value] into commands [robot, value], of the robots that are asked at this tick.

        Otherwise as `Controller.step`.
        """
        raise NotImplementedError("a controller needs a step(self, observations, commands)")

    def save(self) -> bytes | None:
        """Returns what it remembers of all robots as bytes: as `Controller.save`.

        Goes on where the same robots are driven together.
        """
        return None

    def load(self, state: bytes) -> None:
        """Takes the bytes that `save` of the same class returned: as `Controller.load`."""
