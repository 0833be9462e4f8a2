"""Bad input raises exceptions with numbers."""

import os
import threading

import numpy as np
import pytest

import farsa_gym

F32 = np.float32


@pytest.fixture
def envs():
    envs = farsa_gym.make_vec("hopper", 4, threads=1)
    envs.reset(seed=1)
    return envs


def test_actions_of_another_shape_or_dtype(envs):
    with pytest.raises(ValueError, match=r"shape \(3, 3\), not \(4, 3\)"):
        envs.step(np.zeros((3, 3), F32))
    with pytest.raises(ValueError, match=r"shape \(4,\), not \(4, 3\)"):
        envs.step(np.zeros(4, F32))
    with pytest.raises(TypeError, match="dtype complex128"):
        envs.step(np.zeros((4, 3), complex))
    with pytest.raises(TypeError, match="dtype object"):
        envs.step(np.full((4, 3), None))
    with pytest.raises(TypeError, match="dtype <U1"):
        envs.step(np.full((4, 3), "1"))
    # Other real numbers are converted, also from arrays that are not contiguous.
    envs.step(np.zeros((4, 3), np.float64))
    envs.step(np.zeros((3, 4), F32).T)
    envs.step([[0.5] * 3] * 4)


def test_actions_that_are_not_finite(envs):
    actions = np.zeros((4, 3), F32)
    actions[2, 1] = np.nan
    with pytest.raises(ValueError, match="action 1 of environment 2 is NaN"):
        envs.step(actions)
    single = farsa_gym.make("hopper")
    single.reset(seed=1)
    with pytest.raises(ValueError, match="action 0 of environment 0 is NaN"):
        single.step(np.full(3, np.nan, F32))
    # An infinite action is the end of the range.
    high, _ = single.reset(seed=1), single.step(np.full(3, np.inf, F32))
    other, _ = single.reset(seed=1), single.step(np.full(3, np.inf, F32))
    assert np.array_equal(high[0], other[0])
    assert np.array_equal(single.reset(seed=1)[0], high[0])
    infinite = single.step(np.full(3, np.inf, F32))[0]
    single.reset(seed=1)
    assert np.array_equal(infinite, single.step(np.ones(3, F32))[0])


def test_environments_that_cannot_be_made():
    with pytest.raises(ValueError, match="0 environments: there must be 1 to 1048576"):
        farsa_gym.make_vec("hopper", 0)
    with pytest.raises(ValueError, match="5 lanes; the nearest number is 8"):
        farsa_gym.make_vec("hopper", 4, lanes=5)
    with pytest.raises(ValueError, match="'Never' is not a valid AutoresetMode"):
        farsa_gym.make_vec("hopper", 4, autoreset="Never")
    with pytest.raises(ValueError, match="unknown experiment `hoper`; the nearest is `hopper`"):
        farsa_gym.make("hoper")
    with pytest.raises(ValueError, match="episode.steps"):
        farsa_gym.make("hopper", settings={"episode.step": 3})
    with pytest.raises(ValueError, match="-3"):
        farsa_gym.make("hopper", settings={"episode.steps": -3})
    with pytest.raises(TypeError, match="a setting is a"):
        farsa_gym.make("hopper", settings={"episode.steps": object()})
    with pytest.raises(OverflowError):
        farsa_gym.make_vec("hopper", -1)


def test_seeds_and_masks(envs):
    with pytest.raises(ValueError, match="3 seeds for 4 environments"):
        envs.reset(seed=[1, 2, 3])
    for mask, error, why in [
        (np.ones(3, bool), ValueError, r"shape \(3,\), not \(4,\)"),
        (np.zeros(4, bool), ValueError, "False for all 4"),
        (np.ones(4, int), TypeError, "is a int64"),
        ([True] * 4, TypeError, "is a list"),
    ]:
        with pytest.raises(error, match=why):
            envs.reset(options={"reset_mask": mask})
    with pytest.raises(ValueError, match=r"options\['trial'\] is 1: the experiment has 1 trials"):
        envs.reset(options={"trial": 1})
    with pytest.raises(ValueError, match="is -1, not a whole number from 0"):
        envs.reset(options={"generation": -1})


def test_a_step_before_the_reset_or_after_the_end():
    envs = farsa_gym.make_vec("discrimination", 2, autoreset="Disabled", settings={"trial.steps": 2})
    actions = np.zeros((2, 2), F32)
    with pytest.raises(RuntimeError, match="must be reset before its first step"):
        envs.step(actions)
    with pytest.raises(RuntimeError, match="the first reset needs all"):
        envs.reset(options={"reset_mask": np.array([True, False])})
    envs.reset(seed=1)
    envs.step(actions)
    assert envs.step(actions)[3].all()
    with pytest.raises(RuntimeError, match="the episode of environment 0 has ended"):
        envs.step(actions)
    envs.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(RuntimeError, match="the episode of environment 1 has ended"):
        envs.step(actions)


def test_a_closed_environment(envs):
    envs.close()
    envs.close()
    with pytest.raises(RuntimeError, match="the environment of 4 worlds is closed"):
        envs.step(np.zeros((4, 3), F32))
    single = farsa_gym.make("hopper")
    single.close()
    with pytest.raises(RuntimeError, match="the environment of 1 worlds is closed"):
        single.reset()


def test_two_threads_on_one_environment():
    envs = farsa_gym.make_vec("humanoid", 64, threads=1)
    envs.reset(seed=1)
    actions = np.full((64, 17), 0.5, F32)
    errors, steps = [], [0, 0]

    def work(place):
        for _ in range(30):
            try:
                envs.step(actions)
                steps[place] += 1
            except RuntimeError as error:
                errors.append(str(error))

    threads = [threading.Thread(target=work, args=(place,)) for place in range(2)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert sum(steps) + len(errors) == 60 and steps != [0, 0]
    assert set(errors) <= {"the environment of 64 worlds is in use by another thread"} and errors
    envs.step(actions)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_cannot_use_it():
    envs = farsa_gym.make_vec("hopper", 32, lanes=8, threads=2)
    envs.reset(seed=1)
    actions = np.zeros((32, 3), F32)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            envs.step(actions)
            os.write(write, b"no error")
        except RuntimeError as error:
            os.write(write, str(error).encode())
        finally:
            os._exit(0)
    os.close(write)
    message = os.read(read, 1000).decode()
    os.waitpid(child, 0)
    assert message == f"process {os.getpid()} made the environment, which process {child} cannot use after a fork"
    envs.step(actions)


def test_parameters_and_scores():
    evaluator = farsa_gym.Evaluator("discrimination", threads=1)
    count = len(evaluator.about["parameters"])
    with pytest.raises(ValueError, match=rf"individual 0 has 3 parameters where discrimination has {count}"):
        evaluator(np.zeros((2, 3)))
    with pytest.raises(ValueError, match=r"shape \(3,\), not \(individuals, numbers\)"):
        evaluator(np.zeros(3))
    with pytest.raises(ValueError, match=r"shape \(0, n\)"):
        evaluator(np.zeros((0, count)))
    with pytest.raises(TypeError, match="dtype complex128"):
        evaluator(np.zeros((2, count), complex))
    wrong = np.zeros((2, count))
    wrong[1, 0] = np.nan
    with pytest.raises(ValueError, match="individual 1: .* is NaN, outside"):
        evaluator(wrong)
    wrong[1, 0] = 1e9
    with pytest.raises(ValueError, match="individual 1: .* is 1000000000.0, outside"):
        evaluator(wrong)
    with pytest.raises(ValueError, match="2 populations"):
        farsa_gym.evaluate("predator-prey", np.zeros((1, 2)))
    with pytest.raises(ValueError, match="observations are normalized"):
        farsa_gym.evaluate("hopper", np.zeros((1, 36)))
    strategy = farsa_gym.Strategy("cma-es", genes=5)
    with pytest.raises(ValueError, match=r"scores have the shape \[3, 1\], not \["):
        strategy.tell(np.zeros(3))
    with pytest.raises(ValueError, match="unknown strategy `cmaes`; the nearest is `cma-es`"):
        farsa_gym.Strategy("cmaes", genes=5)
    with pytest.raises(ValueError, match="0 genes: there must be 1 to"):
        farsa_gym.Strategy("cma-es", genes=0)
    with pytest.raises(ValueError):
        strategy.restore(b"no state")
    with pytest.raises(OSError):
        farsa_gym.load_run("no-such-run")
    with pytest.raises(RuntimeError, match="exit code 2: .*hoper"):
        farsa_gym.command(["info", "hoper"])
