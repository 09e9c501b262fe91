import json
import subprocess
import sys
import unittest
import unittest.mock
from pathlib import Path

import numpy

BENCHMARK = Path(__file__).resolve().parents[2] / "benchmark"
sys.path.insert(0, str(BENCHMARK))

import ring_shape  # noqa: E402
import run  # noqa: E402

# Of what a reference may change with cells or steps twice the size (README.md): its own error is a third.
WIDER = {("slide", "surface"): 0.016, ("swing", "force"): 0.016, ("swing", "surface"): 0.017}

try:
    import scipy.sparse.linalg

    import references
    import solids
    from contact import Body, sphere
    from fem import Grid
    from friction import Grip
except ModuleNotFoundError:
    references = None


@unittest.skipUnless(references, "python3-scipy is missing")
class TruthTest(unittest.TestCase):
    def test_hertz_ball_in_a_half_space(self):
        """What is above Hertz' force falls as the block grows: 0.6 % in one 300 times as wide as the contact."""
        fine, size, radius, depth = 8e-5, 0.5, 0.05, 5e-5
        grid = Grid([references.meshes.graded(fine, 0.002, size),
                     size - references.meshes.graded(fine, 0.0013, size)[::-1]])
        bottom, top = grid.on(1, 0.0), grid.on(1, size)
        touching = top[(grid.nodes[top, 0] < 0.003) & (grid.nodes[top, 0] > 0)]
        fixed = numpy.unique(numpy.r_[2 * grid.on(0, 0.0), 2 * bottom, 2 * bottom + 1])
        body = Body(grid, references.SOFT, fixed, touching, None)
        force = -body.advance(sphere(numpy.array([0.0, size + radius - depth]), radius))[:, 1].sum()
        modulus = references.SOFT["youngs_modulus"] / (1 - references.SOFT["poisson_ratio"] ** 2)
        hertz = 4 / 3 * modulus * numpy.sqrt(radius) * depth**1.5
        self.assertAlmostEqual(force / hertz, 1.0, delta=0.008)

    def test_hertz_impact(self):
        """A slow impact of two balls has Hertz' peak and duration; impulse is change of momentum."""
        speed, step = 0.005, 5e-4
        grid = references.ball_grid(5e-4)
        touching = references.near_top(grid, 1.0, 0.018)
        body = Body(grid, references.SOFT, 2 * grid.on(0, 0.0), touching, step, numpy.array([0.0, speed]))

        def below(points):
            return references.BALL_RADIUS - points[:, 1], numpy.array([0.0, -1.0]) + 0 * points
        force = numpy.array([-body.advance(below)[:, 1].sum() for _ in range(400)])
        mass = body.mass[1::2][:, 1::2].sum()
        modulus = references.SOFT["youngs_modulus"] / (1 - references.SOFT["poisson_ratio"] ** 2) / 2
        radius = references.BALL_RADIUS / 2
        depth = (15 * mass / 2 * (2 * speed) ** 2 / (16 * modulus * radius**0.5)) ** 0.4
        self.assertAlmostEqual(force.max() / (4 / 3 * modulus * radius**0.5 * depth**1.5), 1.0, delta=0.03)
        self.assertAlmostEqual((force > 0).sum() * step / (2.943 * depth / (2 * speed)), 1.0, delta=0.03)
        left = (body.mass @ body.v[0])[1::2].sum()
        self.assertAlmostEqual(force.sum() * step, mass * speed - left, delta=1e-9)

    def test_stiff_core_of_a_ball(self):
        """A ball with a core ten times as stiff, its surface moved inward: energy of Lame's closed form."""
        outer, core, factor, depth = references.BALL_RADIUS, 0.02, 10.0, 1e-3
        grid = Grid([numpy.linspace(0, 1, 49), numpy.linspace(-1, 1, 97)], lambda x: outer * references.meshes.disc(x))
        material = {**references.SOFT, "stiffer": (numpy.zeros(2), core, factor)}
        stiffness = grid.assemble(material)[0]
        radius = numpy.hypot(*grid.nodes.T)
        rim = numpy.flatnonzero(radius > outer - 1e-9)
        u = (-depth / outer * grid.nodes).ravel()
        known = numpy.unique(numpy.r_[2 * rim, 2 * rim + 1, 2 * grid.on(0, 0.0)])
        free = numpy.setdiff1d(numpy.arange(len(u)), known)
        u[free] = 0.0
        u[free] = scipy.sparse.linalg.spsolve(stiffness[free][:, free], -(stiffness @ u)[free])
        young, poisson = material["youngs_modulus"], material["poisson_ratio"]
        bulk, shear = young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))
        # u = a r within, b r + c core^3 / r^2 outside.
        c = 3 * (factor - 1) * bulk / (3 * factor * bulk + 4 * shear)  # over -b
        share = (core / outer) ** 3
        b = depth / outer / (1 - c * share)
        stress = b * (3 * bulk + 4 * shear * c * share)
        energy = 0.5 * stress * depth * 4 * numpy.pi * outer**2
        self.assertAlmostEqual(0.5 * u @ (stiffness @ u) / energy, 1.0, delta=0.0015)

    def test_work_of_a_peg_is_dissipated(self):
        """Without friction what the ball puts into the ring it gets back, but for the damping."""
        lost = []

        class Watched(Body):
            def advance(self, gap):
                force = super().advance(gap)
                lost.append(self.step * self.damping * self.v[0] @ (self.stiffness @ self.v[0]))
                return force
        case = references.peg_case()
        with unittest.mock.patch.object(references, "Body", Watched):
            force = references.pegged_ring(case, 1e-3, 1e-3)[0]
        moved = numpy.diff(numpy.array(case["tools"][0]["path"])[:, 2])
        middle = (force + numpy.r_[0.0, force[:-1]]) / 2
        self.assertLess(abs(middle @ moved + sum(lost)), 0.005 * abs(middle) @ abs(moved))

    def test_cubes_keep_momentum_and_swing_as_a_rod(self):
        momentum = []

        class Watched(Body):
            def finish(self, force):
                super().finish(force)
                momentum.append((self.mass @ self.v[0])[1::3].sum())
        case, _, _ = solids.cases(references.SOFT, 1e-3)[0]
        with unittest.mock.patch.object(solids, "Body", Watched):
            force = solids.two_cubes(case, 0.025, 1e-3, references.SOFT, 1e-3)[0][:, 1]
        upper = numpy.r_[0.0, 0.0, momentum[1::2]]  # of a quarter
        weight = 9.81 * case["bodies"][1]["mass"]
        change = 4 * (1.5 * upper[2:] - 2 * upper[1:-1] + 0.5 * upper[:-2]) / 1e-3
        self.assertLess(abs(force - weight - change).max(), 1e-7)
        # A rod of both, held below, has the period 4 length / sqrt(E / density).
        time = 1e-3 * numpy.arange(1, len(force) + 1)
        above = numpy.flatnonzero((force[1:] >= weight) & (force[:-1] < weight))
        self.assertAlmostEqual(numpy.diff(time[above])[-1] / (8 * solids.EDGE / 10.0), 1.0, delta=0.03)

    def test_face_without_mass_keeps_mass_and_inertia(self):
        grid = Grid([[-0.02, 0.0, 0.01], [0.0, 0.01, 0.03], [0.0, 0.02]])
        whole = grid.assemble(references.SOFT)[1]
        fields = [grid.nodes[:, [axis]] ** power * numpy.ones(3) for axis in range(3) for power in (0, 1)]
        for face in ((0, -0.02), (1, 0.03)):
            mass = grid.assemble(references.SOFT, face)[1]
            self.assertLess(abs(mass[3 * grid.on(*face)]).max(), 1e-15)
            for a in fields:
                for b in fields:
                    self.assertAlmostEqual(a.ravel() @ mass @ b.ravel(), a.ravel() @ whole @ b.ravel(), delta=1e-12)

    def test_friction_stops_a_sliding_block(self):
        """Deceleration and way by Coulomb's law; then it stands still, though pushed by its weight."""
        step, speed, friction, far = 2.5e-4, 0.1, 0.5, 1e4
        grid = Grid([[-0.03, 0.0, 0.03], [0.0, 0.02, 0.04], [0.0, 0.03]])
        bottom = grid.on(1, 0.0)
        body = Body(grid, references.SOFT, 3 * grid.on(2, 0.0) + 2, bottom, step, numpy.array([speed, 0.0, 0.0]),
                    gravity=numpy.array([0.0, -9.81, 0.0]), light=(1, 0.0))
        mass = body.mass[0::3][:, 0::3].sum()
        centre = numpy.array([0.0, -far, 0.0])
        grip = Grip(body, centre, far, friction)
        force = numpy.array([grip.advance(centre).sum(axis=0) for _ in range(400)])
        self.assertLess((abs(force[:, 0]) - friction * force[:, 1]).max(), 1e-6)
        sliding = slice(0, round(0.5 * speed / (friction * 9.81) / step))
        self.assertLess(abs(force[sliding, 0] + friction * force[sliding, 1]).max(), 0.01 * mass * 9.81)
        self.assertAlmostEqual(force[:, 0].sum() * step / (mass * speed), -1.0, delta=0.02)
        way = (body.mass @ body.u[0])[0::3].sum() / mass
        self.assertAlmostEqual(way / (speed**2 / (2 * friction * 9.81)), 1.0, delta=0.05)

    def test_stored_references(self):
        """Coarser cells and steps give the references within what they say, and those say below 1 %, but WIDER."""
        for case, compute, (fine, step) in references.cases():
            with self.subTest(case["name"]):
                stored = json.loads((BENCHMARK / "references" / f"{case['name']}.json").read_text())
                same = json.loads((BENCHMARK / "cases" / f"{case['name']}.json").read_text())
                self.assertEqual(same, json.loads(json.dumps(case)))
                for change in stored["largest_change_by_peak_with"].values():
                    for what in ("force", "surface"):
                        self.assertLess(change[what], WIDER.get((case["name"], what), 0.01))
                if case["name"] in ("press", "two-spheres"):
                    truth = numpy.array(stored["force"])[:, 1]
                    force = compute(case, 2 * fine, 2 * step)[0]
                    said = sum(one["force"] for one in stored["largest_change_by_peak_with"].values())
                    self.assertLess(abs(force - truth).max() / truth.max(), 1.2 * said)


class ShapeTest(unittest.TestCase):
    def test_ring_with_curved_edges(self):
        """All nodes of the hole lie on the wall, mid-side ones near the middles of edges, and nothing folds over."""
        nodes, tets = ring_shape.mesh()
        inner = numpy.hypot(nodes[:, 0], nodes[:, 2]) < ring_shape.wall(nodes[:, 1]) + 1e-9
        self.assertEqual(inner.sum(), 2 * ring_shape.AROUND * (2 * len(ring_shape.ROWS) - 1))
        self.assertLess(abs(numpy.hypot(nodes[:, 0], nodes[:, 2]) - ring_shape.wall(nodes[:, 1]))[inner].max(), 1e-12)
        for k, (i, j) in enumerate(run.meshes.EDGES, 4):
            ends = nodes[tets[:, [i, j]]]
            off = numpy.linalg.norm(nodes[tets[:, k]] - ends.mean(axis=1), axis=1)
            self.assertLess((off / numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)).max(), 0.15)
        eight = tets[:, [[0, 4, 6, 7], [4, 1, 5, 9], [6, 5, 2, 8], [7, 9, 8, 3]]].reshape(-1, 4)
        volume = run.meshes.signed_volume(nodes, eight)
        self.assertGreater(volume.min(), 0.0)


class TableTest(unittest.TestCase):
    def check_rows(self, rows):
        for name, engine, results in rows:
            with self.subTest(name, engine=engine):
                _, found = run.run(engine, name)
                said = json.loads((BENCHMARK / "results" / f"{results}.json").read_text())["cases"][name]
                for key in ("error_max_N", "error_rms_N", "jnd", "surface_mm"):
                    self.assertLess(found[key], 1.2 * said[key], key)
                    self.assertGreater(found[key], 0.8 * said[key], key)
                if results == "irdm-fine":
                    self.assertLess(found["error_max_N"], 0.02 * found["peak_N"])

    def test_irdm_is_as_the_table_says(self):
        self.check_rows((("push", "irdm", "irdm"), ("slide", "irdm, fine", "irdm-fine")))

    def test_page_has_the_results(self):
        self.assertIn(run.table(), (BENCHMARK / "README.md").read_text())

    def test_data_are_small(self):
        data = [path for folder in ("cases", "references", "results") for path in (BENCHMARK / folder).iterdir()]
        self.assertLess(sum(path.stat().st_size for path in data), 2e6)

    def test_truth_scores_zero(self):
        for name in run.case_names():
            scene, reference = run.scene_of(name)
            rest = numpy.array(scene["bodies"][0]["nodes"])[scene["watched"]]
            there = (rest + numpy.array(reference["displacements"])).tolist()
            means = run.means_of_values(numpy.array(reference["force"]))
            found = {"force": means.tolist(), "dt": reference["dt"], "positions": there, "step_us": [1, 1],
                     "settings": ""}
            row = run.score(scene, reference, found)
            for key in ("error_max_N", "jnd", "surface_mm"):
                self.assertAlmostEqual(row[key], 0.0, delta=1e-9)
            self.assertLess(row["penetration_mm"] or 0.0, 0.01)
            found["force"] = (1.1 * means).tolist()
            row = run.score(scene, reference, found)
            self.assertAlmostEqual(row["error_max_N"], 0.1 * row["peak_N"], delta=0.01)
            self.assertLessEqual(row["jnd"], 1.0)

    def test_means_are_of_the_same_time(self):
        """A force that grows with time, as means over steps of another length and as values at the ends."""
        fine = 2e-4 * (numpy.arange(50) + 0.5)[:, None] * numpy.ones(3)
        ends = 1e-3 * numpy.arange(1, 11)[:, None] * numpy.ones(3)
        self.assertLess(abs(run.means_of_means(fine, 2e-4, 1e-3, 10) - run.means_of_values(ends)).max(), 1e-15)

    def test_wrong_names(self):
        for arguments, text in ((["--engine", "nobody"], "--engine nobody: is unknown; use one of: irdm"),
                                (["--engine", "irdm", "--case", "fly"], "--case fly: is unknown; use one of: palpation")):
            done = subprocess.run([sys.executable, str(BENCHMARK / "run.py"), *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)
            self.assertIn(text, done.stderr)


class LongTableTest(TableTest):
    def test_irdm_is_as_the_table_says(self):
        self.check_rows((("two-spheres", "irdm", "irdm"), ("push", "irdm, rigid ball", "irdm-rigid-ball"),
                         ("push", "irdm, fine", "irdm-fine")))


if __name__ == "__main__":
    unittest.main()
