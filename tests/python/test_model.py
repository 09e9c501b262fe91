import os
import unittest

import numpy
from support import block, cube, cube_config, folder

import irdm


class ModelTest(unittest.TestCase):
    def test_shapes(self):
        model = cube()
        self.assertEqual(model.nodes.shape, (56, 3))
        self.assertEqual(model.triangles.shape, (108, 3))
        edges = model.volume_nodes[model.tetrahedra[:, 1:]] - model.volume_nodes[model.tetrahedra[:, :1]]
        self.assertAlmostEqual(abs(numpy.linalg.det(edges)).sum() / 6, 0.12**3, places=12)
        numpy.testing.assert_allclose(model.volume_nodes[model.surface_nodes], model.nodes)
        # The volume that the triangles enclose: outward, and of the whole cube.
        a, b, c = (model.nodes[model.triangles[:, i]] for i in range(3))
        self.assertAlmostEqual(numpy.einsum("ij,ij->", a, numpy.cross(b, c)) / 6, 0.12**3, places=12)
        self.assertAlmostEqual(model.mass, 110 * 0.12**3, places=12)
        self.assertEqual(model.material["youngs_modulus"], 5000.0)
        self.assertEqual((model.dt, model.steps, model.rigid, model.fixed), (0.002, 100, False, False))

    def test_response_is_the_sum_of_modes(self):
        """R[s] against the closed form of an oscillator under a force that is held for one step."""
        model = cube()
        modes = model.modes
        shapes = modes["shapes"].astype(float)
        frequency, decay = modes["angular_frequency"], modes["decay_rate"]
        self.assertFalse(modes["shapes"].flags.writeable)
        damped = numpy.sqrt((frequency**2 - decay**2).astype(complex))

        def after_step_force(time):  # of a unit force that begins at 0 and stays
            wave = numpy.exp(-decay * time) * (numpy.cos(damped * time) + decay / damped * numpy.sin(damped * time))
            return numpy.where(time > 0, (1 - wave.real) / frequency**2, 0.0)

        block_of_r = model.response_block(7, 20, steps=30)
        column = model.response_column(20, 1, steps=30)
        self.assertEqual(column.shape, (30, 56, 3))
        numpy.testing.assert_array_equal(column[:, 7, :], block_of_r[:, :, 1])
        for s in (0, 1, 5, 29):
            h = after_step_force((s + 1) * model.dt) - after_step_force(s * model.dt)
            expected = (shapes[7] * h) @ shapes[20].T
            numpy.testing.assert_allclose(block_of_r[s], expected, atol=1e-9 * abs(block_of_r).max())
        zero = model.zero_lag()
        numpy.testing.assert_allclose(zero[7, :, 20, :], block_of_r[0], atol=1e-9 * abs(zero).max())
        numpy.testing.assert_allclose(zero, zero.transpose(2, 3, 0, 1), atol=1e-12 * abs(zero).max())

    def test_regions(self):
        """A stiff layer: whose tetrahedra they are, and the mass and centre of mass of what they weigh."""
        layer = {"box": {"min": [0, 0.08, 0], "max": [0.12, 0.12, 0.12]}, "youngs_modulus": 2e4, "density": 300.0}
        model = irdm.precompute(cube_config(region=[layer]), f"{folder.name}/layers.h5")
        materials = model.element_materials
        corners = model.volume_nodes[model.tetrahedra[:, :4]]
        inside = corners[:, :, 1].mean(axis=1) > corners[:, :, 1].max() - 0.04
        numpy.testing.assert_array_equal(materials["region"], inside)
        numpy.testing.assert_array_equal(materials["youngs_modulus"], numpy.where(inside, 2e4, 5e3))
        numpy.testing.assert_array_equal(materials["poisson_ratio"], 0.4)
        numpy.testing.assert_array_equal(materials["density"], numpy.where(inside, 300, 110))
        # Tetrahedra that the layer's boundary cuts are whole in it or not.
        mass = abs(numpy.linalg.det(corners[:, 1:] - corners[:, :1])) / 6 * materials["density"]
        self.assertAlmostEqual(model.mass, mass.sum(), places=12)
        numpy.testing.assert_allclose(mass @ corners.mean(axis=1), 0, atol=1e-12)
        self.assertGreater(model.mass, 1.3 * cube().mass)
        self.assertEqual(cube().element_materials, {})

    def test_rigid(self):
        model = block()
        self.assertTrue(model.rigid)
        self.assertIsNone(model.modes)
        self.assertNotIn("youngs_modulus", model.material)
        numpy.testing.assert_allclose(model.com_offset, [0.03, 0.03, 0.03], atol=1e-15)
        numpy.testing.assert_allclose(model.inertia, numpy.eye(3) * model.mass * 0.06**2 / 6, atol=1e-15)
        with self.assertRaisesRegex(irdm.Error, "rigid"):
            model.zero_lag()

    def test_wrong_use(self):
        with self.assertRaisesRegex(irdm.Error, "nowhere.h5"):
            irdm.Model.open("nowhere.h5")
        with self.assertRaisesRegex(irdm.Error, "modal"):
            irdm.Model.open(cube().path, response="spectral")
        broken = os.path.join(folder.name, "broken.h5")
        with open(broken, "wb") as file:
            file.write(b"not HDF5")
        with self.assertRaisesRegex(irdm.Error, "broken.h5"):
            irdm.Model.open(broken)
        for arguments in ((-1, 0), (56, 0), (0, 3), (0, -1)):
            with self.assertRaises(IndexError):
                cube().response_column(*arguments)
        with self.assertRaises(ValueError):
            cube().response_block(0, 0, steps=0)
        with self.assertRaises(TypeError):
            irdm.Model(3)


if __name__ == "__main__":
    unittest.main()
