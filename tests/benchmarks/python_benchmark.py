#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Prints a table of the cost of control steps in Python: Cohort, its batch as a lower bound, and other simulators.

    tools/dev/python-environment --benchmarks                          # prints a Python that has all of them
    PYTHONPATH=build/release/python PYTHON tests/benchmarks/python_benchmark.py [--seconds S] [--worlds N]

A step is one tick of 10 ms of one world: all robots sense and are commanded. Rows are measured in turns, so that other
load of the machine affects all alike. Medians and quartiles are robot-steps per second of CPU time. The output names
simulators that are not installed.
"""

import argparse
import functools
import pathlib
import statistics
import time

import cohort
import cohort.gym
import numpy

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
STEP = 0.01  # [s]

MUJOCO_MODEL = """
<mujoco><option timestep="0.01" integrator="implicitfast"/>
<worldbody><geom type="plane" size="5 5 0.1"/>{walls}
<body name="robot" pos="0 0 0.035"><freejoint/>
<geom type="cylinder" size="0.06 0.02" mass="0.5"/>
<geom type="sphere" size="0.012" pos="0.045 0 -0.023" mass="0.01" friction="0 0 0"/>
<geom type="sphere" size="0.012" pos="-0.045 0 -0.023" mass="0.01" friction="0 0 0"/>
<body pos="0 0.05 -0.01"><joint name="left" axis="0 1 0" damping="0.001" armature="0.0001"/>
<geom type="cylinder" size="0.025 0.008" euler="90 0 0" mass="0.05" friction="1 0.01 0.001"/></body>
<body pos="0 -0.05 -0.01"><joint name="right" axis="0 1 0" damping="0.001" armature="0.0001"/>
<geom type="cylinder" size="0.025 0.008" euler="90 0 0" mass="0.05" friction="1 0.01 0.001"/></body>
{sites}</body></worldbody>
<actuator><velocity joint="left" kv="0.05"/><velocity joint="right" kv="0.05"/></actuator>
<sensor>{sensors}</sensor></mujoco>
"""


def mujoco_model():
    import mujoco

    walls = "".join(
        f'<geom type="box" size="{size}" pos="{place}"/>'
        for size, place in (
            ("1 .02 .1", "0 1 .1"),
            ("1 .02 .1", "0 -1 .1"),
            (".02 1 .1", "1 0 .1"),
            (".02 1 .1", "-1 0 .1"),
        )
    )
    sites, sensors = "", ""
    for i in range(8):
        x, y = numpy.cos(i * numpy.pi / 4), numpy.sin(i * numpy.pi / 4)
        sites += f'<site name="s{i}" pos="{0.062 * x} {0.062 * y} 0" zaxis="{x} {y} 0"/>'
        sensors += f'<rangefinder site="s{i}" cutoff="0.2"/>'
    return mujoco.MjModel.from_xml_string(MUJOCO_MODEL.format(walls=walls, sites=sites, sensors=sensors))


class Rate:
    """A row: `advance()` makes robot-steps and returns how many."""

    def __init__(self, name, advance, threads=1):
        self.name, self.advance, self.threads = name, advance, threads
        self.cpu, self.wall = [], []

    def measure(self, seconds):
        cpu, wall, count = time.process_time(), time.perf_counter(), 0
        while time.perf_counter() - wall < seconds:
            count += self.advance()
        self.cpu.append(count / (time.process_time() - cpu))
        self.wall.append(count / (time.perf_counter() - wall))


def experiment(name, fidelity):
    file = SOURCE / "tests/data/batch" / f"{name}.yaml"
    text = file.read_text() + f"physics: {{fidelity: {fidelity}}}\n"
    return cohort.Experiment.read_text(text, folder=file.parent, duration=0)


def reward(state):
    return state["proximity/*/reading"].max(axis=(1, 2))


def vector_env(experiment, worlds, threads, ticks=1):
    envs = cohort.gym.VectorEnv(
        experiment, worlds, reward=reward, horizon=1000, observe=["proximity/*/reading"], act=["treel/*/velocity"],
        ticks_per_step=ticks, threads=threads,
    )  # fmt: skip
    envs.reset(seed=1)
    actions = numpy.tile(numpy.float32([0.08, 0.06]), (worlds, envs.single_action_space.shape[0] // 2))
    robots = len(envs.worlds.robots)

    def advance():
        envs.step(actions)
        return worlds * robots * ticks

    return advance


def batch(experiment, worlds, threads):
    batch = cohort.Batch(experiment, worlds, threads)
    batch.reset(numpy.arange(1, worlds + 1))
    tracks = batch.command_channels().indices("treel/*/velocity")
    batch.commands[:, :, tracks] = (0.08, 0.06)

    def advance():
        batch.step()
        return worlds * len(batch.robots)

    return advance


def mujoco_loop():
    import mujoco

    model = mujoco_model()
    data = mujoco.MjData(model)
    data.ctrl[:] = (3.2, 2.4)

    def advance():
        for _ in range(100):
            mujoco.mj_step(model, data)
            data.sensordata.copy()
        return 100

    return advance


def mujoco_rollout(threads):
    import mujoco
    from mujoco import rollout

    model = mujoco_model()
    datas = [mujoco.MjData(model) for _ in range(threads)]
    worlds, steps = 256, 10
    first = numpy.empty((worlds, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    mujoco.mj_getState(model, datas[0], first[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    first[:] = first[0]
    control = numpy.tile([3.2, 2.4], (worlds, steps, 1))
    runner = rollout.Rollout(nthread=threads)

    def advance():
        states, _ = runner.rollout(model, datas, first, control)
        first[:] = states[:, -1]
        return worlds * steps

    return advance


def pybullet_loop():
    import pybullet
    import pybullet_data

    client = pybullet.connect(pybullet.DIRECT)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
    pybullet.setGravity(0, 0, -9.81, physicsClientId=client)
    pybullet.setTimeStep(STEP, physicsClientId=client)
    pybullet.loadURDF("plane.urdf", physicsClientId=client)
    robot = pybullet.loadURDF("r2d2.urdf", [0, 0, 0.5], physicsClientId=client)
    wheels = [2, 3, 6, 7]
    angles = numpy.arange(8) * numpy.pi / 4
    rays = numpy.stack([numpy.cos(angles), numpy.sin(angles), numpy.zeros(8)], axis=1)

    def advance():
        for _ in range(10):
            pybullet.setJointMotorControlArray(
                robot, wheels, pybullet.VELOCITY_CONTROL, targetVelocities=[3, 3, 2, 2], physicsClientId=client
            )
            pybullet.stepSimulation(physicsClientId=client)
            position, _ = pybullet.getBasePositionAndOrientation(robot, physicsClientId=client)
            begin = numpy.asarray(position) + 0.4 * rays
            pybullet.rayTestBatch(begin.tolist(), (begin + 0.2 * rays).tolist(), physicsClientId=client)
        return 10

    return advance


def half_cheetah(count):
    import gymnasium

    envs = gymnasium.make_vec("HalfCheetah-v5", num_envs=count, vectorization_mode="sync")
    envs.reset(seed=1)
    actions = numpy.zeros(envs.action_space.shape, dtype=numpy.float32)

    def advance():
        envs.step(actions)
        return count

    return advance


def rows(worlds):
    for fidelity in ("treel", "planar"):
        alone = experiment("alone", fidelity)
        yield f"batch, {fidelity}, 1 robot", functools.partial(batch, alone, worlds, 1), 1
        yield f"VectorEnv, {fidelity}, 1 robot", functools.partial(vector_env, alone, worlds, 1), 1
        yield f"VectorEnv, {fidelity}, 1 robot, 2 threads", functools.partial(vector_env, alone, worlds, 2), 2
        yield f"VectorEnv, {fidelity}, 1 robot, 10 ticks a step", functools.partial(vector_env, alone, worlds, 1, 10), 1
        many = crowd_experiment(fidelity)
        yield f"batch, {fidelity}, 16 robots", functools.partial(batch, many, worlds, 1), 1
        yield f"VectorEnv, {fidelity}, 16 robots", functools.partial(vector_env, many, worlds, 1), 1
    yield "MuJoCo, 8 range finders, loop", mujoco_loop, 1
    yield "MuJoCo, mujoco.rollout, 256 x 10", functools.partial(mujoco_rollout, 1), 1
    yield "MuJoCo, mujoco.rollout, 256 x 10, 2 threads", functools.partial(mujoco_rollout, 2), 2
    yield "PyBullet, 8 rays", pybullet_loop, 1
    yield "HalfCheetah-v5, 16 environments (5 ticks a step)", functools.partial(half_cheetah, 16), 1


def crowd_experiment(fidelity):
    file = SOURCE / "worlds/experiments/obstacle_avoidance.yaml"
    text = file.read_text() + f"physics: {{fidelity: {fidelity}}}\n"
    return cohort.Experiment.read_text(text, folder=file.parent, duration=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=1.0, help="wall time of each measurement")
    parser.add_argument("--turns", type=int, default=5, help="measurements of each row")
    parser.add_argument("--worlds", type=int, default=256, help="worlds of Cohort's rows")
    parser.add_argument("--only", default="", help="rows with this text in their names")
    arguments = parser.parse_args()
    measured = []
    for name, make, threads in rows(arguments.worlds):
        if arguments.only not in name:
            continue
        try:
            measured.append(Rate(name, make(), threads))
        except ImportError as error:
            print(f"left out: {name} ({error})")
    for _ in range(arguments.turns):
        for rate in measured:
            rate.measure(arguments.seconds)
    print(f"{'':52} {'thousand robot-steps':>22} {'':>16} {'wall':>8}")
    print(f"{'':52} {'a CPU-second, median':>22} {'quartiles':>16} {'median':>8}")
    for rate in measured:
        low, median, high = statistics.quantiles(rate.cpu, n=4) if len(rate.cpu) > 1 else (rate.cpu[0],) * 3
        print(
            f"{rate.name:52} {median / 1e3:22.1f} {low / 1e3:7.1f} {high / 1e3:8.1f}"
            f" {statistics.median(rate.wall) / 1e3:8.1f}"
        )


if __name__ == "__main__":
    main()
