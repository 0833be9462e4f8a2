"""Gymnasium environments of experiments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._farsa_gym import Problem, Worlds

Seed = int | Sequence[int | None] | None
#: Built-in experiments with one robot, whose steps take actions from outside.
STEPPED = (
    "ant",
    "braitenberg",
    "discrimination",
    "discrimination-cylinders",
    "g1-walk",
    "go1-joystick",
    "half-cheetah",
    "hopper",
    "humanoid",
    "reach-grasp-lift",
    "walker2d",
)
_ID = ("seed", "generation", "individual", "trial")


def environment_id(experiment: str) -> str:
    """Returns the name of an experiment in Gymnasium's registry."""
    return f"farsa/{''.join(word.capitalize() for word in experiment.split('-'))}-v0"


def register_all() -> None:
    """Registers the built-in experiments."""
    for experiment in STEPPED:
        if environment_id(experiment) not in gymnasium.registry:
            gymnasium.register(
                environment_id(experiment),
                entry_point="farsa_gym.environments:Env",
                vector_entry_point="farsa_gym.environments:VectorEnv",
                kwargs={"experiment": experiment},
            )


def _spaces(worlds: Worlds) -> tuple[Box, Box]:
    observations = Box(-np.inf, np.inf, (worlds.observation_size,), np.float32)
    return observations, Box(0.0, 1.0, (worlds.action_size,), np.float32)


def _row_of_actions(action: Any, shape: tuple[int, ...]) -> NDArray[np.float32]:
    values = np.asarray(action)
    if values.dtype.kind not in "fiu":
        raise TypeError(f"actions have the dtype {values.dtype}, not a real number such as float32")
    if values.shape != shape:
        raise ValueError(f"actions have the shape {values.shape}, not {shape}")
    return np.ascontiguousarray(values, dtype=np.float32)


def _drawn(generator: np.random.Generator) -> int:
    """Draws the seed of an environment's episodes."""
    return int(generator.integers(1 << 63))


def _start(options: Mapping[str, Any] | None, trials: int) -> tuple[int, int, int] | None:
    """Returns the episode that options name: its seed, individual and number."""
    named = {key: options[key] for key in _ID if key in options} if options else {}
    if not named:
        return None
    for key, value in named.items():
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 0:
            raise ValueError(f"options[{key!r}] is {value!r}, not a whole number from 0")
    if named.get("trial", 0) >= trials:
        raise ValueError(f"options['trial'] is {named['trial']}: the experiment has {trials} trials, from 0")
    number = int(named.get("generation", 0)) * trials + int(named.get("trial", 0))
    return int(named.get("seed", 1)), int(named.get("individual", 0)), number


def _end(about: Mapping[str, Any], ended: tuple[Any, ...]) -> dict[str, Any]:
    """Returns the info of the last step of an episode."""
    _, fitness, steps, success, failed, terms, _ = ended
    info: dict[str, Any] = {"fitness": fitness, "steps": steps, "failed": failed}
    if about["has_success"]:
        info["success"] = success
    if not failed:
        info["terms"] = dict(zip(about["terms"], terms, strict=True))
    return info


class Env(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """One world of an experiment with one robot.

    The observation is the input of the controller's network, and the action is its output, from 0 to 1. The reward is the
    increase of the trial's fitness. Episodes go through the trials of the experiment. A step whose numbers are not finite
    terminates the episode with reward 0 and `info["failed"]`.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"]}

    def __init__(
        self,
        experiment: str | PathLike[str],
        *,
        condition: str | None = None,
        settings: Mapping[str, Any] | None = None,
        render_mode: Literal["rgb_array"] | None = None,
    ) -> None:
        self.render_mode = render_mode
        problem = Problem(fspath(experiment), condition, None if settings is None else dict(settings))
        self.about = problem.about()
        self.metadata = {**self.metadata, "render_fps": 1.0 / (self.about["step_seconds"] or 1.0)}
        self._worlds = Worlds(problem, 1, 1, 1, "Disabled")
        self.observation_space, self.action_space = _spaces(self._worlds)
        self._seeded = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Starts the next episode, that of a seed, or that of `options` with seed, generation, individual and trial."""
        super().reset(seed=seed)
        start = _start(options, self.about["trials"])
        if start is None and (seed is not None or not self._seeded):
            start = (_drawn(self.np_random), 0, 0)
        self._worlds.reset([True], [start])
        self._seeded = True
        return self._worlds.observations[0].copy(), {}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Steps the world by an action."""
        row = _row_of_actions(action, (self._worlds.action_size,))
        rewards, terminated, truncated, ended = self._worlds.step(row[None])
        info = {} if ended is None else _end(self.about, ended[0])
        return self._worlds.observations[0].copy(), float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info

    def render(self) -> NDArray[np.uint8] | None:  # type: ignore[override]
        """Draws the world with `render_mode="rgb_array"`."""
        return None if self.render_mode is None else self._worlds.render(0)

    def close(self) -> None:
        """Frees the world."""
        self._worlds.close()


class VectorEnv(gymnasium.vector.VectorEnv[NDArray[np.float32], NDArray[np.float32], NDArray[Any]]):
    """Worlds of an experiment in SIMD lanes and threads, equal to the bit to a `SyncVectorEnv` of `Env`.

    With `copy=False` the returned observations are the array that the next step overwrites.
    """

    def __init__(
        self,
        experiment: str | PathLike[str],
        num_envs: int = 1,
        *,
        lanes: int | Literal["auto"] = "auto",
        threads: int = 0,
        autoreset: str | AutoresetMode = "SameStep",
        copy: bool = True,
        condition: str | None = None,
        settings: Mapping[str, Any] | None = None,
        render_mode: Literal["rgb_array"] | None = None,
    ) -> None:
        mode = AutoresetMode(autoreset)
        self.render_mode = render_mode
        self.metadata = {"render_modes": ["rgb_array"], "autoreset_mode": mode}
        problem = Problem(fspath(experiment), condition, None if settings is None else dict(settings))
        self.about = problem.about()
        self._worlds = Worlds(problem, num_envs, None if lanes == "auto" else lanes, threads, mode.value)
        self.num_envs, self.copy = num_envs, copy
        self.lanes, self.threads = self._worlds.lanes, self._worlds.threads
        self.single_observation_space, self.single_action_space = _spaces(self._worlds)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._shape = (num_envs, self._worlds.action_size)
        self._seeded = np.zeros(num_envs, dtype=np.bool_)
        self._observations = self._worlds.observations

    def reset(
        self, *, seed: Seed = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Starts episodes in all environments, or in those of `options["reset_mask"]`."""
        seeds = self._seeds(seed)
        mask = self._mask(options)
        named = _start(options, self.about["trials"])
        starts: list[tuple[int, int, int] | None] = []
        for number in range(self.num_envs):
            start = named
            if start is None and mask[number] and (seeds[number] is not None or not self._seeded[number]):
                start = (_drawn(seeding.np_random(seeds[number])[0]), 0, 0)
            starts.append(start)
        if isinstance(seed, int):
            super().reset(seed=seed)
        self._worlds.reset(mask.tolist(), starts)
        self._seeded |= mask
        return self._observed(), {}

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Steps all environments by the rows of actions."""
        if not (
            type(actions) is np.ndarray
            and actions.dtype == np.float32
            and actions.shape == self._shape
            and actions.flags.c_contiguous
        ):
            actions = _row_of_actions(actions, self._shape)
        rewards, terminated, truncated, ended = self._worlds.step(actions)
        infos: dict[str, Any] = {}
        for episode in ended or ():
            info = _end(self.about, episode)
            if episode[6] is not None:
                info = {"final_obs": episode[6], "final_info": info}
            infos = self._add_info(infos, info, episode[0])
        return self._observed(), rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:  # type: ignore[override]
        """Draws all worlds with `render_mode="rgb_array"`."""
        if self.render_mode is None:
            return None
        return tuple(self._worlds.render(number) for number in range(self.num_envs))

    def close_extras(self, **kwargs: Any) -> None:
        """Frees the worlds and ends the threads."""
        self._worlds.close()

    def _observed(self) -> NDArray[np.float32]:
        return self._observations.copy() if self.copy else self._observations

    def _seeds(self, seed: Seed) -> Sequence[int | None]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, (int, np.integer)):
            return [int(seed) + number for number in range(self.num_envs)]
        if len(seed) != self.num_envs:
            raise ValueError(f"{len(seed)} seeds for {self.num_envs} environments")
        return seed

    def _mask(self, options: Mapping[str, Any] | None) -> NDArray[np.bool_]:
        mask = (options or {}).get("reset_mask")
        if mask is None:
            return np.ones(self.num_envs, dtype=np.bool_)
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            found = mask.dtype if isinstance(mask, np.ndarray) else type(mask).__name__
            raise TypeError(f"options['reset_mask'] is a {found}, not an array of bool")
        if mask.shape != (self.num_envs,):
            raise ValueError(f"options['reset_mask'] has the shape {mask.shape}, not ({self.num_envs},)")
        if not mask.any():
            raise ValueError(f"options['reset_mask'] is False for all {self.num_envs} environments")
        return mask


def make(experiment: str | PathLike[str], **keywords: Any) -> Env:
    """Makes one environment of a built-in experiment or of an experiment file."""
    return Env(experiment, **keywords)


def make_vec(experiment: str | PathLike[str], num_envs: int = 1, **keywords: Any) -> VectorEnv:
    """Makes several environments of a built-in experiment or of an experiment file."""
    return VectorEnv(experiment, num_envs, **keywords)
