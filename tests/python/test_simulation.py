import os
import subprocess
import sys
import threading
import unittest

import numpy
from support import PRELOADED, block, cube, folder, scene

import irdm


def tips(steps):
    """Two fingers that press the cube from its sides and rub it: (steps, 2, 3) [m]."""
    k = numpy.arange(steps)
    depth = 0.004 * numpy.minimum(1, k / 150)
    z = 0.01 * numpy.sin(0.02 * k)
    one = numpy.stack([0.062 - depth, numpy.full(steps, 0.06), z], axis=-1)
    return numpy.stack([one, one * [-1, 1, 1]], axis=1)


class SimulationTest(unittest.TestCase):
    def test_one_stylus_needs_no_axis(self):
        table = scene(stylus=[{"radius": 0.02, "coupling_stiffness": 500}])
        way = tips(20)[:, 0]
        buttons = numpy.ones(20)
        short = irdm.Simulation(table).step_many(way, buttons)
        full = irdm.Simulation(table).step_many(way[:, None], buttons[:, None].astype(int))
        self.assertEqual(short.styluses.tobytes(), full.styluses.tobytes())
        with self.assertRaisesRegex(ValueError, r"give \(20, 1, 3\)"):
            irdm.Simulation(table).step_many(way.reshape(20, 3, 1))

    def test_ctrl_c(self):
        """step_many() ends soon, and the steps until then are done."""
        program = (
            "import numpy, os, signal, sys, threading, time, irdm\n"
            "simulation = irdm.Simulation(sys.argv[1])\n"
            "start = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))\n"
            "start.start()\n"
            "try:\n"
            "    simulation.step_many(numpy.zeros((3_000_000, 2, 3)), present=numpy.zeros((3_000_000, 2), bool))\n"
            "except KeyboardInterrupt:\n"
            "    print(simulation.next_step)\n"
        )
        path = os.path.join(folder.name, "ctrl_c.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(irdm.to_toml(scene()))
        run = subprocess.run([sys.executable, "-c", program, path], stdout=subprocess.PIPE, text=True, timeout=600,
                             env={**os.environ, "LD_PRELOAD": PRELOADED})
        self.assertTrue(0 < int(run.stdout) < 3_000_000, run.stdout)

    def test_forces_change_momentum(self):
        """Line by line: the forces on each object and its weight are the change of its momentum."""
        simulation = irdm.Simulation(scene())
        mass = numpy.array([cube().mass, block().mass])
        before = numpy.zeros((2, 3))
        kinds = set()
        for k, tip in enumerate(tips(400)):
            if k == 300:
                simulation.gravity = [0.5, -8, 1]
            step = simulation.step(tip)
            force = numpy.zeros((2, 3))
            numpy.add.at(force, step.contacts["object"], step.contacts["force"])
            weight = mass[:, None] * simulation.gravity
            change = mass[:, None] * (step.objects["velocity"] - before) / simulation.dt
            self.assertLess(abs(change - force - weight).max(), 1e-9)
            before = step.objects["velocity"]
            kinds.update(step.contacts["kind"].tolist())
            by_styluses = step.contacts[step.contacts["kind"] == irdm.STYLUS]
            for s in range(2):
                on_it = -by_styluses["force"][by_styluses["other"] == s].sum(axis=0)
                numpy.testing.assert_allclose(on_it, step.styluses["force"][s], atol=1e-12)
        self.assertEqual(kinds, {irdm.STYLUS, irdm.OBJECT, irdm.SCENERY})
        self.assertAlmostEqual(step.time, 400 * simulation.dt, places=12)

    def test_many_steps_are_single_steps(self):
        way = tips(300)
        buttons = numpy.zeros((300, 2), dtype=numpy.uint32)
        buttons[150:, 0] = irdm.GRAB
        present = numpy.ones((300, 2), dtype=bool)
        present[:30, 1] = False
        way[:30, 1] = numpy.nan  # of nobody
        many = irdm.Simulation(scene()).step_many(way, buttons, present=present)
        simulation = irdm.Simulation(scene())
        for k in range(300):
            step = simulation.step(way[k], buttons[k], present=present[k])
            self.assertEqual(step.styluses.tobytes(), many.styluses[k].tobytes())
            self.assertEqual(step.objects.tobytes(), many.objects[k].tobytes())
            some = many.contacts[many.first_contact[k] : many.first_contact[k + 1]]
            self.assertEqual(step.contacts.tobytes(), some.tobytes())
        self.assertEqual(many.styluses["contact"][-1].tolist(), [2, 1])
        self.assertEqual(many.styluses["present"][10].tolist(), [1, 0])

    def test_threads_side_by_side(self):
        way = tips(300)
        expected = irdm.Simulation(scene()).step_many(way)
        results = [None] * 4

        def run(i):
            results[i] = irdm.Simulation(scene()).step_many(way)

        threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            self.assertEqual(result.objects.tobytes(), expected.objects.tobytes())
            self.assertEqual(result.contacts.tobytes(), expected.contacts.tobytes())

    def test_one_thread_at_a_time(self):
        simulation = irdm.Simulation(scene())
        refused = threading.Event()
        ended = threading.Event()

        def run():
            while not refused.is_set() and not ended.is_set():
                try:
                    simulation.step_many(tips(50))
                except RuntimeError as error:
                    self.assertIn("another thread", str(error))
                    refused.set()

        threads = [threading.Thread(target=run) for _ in range(2)]
        for thread in threads:
            thread.start()
        met = refused.wait(60)
        ended.set()
        for thread in threads:
            thread.join()
        self.assertTrue(met)
        simulation.step()

    def test_surface(self):
        simulation = irdm.Simulation(scene())
        at_rest = simulation.surface(0)
        numpy.testing.assert_allclose(at_rest, cube().nodes + [0, 0.061, 0], atol=1e-15)
        self.assertFalse(at_rest.flags.writeable)
        simulation.step_many(tips(200))
        pressed = simulation.surface(0)
        # Not copied: the same memory, written anew.
        self.assertEqual(pressed.ctypes.data, at_rest.ctypes.data)
        self.assertGreater(abs(pressed - cube().nodes - [0, 0.061, 0]).max(), 0.002)
        del simulation
        self.assertTrue(numpy.isfinite(pressed).all())  # its memory lives on
        # A body that does not deform: only its pose moves it.
        simulation = irdm.Simulation(scene())
        step = simulation.step_many(tips(100))
        w, x, y, z = step.objects["orientation"][-1, 1]
        turn = numpy.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ])
        expected = step.objects["position"][-1, 1] + block().nodes @ turn.T
        numpy.testing.assert_allclose(simulation.surface(1), expected, atol=1e-12)

    def test_reset(self):
        simulation = irdm.Simulation(scene())
        first = simulation.step_many(tips(100))
        simulation.reset()
        again = simulation.step_many(tips(100))
        self.assertEqual(first.objects.tobytes(), again.objects.tobytes())
        self.assertEqual(simulation.next_step, 200)

    def test_saved_state(self):
        first, second = irdm.Simulation(scene()), irdm.Simulation(scene())
        first.step_many(tips(150))
        state = first.save_state()
        self.assertIsInstance(state, bytes)
        expected = first.step_many(tips(300)[150:])
        second.step_many(tips(40))
        for simulation in (second, first):
            simulation.load_state(state)
            again = simulation.step_many(tips(300)[150:])
            self.assertEqual(again.contacts.tobytes(), expected.contacts.tobytes())
            self.assertEqual(again.objects.tobytes(), expected.objects.tobytes())
        for wrong in (b"", state[:-1], state[:100] + b"?" + state[101:]):
            with self.assertRaisesRegex(irdm.Error, "state: is"):
                first.load_state(wrong)
        self.assertEqual(first.next_step, 300)

    def test_energy(self):
        """What damping leaves of the fingers' work; a body in free fall keeps its energy."""
        table = scene()
        table["scenery"] = []
        falling = irdm.Simulation(table)
        energy = falling.step_many(numpy.zeros((200, 2, 3)), present=numpy.zeros((200, 2), bool)).objects["energy"]
        numpy.testing.assert_allclose(energy[:40], numpy.broadcast_to(energy[0], (40, 2)), rtol=1e-9)
        pressed = irdm.Simulation(scene())
        steps = pressed.step_many(tips(400))
        moved = numpy.diff(steps.styluses["tip"], axis=0, prepend=steps.styluses["tip"][:1])
        work = -(steps.styluses["force"] * moved).sum()
        total = steps.objects["energy"].sum(axis=1)
        self.assertGreater(work, 0)
        self.assertLess(total[-1], total[0] + work)

    def test_tool(self):
        table = scene()
        table["stylus"] = [{"tool": {"object": "block"}}]
        simulation = irdm.Simulation(table)
        # The corner of its mesh, which follows the tip.
        place, still = [-0.02, 0.123, -0.03], [1.0, 0.0, 0.0, 0.0]
        before = numpy.zeros(3)
        for k in range(200):
            step = simulation.step([[place[0], place[1] - 5e-5 * k, place[2]]], orientations=[still])
            of_block = step.contacts[step.contacts["object"] == 1]
            change = block().mass * (step.objects["velocity"][1] - before) / simulation.dt
            missing = change - of_block["force"].sum(axis=0) - block().mass * simulation.gravity
            self.assertLess(abs(missing).max(), 1e-9)
            before = step.objects["velocity"][1]
        self.assertIn(irdm.COUPLING, of_block["kind"].tolist())
        self.assertIn(irdm.OBJECT, of_block["kind"].tolist())

    def test_wrong_use(self):
        simulation = irdm.Simulation(scene())
        twin = irdm.Simulation(scene())
        good = tips(1)[0]
        wrong = [
            ((good[:1],), {}, r"tips has the shape \(1, 3\): give \(2, 3\)"),
            ((good.T,), {}, r"tips has the shape \(3, 2\): give \(2, 3\)"),
            ((numpy.full((2, 3), numpy.nan),), {}, "stylus 0"),
            (([[0, 1, 0], [0, 1e5, 0]],), {}, "stylus 1"),
            ((good,), {"orientations": numpy.zeros((2, 4))}, "orientation"),
            ((good,), {"buttons": [1]}, "buttons"),
            ((good,), {"buttons": [-1, 0]}, "buttons has -1.0"),
            ((good,), {"buttons": [0, 2**40]}, "buttons has"),
            ((good,), {"buttons": [1.5, 0]}, "buttons has 1.5"),
            ((good,), {"present": [2, 0]}, "present has 2.0"),
            ((), {"buttons": [1, 1]}, "tips"),
        ]
        for arguments, named, text in wrong:
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                simulation.step(*arguments, **named)
        masked = numpy.ma.masked_array(good, mask=[[True, False, False]] * 2)
        for odd, text in ((good + 1j, "complex"), (masked, "masked"), (good.astype(object), "object")):
            with self.subTest(text), self.assertRaisesRegex(TypeError, text):
                simulation.step(odd)
            with self.subTest(text), self.assertRaisesRegex(TypeError, text):
                simulation.step_many(odd[None])
            with self.subTest(text), self.assertRaisesRegex(TypeError, text):
                simulation.gravity = odd[0]
        for odd in ("tips", [["a", "b", "c"]], object()):
            with self.assertRaises((TypeError, ValueError)):
                simulation.step(odd)
        with self.assertRaisesRegex(ValueError, "step 1, stylus 0"):
            simulation.step_many([[[0, 1, 0], [0, 1, 0]], [[numpy.inf, 1, 0], [0, 1, 0]]])
        for index in (-1, 2):
            with self.assertRaises(IndexError):
                simulation.surface(index)
            with self.assertRaises(IndexError):
                simulation.model(index)
        for gravity in ([0, 1], [[0, 1, 2]]):
            with self.assertRaisesRegex(ValueError, "shape"):
                simulation.gravity = gravity
        for gravity in ([0, numpy.nan, 0], [0, 0, 101]):
            with self.assertRaisesRegex(irdm.Error, "gravity: is .* give a finite number"):
                simulation.gravity = gravity
        # Nothing of that was a step.
        self.assertEqual(simulation.step(good).objects.tobytes(), twin.step(good).objects.tobytes())

    def test_wrong_scenes(self):
        for table, text in (
            ({}, "object is missing"),
            ({"object": [{"model": "nowhere.h5"}]}, "nowhere.h5"),
            (scene(colour="red"), "colour"),
            (scene(world={"gravity": [0, float("nan"), 0]}), "gravity"),
            ({"object": {1, 2}}, "set"),
            ({"object": [{"model": irdm.Simulation(scene()).model(0)}]}, "without a file"),
            ({3: 4}, "key 3"),
        ):
            with self.subTest(text), self.assertRaisesRegex(irdm.Error, text):
                irdm.Simulation(table)
        with self.assertRaisesRegex(irdm.Error, "nowhere.toml"):
            irdm.Simulation("nowhere.toml")

    def test_made_often(self):
        """Nothing keeps what is given back."""
        kept = sys.getrefcount(cube())
        for _ in range(50):
            simulation = irdm.Simulation(scene())
            surface = simulation.surface(0)
            del simulation, surface
        self.assertEqual(sys.getrefcount(cube()), kept)


class TomlTest(unittest.TestCase):
    def test_text(self):
        import pathlib
        import tomllib

        table = {"a": 1, "b": True, "c": -2.5e-3, "d": "x \"y\" \\ \n µ", "e": [1, 2], "f": {"g h": [{"i": 1}]},
                 "j": numpy.float32(0.5), "k": numpy.arange(3), "l": pathlib.Path("x/y"), "m": float("inf")}
        read = tomllib.loads(irdm.to_toml(table))
        self.assertEqual(read, {**table, "k": [0, 1, 2], "l": "x/y", "j": 0.5})


if __name__ == "__main__":
    unittest.main()
