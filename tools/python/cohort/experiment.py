# SPDX-License-Identifier: Apache-2.0

"""Experiments: a world, robots in teams, their controllers, and a duration."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import pathlib
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Union

from cohort import _files, _native
from cohort._hosting import Maker, maker_in, portable_calls
from cohort.controller import Controller, TeamController

if TYPE_CHECKING:
    import pandas

#: A team's controller: a class, or the name or path of a controller.
Driver = Union[type[Controller], type[TeamController], str, os.PathLike]
#: The controller of all teams, or a dictionary of controllers by the names of teams.
Controllers = Union[Driver, dict[str, Driver]]

_NOBODY = "none"  # controller of a team without one, in experiments made in Python
_PEOPLE = "keyboard"  # for `cohort teleop`, on a server


class _Idle(Controller):
    """A controller that leaves all commands neutral, for a team without a controller."""

    def step(self, observation, command):
        pass


class _PathEncoder(json.JSONEncoder):
    def default(self, value):
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if hasattr(value, "tolist"):
            return value.tolist()
        return super().default(value)


@dataclasses.dataclass(frozen=True)
class Team:
    """A team of an experiment.

    Attributes:
        name: name of the team.
        controller: name of its controller in the experiment; empty if there is none.
        robots: ids of its robots, in ascending order.
        period: number of ticks from one command to the next.
    """

    name: str
    controller: str
    robots: tuple[int, ...]
    period: int


@dataclasses.dataclass(frozen=True)
class Result:
    """The result of a run.

    Attributes:
        end: `finished`, `interrupted` or `failed`.
        error: reason of a failure; empty if there is none.
        stop_reason: the stop condition that ended the run; empty if none did.
        ticks: number of ticks.
        time: simulated time [s].
        wall_time: wall time from the first frame to the last step [s].
        state_hash: hash of the last state; identical for all runs of the same experiment with the same controllers.
        robots: number of robots at the end.
        robot_ticks: number of robots, summed over all ticks: the total to which the next two values refer.
        touching_obstacles: number of robot-ticks in which a robot touched an object other than a robot or a plane.
        touching_robots: number of robot-ticks in which a robot touched another robot.
        events: events of the run, a list of tuples (tick, kind, text, count).
        seed: seed of the experiment.
    """

    end: str
    error: str
    stop_reason: str
    ticks: int
    time: float
    wall_time: float
    state_hash: int
    robots: int
    robot_ticks: int
    touching_obstacles: int
    touching_robots: int
    events: list[tuple[int, str, str, int]]
    seed: int


def _without_places(problems: str, files: list[str]) -> str:
    """Returns the problems without the lines of these files, which the program has not written."""
    for file in files:
        problems = re.sub(rf"^{re.escape(file)}(:\d+)?: ", "Experiment: ", problems, flags=re.MULTILINE)
    return problems


class Experiment:
    """A world with robots in teams, checked and ready to run.

    Read it from a file with `Experiment.read`, or create it in Python with the keys of experiment files as arguments:

        cohort.Experiment(
            world="arena.sdf",
            duration=60,
            teams=[{"name": "explorers", "robots": "explorers/*", "controller": Wanderer}],
        )

    `world` is a path, or a dictionary with the keys of world files in YAML, which are those of SDF. The controller of a
    team may be a class derived from `cohort.Controller` or `cohort.TeamController`. If a team has none, pass it to
    `run`; otherwise, its robots keep neutral commands. Paths are relative to `folder`, by default the working
    directory. Raises `cohort.InputError` with all problems and the keys that have them, as `cohort check` does.
    """

    def __init__(
        self,
        *,
        folder: str | os.PathLike = ".",
        name: str = "experiment",
        seed: int | None = None,
        duration: float | None = None,
        **keys: Any,
    ) -> None:
        if seed is not None:
            keys["seed"] = seed
        if duration is not None:
            keys["duration"] = duration
        self._classes: dict[object, type] = {}
        if isinstance(keys.get("teams"), (list, tuple)):
            keys["teams"] = [self._named_team(team) for team in keys["teams"]]
        world = None
        if isinstance(keys.get("world"), dict):
            world = json.dumps({"world": keys["world"]}, cls=_PathEncoder, indent=1)
            keys["world"] = f"{name}-world.yaml"
        text = json.dumps(keys, cls=_PathEncoder, indent=1)
        folder = pathlib.Path(folder).absolute()
        texts = [(os.fspath(folder / f"{name}.yaml"), text)]
        if world is not None:
            texts.append((os.fspath(folder / keys["world"]), world))
        try:
            self._native = _native.Experiment.read_texts(texts, None, None, _files.model_folders())
        except _native.InputError as error:
            raise _native.InputError(_without_places(str(error), [file for file, _ in texts])) from None

    def _named_team(self, team):
        """Returns a team whose controller is a name, and stores its class if it has one."""
        if not isinstance(team, dict):
            return team
        controller = team.get("controller", _NOBODY)
        if isinstance(controller, type) and issubclass(controller, (Controller, TeamController)):
            self._classes[team.get("name")] = controller
            controller = controller.__name__
        return team | {"controller": controller}

    @classmethod
    def read(cls, file: str | os.PathLike, seed: int | None = None, duration: float | None = None) -> Experiment:
        """Reads an experiment in YAML, or a world or a model in SDF or URDF.

        Args:
            file: a path, or the name of a bundled experiment (`cohort.examples()`).
            seed: seed that replaces the one in the file.
            duration: simulated time [s] that replaces the duration in the file; 0: no end.
        """
        return cls._of(_native.Experiment.read(_files.experiment_called(file), seed, duration, _files.model_folders()))

    @classmethod
    def read_text(
        cls,
        text: str,
        folder: str | os.PathLike = ".",
        name: str = "experiment",
        seed: int | None = None,
        duration: float | None = None,
    ) -> Experiment:
        """Reads an experiment from a string in YAML, with paths relative to `folder`."""
        file = pathlib.Path(folder).absolute() / f"{name}.yaml"
        return cls._of(_native.Experiment.read_texts([(os.fspath(file), text)], seed, duration, _files.model_folders()))

    @classmethod
    def _of(cls, native: _native.Experiment) -> Experiment:
        experiment = cls.__new__(cls)
        experiment._native = native
        experiment._classes = {}
        return experiment

    @classmethod
    def _of_kept_files(cls, kept, classes):
        experiment = cls._of(_native.Experiment.read_kept_files(kept))
        experiment._classes = classes
        return experiment

    # A pickled experiment contains its files, so that another machine can read it.
    def __reduce__(self):
        return self._of_kept_files, (self._native.kept_files(), self._classes)

    # Experiments are never changed.
    def __deepcopy__(self, memo):
        return self.with_seed(self.seed)

    def with_seed(self, seed: int) -> Experiment:
        """Returns the same experiment with another seed, which changes random placements."""
        experiment = self._of(self._native.with_seed(seed))
        experiment._classes = self._classes
        return experiment

    def with_values(self, values: dict[str, Any]) -> Experiment:
        """Returns the same experiment with other values, by their paths in its file or below `world`.

            experiment.with_values({"teams.explorers.parameters.gain": 2.0, "world.gravity": [0, 0, -1.6]})

        The steps of a path are keys; an item of a list has its name or its index. Missing keys are added. Raises
        `cohort.InputError` for a value that the experiment cannot have, and `ValueError` if it was not read from files.
        """
        settings = [f"{path}={json.dumps(value, cls=_PathEncoder)}" for path, value in values.items()]
        experiment = self._of(self._native.with_settings(settings))
        experiment._classes = self._classes
        return experiment

    @property
    def name(self) -> str:
        """Name of its file, without the extension."""
        return self._native.name

    @property
    def file(self) -> pathlib.Path:
        """Path of its file."""
        return self._native.file

    @property
    def seed(self) -> int:
        """Seed of all random numbers of the run."""
        return self._native.seed

    @property
    def step(self) -> float:
        """Simulated time between ticks [s]."""
        return self._native.step

    @property
    def duration(self) -> float:
        """Simulated duration of a run [s]; 0: no end."""
        return self._native.duration

    @property
    def robots(self) -> list[str]:
        """Scoped names of the robots, in the order of their ids."""
        return self._native.robots

    @property
    def teams(self) -> list[Team]:
        """Teams of the experiment, a list of `Team`."""
        return [
            Team(each["name"], each["controller"], tuple(each["robots"]), each["period"]) for each in self._native.teams
        ]

    @property
    def warnings(self) -> list[str]:
        """Warnings about features of its files that are not simulated, a list of sentences."""
        return self._native.warnings

    def run(
        self, controllers: Controllers | None = None, *, threads: int = 1, record: str | os.PathLike | None = None
    ) -> Result:
        """Runs the experiment to its end in this process, and returns a `Result`.

        Args:
            controllers: a class derived from `cohort.Controller` or `cohort.TeamController`, the name or path of a
                controller, or a dictionary of these by the names of teams. Other teams use the controller in the
                experiment.
            threads: number of threads that step the world; the result does not depend on it.
            record: path of a recording (MCAP) to write.

        Raises RuntimeError with the reason if the run fails, and KeyboardInterrupt after Ctrl-C.
        """
        drivers = [self._driver_of(team, controllers) for team in self.teams]
        calls_python = any(isinstance(each, Maker) for each in drivers)
        with portable_calls() if calls_python else contextlib.nullcontext():
            facts = _native.run(self._native, threads, drivers, _files.plugin_folders(), record or "")
        result = Result(seed=self.seed, **facts)
        if result.end == "failed":
            raise RuntimeError(f"the run failed at tick {result.ticks}: {result.error}")
        return result

    def _driver_of(self, team, controllers):
        """Returns the driver of a team: the name or path of a plugin, or a `Maker` of controllers of a class."""
        chosen = controllers
        if isinstance(controllers, dict):
            names = [each.name for each in self.teams]
            for name in controllers:
                if name not in names:
                    raise ValueError(f"unknown team '{name}', expected one of {names}")
            chosen = controllers.get(team.name)
        folder = pathlib.Path()
        if chosen is None:
            chosen = self._classes.get(team.name, team.controller)
            folder = pathlib.Path(self.file).parent
        if isinstance(chosen, os.PathLike):
            chosen = os.fspath(chosen)
        if not isinstance(chosen, str):
            return Maker(chosen)
        if chosen in (_NOBODY, _PEOPLE):
            return Maker(_Idle)
        if chosen.endswith(".py"):
            return maker_in(folder / chosen)
        return os.fspath(folder / chosen) if "/" in chosen or chosen.endswith(".so") else chosen

    def __repr__(self) -> str:
        return f"<cohort.Experiment {self.name}: {len(self.robots)} robots, {self.duration:g} s, seed {self.seed}>"


def run(
    experiment: str | os.PathLike,
    controllers: Controllers | None = None,
    *,
    seed: int | None = None,
    duration: float | None = None,
    threads: int = 1,
    record: str | os.PathLike | None = None,
) -> Result:
    """Reads an experiment, runs it to its end in this process, and returns a `Result`; see `Experiment.run`."""
    return Experiment.read(experiment, seed, duration).run(controllers, threads=threads, record=record)


def run_seeds(
    experiment: Experiment | str | os.PathLike,
    seeds: Iterable[int],
    controllers: Controllers | None = None,
    *,
    threads: int = 1,
) -> pandas.DataFrame:
    """Runs an experiment once for each seed, and returns a table of the results.

    Args:
        experiment: an `Experiment`, or a file for `Experiment.read`.
        seeds: an iterable of integers.
        controllers, threads: as in `Experiment.run`.

    Returns a `pandas.DataFrame` with one row per seed.
    """
    import pandas

    if not isinstance(experiment, Experiment):
        experiment = Experiment.read(experiment)
    results = [experiment.with_seed(int(seed)).run(controllers, threads=threads) for seed in seeds]
    rows = [{key: value for key, value in dataclasses.asdict(each).items() if key != "events"} for each in results]
    return pandas.DataFrame(rows).set_index("seed")
