"""Experiments: a world, robots in teams, what drives them, for how long."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Union

from cohort import _files, _native
from cohort._hosting import Maker, maker_in
from cohort.controller import Controller, TeamController

if TYPE_CHECKING:
    import pandas

#: What drives a team: a class, or the name or the path of a controller.
Driver = Union[type[Controller], type[TeamController], str, os.PathLike]
#: What drives all teams, or each by its name.
Controllers = Union[Driver, dict[str, Driver]]

_NOBODY = "none"  # what a team of an experiment made in Python is given as its controller that has none
_PEOPLE = "keyboard"  # with `cohort teleop`, of a server


class _Idle(Controller):
    """Drives a team without a controller: its commands stay neutral."""

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
    """A team as experiments describe it.

    Attributes:
        name: of the team.
        controller: what the experiment names as its controller; empty if it names none.
        robots: ids of its robots, ascending.
        period: ticks from one command to the next.
    """

    name: str
    controller: str
    robots: tuple[int, ...]
    period: int


@dataclasses.dataclass(frozen=True)
class Result:
    """How a run ended.

    Attributes:
        end: `finished`, `interrupted` or `failed`.
        error: why it failed; empty if it did not.
        stop_reason: the stop condition that ended it; empty if none did.
        ticks: how many there were.
        time: simulated time [s].
        wall_time: from the first frame to the last step [s].
        state_hash: of the last state. The same for every run of the same experiment and controllers.
        robots: how many there were at the end.
        robot_ticks: robots times ticks, to which the next two are compared.
        touching_obstacles: robot-ticks in which a robot touched something that is neither a robot nor a plane.
        touching_robots: robot-ticks in which a robot touched another one.
        events: a list of tuples (tick, kind, text, count).
        seed: of the experiment.
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


class Experiment:
    """A world with robots in teams, checked and ready to run.

    Made from a file with `Experiment.read`, or in Python with the keys of experiment files as arguments:

        cohort.Experiment(
            world="arena.sdf",
            duration=60,
            teams=[{"name": "explorers", "robots": "explorers/*", "controller": Wanderer}],
        )

    `world` is a path, or a dictionary: a world as files in YAML write it, which have SDF's words. The controller of a
    team may be a class that derives from `cohort.Controller`, or left out: then `run` gives one, or the robots stay as
    they are. Paths are relative to `folder`, by default the working directory. Raises `cohort.InputError` with every
    problem that was found, in the words of `cohort check`.
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
        self._native = _native.Experiment.read_texts(texts, None, None, _files.model_folders())

    def _named_team(self, team):
        """Returns a team whose controller is a name, and keeps its class if it has one."""
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
            file: a path, or the name of an experiment that comes with Cohort (`cohort.examples()`).
            seed: in place of that of the file.
            duration: simulated time [s] in place of that of the file; 0: without an end.
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
        """Reads an experiment from a text in YAML whose paths are relative to `folder`."""
        file = pathlib.Path(folder).absolute() / f"{name}.yaml"
        return cls._of(_native.Experiment.read_texts([(os.fspath(file), text)], seed, duration, _files.model_folders()))

    @classmethod
    def _of(cls, native: _native.Experiment) -> Experiment:
        experiment = cls.__new__(cls)
        experiment._native = native
        experiment._classes = {}
        return experiment

    def with_seed(self, seed: int) -> Experiment:
        """Returns the same experiment with another seed; robots that are placed at random stand elsewhere."""
        experiment = self._of(self._native.with_seed(seed))
        experiment._classes = self._classes
        return experiment

    @property
    def name(self) -> str:
        """The name of its file, without the extension."""
        return self._native.name

    @property
    def file(self) -> pathlib.Path:
        """The path of its file."""
        return self._native.file

    @property
    def seed(self) -> int:
        """The seed of all that is random in it."""
        return self._native.seed

    @property
    def step(self) -> float:
        """Simulated time between ticks [s]."""
        return self._native.step

    @property
    def duration(self) -> float:
        """Simulated time of a run [s]; 0: without an end."""
        return self._native.duration

    @property
    def robots(self) -> list[str]:
        """Scoped names of the robots, in the order of their ids."""
        return self._native.robots

    @property
    def teams(self) -> list[Team]:
        """The teams, a list of `Team`."""
        return [
            Team(each["name"], each["controller"], tuple(each["robots"]), each["period"]) for each in self._native.teams
        ]

    @property
    def warnings(self) -> list[str]:
        """What its files ask for that is not simulated, a list of sentences."""
        return self._native.warnings

    def run(
        self, controllers: Controllers | None = None, *, threads: int = 1, record: str | os.PathLike | None = None
    ) -> Result:
        """Runs the experiment to its end in this process, and returns a `Result`.

        Args:
            controllers: what drives the robots: a class that derives from `cohort.Controller`, the name or the path of
                a controller, or a dictionary of these by the names of teams. Teams that are not named have the
                controller of the experiment.
            threads: that step the world; the result is the same for any number.
            record: path of a recording (MCAP) to write.

        Raises RuntimeError with the error if the run fails, and KeyboardInterrupt after Ctrl-C.
        """
        drivers = [self._driver_of(team, controllers) for team in self.teams]
        facts = _native.run(self._native, threads, drivers, _files.plugin_folders(), record or "")
        result = Result(seed=self.seed, **facts)
        if result.end == "failed":
            raise RuntimeError(f"the run failed at tick {result.ticks}: {result.error}")
        return result

    def _driver_of(self, team, controllers):
        """Returns what drives a team: the name or the path of a plugin, or what makes controllers of a class."""
        chosen = controllers
        if isinstance(controllers, dict):
            names = [each.name for each in self.teams]
            for name in controllers:
                if name not in names:
                    raise ValueError(f"there is no team '{name}', expected one of {names}")
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
    """Reads an experiment, runs it to its end in this process, and returns a `Result`: see `Experiment.run`."""
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
        experiment: an `Experiment`, or what `Experiment.read` takes.
        seeds: an iterable of integers.
        controllers, threads: as in `Experiment.run`.

    Returns a `pandas.DataFrame` with a row for each seed.
    """
    import pandas

    if not isinstance(experiment, Experiment):
        experiment = Experiment.read(experiment)
    results = [experiment.with_seed(int(seed)).run(controllers, threads=threads) for seed in seeds]
    rows = [{key: value for key, value in dataclasses.asdict(each).items() if key != "events"} for each in results]
    return pandas.DataFrame(rows).set_index("seed")
