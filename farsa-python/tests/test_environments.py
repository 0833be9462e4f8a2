"""Environments: Gymnasium's checks, and equal bits alone, in lanes and in threads."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import farsa_gym
from farsa_gym.environments import STEPPED, environment_id

MODES = ["SameStep", "NextStep", "Disabled"]
# Short episodes of an articulated robot, and of a robot on wheels with noise.
EXPERIMENTS = {
    "hopper": {},
    "discrimination": {"settings": {"trial.steps": 40}},
}


def same(a, b):
    """Compares infos to the bit."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray) and a.dtype == object:
        return a.shape == b.shape and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    return a == b


@pytest.mark.parametrize("experiment", STEPPED)
def test_every_registered_experiment_steps(experiment):
    env = gymnasium.make(environment_id(experiment))
    check_env(env.unwrapped, skip_render_check=True)
    env.close()
    envs = gymnasium.make_vec(environment_id(experiment), num_envs=3)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    observations, _ = envs.reset(seed=5)
    assert observations.shape == envs.observation_space.shape and observations.dtype == np.float32
    envs.close()


def test_the_other_experiments_are_refused_with_the_reason():
    # `push-box` needs rapier, which a smaller wheel lacks.
    refused = {name for name, _ in farsa_gym.experiments()} - {*STEPPED, "push-box"}
    for experiment in refused:
        with pytest.raises(ValueError, match="cannot be stepped: "):
            farsa_gym.make(experiment)
    with pytest.raises(ValueError, match=r"it has \d+ robots, and an action is for one"):
        farsa_gym.make("foraging")
    with pytest.raises(ValueError, match="2 populations"):
        farsa_gym.make("predator-prey")


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_a_vector_equals_single_environments_to_the_bit(experiment, mode):
    keywords = EXPERIMENTS[experiment]
    # 10^5 steps over all modes and both experiments.
    count, steps = 19, 900
    reference = SyncVectorEnv(
        [lambda: farsa_gym.make(experiment, **keywords)] * count, autoreset_mode=AutoresetMode(mode)
    )
    shapes = [(1, 1), (8, 1), (8, 2), (16, 2)]
    ours = [
        farsa_gym.make_vec(experiment, count, lanes=lanes, threads=threads, autoreset=mode, **keywords)
        for lanes, threads in shapes
    ]
    assert [(env.lanes, env.threads) for env in ours] == shapes
    generator = np.random.default_rng(1)
    expected, _ = reference.reset(seed=7)
    for env in ours:
        assert np.array_equal(env.reset(seed=7)[0], expected)
    ends = 0
    for step in range(steps):
        actions = generator.random((count, ours[0].single_action_space.shape[0]), dtype=np.float32)
        expected = reference.step(actions)
        ended = expected[2] | expected[3]
        ends += int(ended.sum())
        for env in ours:
            found = env.step(actions)
            for k in range(4):
                assert found[k].dtype == expected[k].dtype
                assert np.array_equal(found[k], expected[k]), (step, k)
            assert same(found[4], expected[4]), (step, found[4], expected[4])
        if mode == "Disabled" and ended.any():
            # Some go on with their episodes, one gets a new seed.
            seeds = [11 if number == ended.argmax() else None for number in range(count)]
            expected, _ = reference.reset(seed=seeds, options={"reset_mask": ended.copy()})
            for env in ours:
                assert np.array_equal(env.reset(seed=seeds, options={"reset_mask": ended})[0], expected)
    assert ends > count, ends


def test_rewards_sum_to_the_fitness_of_the_trial():
    for experiment, keywords in EXPERIMENTS.items():
        env = farsa_gym.make(experiment, **keywords)
        env.action_space.seed(2)
        for episode in range(3):
            env.reset(seed=1 if episode == 0 else None)
            total, done = 0.0, False
            while not done:
                _, reward, terminated, truncated, info = env.step(env.action_space.sample())
                total += reward
                done = terminated or truncated
            assert not info["failed"]
            assert total == pytest.approx(info["fitness"], rel=1e-9)
            assert sum(info["terms"].values()) == pytest.approx(info["fitness"], rel=1e-12)


def test_an_episode_named_by_options_is_the_trial_of_a_run():
    env = farsa_gym.make("discrimination")
    trials = env.about["trials"]
    assert trials > 1
    first, _ = env.reset(options={"seed": 3, "generation": 2, "individual": 1, "trial": trials - 1})
    following, _ = env.reset()
    again, _ = env.reset(options={"seed": 3, "generation": 3, "individual": 1})
    assert np.array_equal(following, again) and not np.array_equal(first, following)


def test_a_step_without_copy_returns_the_live_array():
    live = farsa_gym.make_vec("hopper", 2, copy=False)
    first, _ = live.reset(seed=1)
    before = first.copy()
    second = live.step(live.action_space.sample())[0]
    assert second is first and not np.array_equal(before, first)
    copied = farsa_gym.make_vec("hopper", 2)
    assert copied.reset(seed=1)[0] is not copied.reset(seed=1)[0]


def test_an_experiment_file_is_an_environment(tmp_path):
    farsa_gym.command(["new", str(tmp_path / "lamp.toml"), "--from", "light", "--quiet"])
    envs = farsa_gym.make_vec(tmp_path / "lamp.toml", 5)
    total = np.zeros(5)
    envs.reset(seed=1)
    while True:
        _, rewards, _, truncated, infos = envs.step(np.ones((5, 2), dtype=np.float32))
        total += rewards
        if truncated.any():
            break
    assert truncated.all() and infos["_final_info"].all()
    assert infos["final_info"]["fitness"] == pytest.approx(total)


def test_pictures_are_arrays():
    single = farsa_gym.make("hopper", render_mode="rgb_array")
    with pytest.raises(RuntimeError, match="must be reset before it is drawn"):
        single.render()
    single.reset(seed=1)
    first = single.render()
    assert first.shape == (320, 480, 3) and first.dtype == np.uint8 and len(np.unique(first)) > 10
    for _ in range(5):
        single.step(np.zeros(3, np.float32))
    assert not np.array_equal(first, single.render())
    envs = farsa_gym.make_vec("hopper", 2, lanes=8, render_mode="rgb_array")
    envs.reset(seed=1)
    assert np.array_equal(envs.render()[0], first) and len(envs.render()) == 2
    with pytest.raises(ValueError, match="environment 2 of 2"):
        envs._worlds.render(2)
    with pytest.raises(ValueError, match="8 x 320"):
        envs._worlds.render(0, 8)
    assert farsa_gym.make("hopper").render() is None
