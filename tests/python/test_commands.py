import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

from support import cube, cube_config, folder

import irdm


def eventually(condition):
    end = time.monotonic() + 60
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.01)
    return False


def running(pid):
    """A process that has ended and waits for init is not."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


class PrecomputeTest(unittest.TestCase):
    def test_progress(self):
        seen = []
        config = cube_config(mesh={"box": {"size": [0.1, 0.1, 0.1], "cells": [4, 4, 4]}, "order": 1})
        config["response"]["storage"] = "dense"
        model = irdm.precompute(config, progress=lambda text, fraction: seen.append((text, fraction)), threads=1)
        self.assertIn(1.0, [fraction for _, fraction in seen])
        self.assertTrue(any("modes" in text for text, _ in seen), seen)
        # A temporary file, which goes with the model.
        path = model.path
        self.assertTrue(os.path.exists(path))
        self.assertIsNone(model.modes)
        del model
        self.assertFalse(os.path.exists(path))

    def test_file(self):
        path = os.path.join(folder.name, "config.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(irdm.to_toml(cube_config()))
        model = irdm.precompute(path, os.path.join(folder.name, "again.h5"))
        self.assertEqual(model.nodes.tobytes(), cube().nodes.tobytes())

    def test_errors(self):
        for table, text in (
            (cube_config(colour="red"), "colour"),
            (cube_config(mesh={"file": "nowhere.stl", "unit": "m"}), "nowhere.stl"),
            ({}, "mesh"),
        ):
            with self.subTest(text), self.assertRaisesRegex(irdm.Error, text) as caught:
                irdm.precompute(table)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(irdm.Error, "nowhere.toml"):
            irdm.precompute("nowhere.toml")

    def test_ended_by_the_callable(self):
        def stop(_text, _fraction):
            raise KeyError("enough")

        with tempfile.TemporaryDirectory() as place:
            with self.assertRaisesRegex(KeyError, "enough"):
                irdm.precompute(cube_config(), os.path.join(place, "x.h5"), progress=stop)
            self.assertEqual(os.listdir(place), [])

    def test_interrupted(self):
        """Ctrl-C: KeyboardInterrupt, no program and no file left."""
        program = textwrap.dedent("""
            import sys, irdm
            config = {"mesh": {"box": {"size": [0.1, 0.1, 0.1], "cells": [11, 11, 11]}, "order": 1},
                      "material": {"youngs_modulus": 5000.0, "poisson_ratio": 0.4, "density": 110.0}}
            try:
                irdm.precompute(config, sys.argv[1], progress=lambda text, fraction: print(text, flush=True))
            except KeyboardInterrupt:
                print("interrupted")
            """)
        with tempfile.TemporaryDirectory() as place:
            run = subprocess.Popen([sys.executable, "-c", program, os.path.join(place, "x.h5")],
                                   stdout=subprocess.PIPE, text=True, start_new_session=True)
            first = run.stdout.readline()
            os.killpg(run.pid, signal.SIGINT)
            rest = run.stdout.read()
            run.stdout.close()
            run.wait(60)
            self.assertIn("interrupted", rest, first)
            deadline = time.monotonic() + 10
            while os.listdir(place) and time.monotonic() < deadline:
                time.sleep(0.05)
            self.assertEqual(os.listdir(place), [])


    def test_terminated(self):
        """SIGTERM and SIGKILL to Python: no program that goes on; after SIGTERM no temporary folder either."""
        program = textwrap.dedent("""
            import sys, irdm
            config = {"mesh": {"file": sys.argv[1]},
                      "material": {"youngs_modulus": 5000.0, "poisson_ratio": 0.4, "density": 110.0}}
            irdm.precompute(config)
            """)
        for number in (signal.SIGTERM, signal.SIGKILL):
            with self.subTest(number), tempfile.TemporaryDirectory() as place:
                for name in ("bin", "tmp"):
                    os.mkdir(os.path.join(place, name))
                fake = os.path.join(place, "bin", "gmsh")
                pid_file = os.path.join(place, "pid")
                with open(fake, "w", encoding="utf-8") as file:
                    file.write(f"#!/bin/sh\necho $$ > {pid_file}.new\nmv {pid_file}.new {pid_file}\nexec sleep 100000\n")
                os.chmod(fake, 0o755)
                script = os.path.join(place, "a.geo")
                with open(script, "w", encoding="utf-8") as file:
                    file.write('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\n')
                environment = dict(os.environ, TMPDIR=os.path.join(place, "tmp"))
                environment["PATH"] = os.path.join(place, "bin") + ":" + environment["PATH"]
                with subprocess.Popen([sys.executable, "-c", program, script], env=environment) as run:
                    self.assertTrue(eventually(lambda: os.path.exists(pid_file)))
                    with open(pid_file, encoding="utf-8") as file:
                        gmsh = int(file.read())
                    run.send_signal(number)
                    run.wait(60)
                self.assertTrue(eventually(lambda: not running(gmsh)))
                # A killed Python leaves its own folder, but no program's.
                begin = "" if number == signal.SIGTERM else "irdm-gmsh"
                left = lambda: [name for name in os.listdir(os.path.join(place, "tmp")) if name.startswith(begin)]
                self.assertTrue(eventually(lambda: not left()), left())

    def test_program_of_a_build_folder(self):
        """It is found without PATH; without both, the message says what to do."""
        program = "import irdm; print(irdm.commands._program())"
        environment = dict(os.environ, PATH="/nowhere")
        found = subprocess.run([sys.executable, "-c", program], env=environment, stdout=subprocess.PIPE, text=True)
        self.assertTrue(found.stdout.strip().endswith("/bin/irdm-precompute"), found.stdout)
        program = "import irdm, pathlib; irdm.commands.Path.is_file = lambda _: False; irdm.commands._program()"
        lost = subprocess.run([sys.executable, "-c", program], env=environment, stderr=subprocess.PIPE, text=True)
        self.assertIn("add the folder that the program is in to PATH", lost.stderr)


class CheckTest(unittest.TestCase):
    def test_lines(self):
        report = {line.name: line for line in irdm.check(cube())}
        self.assertEqual(report["checksum"].verdict, "ok")
        self.assertNotIn("FAIL", [line.verdict for line in report.values()])
        stiff = irdm.check(cube().path, coupling=1e7)
        self.assertIn("FAIL", [line.verdict for line in stiff])

    def test_no_file(self):
        with self.assertRaisesRegex(irdm.Error, "nowhere.h5"):
            irdm.check("nowhere.h5")


if __name__ == "__main__":
    unittest.main()
