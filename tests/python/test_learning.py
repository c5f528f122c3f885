# SPDX-License-Identifier: Apache-2.0

"""Learning environments: what Gymnasium and PettingZoo ask of them, and the same trajectories for the same seeds."""

import copy
import pickle
import warnings

import cohort
import cohort.gym
import gymnasium
import numpy
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from pettingzoo.test import parallel_api_test, parallel_seed_test

ONE_ROBOT = """
world: {world}
duration: 20
teams: [{{name: explorers, robots: all, period: 1}}]
"""


def reward(state):
    return state.commands_of("treel/*/velocity").mean(axis=(1, 2)) - state["proximity/*/reading"].max(axis=(1, 2))


def environments(num_envs, **arguments):
    given = {
        "reward": reward,
        "horizon": 7,
        "observe": ["proximity/*/reading"],
        "act": ["treel/*/velocity"],
    } | arguments
    return cohort.gym.VectorEnv("obstacle_avoidance", num_envs, **given)


def trajectory(envs, seed, steps, which=slice(None)):
    """Returns all that an environment gives, with actions that are a function of step and environment's seed alone."""
    observations, _ = envs.reset(seed=seed)
    seen = [observations[which]]
    low, high = envs.single_action_space.low, envs.single_action_space.high
    for step in range(steps):
        shares = 0.5 + 0.5 * numpy.sin(0.3 * step + numpy.arange(len(low)))
        actions = numpy.tile(low + shares * (high - low), (envs.num_envs, 1)).astype(numpy.float32)
        observations, rewards, terminations, truncations, _ = envs.step(actions)
        seen += [observations[which], rewards[which], terminations[which], truncations[which]]
    return seen


def assert_same(first, second):
    assert len(first) == len(second)
    for one, other in zip(first, second):
        numpy.testing.assert_array_equal(one, other)


def test_gymnasiums_checker_accepts_the_environment():
    env = cohort.gym.Env("obstacle_avoidance", reward=reward, horizon=20, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(infinity|symmetric and normalized|spec).*")
        check_env(env)


def test_pettingzoos_test_accepts_the_environment_of_many_agents():
    def each(state):
        return -state["proximity/*/reading"].max(axis=2)

    def make():
        return cohort.gym.parallel_env("obstacle_avoidance", reward=each, horizon=30)

    parallel_api_test(make(), num_cycles=100)
    parallel_seed_test(make, num_cycles=10)


def test_tasks_have_an_id():
    env = gymnasium.make("cohort/ObstacleAvoidance-v0", render_mode="rgb_array")
    env.reset(seed=1)
    assert env.action_space.shape == (32,)
    reward, ended, truncated = env.step(env.action_space.high)[1:4]
    assert isinstance(reward, float) and not ended and not truncated
    assert env.render().shape == (240, 320, 3)
    envs = gymnasium.make_vec("cohort/Aggregation-v0", num_envs=2, vectorization_mode="vector_entry_point")
    envs.reset(seed=1)
    assert (envs.step(envs.action_space.high)[1] < -0.1).all()


def test_the_reward_of_one_world_may_be_a_number():
    env = cohort.gym.Env("obstacle_avoidance", reward=lambda state: 2, done=lambda state: True)
    env.reset(seed=1)
    assert env.step(env.action_space.high)[1:3] == (2.0, True)


def test_a_picture_shows_robots_where_they_are():
    batch = cohort.Batch("obstacle_avoidance", worlds=2)
    batch.reset(numpy.array([1, 2]))
    for world in range(2):
        for x, y, z, *_ in batch.poses[world]:
            picture = batch.render(world, 64, 48, position=(x, y - 1.0, z + 1.0), target=(x, y, z + 0.05))
            red, green, blue = picture[24, 32].astype(float)
            assert red > 1.5 * green and red > 3.0 * blue, "the hull of an s-bot is orange"
    assert batch.render(0, 64, 48).shape == (48, 64, 3)
    assert (batch.render(0) != batch.render(1)).any()
    with pytest.raises(ValueError, match="the picture has 0 x 240 pixels, expected 1 to 4096"):
        batch.render(0, width=0)
    with pytest.raises(ValueError, match="finite"):
        batch.render(0, position=(numpy.nan, 0, 0))


def test_an_unknown_render_mode_is_named():
    with pytest.raises(ValueError, match="render_mode is 'human', expected None or one of \\['rgb_array'\\]"):
        environments(1, render_mode="human")


def test_pickled_and_copied_environments_give_the_same_trajectories():
    envs = environments(2, robots="explorers/sbot_1")
    expected = trajectory(envs, 3, 10)
    for other in (pickle.loads(pickle.dumps(envs)), copy.deepcopy(envs)):
        assert_same(expected, trajectory(other, 3, 10))


def test_a_pickled_experiment_contains_its_files(tmp_path):
    world = tmp_path / "world.yaml"
    world.write_text("{world: {name: w, include: {uri: 'model://sbot', name: a}}}")
    experiment = cohort.Experiment(
        folder=tmp_path, world="world.yaml", duration=1, seed=7, teams=[{"name": "t", "robots": "all"}]
    )
    expected = cohort.run_seeds(experiment, [3]).state_hash[3]
    pickled = pickle.dumps(experiment)
    world.unlink()
    again = pickle.loads(pickled)
    assert (again.seed, again.duration, again.robots) == (7, 1.0, ["a"])
    assert cohort.run_seeds(again, [3]).state_hash[3] == expected
    assert copy.deepcopy(again).run().state_hash == experiment.run().state_hash


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("num_envs", [1, 3, 8])
def test_the_same_seeds_give_the_same_trajectories(num_envs, threads):
    alone = trajectory(environments(1), 5, 25, 0)
    assert_same(alone, trajectory(environments(num_envs, threads=threads), 5, 25, 0))
    last = num_envs - 1
    assert_same(
        trajectory(environments(1), 5 + last, 25, 0), trajectory(environments(num_envs, threads=threads), 5, 25, last)
    )


def test_the_first_episode_is_the_experiment_with_that_seed():
    envs = environments(3, horizon=None)
    envs.reset(seed=11)
    for _ in range(50):
        envs.step(numpy.full(envs.action_space.shape, 0.1, dtype=numpy.float32))
    simulation = cohort.Simulation("obstacle_avoidance", seed=12)
    tracks = simulation.robots[0].command_channels.indices("treel/*/velocity")
    simulation.commands[:, tracks] = numpy.float32(0.1)
    simulation.step(50)
    assert envs.worlds.batch.state_hash(1) == simulation.state_hash


def test_next_step_mode_resets_in_the_step_after_the_end():
    envs = environments(2, horizon=3)
    envs.reset(seed=1)
    actions = numpy.full(envs.action_space.shape, 0.2, dtype=numpy.float32)
    ends = [envs.step(actions)[3].tolist() for _ in range(8)]
    assert ends == [[False] * 2, [False] * 2, [True] * 2, [False] * 2] * 2
    assert envs.metadata["autoreset_mode"] == AutoresetMode.NEXT_STEP


def test_same_step_mode_gives_the_last_observation_and_begins_the_next_episode():
    envs = environments(2, horizon=3, autoreset_mode=AutoresetMode.SAME_STEP)
    going_on = environments(2, horizon=None, autoreset_mode=AutoresetMode.DISABLED)
    first, _ = envs.reset(seed=1)
    going_on.reset(seed=1)
    actions = numpy.full(envs.action_space.shape, 0.2, dtype=numpy.float32)
    for _ in range(3):
        observations, _, _, truncations, infos = envs.step(actions)
        last = going_on.step(actions)[0]
    assert truncations.all() and infos["_final_obs"].all()
    numpy.testing.assert_array_equal(numpy.stack(infos["final_obs"]), last)
    assert envs.worlds.state.steps.tolist() == [0, 0]


def test_disabled_mode_resets_the_environments_in_the_mask():
    envs = environments(3, horizon=None, autoreset_mode=AutoresetMode.DISABLED)
    envs.reset(seed=1)
    actions = numpy.full(envs.action_space.shape, 0.2, dtype=numpy.float32)
    for _ in range(4):
        envs.step(actions)
    mask = numpy.array([False, True, False])
    envs.reset(options={"reset_mask": mask})
    assert [envs.worlds.batch.tick(env) for env in range(3)] == [4, 0, 4]
    with pytest.raises(ValueError, match="at least one True"):
        envs.reset(options={"reset_mask": numpy.zeros(3, dtype=bool)})


def test_wrappers_of_gymnasium_work():
    envs = gymnasium.wrappers.vector.RecordEpisodeStatistics(environments(2, horizon=3))
    envs.reset(seed=1)
    actions = numpy.zeros(envs.action_space.shape, dtype=numpy.float32)
    infos = [envs.step(actions)[4] for _ in range(3)][-1]
    assert infos["episode"]["l"].tolist() == [3, 3]


def test_spaces_have_the_bounds_of_channels():
    envs = environments(2, robots="explorers/sbot_0")
    assert envs.single_observation_space.shape == (15,)
    channels = cohort.Simulation("obstacle_avoidance").robots[0].command_channels
    assert envs.single_action_space.high.tolist() == [numpy.float32(channels["treel/left/velocity"].upper)] * 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"observe": ["proximty/*"]}, "no channel matches 'proximty/\\*'"),
        ({"robots": "explorers/epuck"}, "no robot matches 'explorers/epuck'"),
        ({"horizon": 0}, "horizon is 0"),
    ],
)
def test_invalid_arguments_are_named(arguments, message):
    with pytest.raises((ValueError, LookupError), match=message):
        environments(1, **arguments)


def test_invalid_actions_are_named():
    envs = environments(2)
    envs.reset(seed=1)
    actions = numpy.zeros(envs.action_space.shape, dtype=numpy.float32)
    with pytest.raises(ValueError, match="expected \\(2, 32\\)"):
        envs.step(actions[:1])
    actions[1, 2] = numpy.nan
    with pytest.raises(ValueError, match="environment 1, robot explorers/sbot_1, value 0 is not finite"):
        envs.step(actions)


def test_rewards_of_another_shape_are_named():
    envs = environments(2, reward=lambda state: numpy.zeros(3))
    envs.reset(seed=1)
    with pytest.raises(ValueError, match="reward\\(state\\) returned shape \\(3,\\), expected \\(2,\\)"):
        envs.step(numpy.zeros(envs.action_space.shape, dtype=numpy.float32))
