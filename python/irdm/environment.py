"""Tasks of touch for learning and control, in the manner of gymnasium: reset(), step(), spaces as plain data."""

from dataclasses import dataclass

import numpy

from irdm import _core
from irdm.scene import Simulation


@dataclass(frozen=True)
class Box:
    """Arrays of this shape between low and high (the same for all numbers of a row, or an array of this shape)."""

    shape: tuple
    low: object
    high: object
    dtype: type = numpy.float64


class Environment:
    """A scene, styluses that move by actions, and a task.

    An action holds the move of each tip in one action step [m], and what the task asks besides; moves are cut to
    `largest_move`. `steps_per_action` force steps are made, in which the tips move evenly. The same seed and actions give
    the same bits.

    action_space, observation_space: Box, and dict of Box. observe_surface: True adds "surface" to observations, the places
    of the nodes of the first object (n, 3) [m].
    """

    largest_move = 0.002  # of a tip along each axis in an action [m]
    longest = 500  # actions, after which an episode is truncated

    def __init__(self, scene, starts, steps_per_action=10, more_actions=0):
        self.observe_surface = False
        self.simulation = Simulation(scene)
        self.steps_per_action = steps_per_action
        self._starts = numpy.asarray(starts, dtype=float)
        self._random = numpy.random.default_rng()
        self._last = None
        styluses = len(self._starts)
        high = numpy.append(numpy.full(3 * styluses, self.largest_move), numpy.ones(more_actions))
        self.action_space = Box((len(high),), -high, high)
        self.observation_space = {
            "tips": Box((styluses, 3), -1.0, 1.0),
            "forces": Box((styluses, 3), -100.0, 100.0),
            "positions": Box((len(self.simulation.object_names), 3), -1.0, 1.0),
            "velocities": Box((len(self.simulation.object_names), 3), -100.0, 100.0),
        }

    def reset(self, seed=None):
        """Begins an episode. seed: of all that is random from now on, or None. Returns (observation, info)."""
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        self.simulation.reset()
        self.tips = self._starts.copy()
        self._actions = 0
        self._begin()
        self._last = self.simulation.step(self.tips)
        return self._observation(), {}

    def step(self, action):
        """One action: an array of action_space. Returns (observation, reward, terminated, truncated, info).

        Raises irdm.Error where it has another shape, is not finite, or the episode has ended.
        """
        if self._last is None:
            raise _core.Error("step: no episode is under way; call reset()")
        try:
            action = _core.numbers(action, "action", self.action_space.shape)
        except (TypeError, ValueError) as error:
            raise _core.Error(f"{error}; see action_space") from error
        if not numpy.isfinite(action).all():
            raise _core.Error(f"action: is not {self.action_space.shape[0]} finite numbers; see action_space")
        action = action.clip(self.action_space.low, self.action_space.high)
        moves = self._to_world(action[: self.tips.size].reshape(self.tips.shape))
        share = numpy.arange(1, self.steps_per_action + 1)[:, None, None] / self.steps_per_action
        steps = self.simulation.step_many(self.tips + share * moves)
        self.tips = self.tips + moves
        self._last = _LastStep(steps)
        self._actions += 1
        reward, terminated, info = self._judge(steps, action[self.tips.size :])
        observation, truncated = self._observation(), self._actions >= self.longest
        if terminated or truncated:
            self._last = None
        return observation, float(reward), bool(terminated), bool(truncated and not terminated), info

    def _observation(self):
        turned = self._to_task
        surface = {"surface": turned(self.simulation.surface(0))} if self.observe_surface else {}
        return surface | {
            "tips": turned(self.tips),
            "forces": turned(self._last.styluses["force"]),
            "positions": turned(self._last.objects["position"]),
            "velocities": turned(self._last.objects["velocity"]),
        }

    def _begin(self):
        pass

    def _to_world(self, vectors):
        return vectors

    def _to_task(self, vectors):
        return numpy.array(vectors)

    def _judge(self, steps, answer):
        raise NotImplementedError


class _LastStep:
    """The end of many steps, with the members of Step that observations have."""

    def __init__(self, steps):
        self.styluses, self.objects = steps.styluses[-1], steps.objects[-1]


class Palpate(Environment):
    """Find the stiff inclusion in soft tissue: a fingertip, and an answer.

    model: fixed by its underside, top towards z. inclusion: its place, x, y from the centre of mass [m]. The task's frame is
    turned by a random number of quarters about z in each episode. The last number of an action above 0.5 answers "here" and
    ends the episode: reward 1 within `near` of the inclusion, else 0. Each action costs 0.001; a force above `most_force`
    [N] hurts, ends the episode, and costs 1. info: "distance" to the inclusion at an answer [m].
    """

    near = 0.006
    most_force = 3.0

    def __init__(self, model, inclusion, steps_per_action=10):
        top = model.nodes[:, 2].max()
        scene = {"object": [{"model": model}], "stylus": [{"radius": 0.012, "coupling_stiffness": 2000}]}
        super().__init__(scene, [[0.0, 0.0, top + 0.002]], steps_per_action, more_actions=1)
        self.inclusion = numpy.asarray(inclusion, dtype=float)
        self._turn = numpy.eye(3)

    def _begin(self):
        angle = numpy.pi / 2 * self._random.integers(4)
        c, s = numpy.round(numpy.cos(angle)), numpy.round(numpy.sin(angle))
        self._turn = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])

    def _to_world(self, vectors):
        return vectors @ self._turn.T

    def _to_task(self, vectors):
        return numpy.asarray(vectors) @ self._turn

    def _judge(self, steps, answer):
        if numpy.linalg.norm(steps.styluses["force"], axis=-1).max() > self.most_force:
            return -1.0, True, {"hurt": True}
        if answer[0] <= 0.5:
            return -0.001, False, {}
        distance = float(numpy.linalg.norm(self.tips[0, :2] - self.inclusion))
        return float(distance <= self.near), True, {"distance": distance}


class Lift(Environment):
    """Lift a soft object from a table by friction, between two fingertips, without crushing it.

    model: a body that floats. The fingertips begin at both sides of it along x; up is y. Reward: the height gained in each
    action [m] times 10, and 1 when its centre of mass has been `height` [m] above where it lay for `hold` actions, which
    ends the episode. A force of a fingertip above `most_force` [N] crushes it, ends the episode, and costs 1.
    """

    height = 0.05
    hold = 25

    def __init__(self, model, most_force=None, friction=0.8, steps_per_action=10):
        low, high = model.nodes.min(axis=0), model.nodes.max(axis=0)
        weight = 9.81 * model.mass
        self.most_force = 3.0 * weight / friction if most_force is None else most_force
        scene = {
            "world": {"gravity": [0, -9.81, 0]},
            "object": [{"model": model, "position": [0, -low[1], 0], "friction": {"static": friction}}],
            "stylus": [{"radius": 0.25 * (high[1] - low[1]), "coupling_stiffness": 500}] * 2,
            "scenery": [{"name": "table", "plane": {}}],
        }
        super().__init__(scene, [[x, -low[1], 0] for x in (low[0] - 0.005, high[0] + 0.005)], steps_per_action)

    def _begin(self):
        self._rest = self._height = None
        self._held = 0

    def _judge(self, steps, answer):
        height = steps.objects["position"][-1, 0, 1]
        if self._rest is None:
            self._rest = self._height = height
        if numpy.linalg.norm(steps.styluses["force"], axis=-1).max() > self.most_force:
            return -1.0, True, {"crushed": True}
        reward, self._height = 10.0 * (height - self._height), height
        self._held = self._held + 1 if height - self._rest > self.height else 0
        done = self._held >= self.hold
        return reward + done, done, {"height": height - self._rest}
