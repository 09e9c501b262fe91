import os
import pathlib
import subprocess
import sys
import unittest

from support import folder

example = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python" / "palpation.py"


class PalpationTest(unittest.TestCase):
    def test_finds_the_inclusion_and_draws_it(self):
        """As a user runs it, the model included; its exit status says whether the stiffest place is above the inclusion."""
        figure = os.path.join(folder.name, "palpation.png")
        command = [sys.executable, str(example), os.path.join(folder.name, "tissue.h5"), figure]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        found, inclusion = [line for line in run.stdout.splitlines() if line.startswith(("stiffest", "inclusion"))]
        above, elsewhere = float(found.split()[-5]), float(inclusion.split()[-2])
        self.assertGreater(above, 1.25 * elsewhere)
        import matplotlib.image

        picture = matplotlib.image.imread(figure)[..., :3]
        self.assertGreater(picture.shape[1], 800)
        self.assertGreater(len({tuple(pixel) for pixel in picture.reshape(-1, 3)[::97].tolist()}), 20)


if __name__ == "__main__":
    unittest.main()
