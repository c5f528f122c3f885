# SPDX-License-Identifier: Apache-2.0

"""A run in Python has the same bits as one of `cohort run`."""

import json

import cohort
import obstacle_avoidance_in_python
import pytest
import yaml_fields

SECONDS = 3


def hash_of_program(cohort_program, folder, experiment, *more):
    summary = folder / "summary.json"
    cohort_program(
        "run",
        str(experiment),
        "--controllers",
        "inprocess",
        "--quiet",
        "--summary",
        str(summary),
        "--duration",
        str(SECONDS),
        *more,
    )
    return int(json.loads(summary.read_text())["state_hash"], 16)


def test_nothing_that_a_run_needs_calls_functions_of_the_c_library():
    assert cohort._native.functions_not_portable() == []


# People drive `teleop`, which `cohort run` does not do in one process.
@pytest.mark.parametrize("name", [each for each in cohort.examples() if each != "teleop"])
def test_every_experiment_that_comes_with_cohort(name, cohort_program, tmp_path):
    result = cohort.run(name, duration=SECONDS, threads=2)
    assert result.state_hash == hash_of_program(cohort_program, tmp_path, name)


@pytest.mark.parametrize("dynamics", ["bullet", "cohort"])
@pytest.mark.parametrize("fidelity", ["articulated", "treel", "planar"])
def test_every_fidelity_and_dynamics(fidelity, dynamics, cohort_program, tmp_path):
    text = yaml_fields.of_example("obstacle_avoidance", physics={"fidelity": fidelity, "dynamics": dynamics})
    file = tmp_path / "experiment.yaml"
    file.write_text(text)
    experiment = cohort.Experiment.read_text(text, duration=SECONDS)
    assert experiment.run().state_hash == hash_of_program(cohort_program, tmp_path, file)


def test_a_controller_in_python_as_its_twin_in_cpp():
    twin = obstacle_avoidance_in_python.ObstacleAvoidance
    in_cpp = cohort.run("obstacle_avoidance", duration=20).state_hash
    assert cohort.run("obstacle_avoidance", twin, duration=20).state_hash == in_cpp
    assert cohort.run("obstacle_avoidance", twin, duration=20, threads=2).state_hash == in_cpp


def test_a_simulation_that_python_steps_as_one_with_controllers():
    class Forward(cohort.Controller):
        def start(self, start):
            self.tracks = start.commands("treel/*/velocity", 2)

        def step(self, observation, command):
            command[self.tracks] = 0.1

    result = cohort.run("obstacle_avoidance", Forward, duration=SECONDS)
    simulation = cohort.Simulation("obstacle_avoidance")
    simulation.commands[:, simulation.robots[0].command_channels.indices("treel/*/velocity")] = 0.1
    simulation.run(until=SECONDS)
    assert simulation.tick == result.ticks
    assert simulation.state_hash == result.state_hash
