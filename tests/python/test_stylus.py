import os
import signal
import subprocess
import sys
import time
import unittest

import numpy
from support import PRELOADED, cube, folder

import irdm

DEADLINE = 60  # says only when a test that hangs gives up [s]


def eventually(condition):
    end = time.monotonic() + DEADLINE
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.001)
    return False


class Server:
    """irdm-server with a cube of 12 cm on a table, as a child; a context manager."""

    def __init__(self, *arguments, styluses=1, port=0):
        path = os.path.join(folder.name, f"stylus{styluses}.toml")
        table = {
            "server": {"port": port, "black_box": ""},
            "world": {"gravity": [0, -9.81, 0]},
            "object": [{"model": cube(), "position": [0, 0.06, 0]}],
            "scenery": [{"plane": {}}],
            "stylus": [{"coupling_stiffness": 500}] * styluses,
        }
        with open(path, "w", encoding="utf-8") as file:
            file.write(irdm.to_toml(table))
        self.scene = path
        self.process = subprocess.Popen(["irdm-server", path, "--no-viewer", *arguments],
                                        stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        while not line.startswith("listening on "):
            assert line, "the server ended"
            line = self.process.stdout.readline()
        self.address = line.split()[-1]
        self.port = int(self.address.rsplit(":", 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


PRESSED = [0.0, 0.115, 0.0]  # 5 mm below the top of the cube


class LockstepTest(unittest.TestCase):
    def test_same_bits(self):
        k = numpy.arange(300)
        tips = numpy.stack([0.002 * numpy.sin(0.02 * k), 0.123 - numpy.minimum(4e-5 * k, 0.006), 0 * k], axis=-1)
        with Server("--lockstep") as server:
            with irdm.Stylus.connect(server.address, lockstep=True) as stylus:
                self.assertEqual((stylus.dt, stylus.number, stylus.lockstep), (0.002, 0, True))
                forces = numpy.array([stylus.step(tip, buttons=irdm.GRAB * int(i > 200)) for i, tip in enumerate(tips)])
                self.assertEqual(stylus.contact, 2)
                self.assertEqual(stylus.ticks, 300)
                with self.assertRaisesRegex(RuntimeError, "use step"):
                    stylus.set(tips[0])
            self.assertEqual(server.process.wait(DEADLINE), 0)
            buttons = numpy.where(k > 200, irdm.GRAB, 0).reshape(-1, 1)
            steps = irdm.Simulation(server.scene).step_many(tips[:, None], buttons)
        self.assertEqual(forces.tobytes(), steps.styluses["force"][:, 0].tobytes())
        self.assertGreater(abs(forces).max(), 0.1)

    def test_a_killed_server_ends_the_run(self):
        with Server("--lockstep") as server:
            stylus = irdm.Stylus.connect(server.address, lockstep=True)
            stylus.step(PRESSED)
            server.process.kill()
            with self.assertRaisesRegex(irdm.Error, "connection lost in lockstep"):
                for _ in range(1000):
                    stylus.step(PRESSED)
            with self.assertRaisesRegex(irdm.Error, "the run is over"):
                stylus.step(PRESSED)
            self.assertIn("over", stylus.state)
            stylus.close()


class RealTimeTest(unittest.TestCase):
    def press(self, stylus):
        """Comes down onto the cube at 0.1 m/s and stays until a force is felt."""
        begin = time.monotonic()

        def feels():
            stylus.set([0, max(PRESSED[1], 0.2 - 0.1 * (time.monotonic() - begin)), 0])
            return stylus.ready and stylus.force[1] > 0.01

        self.assertTrue(eventually(feels), stylus.state)

    def test_a_lost_server(self):
        with Server() as server:
            stylus = irdm.Stylus.connect(server.address, [0, 0.2, 0], device={"mode": "hold"})
            self.assertFalse(stylus.ready)
            self.press(stylus)
            port = server.port
        # Killed.
        self.assertTrue(eventually(lambda: stylus.set(PRESSED) or not stylus.force.any()))
        self.assertTrue(eventually(lambda: stylus.set(PRESSED) or stylus.state.startswith("no link")), stylus.state)
        self.assertFalse(stylus.ready)
        with Server(port=port):
            self.press(stylus)
            self.assertEqual(stylus.sessions, 2)
            stylus.close()
        self.assertTrue(stylus.closed)
        self.assertEqual(stylus.state, "closed")
        with self.assertRaisesRegex(RuntimeError, "closed"):
            stylus.set(PRESSED)

    def test_no_poses(self):
        """A program that sets no more tips has no force; one that goes on has it again."""
        with Server() as server, irdm.Stylus.connect(server.address, [0, 0.2, 0]) as stylus:
            self.press(stylus)
            self.assertGreater(stylus.ticks, 0)
            self.assertGreaterEqual(stylus.latency, 0.0)
            self.assertTrue(eventually(lambda: not stylus.force.any() and "no pose" in stylus.state), stylus.state)
            self.press(stylus)

    def test_a_killed_program(self):
        """The server lets its stylus go, and serves the next one."""
        with Server(styluses=2) as server, irdm.Stylus.connect(server.address, [0, 0.2, 0], stylus=0) as other:
            code = ("import irdm, sys\ns = irdm.Stylus.connect(sys.argv[1], [0, 0.2, 0], stylus=1)\nprint('on', flush=True)\n"
                    "while True: s.set([0, 0.115, 0])\n")
            self.press(other)
            with subprocess.Popen([sys.executable, "-c", code, server.address], stdout=subprocess.PIPE, text=True,
                                  env={**os.environ, "LD_PRELOAD": PRELOADED}) as child:
                self.assertEqual(child.stdout.readline(), "on\n")
                child.send_signal(signal.SIGKILL)
            with irdm.Stylus.connect(server.address, [0, 0.2, 0], stylus=1) as stylus:
                self.assertTrue(eventually(lambda: stylus.set([0, 0.2, 0]) or stylus.ready), stylus.state)
                # The one beside it has not felt it.
                self.assertTrue(eventually(lambda: other.set(PRESSED) or other.force[1] > 0.01), other.state)
                self.assertEqual(other.sessions, 1)

    def test_stylus_numbers(self):
        with Server(styluses=2) as server:
            with irdm.Stylus.connect(server.address, [0, 0.2, 0], stylus=0) as first:
                with irdm.Stylus.connect(server.address, [0, 0.2, 0], stylus=1) as second:
                    self.assertEqual((first.number, second.number), (0, 1))
            with self.assertRaisesRegex(irdm.Error, "gives stylus 0, not 5"):
                irdm.Stylus.connect(server.address, [0, 0.2, 0], stylus=5, timeout=0.3)


class WrongUseTest(unittest.TestCase):
    def test_connect(self):
        def refused(what, *arguments, **more):
            with self.assertRaisesRegex(irdm.Error, what):
                irdm.Stylus.connect(*arguments, **more)

        refused("has no port", "localhost", [0, 0, 0])
        refused("no connection", "127.0.0.1:1", [0, 0, 0], timeout=0.2)
        refused("cannot resolve", "no-such-name.invalid:1", [0, 0, 0])
        refused("tip is missing", "127.0.0.1:1")
        refused("tip", "127.0.0.1:1", [numpy.nan, 0, 0])
        refused("tip", "127.0.0.1:1", [3, 0, 0])
        refused("tip", "127.0.0.1:1", [0, 0])
        refused("stylus", "127.0.0.1:1", [0, 0, 0], stylus=-1)
        refused("colour", "127.0.0.1:1", [0, 0, 0], device={"colour": 1})
        refused("max_force", "127.0.0.1:1", [0, 0, 0], device={"max_force": 41})
        refused("workspace", "127.0.0.1:1", lockstep=True, device={"workspace": {}})
        with Server() as server:
            refused("runs in real time", server.address, lockstep=True)
        with Server("--lockstep") as server:
            refused("runs in lockstep", server.address, [0, 0, 0])

    def test_a_fork_closes_its_copy_only(self):
        for lockstep in (False, True):
            with self.subTest(lockstep=lockstep), Server(*["--lockstep"] * lockstep) as server:
                tip = {} if lockstep else {"tip": [0, 0.2, 0]}
                stylus = irdm.Stylus.connect(server.address, lockstep=lockstep, **tip)
                child = os.fork()
                if child == 0:
                    try:
                        stylus.set([0, 0.2, 0])
                        os._exit(1)
                    except RuntimeError as error:
                        stylus.close()
                        os._exit(0 if "before fork()" in str(error) and stylus.closed else 2)
                self.assertEqual(os.waitpid(child, 0)[1], 0)
                if lockstep:
                    for _ in range(5):
                        stylus.step([0, 0.2, 0])
                    self.assertEqual(stylus.ticks, 5)
                else:
                    before = stylus.ticks
                    self.assertTrue(eventually(lambda: stylus.set([0, 0.2, 0]) or stylus.ticks > before + 1000))
                    self.assertTrue(eventually(lambda: stylus.set([0, 0.2, 0]) or stylus.ready), stylus.state)
                    # On a slow machine a session may stall and begin anew: nobody said goodbye.
                    server.process.terminate()
                    self.assertNotIn("goodbye", server.process.stdout.read())
                stylus.close()

    def test_set(self):
        with Server() as server, irdm.Stylus.connect(server.address, [0, 0.2, 0]) as stylus:
            for tip in ([numpy.nan, 0, 0], [0, numpy.inf, 0], [0, 0, 2.1]):
                with self.assertRaisesRegex(ValueError, "within 2 m"):
                    stylus.set(tip)
            with self.assertRaisesRegex(ValueError, r"tip has the shape \(2,\): give \(3,\)"):
                stylus.set([0, 0])
            with self.assertRaisesRegex(TypeError, "complex"):
                stylus.set([0, 0.2 + 1j, 0])
            for orientation in ([1, 1, 0, 0], [0, 0, 0, 0], [numpy.nan, 0, 0, 0]):
                with self.assertRaisesRegex(ValueError, "length 1"):
                    stylus.set([0, 0.2, 0], orientation)
            for buttons in (-1, 2**40, 1.5):
                with self.assertRaises(TypeError):
                    stylus.set([0, 0.2, 0], buttons=buttons)
            with self.assertRaisesRegex(RuntimeError, "not connected in lockstep"):
                stylus.step([0, 0.2, 0])
            # None of them counted as a tip.
            self.assertIn("no pose", stylus.state)


if __name__ == "__main__":
    unittest.main()
