"""An elastic body in time, with exact frictionless contact of its nodes with a rigid shape."""

import numpy
import scipy.linalg
import scipy.optimize
import scipy.sparse.linalg


def complementarity(compliance, gap, active):
    """Pressing forces f >= 0 with compliance f + gap >= 0 and one of both zero, by an active set; `active` begins."""
    force = numpy.zeros(len(gap))
    for _ in range(30):
        force[:] = 0.0
        if active.any():
            force[active] = numpy.linalg.solve(compliance[numpy.ix_(active, active)], -gap[active])
        opened = compliance @ force + gap
        scale = numpy.abs(gap).max() + 1e-300
        following = numpy.where(active, force > 0, opened < -1e-12 * scale)
        if (following == active).all():
            return force, active
        active = following
    factor = numpy.linalg.cholesky(compliance)  # the same as a least-squares problem, always solvable
    force, _ = scipy.optimize.nnls(factor.T, -scipy.linalg.solve_triangular(factor, gap, lower=True), maxiter=10**5)
    return force, force > 0


class Body:
    """Free degrees of freedom of a Grid, its state, and what touches it.

    touching: nodes that may touch. step [s] of the second order backward difference; None: statics.
    """

    def __init__(self, grid, material, fixed, touching, step, velocity=None):
        d = grid.dimension
        self.grid, self.step, self.d = grid, step, d
        self.stiffness, self.mass, self.volume = grid.assemble(material)
        self.free = numpy.setdiff1d(numpy.arange(d * len(grid.nodes)), fixed)
        self.damping = material["rayleigh_beta"]
        matrix = self.stiffness
        if step is not None:
            matrix = 2.25 / step**2 * self.mass + (1 + 1.5 / step * self.damping) * self.stiffness
        matrix = matrix[self.free][:, self.free]
        self.solve = scipy.sparse.linalg.splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A",
                                              options={"SymmetricMode": True, "DiagPivotThresh": 0.0}).solve
        place = numpy.full(d * len(grid.nodes), -1)
        place[self.free] = numpy.arange(len(self.free))
        self.touching = touching
        dofs = place[(d * touching[:, None] + numpy.arange(d))]  # -1: does not move
        self.response = numpy.zeros((len(self.free), dofs.size))  # by force
        for column, dof in enumerate(dofs.ravel()):
            if dof >= 0:
                unit = numpy.zeros(len(self.free))
                unit[dof] = 1.0
                self.response[:, column] = self.solve(unit)
        self.compliance = numpy.where(dofs.ravel()[:, None] >= 0, self.response[dofs.ravel()], 0.0)
        self.active = numpy.zeros(len(touching), dtype=bool)
        speed = numpy.zeros(d * len(grid.nodes)) if velocity is None else numpy.tile(velocity, len(grid.nodes))
        self.u = [-k * (step or 0.0) * speed for k in range(2)]  # now, and a step before
        self.v = [speed, speed]

    def advance(self, gap):
        """One step. gap: of points (n, d) the distances outside of the rigid shape (n) and its outward normals (n, d),
        at the step's end. Returns the force on each touching node [N] (n, d)."""
        load = numpy.zeros(len(self.u[0]))
        if self.step is not None:
            h = self.step
            u_past = (-4 * self.u[0] + self.u[1]) / (2 * h)
            v_past = (-4 * self.v[0] + self.v[1]) / (2 * h)
            load = -(self.mass @ (1.5 / h * u_past + v_past)) - self.damping * (self.stiffness @ u_past)
        u = numpy.zeros(len(load))
        u[self.free] = self.solve(load[self.free])
        rest = self.grid.nodes[self.touching]
        shape = rest.shape
        without = rest + u.reshape(-1, self.d)[self.touching]
        with_force, force = without, numpy.zeros(shape)
        for _ in range(25):  # the normals follow the nodes
            distance, normal = gap(with_force)
            m = len(rest)
            along = numpy.zeros((shape[0] * self.d, m))
            along[(self.d * numpy.arange(m)[:, None] + numpy.arange(self.d)).ravel(),
                  numpy.repeat(numpy.arange(m), self.d)] = normal.ravel()
            first = distance - numpy.einsum("ia,ia->i", normal, with_force - without)
            pressing, self.active = complementarity(along.T @ self.compliance @ along, first, self.active)
            force = pressing[:, None] * normal
            moved = without + (self.compliance @ force.ravel()).reshape(shape)
            change = abs(moved - with_force).max()
            with_force = moved
            if change < 1e-11:
                break
        u[self.free] += self.response @ force.ravel()
        if self.step is not None:
            self.v = [1.5 / h * u + u_past, self.v[0]]
        self.u = [u, self.u[0]]
        return force


def sphere(centre, radius):
    """The gap to a rigid ball."""
    def gap(points):
        off = points - centre
        length = numpy.linalg.norm(off, axis=1)
        return length - radius, off / length[:, None]
    return gap

