# SPDX-License-Identifier: Apache-2.0

"""A simulation that Python steps."""

import math
import multiprocessing
import os
import resource
import signal
import threading

import cohort
import numpy
import pytest

CRATE = """<sdf version='1.9'><model name='crate'><link name='body'><inertial><mass>1</mass><inertia><ixx>0.01</ixx>
<iyy>0.01</iyy><izz>0.01</izz></inertia></inertial><collision name='hull'><geometry><box><size>0.2 0.2 0.2</size></box>
</geometry></collision></link></model></sdf>"""


@pytest.fixture
def simulation():
    return cohort.Simulation("obstacle_avoidance", seed=1)


def tracks_of(simulation):
    return simulation.robots[0].command_channels.indices("treel/*/velocity", 2)


def test_arrays_show_the_current_state_without_copies(simulation):
    observations, commands = simulation.observations, simulation.commands
    assert observations.dtype == commands.dtype == numpy.float64
    commands[:, tracks_of(simulation)] = 0.1
    before = observations.copy()
    simulation.step(10)
    assert (observations != before).any()
    assert numpy.shares_memory(observations, simulation.observations)
    assert numpy.shares_memory(simulation.robots[3].observation, observations)
    with pytest.raises(ValueError, match="read-only"):
        observations[0, 0] = 1.0


def test_poses_follow_the_robots(simulation):
    simulation.commands[:, tracks_of(simulation)] = 0.1
    simulation.step(50)  # until all have their speed
    before = simulation.poses
    simulation.step(50)
    way = simulation.poses[:, :2] - before[:, :2]
    heading = 2.0 * numpy.arctan2(before[:, 6], before[:, 3])
    forward = (way * numpy.stack([numpy.cos(heading), numpy.sin(heading)], axis=1)).sum(axis=1)
    assert numpy.median(forward) == pytest.approx(0.1 * 0.5, rel=0.02)
    numpy.testing.assert_allclose(simulation.pose(simulation.robots[2].name), simulation.robots[2].pose)
    assert numpy.median(numpy.linalg.norm(simulation.velocities[:, :2], axis=1)) == pytest.approx(0.1, rel=0.02)


def test_a_run_continues_from_a_snapshot_with_the_same_bits(simulation):
    simulation.commands[:, tracks_of(simulation)] = 0.1
    simulation.step(100)
    snapshot = simulation.save()
    simulation.step(100)
    end = simulation.state_hash
    other = cohort.Simulation("obstacle_avoidance", seed=1, threads=2)
    other.restore(snapshot)
    assert other.tick == 100
    other.step(100)
    assert other.state_hash == end


def test_a_snapshot_of_another_experiment_is_refused_and_changes_nothing(simulation):
    simulation.step(3)
    before = simulation.state_hash
    for snapshot in (b"", b"no snapshot", simulation.save()[:-1], cohort.Simulation("wheels").save()):
        with pytest.raises(cohort.SnapshotError):
            simulation.restore(snapshot)
    assert simulation.state_hash == before


def test_a_reset_is_a_new_simulation_with_that_seed(simulation):
    simulation.step(20)
    simulation.reset(seed=7)
    assert simulation.tick == 0
    assert simulation.state_hash == cohort.Simulation("obstacle_avoidance", seed=7).state_hash
    simulation.reset()
    assert simulation.state_hash == cohort.Simulation("obstacle_avoidance", seed=7).state_hash


def test_what_happened_names_a_quarantined_object(tmp_path):
    (tmp_path / "world.yaml").write_text(
        "world: {name: w, 'cohort:physics': {lowest: -0.1}, model: {name: crate, link: {collision: {geometry: {sphere: "
        "{radius: 0.1}}}}}}"
    )
    (tmp_path / "fall.yaml").write_text("world: world.yaml\nduration: 1\nteams: []\n")
    simulation = cohort.Simulation(tmp_path / "fall.yaml")
    while simulation.tick < 100 and not simulation.happened:
        simulation.step()
    assert simulation.happened == ["'crate' has left the world"]
    assert 0.13 < simulation.time < 0.17, "0.1 m of free fall"
    simulation.step()
    assert simulation.happened == []


def test_an_object_is_spawned_falls_is_pushed_and_is_removed(simulation):
    name = simulation.spawn(CRATE, position=(0.0, 0.0, 0.5), yaw=0.5, name="crate")
    assert simulation.pose(name)[2] == pytest.approx(0.5)
    assert simulation.pose(name)[6] == pytest.approx(math.sin(0.25))
    simulation.step(100)
    assert simulation.pose(name)[2] == pytest.approx(0.1, abs=0.002)
    assert any(simulation.objects.index(name) in pair for pair in simulation.contacts()["objects"])
    place = simulation.pose(name)[0]
    simulation.apply_force(name, force=(20.0, 0.0, 0.0), duration=0.5)
    simulation.step(50)
    assert simulation.pose(name)[0] > place + 0.1
    simulation.set_pose(name, (0.0, 0.0, 2.0))
    simulation.set_velocity(name, linear=(0.0, 0.0, 1.0))
    simulation.step()
    assert simulation.pose(name)[2] > 2.0
    simulation.remove(name)
    assert not simulation.objects_present[simulation.objects.index(name)]
    with pytest.raises(ValueError, match="crate"):
        simulation.set_pose(name, (0.0, 0.0, 1.0))


def test_an_added_robot_has_a_row(simulation):
    before = simulation.observations
    name = simulation.spawn("sbot", (0.2, 0.2, 0.1), name="newcomer", team="explorers")
    assert simulation.observations.shape[0] == before.shape[0] + 1 == len(simulation.robots)
    assert simulation.robots[-1].name == name
    simulation.commands[-1, tracks_of(simulation)] = 0.1
    simulation.step(10)
    assert before.shape[0] == 16  # what was kept stays as it was


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e9])
def test_an_invalid_command_is_named_and_nothing_moves(simulation, value):
    simulation.commands[3, tracks_of(simulation)] = value
    with pytest.raises(ValueError, match=r"sbot_3.*treel/left/velocity"):
        simulation.step()
    assert simulation.tick == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: s.set_pose("nobody", (0, 0, 0)), "nobody"),
        (lambda s: s.set_pose("explorers/sbot_0", (0, 0)), "position is"),
        (lambda s: s.set_pose("explorers/sbot_0", (0, 0, math.nan)), "finite"),
        (lambda s: s.set_pose("explorers/sbot_0", (0, 0, 0), orientation=(0, 0, 0, 0)), "quaternion"),
        (lambda s: s.set_pose("explorers/sbot_0", (0, 0, 0), 1e100), "yaw is 1e\\+100, expected an angle from -1e6"),
        (lambda s: s.spawn("sbot", (0, 0, 0), yaw=math.nan), "yaw is nan"),
        (lambda s: s.apply_force("explorers/sbot_0", duration=-1), "duration is -1"),
        (lambda s: s.spawn("<sdf>"), "sdf"),
        (lambda s: s.robots[0].observation_channels.index("proximity/99/reading"), "the nearest are proximity/"),
        (lambda s: cohort.Simulation("obstacle_avoidanc"), "did you mean obstacle_avoidance"),
        (lambda s: cohort.Simulation("chain", threads=0), "threads is 0"),
    ],
)
def test_invalid_arguments_are_named(simulation, call, message):
    with pytest.raises((ValueError, LookupError, FileNotFoundError), match=message):
        call(simulation)


def test_a_second_thread_is_refused_while_the_first_steps(simulation):
    refused = []
    done = threading.Event()

    def use():
        while not done.is_set():
            try:
                simulation.step(5)
            except RuntimeError as error:
                refused.append(str(error))

    other = threading.Thread(target=use)
    other.start()
    while not refused:
        try:
            simulation.step(5)
        except RuntimeError as error:
            refused.append(str(error))
    done.set()
    other.join()
    assert set(refused) == {"another thread is using this object"}
    simulation.step()


def step_in_child(simulation, answers):
    try:
        simulation.step()
        answers.put("it stepped")
    except RuntimeError as error:
        answers.put(str(error))


def test_use_after_a_fork_is_an_error(simulation):
    context = multiprocessing.get_context("fork")
    answers = context.Queue()
    child = context.Process(target=step_in_child, args=(simulation, answers))
    child.start()
    assert "cannot be used after a fork" in answers.get(timeout=300)
    child.join()


def test_an_interrupted_simulation_continues_from_its_tick(simulation):
    simulation.commands[:, tracks_of(simulation)] = 0.1
    killer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    killer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.step(100_000_000)
    reached = simulation.tick
    assert reached > 0
    simulation.step(10)
    assert simulation.tick == reached + 10
    other = cohort.Simulation("obstacle_avoidance", seed=1)
    other.commands[:] = simulation.commands
    other.step(reached + 10)
    assert other.state_hash == simulation.state_hash


@pytest.mark.skipif("ASAN_OPTIONS" in os.environ, reason="AddressSanitizer keeps what is freed for a while")
def test_memory_does_not_grow_over_many_steps():
    batch = cohort.Batch("obstacle_avoidance", worlds=4)
    simulation = cohort.Simulation("obstacle_avoidance")

    def use(turns):
        for turn in range(turns):
            batch.reset(numpy.arange(4) + turn)
            batch.step(20)
            simulation.reset(seed=turn)
            simulation.step(20)
            simulation.observations, simulation.poses, simulation.contacts(), simulation.save()

    use(20)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    use(200)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before  # [KiB]
    assert grown < 4096


def test_a_world_without_a_file_of_an_experiment_runs():
    simulation = cohort.Simulation(cohort._files.worlds_folder() / "arenas/obstacles.sdf")
    simulation.step(5)
    assert simulation.tick == 5


def test_the_end_of_the_experiment_ends_a_run():
    simulation = cohort.Simulation("obstacle_avoidance", duration=1.0)
    calls = []
    simulation.run(each=lambda now: calls.append(now.tick))
    assert simulation.is_over and simulation.tick == 100 and calls == list(range(100))


def test_a_bound_that_a_policy_has_rounded_to_float32_acts_as_the_bound(simulation):
    upper = simulation.robots[0].command_channels["treel/left/velocity"].upper
    assert float(numpy.float32(upper)) > upper
    simulation.commands[:, tracks_of(simulation)] = numpy.float32(upper)
    simulation.step()
    assert simulation.commands[0, tracks_of(simulation)].tolist() == [upper, upper]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda batch: batch.robot_model(16), "no robot 16, expected a number below 16"),
        (lambda batch: batch.observation_channels(99), "no robot 99"),
        (lambda batch: batch.tick(2), "no world 2, expected a number below 2"),
        (lambda batch: batch.state_hash(7), "no world 7"),
        (lambda batch: batch.step(only=numpy.ones(3, dtype=bool)), "the selection has 3 worlds, expected 2"),
    ],
)
def test_a_missing_robot_or_world_of_a_batch_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call(cohort.Batch("obstacle_avoidance", worlds=2))


def test_nothing_is_read_while_another_thread_steps(simulation):
    stepping = threading.Thread(target=simulation.step, args=(20_000,))
    stepping.start()
    refused = set()
    while stepping.is_alive() and len(refused) < 3:
        for name in ("poses", "tick", "observations"):
            try:
                getattr(simulation, name)
            except RuntimeError:
                refused.add(name)
    stepping.join()
    assert refused == {"poses", "tick", "observations"}
    assert simulation.tick == 20_000
