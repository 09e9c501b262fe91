import importlib.util
import json
import os
import tempfile
import unittest

import h5py
import numpy

from irdm.lerobot import to_lerobot


def write_episodes(path, lengths):
    """In robomimic's layout, with numbers that can be told apart."""
    with h5py.File(path, "w") as file:
        for e, n in enumerate(lengths):
            k = numpy.arange(n, dtype=float)
            demo = file.create_group(f"data/demo_{e}")
            demo["obs/tips"] = (100 * e + k)[:, None, None] + numpy.arange(6).reshape(1, 2, 3) / 10
            demo["obs/force"] = -k
            demo["actions"] = numpy.stack([k, k + 0.5], axis=1)
            demo["rewards"] = k / 2
            demo["dones"] = (k == n - 1).astype(int)


@unittest.skipUnless(importlib.util.find_spec("pyarrow"), "pyarrow is not there")
class LeRobotTest(unittest.TestCase):
    def test_dataset(self):
        from pyarrow import parquet

        lengths = [4, 1, 3]
        with tempfile.TemporaryDirectory() as folder:
            write_episodes(f"{folder}/e.h5", lengths)
            to_lerobot(f"{folder}/e.h5", f"{folder}/set", "press", 500)
            with open(f"{folder}/set/meta/info.json", encoding="utf-8") as file:
                info = json.load(file)
            self.assertEqual((info["codebase_version"], info["total_episodes"], info["total_frames"]), ("v2.1", 3, 8))
            self.assertEqual(info["splits"], {"train": "0:3"})
            state = info["features"]["observation.state"]
            self.assertEqual((state["dtype"], state["shape"]), ("float32", [7]))
            self.assertEqual(state["names"], ["force"] + [f"tips_{i}" for i in range(6)])
            total = 0
            for e, n in enumerate(lengths):
                path = info["data_path"].format(episode_chunk=0, episode_index=e)
                table = parquet.read_table(f"{folder}/set/{path}")
                self.assertEqual(sorted(table.column_names), sorted(info["features"]))
                rows = table.to_pydict()
                k = numpy.arange(n)
                expected = numpy.column_stack([-k] + [100 * e + k + i / 10 for i in range(6)])
                numpy.testing.assert_allclose(rows["observation.state"], expected, rtol=1e-6)
                numpy.testing.assert_allclose(rows["action"], numpy.stack([k, k + 0.5], axis=1))
                numpy.testing.assert_allclose(rows["timestamp"], k / 500, rtol=1e-6)
                self.assertEqual(rows["next.done"], [i == n - 1 for i in range(n)])
                self.assertEqual(rows["index"], list(range(total, total + n)))
                self.assertEqual(rows["frame_index"], list(range(n)))
                self.assertEqual(set(rows["episode_index"]), {e})
                for name, feature in info["features"].items():
                    kind = str(table.schema.field(name).type)
                    self.assertIn({"float32": "float", "bool": "bool", "int64": "int64"}[feature["dtype"]], kind)
                total += n
            with open(f"{folder}/set/meta/episodes_stats.jsonl", encoding="utf-8") as file:
                stats = [json.loads(line) for line in file]
            self.assertEqual(stats[2]["stats"]["action"], {
                "min": [0.0, 0.5], "max": [2.0, 2.5], "mean": [1.0, 1.5],
                "std": [numpy.std([0, 1, 2])] * 2, "count": [3]})
            with self.assertRaisesRegex(FileExistsError, "not empty"):
                to_lerobot(f"{folder}/e.h5", f"{folder}/set", "press", 500)
            to_lerobot(f"{folder}/e.h5", f"{folder}/tips", "press", 500, observations=["tips"])
            with open(f"{folder}/tips/meta/info.json", encoding="utf-8") as file:
                self.assertEqual(json.load(file)["features"]["observation.state"]["shape"], [6])
            with self.assertRaises(KeyError):
                to_lerobot(f"{folder}/e.h5", f"{folder}/other", "press", 500, observations=["colour"])
            self.assertTrue(os.path.isdir(f"{folder}/tips/data/chunk-000"))


if __name__ == "__main__":
    unittest.main()
