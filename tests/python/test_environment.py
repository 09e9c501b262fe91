import json
import unittest

import numpy
from support import cube, cube_config, folder

import irdm
from irdm.environment import Lift, Palpate


def tissue():
    """A block with a stiff ball in it, fixed by its underside; the centre of mass is all but in the middle."""
    config = cube_config(
        mesh={"box": {"size": [0.09, 0.09, 0.036], "cells": [5, 5, 2]}},
        material={"youngs_modulus": 4000.0, "poisson_ratio": 0.45, "density": 1000.0, "rayleigh_alpha": 10.0},
        region=[{"ball": {"centre": [0.063, 0.054, 0.024], "radius": 0.012}, "youngs_modulus": 60000.0}],
        support={"half_space": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
        modes={"count": 200},
    )
    config["response"]["support"] = "fixed"
    return irdm.precompute(config, f"{folder.name}/tissue.h5")


def press(environment, down):
    """Goes down by so much in small moves and back up; the largest force [N]."""
    largest = 0.0
    for direction in (-1, 1):
        for _ in range(int(round(down / environment.largest_move))):
            observation, reward, ended, truncated, _ = environment.step([0, 0, direction * environment.largest_move, 0])
            assert not ended and not truncated and reward == -0.001
            largest = max(largest, observation["forces"][0, 2])
    return largest


def go(environment, place):
    """Moves the tip above a place of the task's frame."""
    for _ in range(40):
        way = place - environment._observation()["tips"][0, :2]
        environment.step([*way, 0, 0])


class PalpateTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = tissue()

    def test_a_search_by_touch_finds_it(self):
        """A grid of presses, by observations alone; the frame is turned at random."""
        environment = Palpate(self.model, (0.018, 0.009))
        environment.longest = 100_000
        places = [numpy.array([x, y]) for x in (-0.02, 0.0, 0.02) for y in (-0.02, 0.0, 0.02)]
        turns = set()
        for seed in range(4):
            environment.reset(seed)
            turns.add(tuple(environment._turn.ravel()))
            force = []
            for place in places:
                go(environment, place)
                force.append(press(environment, 0.008))
            # The grid of presses gives the quarter; the inclusion is at (18, 9) mm there.
            excess = numpy.array(force) - numpy.median(force)
            go(environment, places[int(numpy.argmax(excess))])
            *_, ended, truncated, info = environment.step([0, 0, 0, 1])
            self.assertTrue(ended and not truncated)
            self.assertLess(info["distance"], 0.012)
            with self.assertRaisesRegex(irdm.Error, "reset"):
                environment.step([0, 0, 0, 0])
        self.assertGreater(len(turns), 1)

    def test_too_much_force_hurts(self):
        environment = Palpate(self.model, (0.018, 0.009))
        environment.most_force = 0.2
        environment.reset(1)
        for _ in range(30):
            _, reward, ended, _, info = environment.step([0, 0, -0.002, 0])
            if ended:
                break
        self.assertEqual((reward, ended, info), (-1.0, True, {"hurt": True}))

    def test_same_seed_and_actions_same_bits(self):
        actions = numpy.random.default_rng(3).normal(size=(50, 4)) * [1e-3, 1e-3, 2e-3, 0]

        def run():
            environment = Palpate(self.model, (0.018, 0.009))
            seen = [environment.reset(5)[0]]
            seen += [environment.step(action)[0] for action in actions]
            return b"".join(one["forces"].tobytes() + one["tips"].tobytes() for one in seen)

        self.assertEqual(run(), run())

    def test_wrong_actions_are_refused(self):
        environment = Palpate(self.model, (0.018, 0.009))
        with self.assertRaisesRegex(irdm.Error, "reset"):
            environment.step([0, 0, 0, 0])
        environment.reset(0)
        for wrong in ([0, 0, 0], [0, 0, 0, numpy.nan], 1.0):
            with self.assertRaisesRegex(irdm.Error, "action"):
                environment.step(wrong)

    def test_episodes_are_truncated(self):
        environment = Palpate(self.model, (0.018, 0.009))
        environment.longest = 3
        environment.reset(0)
        ends = [environment.step([0, 0, 0, 0])[2:4] for _ in range(3)]
        self.assertEqual(ends, [(False, False), (False, False), (False, True)])


class LiftTest(unittest.TestCase):
    def lift(self, squeeze, most_force=None):
        """Closes the fingers by so much, lifts, and holds. Returns (rewards, last info)."""
        environment = Lift(cube(), most_force)
        environment.reset(0)
        rewards, info, closed = [], {}, 0.0
        for _ in range(environment.longest):
            move = min(0.0005, squeeze - closed)
            closed += move
            up = 0.001 if move == 0.0 and info.get("height", 0.0) < 0.055 else 0.0
            _, reward, ended, truncated, info = environment.step([move, up, 0, -move, up, 0])
            rewards.append(reward)
            if ended or truncated:
                break
        return rewards, info

    def test_a_firm_grip_lifts(self):
        rewards, info = self.lift(0.013)
        self.assertGreater(info["height"], 0.05)
        # All the height that was gained, and 1 for what was asked.
        self.assertAlmostEqual(sum(rewards), 1 + 10 * info["height"], places=9)

    def test_a_loose_grip_slips(self):
        rewards, info = self.lift(0.0055)
        self.assertLess(info["height"], 0.01)
        self.assertLess(sum(rewards), 0.2)

    def test_a_crushing_grip_ends_it(self):
        rewards, info = self.lift(0.04, most_force=2.0)
        self.assertEqual((rewards[-1], info), (-1.0, {"crushed": True}))

    def test_episodes_are_kept(self):
        """As robomimic has them: what was seen, done and won, line by line."""
        import h5py

        environment = Lift(cube())
        environment.observe_surface = True
        path = f"{folder.name}/episodes.h5"
        with irdm.Episodes(path, "lift", {"model": "cube.h5"}) as episodes:
            for length in (5, 3):
                seen, actions, rewards = [environment.reset(0)[0]], [], []
                for k in range(length):
                    actions.append([0.002, 0, 0, -0.002, 0, 0.0001 * k])
                    observation, reward, *_ = environment.step(actions[-1])
                    seen.append(observation)
                    rewards.append(reward)
                episodes.add(seen, actions, rewards)
            with self.assertRaisesRegex(irdm.Error, "does not fit"):
                episodes.add(seen, actions, rewards[1:])
            with self.assertRaisesRegex(irdm.Error, "different names"):
                episodes.add(seen[:-1] + [{}], actions, rewards)
        with h5py.File(path) as file:
            data = file["data"]
            self.assertEqual((sorted(data), data.attrs["total"]), (["demo_0", "demo_1"], 8))
            self.assertEqual(json.loads(data.attrs["env_args"])["env_name"], "lift")
            last = data["demo_1"]
            self.assertEqual(last.attrs["num_samples"], 3)
            numpy.testing.assert_array_equal(last["actions"], actions)
            numpy.testing.assert_array_equal(last["rewards"], rewards)
            self.assertEqual(last["dones"][:].tolist(), [0, 0, 1])
            for name in ("surface", "forces", "positions", "tips"):
                numpy.testing.assert_array_equal(last[f"obs/{name}"], [one[name] for one in seen[:-1]])
                numpy.testing.assert_array_equal(last[f"next_obs/{name}"], [one[name] for one in seen[1:]])
            self.assertGreater(abs(last["next_obs/forces"][:]).max(), 0.01)
            self.assertEqual(last["obs/surface"].shape, (3, len(cube().surface_nodes), 3))


if __name__ == "__main__":
    unittest.main()
