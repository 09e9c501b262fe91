import os
import subprocess
import unittest

import numpy
from support import folder, scene

import irdm

SCRIPTS = ("0,0.10,0.06,0,0\n0.2,0.058,0.06,0,0\n0.4,0.058,0.06,0.004,0\n0.6,0.058,0.062,0,1\n0.9,0.07,0.07,0.01,1\n",
           "0,-0.10,0.06,0,0\n0.3,-0.058,0.06,0,0\n0.9,-0.059,0.06,0.01,0\n")


class LockstepTest(unittest.TestCase):
    """A run of irdm-server and irdm-bridge in lockstep, in which the server finds the forces; stepped again here."""

    @classmethod
    def setUpClass(cls):
        path = os.path.join(folder.name, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(irdm.to_toml(scene()))
        devices = []
        for number, script in enumerate(SCRIPTS):
            name = os.path.join(folder.name, f"script{number}.csv")
            with open(name, "w", encoding="utf-8") as file:
                file.write("time,x,y,z,button\n" + script)
            devices.append({"script": name, "hand": {}})
        table = {"bridge": {"mode": "hold"}, "device": devices}
        config = os.path.join(folder.name, "bridge.toml")
        with open(config, "w", encoding="utf-8") as file:
            file.write(irdm.to_toml(table))
        cls.trace = os.path.join(folder.name, "trace.h5")
        server = subprocess.Popen(["irdm-server", path, "--lockstep", "--no-viewer", "--record", cls.trace],
                                  stdout=subprocess.PIPE, text=True)
        with server:
            line = server.stdout.readline()
            while not line.startswith("listening on "):
                assert line, "the server ended"
                line = server.stdout.readline()
            subprocess.run(["irdm-bridge", config, "--server", line.split()[-1]], check=True, stdout=subprocess.DEVNULL)
            server.stdout.read()
        assert server.returncode == 0

    def test_same_bits(self):
        with irdm.Trace.open(self.trace) as trace:
            self.assertGreater(trace.steps, 400)
            tips = numpy.stack([trace[f"stylus/{s}/tip"] for s in range(2)], axis=1)
            buttons = numpy.stack([trace[f"stylus/{s}/buttons"] for s in range(2)], axis=1)
            present = numpy.stack([trace[f"stylus/{s}/present"] for s in range(2)], axis=1)
            forces = numpy.stack([trace[f"stylus/{s}/force"] for s in range(2)], axis=1)
            contact = numpy.stack([trace[f"stylus/{s}/contact"] for s in range(2)], axis=1)
            position = trace["object/cube/body_position"]
            orientation = trace["object/block/body_orientation"]
            contacts = trace.contacts
            table = trace.table(["step/time", "stylus/0/tip"])
        steps = irdm.Simulation(os.path.join(folder.name, "scene.toml")).step_many(tips, buttons, present=present)
        self.assertEqual(steps.styluses["force"].tobytes(), forces.tobytes())
        self.assertEqual(steps.objects["position"][:, 0].tobytes(), position.tobytes())
        self.assertEqual(steps.objects["orientation"][:, 1].tobytes(), orientation.tobytes())
        self.assertGreater(abs(forces[:, 0]).max(), 0.1)
        self.assertEqual(set(contact.ravel()), {0, 1, 2})
        of_bodies = steps.contacts[(steps.contacts["kind"] == irdm.SCENERY) | (steps.contacts["kind"] == irdm.OBJECT)]
        self.assertEqual(abs(of_bodies["force"]).max(), abs(contacts["force"]).max())
        self.assertEqual(sorted(table), ["step/time", "stylus/0/tip.0", "stylus/0/tip.1", "stylus/0/tip.2"])
        numpy.testing.assert_array_equal(table["step/time"], steps.time)

    def test_names(self):
        with irdm.Trace.open(self.trace) as trace:
            for name in trace.names:
                self.assertEqual(len(trace[name]), trace.steps, name)
            self.assertIn("stylus/1/applied_force", trace.names)
            self.assertIn("[[", trace.scene.replace("= [{", "[["))
            self.assertEqual(trace.dt, 0.002)

    def test_an_episode_of_the_run(self):
        import h5py

        path = os.path.join(folder.name, "run.h5")
        with irdm.Trace.open(self.trace) as trace, irdm.Episodes(path, "two fingers") as episodes:
            episodes.add_trace(trace)
            with self.assertRaisesRegex(irdm.Error, "rewards are needed"):
                episodes.add_trace(trace, [0.0])
            force, tip = trace["stylus/0/applied_force"], trace["stylus/0/tip"]
            present = trace["stylus/0/present"]
            place = trace["object/cube/body_position"]
        with h5py.File(path) as file:
            demo = file["data/demo_0"]
            self.assertEqual(demo.attrs["num_samples"], len(force) - 1)
            numpy.testing.assert_array_equal(demo["obs/forces"][:, 0], force[:-1])
            numpy.testing.assert_array_equal(demo["next_obs/object_cube_body_position"], place[1:])
            numpy.testing.assert_array_equal(demo["actions"][:, :3], numpy.where(present[1:, None], tip[1:], 0))
            self.assertEqual(demo["actions"].shape, (len(force) - 1, 10))

    def test_wrong_files(self):
        with self.assertRaisesRegex(irdm.Error, "nowhere.h5"):
            irdm.Trace.open("nowhere.h5")
        with self.assertRaisesRegex(irdm.Error, "not a trace"):
            irdm.Trace.open(os.path.join(folder.name, "cube.h5"))


if __name__ == "__main__":
    unittest.main()
