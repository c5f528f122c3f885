# SPDX-License-Identifier: Apache-2.0

"""Recordings of runs, as arrays and tables, and comparisons of recordings."""

import functools
import os
import pathlib
import typing
import warnings

import numpy

from cohort import _native
from cohort._tables import Rows, Table, package, times_of, value_names
from cohort.experiment import Experiment
from cohort.findings import Comparison, Difference, Verification
from cohort.simulation import Simulation

RecordingError = _native.RecordingError

_REASONS = ("first", "reset", "restored", "attached")
_POSE = ("x", "y", "z", "qw", "qx", "qy", "qz")
_EVENT_COLUMNS = ("run", "time", "tick", "kind", "text", "count")


class World(typing.NamedTuple):
    """A world in a recording. A recording contains one world, and another one after each reset or restored snapshot.

    `run` is the number of the world, from 0. `reason` is the reason for its start: `first`, `reset`, `restored` or
    `attached`. `tick` is its first tick. `start` is the time of its start in the recording [s].
    """

    run: int
    seed: int
    reason: str
    tick: int
    start: float


class Recording:
    """A recording of a run (MCAP), written by `cohort run --record` or `cohort.run(…, record=…)`.

        recording = cohort.Recording("run.mcap")
        recording.poses.sel(object="explorers/sbot_0", component="x").plot()
        recording.observations.sel(channel="proximity/3/reading").mean("robot")
        recording.table("events")

    Numbers are those of the file, bit for bit, in SI units. Times are simulated time [s]. The experiment's key `record`
    defines which poses and observations a recording contains. A table is read when it is first used, and then cached.
    A damaged recording is read as far as possible, with a warning: see `damage`.

    Raises FileNotFoundError if the file does not exist, and `cohort.RecordingError`, a ValueError, if the file is not a
    recording or nothing in it can be read.
    """

    def __init__(self, file):
        self.file = pathlib.Path(os.fspath(file))
        if not self.file.exists():
            raise FileNotFoundError(f"no such recording: '{self.file}'")
        self._native = _native.Recording(self.file)
        self._tables = None
        self._rosters = self._native.rosters
        if self.damage:
            warnings.warn(self.damage, stacklevel=2)

    @property
    def facts(self):
        """Metadata of the run, a dictionary of strings: version, commit, experiment, seed, step_ns, compiler, cpu, …"""
        return self._native.facts

    @property
    def end(self):
        """How the run ended: a keyword such as `finished` or `interrupted`; empty if unknown."""
        return self._native.end

    @property
    def damage(self):
        """A description of the part of the file that cannot be read; empty if there is none."""
        return self._native.damage

    @property
    def worlds(self):
        """The worlds of the recording in their order, a list of `World`."""
        return [
            World(run, seed, _REASONS[reason], tick, start) for run, seed, reason, tick, start in self._native.worlds
        ]

    @functools.cached_property
    def experiment(self):
        """The `Experiment` of the first world, read from the files that the recording contains."""
        return Experiment._of(self._native.experiment(0))

    @property
    def robots(self):
        """Scoped names of the robots, in the order of their ids; robots that were added later follow."""
        return list(dict.fromkeys(name for *_, robots in self._rosters for name, *_ in robots))

    @property
    def duration(self):
        """Simulated time from the first message to the last one, over all worlds [s]."""
        start, end = self._native.times
        return end - start

    @property
    def tables(self):
        """Names of the tables; they are those of `cohort export-data`."""
        if self._tables is None:
            self._tables = self._native.tables([], [])
        return sorted(self._tables)

    def table(self, name):
        """Returns a table as a `pandas.DataFrame`, with the rows that `cohort export-data` writes.

        `attrs["units"]` is a dictionary of the units of the columns. Raises LookupError if there is no such table.
        """
        pandas = package("pandas", "a table")
        table = self._table(name)
        frame = pandas.DataFrame({column: table.column(column) for column, _, _ in table.columns})
        frame.attrs["units"] = {column: unit for column, _, unit in table.columns if unit}
        return frame

    @property
    def poses(self):
        """Poses in the world frame, an `xarray.DataArray` (time [s], object, component: x y z [m], qw qx qy qz).

        It contains the objects that can move. Recorded poses of their links and devices are in the table
        `trajectories`. Missing poses are NaN. The coordinate `run` is the number of the world at each time.
        """
        if "trajectories" not in self.tables:
            raise RecordingError(
                f"{self.file} has no poses: record them with `record: {{poses: 10}}` in the experiment"
            )
        table = self._table("trajectories")
        objects = self._objects_among([table.values[each] for each in numpy.unique(table.codes("object"))])
        place_of = {name: place for place, name in enumerate(objects)}
        place = numpy.array([place_of.get(name, -1) for name in table.values])[table.codes("object")]
        rows = place >= 0
        runs, times, (row_places,) = times_of([Rows(table, rows)])
        values = numpy.full((len(times), len(objects), len(_POSE)), numpy.nan)
        values[row_places, place[rows]] = numpy.stack([table.column(each)[rows] for each in _POSE], axis=1)
        units = ["m"] * 3 + ["1"] * 4
        coordinates = {"object": objects, "component": list(_POSE), "unit": ("component", units)}
        return self._array("poses", values, runs, times, coordinates, ("time", "object", "component"))

    @property
    def observations(self):
        """Observations of the robots, an `xarray.DataArray` (time [s], robot, channel).

        Channels have the names of `Robot.observation_channels`; the values of a channel with several values are
        `NAME/0`, `NAME/1`, … Values are NaN if a robot does not have the channel or was not recorded. The coordinate
        `unit` is the unit of each channel. The coordinate `run` is the number of the world at each time.
        """
        if not any(each.startswith("observations_") for each in self.tables):
            record = "record: {observations: 10}"
            raise RecordingError(f"{self.file} has no observations: record them with `{record}` in the experiment")
        return self._values("observations", 1)

    @property
    def commands(self):
        """Commands of the robots, an `xarray.DataArray` (time [s], robot, channel), like `observations`.

        Its times are those of the ticks at which a command changes. There it contains all channels of each robot whose
        command changes, and NaN for the other robots; `commands_at` returns the commands of all robots.
        """
        return self._values("commands", 2)

    def commands_at(self, times=None, run=0):
        """Returns the commands that are in effect at given times, for all robots, like `commands`.

        They are NaN before a robot is added.

        Args:
            times: simulated times [s], an array; by default those of all ticks.
            run: number of the world.
        """
        if times is None:
            ticks = self._table("ticks")
            times = ticks.time[ticks.run == run]
        times = numpy.asarray(times, dtype=numpy.float64)
        if times.ndim != 1:
            raise ValueError(f"times has {times.ndim} dimensions, expected one")
        changes = self.commands
        rosters = [roster for roster in self._rosters if roster[0] == run]
        if not rosters:
            raise ValueError(f"unknown run {run}, expected a number below {len(self.worlds)}")
        in_run = changes.coords["run"].values == run
        change_times = changes.coords["time"].values[in_run]
        change_values = changes.values[in_run]
        names = list(zip(changes.coords["channel"].values, changes.coords["unit"].values))
        values = numpy.full((len(times), *changes.shape[1:]), numpy.nan)
        # A roster has the commands at its time: later ones matter only for robots that were added.
        first = {robot[0]: (came, kinds, robot) for _, came, kinds, robots in reversed(rosters) for robot in robots}
        for robot, name in enumerate(self.robots):
            if name not in first:
                continue
            came, kinds, (_, _, kind, initial) = first[name]
            channels = [names.index(each) for each in value_names(kinds[kind][2])]
            of_robot = change_values[:, robot][:, channels]
            changed = ~numpy.isnan(of_robot).all(axis=1)
            known = numpy.concatenate([[initial], of_robot[changed]])
            there = numpy.flatnonzero(times >= came)
            last = numpy.searchsorted(change_times[changed], times[there], side="right")
            values[there[:, None], robot, channels] = known[last]
        runs = numpy.full(len(times), run, dtype=numpy.int64)
        coordinates = {"robot": self.robots, "channel": changes.coords["channel"].values}
        coordinates["unit"] = ("channel", changes.coords["unit"].values)
        return self._array("commands", values, runs, times, coordinates, ("time", "robot", "channel"))

    @property
    def events(self):
        """Events of the run, a `pandas.DataFrame` with the columns run, time [s], tick, kind, text and count."""
        if "events" in self.tables:
            return self.table("events")
        return package("pandas", "a table").DataFrame({name: [] for name in _EVENT_COLUMNS})

    def with_events(self, frame):
        """Returns a table with new columns for the last event at or before the time of each row.

        `frame` is a `pandas.DataFrame` with a column `time` [s], and `run` if there are several worlds. The new columns
        are `event_time` [s], `event_kind` and `event_text`. Their values are missing before the first event.
        """
        pandas = package("pandas", "a table")
        if "time" not in frame.columns:
            raise ValueError(f"the table has no column 'time'; its columns are {list(frame.columns)}")
        by = ["run"] if "run" in frame.columns else []
        events = self.events.astype({"run": "int64", "time": "float64"})
        events = events[["run", "time", "kind", "text"]].assign(event_time=events["time"])
        events = events.rename(columns={"kind": "event_kind", "text": "event_text"}).sort_values("time", kind="stable")
        events = events[[*by, "time", "event_time", "event_kind", "event_text"]]
        ordered = frame.assign(_row=numpy.arange(len(frame))).sort_values("time", kind="stable")
        joined = pandas.merge_asof(ordered, events, on="time", by=by or None)
        return joined.sort_values("_row").drop(columns="_row").set_axis(frame.index)

    def images(self, robot, sensor):
        """Yields (time [s], image) for each recorded image of a robot's camera.

        An image is an array [height, width, 3] of uint8: red, green and blue.

        Args:
            robot: scoped name of the robot.
            sensor: name of a camera with images, such as a `cohort:panorama`.

        Raises LookupError if there is no such robot or camera, and `cohort.RecordingError` if no observations of the
        robot were recorded.
        """
        if robot not in self.robots:
            raise LookupError(f"unknown robot '{robot}', expected one of {', '.join(self.robots)}")
        kinds_of = {name: kinds[kind] for *_, kinds, robots in self._rosters for name, _, kind, _ in robots}
        model, channels, _ = kinds_of[robot]
        shape = self._native.image_shape(model, sensor)
        names = [name for name, _ in value_names(channels)]
        first = f"{sensor}/0/image/0"
        if shape is None or first not in names:
            raise LookupError(f"robots of model '{model}' have no camera '{sensor}' with images")
        table = self._native.tables([f"observations_{model}"], [robot]).get(f"observations_{model}")
        if table is None:
            raise RecordingError(f"{self.file} has no observations of '{robot}'")
        return self._images_in(Table(*table), 1 + names.index(first), shape)

    @staticmethod
    def _images_in(table, start, shape):
        height, width = shape
        for time, row in zip(table.time.tolist(), table.reals[:, start : start + height * width * 3]):
            yield time, numpy.rint(numpy.clip(row, 0, 1) * 255).astype(numpy.uint8).reshape(height, width, 3)

    def verify(self, threads=1):
        """Replays the recording without controllers, compares the state of every tick, and returns a `Verification`.

        Releases Python's global interpreter lock. Ctrl-C raises KeyboardInterrupt.
        """
        ticks, difference, problem = self._native.verify(_at_least_one(threads))
        return Verification(ticks, *(difference or (None,) * 4), problem)

    def simulation_at(self, time):
        """Returns a `Simulation` that continues from the first tick at or after a time of the recording [s].

        The simulation starts with the commands that are in effect at this tick. Raises ValueError if the recording ends
        before `time`.
        """
        state = self._native.state_at(time)
        if state is None:
            raise ValueError(f"{self.file} ends before {time} s")
        world, snapshot = state
        simulation = Simulation(Experiment._of(self._native.experiment(world)))
        simulation.restore(snapshot)
        return simulation

    def _table(self, name):
        if name not in self.tables:
            raise LookupError(f"{self.file} has no table '{name}', expected one of {', '.join(self.tables)}")
        self._read([name])
        return self._tables[name]

    def _read(self, names):
        wanted = [each for each in names if self._tables[each] is None]
        if wanted:
            read = self._native.tables(wanted, [])
            self._tables.update({name: Table(*read[name]) for name in wanted})

    def _objects_among(self, frames):
        """Returns the frames that are objects, without links and devices, whose names extend the name of an object."""
        robots, known = set(self.robots), set(frames)

        def is_object(name):
            parts = name.split("/")
            return name in robots or not any("/".join(parts[:count]) in known for count in range(1, len(parts)))

        return [each for each in frames if is_object(each)]

    def _values(self, what, kind_part):
        """Returns the tables `WHAT_MODEL` as one array; `kind_part` is the index of their channels in a kind."""
        kinds = {kind[0]: kind[kind_part] for *_, kinds, _ in self._rosters for kind in kinds}
        names = list(dict.fromkeys(each for channels in kinds.values() for each in value_names(channels)))
        place_of = {name: place for place, name in enumerate(names)}
        robot_of = {name: place for place, name in enumerate(self.robots)}
        models = [each for each in kinds if f"{what}_{each}" in self.tables]
        self._read([f"{what}_{each}" for each in models])
        tables = [self._tables[f"{what}_{each}"] for each in models]
        runs, times, row_places = times_of(tables)
        values = numpy.full((len(times), len(robot_of), len(names)), numpy.nan)
        for model, table, rows in zip(models, tables, row_places):
            robots = numpy.array([robot_of.get(each, -1) for each in table.values])[table.codes("robot")]
            channels = [place_of[each] for each in value_names(kinds[model])]
            values[rows[:, None], robots[:, None], channels] = table.reals[:, 1:]
        coordinates = {"robot": list(robot_of), "channel": [name for name, _ in names]}
        coordinates["unit"] = ("channel", [unit for _, unit in names])
        return self._array(what, values, runs, times, coordinates, ("time", "robot", "channel"))

    def _array(self, name, values, runs, times, coordinates, dimensions):
        xarray = package("xarray", "an array with names")
        time = ("time", times, {"units": "s", "long_name": "simulated time"})
        return xarray.DataArray(values, {"time": time, "run": ("time", runs), **coordinates}, dimensions, name)

    def __repr__(self):
        return (
            f"<cohort.Recording {self.file}: {len(self.robots)} robots, {self.duration:g} s, {self.end or 'not ended'}>"
        )


def _at_least_one(threads):
    if threads < 1:
        raise ValueError(f"threads is {threads}, expected at least 1")
    return threads


def compare(first, second, threads=1):
    """Compares two recordings tick by tick and returns a `Comparison` with the first difference.

    Args:
        first, second: recordings, each a `Recording` or a path.
        threads: number of threads that step the worlds, which are replayed up to the first difference.

    Raises the same errors as `Recording`.
    """
    both = [each if isinstance(each, Recording) else Recording(each) for each in (first, second)]
    ticks, parting, ends = both[0]._native.compare(both[1]._native, _at_least_one(threads))
    tick, time, differences, more = parting or (None, None, [], 0)
    return Comparison(ticks, tick, time, [Difference(*each) for each in differences], more, ends)
