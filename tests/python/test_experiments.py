# SPDX-License-Identifier: Apache-2.0

"""Experiments that are made and run in Python."""

import pickle

import cohort
import pytest


def arena():
    return cohort._files.worlds_folder() / "arenas/obstacles.sdf"


class Forward(cohort.Controller):
    def start(self, start):
        self.speed = start.parameters.real("speed", 0.05)
        self.tracks = start.commands("treel/*/velocity", 2)

    def step(self, observation, command):
        command[self.tracks] = self.speed


def made(**keys):
    given = {"world": arena(), "duration": 2, "teams": [{"name": "explorers", "robots": "explorers/*"}]}
    return cohort.Experiment(**given | keys)


def test_keys_of_files_are_arguments():
    experiment = made(seed=3, step=0.02, teams=[{"name": "explorers", "robots": "explorers/*", "period": 2}])
    assert (experiment.seed, experiment.step, experiment.duration) == (3, 0.02, 2.0)
    assert experiment.teams[0].period == 2 and len(experiment.teams[0].robots) == len(experiment.robots)


def test_an_experiment_made_in_python_is_the_one_of_the_file():
    team = {"name": "explorers", "robots": "explorers/*", "controller": "obstacle_avoidance"}
    experiment = made(duration=5, seed=1, teams=[team])
    assert experiment.run().state_hash == cohort.run("obstacle_avoidance", duration=5).state_hash


def test_parameters_reach_the_controller():
    slow, fast = (
        made(teams=[{"name": "explorers", "robots": "explorers/*", "parameters": {"speed": speed}}]).run(Forward)
        for speed in (0.05, 0.1)
    )
    assert slow.state_hash == made().run(Forward).state_hash != fast.state_hash


@pytest.mark.parametrize(
    ("parameters", "message"),
    [({"sped": 0.1}, "sped"), ({"speed": "fast"}, "parameter 'speed': expected a number")],
)
def test_parameters_that_are_wrong_end_the_run(parameters, message):
    experiment = made(teams=[{"name": "explorers", "robots": "explorers/*", "parameters": parameters}])
    with pytest.raises(RuntimeError, match=message):
        experiment.run(Forward)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"durration": 3}, "durration"),
        ({"duration": -1}, "duration"),
        ({"world": "nowhere.sdf"}, "nowhere.sdf"),
        ({"teams": [{"name": "explorers", "robots": "nobody/*"}]}, "nobody"),
    ],
)
def test_mistakes_have_the_messages_of_check(keys, message):
    with pytest.raises(cohort.InputError, match=f"^Experiment: .*{message}") as refused:
        made(**keys)
    assert "experiment.yaml" not in str(refused.value)


def test_each_team_has_its_own_controller():
    experiment = made(
        teams=[
            {"name": "first", "robots": "explorers/sbot_0"},
            {
                "name": "others",
                "robots": [f"explorers/sbot_{i}" for i in range(1, 16)],
                "controller": "obstacle_avoidance",
            },
        ]
    )
    alone = experiment.run({"first": Forward})
    assert alone.state_hash != experiment.run().state_hash
    with pytest.raises(ValueError, match="unknown team 'frist'"):
        experiment.run({"frist": Forward})


def test_an_invalid_controller_is_named():
    with pytest.raises(RuntimeError, match="returned a object, expected a cohort.Controller"):
        made().run(object)


def test_results_of_seeds_are_a_table():
    table = cohort.run_seeds(made(duration=1), [4, 9], Forward)
    assert list(table.index) == [4, 9] and list(table.ticks) == [100, 100]
    assert table.state_hash[9] == made(duration=1, seed=9).run(Forward).state_hash


def test_a_run_is_recorded(tmp_path, cohort_program):
    made().run(Forward, record=tmp_path / "run.mcap")
    assert "identical" in cohort_program("replay", str(tmp_path / "run.mcap"), "--verify")


def test_values_replace_those_of_the_experiment_and_its_world(tmp_path, cohort_program):
    experiment = made()
    changed = experiment.with_values({"duration": 1, "teams.explorers.period": 2, "world.gravity": [0, 0, -1.6]})
    assert (changed.duration, changed.teams[0].period) == (1.0, 2)
    result = changed.run(Forward, record=tmp_path / "run.mcap")
    assert result.state_hash == pickle.loads(pickle.dumps(changed)).run(Forward).state_hash
    on_earth = experiment.with_values({"duration": 1, "teams.explorers.period": 2})
    assert result.state_hash != on_earth.run(Forward).state_hash
    assert "identical" in cohort_program("replay", str(tmp_path / "run.mcap"), "--verify")
    with pytest.raises(cohort.InputError, match="no item 'explorer'; did you mean 'explorers'"):
        experiment.with_values({"teams.explorer.period": 2})


def test_a_world_is_made_with_the_keys_of_sdf():
    world = {
        "name": "field",
        "model": [
            {
                "name": "ground",
                "static": True,
                "link": {"name": "body", "collision": {"name": "floor", "geometry": {"plane": {}}}},
            }
        ],
        "include": [{"uri": "model://sbot", "name": f"sbot_{i}", "pose": [0.3 * i, 0, 0, 0, 0, 0]} for i in range(3)],
    }
    experiment = made(world=world, teams=[{"name": "all", "robots": "*", "controller": Forward}])
    assert experiment.robots == ["sbot_0", "sbot_1", "sbot_2"]
    simulation = cohort.Simulation(experiment)
    assert simulation.poses[:, 0].tolist() == pytest.approx([0.0, 0.3, 0.6])
    assert experiment.run().ticks == 200
    with pytest.raises(cohort.InputError, match="^Experiment: .*gravitie"):
        made(world=world | {"gravitie": 3}, teams=[])
