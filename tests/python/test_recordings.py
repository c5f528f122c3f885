# SPDX-License-Identifier: Apache-2.0

"""Recordings give NumPy, pandas and xarray what the simulation had, bit for bit."""

import importlib
import itertools
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import cohort
import numpy
import pandas
import pytest
import rosbags.highlevel
import xarray
import yaml_fields

SECONDS = 4
STEP = 0.01
PUSHED = "explorers/sbot_3"
EVENTS = [
    {"at": 1, "apply_force": {"objects": PUSHED, "force": [0.5, 0, 0], "for": 0.2}},
    {"at": 2.5, "remove": {"objects": "explorers/sbot_9"}},
]
EVERY_DEVICE = pathlib.Path(__file__).parents[1] / "data/every_device/world.yaml"


@pytest.fixture(scope="module")
def experiment():
    text = yaml_fields.of_example("obstacle_avoidance", record={"poses": 10, "observations": 20}, events=EVENTS)
    return cohort.Experiment.read_text(text, duration=SECONDS)


@pytest.fixture(scope="module")
def recording(experiment, tmp_path_factory):
    file = tmp_path_factory.mktemp("recording") / "run.mcap"
    experiment.run(record=file)
    return cohort.Recording(file)


@pytest.fixture(scope="module")
def minute(tmp_path_factory):
    """A recording of several chunks."""
    file = tmp_path_factory.mktemp("recording") / "minute.mcap"
    cohort.run("obstacle_avoidance", record=file)
    return cohort.Recording(file)


@pytest.fixture(scope="module")
def every_device(tmp_path_factory):
    """A robot with every device, whose observations the file has as messages of ROS, and the poses of its links."""
    file = tmp_path_factory.mktemp("recording") / "devices.mcap"
    teams = [{"name": "all", "robots": "*", "controller": "keyboard"}]
    record = {"observations": 50, "joints": 50}
    experiment = cohort.Experiment(world=EVERY_DEVICE, duration=0.5, teams=teams, record=record)
    experiment.run(record=file)
    return cohort.Recording(file)


def cut(recording, file, share):
    """Writes the first bytes of a recording to another file."""
    whole = recording.file.read_bytes()
    file.write_bytes(whole[: int(len(whole) * share)])
    return file


def values_of(channels):
    """Returns names and units of the values of channels."""
    names = [(each, f"/{place}" if each.size > 1 else "") for each in channels for place in range(each.size)]
    return [(channel.name + place, channel.unit) for channel, place in names]


def ticks_of(array):
    return numpy.rint(array.time.values / STEP).astype(int).tolist()


def hashes(recording):
    return [int(each, 16) for each in recording.table("ticks").state_hash]


def without_absent(values, present):
    return numpy.where(present[:, None], values, numpy.nan)


def simulated_again(recording):
    """Yields a simulation at each tick, which is given the commands of the recording."""
    simulation = cohort.Simulation(recording.experiment)
    commands = recording.commands_at().values
    for tick in range(len(commands)):
        assert simulation.tick == tick
        yield simulation
        simulation.commands[:] = commands[tick]
        simulation.step()


def test_a_recording_has_the_facts_and_the_end_of_its_run(recording, experiment):
    assert recording.robots == experiment.robots
    assert recording.experiment.teams == experiment.teams
    assert recording.duration == SECONDS
    assert recording.end == "finished"
    assert recording.damage == ""
    assert recording.facts["seed"] == "1" and recording.facts["version"] == cohort.__version__
    assert recording.worlds == [cohort.World(run=0, seed=1, reason="first", tick=0, start=0.0)]


def test_commands_drive_a_simulation_to_the_recorded_state_of_every_tick(recording):
    assert [each.state_hash for each in simulated_again(recording)] == hashes(recording)


def test_poses_and_observations_have_the_bits_of_a_simulation_at_the_same_ticks(recording):
    poses, observations = recording.poses, recording.observations
    pose_ticks, observed_ticks = ticks_of(poses), ticks_of(observations)
    assert pose_ticks == list(range(0, 100 * SECONDS + 1, 10))
    assert observed_ticks == list(range(0, 100 * SECONDS + 1, 5))
    for simulation in simulated_again(recording):
        assert poses.object.values.tolist() == recording.robots
        present = numpy.array([simulation.objects_present[each.object] for each in simulation.robots])
        if simulation.tick in pose_ticks:
            recorded = poses.values[pose_ticks.index(simulation.tick)]
            numpy.testing.assert_array_equal(recorded, without_absent(simulation.poses, present))
        if simulation.tick in observed_ticks:
            recorded = observations.values[observed_ticks.index(simulation.tick)]
            numpy.testing.assert_array_equal(recorded, without_absent(simulation.observations, present))


def test_arrays_have_names_units_and_times(recording):
    robot = cohort.Simulation(recording.experiment).robots[0]
    for array, channels in [
        (recording.observations, robot.observation_channels),
        (recording.commands, robot.command_channels),
    ]:
        assert isinstance(array, xarray.DataArray)
        assert array.dims == ("time", "robot", "channel")
        assert array.robot.values.tolist() == recording.robots
        assert array.time.attrs["units"] == "s"
        assert (array.run == 0).all()
        assert list(zip(array.channel.values.tolist(), array.unit.values.tolist())) == values_of(channels)
    assert recording.poses.dims == ("time", "object", "component")
    assert recording.poses.component.values.tolist() == ["x", "y", "z", "qw", "qx", "qy", "qz"]
    assert recording.poses.unit.values.tolist() == ["m", "m", "m", "1", "1", "1", "1"]


def test_commands_have_a_time_for_each_tick_at_which_one_changed(recording):
    changed, filled = recording.commands, recording.commands_at()
    assert filled.shape[0] == 100 * SECONDS + 1
    differ = (numpy.diff(filled.values, axis=0, prepend=0) != 0).any(axis=2)
    at = ticks_of(changed)
    assert at == numpy.flatnonzero(differ.any(axis=1)).tolist()
    is_recorded = ~numpy.isnan(changed.values).all(axis=2)
    numpy.testing.assert_array_equal(is_recorded, differ[at])
    numpy.testing.assert_array_equal(changed.values[is_recorded], filled.values[at][is_recorded])
    between = recording.commands_at([0.123, 1.0])
    numpy.testing.assert_array_equal(between.values, filled.values[[12, 100]])


@pytest.mark.parametrize("which", ["recording", "every_device"])
def test_tables_are_those_of_the_command(which, request, cohort_program, tmp_path):
    recording = request.getfixturevalue(which)
    cohort_program("export-data", str(recording.file), "--csv", str(tmp_path))
    assert recording.tables == sorted(each.stem for each in tmp_path.glob("*.csv"))
    for name in recording.tables:
        table = recording.table(name)
        texts = {column: str for column in table.columns if not pandas.api.types.is_numeric_dtype(table[column])}
        written = pandas.read_csv(tmp_path / f"{name}.csv", dtype=texts, keep_default_na=False)
        assert table.columns.tolist() == written.columns.tolist()
        for column in table.columns:
            if column in texts:
                assert table[column].tolist() == written[column].tolist()
            else:
                assert table[column].dtype in (numpy.float64, numpy.int64)
                numpy.testing.assert_array_equal(
                    table[column], written[column].astype(table[column].dtype), f"{name}/{column}"
                )
    assert recording.table("ticks").attrs["units"] == {"time": "s"}


def test_another_reader_of_bags_reads_the_same_values(recording):
    robot = recording.robots[5]
    times, readings = [], []
    with rosbags.highlevel.AnyReader([recording.file]) as reader:
        topic = [each for each in reader.connections if each.topic == f"/{robot}/observation"]
        for connection, _, data in reader.messages(topic):
            message = reader.deserialize(data, connection.msgtype)
            times.append(message.stamp.sec + message.stamp.nanosec / 1e9)
            readings.append([message.proximity_0_reading, message.proximity_7_reading, message.treel_left_position])
    ours = recording.observations.sel(robot=robot)
    channels = ["proximity/0/reading", "proximity/7/reading", "treel/left/position"]
    numpy.testing.assert_array_equal(ours.sel(channel=channels).values, numpy.array(readings))
    numpy.testing.assert_allclose(ours.time.values, times, rtol=0, atol=1e-9)
    assert numpy.ptp(numpy.array(readings), axis=0).min() > 0


def test_robots_with_other_channels_have_no_value(every_device):
    observations = every_device.observations
    simulation = cohort.Simulation(every_device.experiment)
    assert len({each.model for each in simulation.robots}) > 1
    for robot in simulation.robots:
        own = [name for name, _ in values_of(robot.observation_channels)]
        of_robot = observations.sel(robot=robot.name).isel(time=0)
        assert set(of_robot.channel.values[~numpy.isnan(of_robot)]) == set(own)
        numpy.testing.assert_array_equal(of_robot.sel(channel=own), robot.observation)


def test_poses_are_those_of_objects_without_their_links_and_devices(every_device):
    frames = set(every_device.table("trajectories").object)
    objects = set(every_device.poses.object.values)
    simulation = cohort.Simulation(every_device.experiment)
    assert objects < frames
    assert objects <= set(simulation.objects)
    assert not numpy.isnan(every_device.poses.sel(object="ball").dropna("time")).any()


def with_panorama(recording):
    robots = cohort.Simulation(recording.experiment).robots
    return next(each.name for each in robots if "panorama/0/image" in each.observation_channels)


def test_images_are_arrays_of_bytes(every_device):
    robot = with_panorama(every_device)
    images = list(every_device.images(robot, "panorama"))
    values = every_device.observations.sel(robot=robot)
    values = values.sel(channel=[f"panorama/0/image/{place}" for place in range(5 * 24 * 3)])
    assert [when for when, _ in images] == values.time.values.tolist()
    for (_, image), recorded in zip(images, values.values):
        assert image.shape == (5, 24, 3) and image.dtype == numpy.uint8
        numpy.testing.assert_allclose(image / 255, recorded.reshape(5, 24, 3), rtol=0, atol=0.5 / 255 + 1e-12)
    assert len({image.tobytes() for _, image in images}) > 1
    with pytest.raises(LookupError, match="have no camera 'lidar' with images"):
        every_device.images(robot, "lidar")
    with pytest.raises(LookupError, match="unknown robot 'nobody', expected one of"):
        every_device.images("nobody", "panorama")


def test_events_are_joined_to_the_rows_of_any_table(recording):
    events = recording.events
    assert events.time.tolist() == [1.0, 2.5]
    assert events.tick.tolist() == [100, 250]
    poses = recording.table("trajectories").query("object == @PUSHED").sample(frac=1, random_state=1)
    joined = recording.with_events(poses)
    pandas.testing.assert_frame_equal(joined[poses.columns], poses, check_exact=True)
    for row in joined.itertuples():
        last = 0 if row.time < 1 else 1 if row.time < 2.5 else 2
        assert pandas.isna(row.event_time) == (last == 0)
        if last:
            assert (row.event_time, row.event_text) == (events.time[last - 1], events.text[last - 1])
    with pytest.raises(ValueError, match="the table has no column 'time'"):
        recording.with_events(pandas.DataFrame({"t": [1.0]}))


def test_a_recording_without_events_has_an_empty_table_of_them(tmp_path):
    cohort.run("obstacle_avoidance", duration=2, record=tmp_path / "run.mcap")
    quiet = cohort.Recording(tmp_path / "run.mcap")
    assert quiet.events.empty
    assert quiet.events.columns.tolist() == ["run", "time", "tick", "kind", "text", "count"]
    assert quiet.with_events(quiet.table("ticks")).event_time.isna().all()


def test_replay_has_the_state_of_every_tick(recording):
    for threads in (1, 2):
        found = recording.verify(threads)
        assert found and found.is_identical
        assert found.ticks == 100 * SECONDS + 1
        assert str(found) == f"identical, {found.ticks} ticks"


def test_other_threads_run_during_a_replay(minute):
    rounds = 0
    ended = False

    def count():
        nonlocal rounds
        while not ended:
            rounds += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)  # no thread is made to give way
    try:
        thread.start()
        before = rounds
        minute.verify()
        assert rounds > before
    finally:
        sys.setswitchinterval(interval)
        ended = True
        thread.join()


def test_ctrl_c_ends_a_replay(minute):
    replayed = []
    interrupt = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        interrupt.start()
        replayed.extend(map(minute._native.verify, itertools.repeat(1, 20)))  # no Python in between
    assert len(replayed) < 20


def test_a_simulation_continues_from_the_middle_of_a_recording(recording):
    simulation = recording.simulation_at(2.0)
    expected = hashes(recording)
    commands = recording.commands_at().values
    assert (simulation.tick, simulation.time) == (200, 2.0)
    numpy.testing.assert_array_equal(simulation.commands, commands[199])
    while simulation.tick < 100 * SECONDS:
        assert simulation.state_hash == expected[simulation.tick]
        simulation.commands[:] = commands[simulation.tick]
        simulation.step()
    assert simulation.state_hash == expected[-1]
    with pytest.raises(ValueError, match="ends before 5 s"):
        recording.simulation_at(5)


@pytest.fixture
def two_worlds(serve, domain, build, cohort_program, tmp_path):
    """A recording of a served run in which a robot comes at tick 50, and that is reset at tick 100."""
    hosts = []

    def host(robots):
        command = [build / "bin/cohort", "host", "obstacle_avoidance", "--robots", robots, "--domain", str(domain)]
        hosts.append(subprocess.Popen(command, stderr=subprocess.DEVNULL))

    def control(*arguments):
        cohort_program("ctl", *arguments, "--domain", str(domain), "--timeout", "300")

    finish = serve("obstacle_avoidance", "--paused", "--record", tmp_path / "run.mcap")
    try:
        host("all")
        control("step", "50")
        control("spawn", "sbot", "--name", "explorers/late", "--pose", "0 -1.8 0", "--team", "explorers")
        host("explorers/late")
        control("step", "50")
        control("reset")
        control("step", "30")
        control("shutdown")
        finish()
    finally:
        for each in hosts:
            each.kill()
            each.wait()
    return cohort.Recording(tmp_path / "run.mcap")


def test_worlds_of_one_recording_are_distinguished(two_worlds):
    assert [(each.run, each.seed, each.reason, each.tick) for each in two_worlds.worlds] == [
        (0, 1, "first", 0),
        (1, 1, "reset", 0),
    ]
    assert two_worlds.robots == [*two_worlds.experiment.robots, "explorers/late"]
    assert two_worlds.verify()
    ticks = two_worlds.table("ticks")
    assert ticks.groupby("run").tick.max().tolist() == [100, 30]

    for run, first in enumerate([50, None]):
        commands = two_worlds.commands_at(run=run)
        late = numpy.isnan(commands.sel(robot="explorers/late")).all("channel").values
        assert numpy.flatnonzero(~late).tolist() == ([] if first is None else list(range(first, 101)))
        expected = [int(each, 16) for each in ticks[ticks.run == run].state_hash]
        poses = two_worlds.poses.isel(time=two_worlds.poses.run.values == run)
        simulation = cohort.Simulation(two_worlds.experiment)
        for tick, hash_of_tick in enumerate(expected):
            if tick == first:
                simulation.spawn("sbot", (0, -1.8, 0), name="explorers/late", team="explorers")
            assert simulation.state_hash == hash_of_tick
            if tick % 10 == 0:
                count = len(simulation.robots)
                numpy.testing.assert_array_equal(poses.values[tick // 10, :count], simulation.poses)
                assert numpy.isnan(poses.values[tick // 10, count:]).all()
            simulation.commands[:] = commands.values[tick, : len(simulation.robots)]
            simulation.step()

    joined = two_worlds.with_events(ticks)
    assert (joined.event_time <= joined.time).all()
    assert (joined.event_time[99], joined.event_time[130]) == (0.5, 0.0)  # each of its own world
    later = two_worlds.simulation_at(two_worlds.worlds[1].start + 0.2)
    assert (later.tick, len(later.robots)) == (20, 16)


class Forward(cohort.Controller):
    """Drives straight on; one robot is faster from one tick on."""

    change = None

    def start(self, start):
        self.is_other = start.name == PUSHED
        self.left = start.command("treel/left/velocity")
        self.tracks = start.commands("treel/*/velocity")

    def step(self, observation, command):
        command[self.tracks] = 0.1
        if self.is_other and self.change is not None and self.tick >= self.change:
            command[self.left] = 0.11


class Changed(Forward):
    change = 57


def test_two_runs_differ_from_the_first_different_command_on(experiment, tmp_path):
    files = [tmp_path / "first.mcap", tmp_path / "second.mcap"]
    for file, controller in zip(files, (Forward, Changed)):
        experiment.run(controller, record=file)
    found = cohort.compare(*files)
    assert not found.are_identical
    assert (found.ticks, found.tick, found.time, found.more, found.ends) == (57, 57, 0.57, 0, "")
    assert found.differences == [(PUSHED, "command", "treel/left/velocity", "0.1", "0.11")]
    assert found.differences[0].object == PUSHED
    assert str(found) == (
        "they diverge at tick 57 (0.570 s), after 57 identical ticks\n"
        "  command      explorers/sbot_3         treel/left/velocity: 0.1 | 0.11"
    )


def test_a_comparison_prints_the_output_of_the_command(recording, experiment, tmp_path, build):
    other = tmp_path / "other.mcap"
    experiment.with_seed(2).run(record=other)
    program = subprocess.run([build / "bin/cohort", "diff", recording.file, other], capture_output=True, text=True)
    settings = "the runs have different settings:\n  seed: 1 | 2\n"  # of the command only
    assert settings + str(cohort.compare(recording, other)) + "\n" == program.stdout
    same = cohort.compare(recording, recording.file)
    assert same.are_identical and same.tick is None and same.differences == []
    assert str(same) == f"identical, {100 * SECONDS + 1} ticks"


def test_a_comparison_with_a_shorter_run_names_the_one_that_ends(recording, tmp_path):
    text = yaml_fields.of_example("obstacle_avoidance", events=EVENTS)
    cohort.Experiment.read_text(text, duration=1).run(record=tmp_path / "short.mcap")
    found = cohort.compare(recording, tmp_path / "short.mcap")
    assert not found.are_identical and found.tick is None
    assert str(found).startswith(f"{tmp_path / 'short.mcap'} ends at tick 100, and the other recording is longer")


def test_a_missing_or_invalid_file_is_an_error(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such recording: '.*missing.mcap'"):
        cohort.Recording(tmp_path / "missing.mcap")
    (tmp_path / "text.mcap").write_text("hello")
    for file, message in [(tmp_path / "text.mcap", "this is not an MCAP file"), (tmp_path, "it is not a regular file")]:
        with pytest.raises(cohort.RecordingError, match=message) as error:
            cohort.Recording(file)
        assert isinstance(error.value, ValueError)


def test_a_truncated_recording_is_read_up_to_its_end_with_a_warning(minute, tmp_path):
    file = cut(minute, tmp_path / "cut.mcap", 0.7)
    with pytest.warns(UserWarning, match="cut.mcap: "):
        cut_short = cohort.Recording(file)
    assert cut_short.damage and cut_short.end == ""
    ticks = cut_short.table("ticks")
    assert 0 < len(ticks) < 6001
    assert hashes(cut_short) == hashes(minute)[: len(ticks)]
    assert cut_short.verify().ticks == len(ticks)


@pytest.mark.parametrize("share", [0.001, 0.01])
def test_a_recording_without_a_complete_run_is_an_error(share, recording, tmp_path):
    with pytest.raises(cohort.RecordingError, match="cut.mcap: .*(it has no readable run|the file ends)"):
        cohort.Recording(cut(recording, tmp_path / "cut.mcap", share))


def test_missing_data_is_an_error_with_advice_how_to_record_it(tmp_path):
    teams = [{"name": "all", "robots": "*", "controller": "keyboard"}]
    cohort.Experiment(world=EVERY_DEVICE, duration=0.1, teams=teams, record={"poses": 0}).run(
        record=tmp_path / "run.mcap"
    )
    recording = cohort.Recording(tmp_path / "run.mcap")
    with pytest.raises(cohort.RecordingError, match="has no poses: record them with `record: {poses: 10}`"):
        _ = recording.poses
    with pytest.raises(cohort.RecordingError, match="has no observations: record them with"):
        _ = recording.observations
    with pytest.raises(LookupError, match="has no table 'trajectories', expected one of .*ticks"):
        recording.table("trajectories")
    robot = with_panorama(recording)
    with pytest.raises(cohort.RecordingError, match=f"has no observations of '{robot}'"):
        recording.images(robot, "panorama")


@pytest.mark.parametrize("package, use", [("pandas", lambda of: of.table("ticks")), ("xarray", lambda of: of.poses)])
def test_a_missing_package_is_named(package, use, recording, monkeypatch):
    real = importlib.import_module

    def import_module(name, *more):
        if name == package:
            raise ImportError(f"No module named '{name}'")
        return real(name, *more)

    monkeypatch.setattr(importlib, "import_module", import_module)
    with pytest.raises(ImportError, match=f"requires the package {package}; install it, for example with `pip"):
        use(recording)
