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

    touching: nodes that may touch. step [s] of the second order backward difference; None: statics. along: the axes of
    forces on them, default all. gravity: acceleration (d) [m/s^2]. light: the face that is touched, if it is to have no
    mass (Grid.assemble): nodes that meet something at some speed do not knock, so that forces are smooth.
    """

    def __init__(self, grid, material, fixed, touching, step, velocity=None, along=None, gravity=None,
                 light=None):
        d = grid.dimension
        self.grid, self.step, self.d = grid, step, d
        self.stiffness, self.mass, self.volume = grid.assemble(material, light)
        ordered = (d * grid.elimination_order()[:, None] + numpy.arange(d)).ravel()
        self.free = ordered[~numpy.isin(ordered, fixed)]
        self.damping = material["rayleigh_beta"]
        matrix = self.stiffness
        if step is not None:
            matrix = 2.25 / step**2 * self.mass + (1 + 1.5 / step * self.damping) * self.stiffness
        matrix = matrix[self.free][:, self.free]
        self.solve = scipy.sparse.linalg.splu(matrix.tocsc(), permc_spec="NATURAL",
                                              options={"SymmetricMode": True, "DiagPivotThresh": 0.0}).solve
        place = numpy.full(d * len(grid.nodes), -1)
        place[self.free] = numpy.arange(len(self.free))
        self.touching = touching
        along = numpy.arange(d) if along is None else numpy.array(along)
        dofs = place[(d * touching[:, None] + along)].ravel()  # -1: does not move
        self.pushed = dofs
        self.compliance = numpy.zeros((dofs.size, dofs.size))
        self.answers = numpy.zeros((dofs.size, len(self.free)))  # of all to a force of 1 N on one
        moves = numpy.flatnonzero(dofs >= 0)
        for some in numpy.array_split(moves, len(moves) // 50 + 1):
            unit = numpy.zeros((len(self.free), len(some)))
            unit[dofs[some], numpy.arange(len(some))] = 1.0
            self.answers[some] = self.solve(unit).T
        self.compliance[:, moves] = self.answers[:, dofs[moves]]
        self.active = numpy.zeros(len(touching), dtype=bool)
        speed = numpy.zeros(d * len(grid.nodes)) if velocity is None else numpy.tile(velocity, len(grid.nodes))
        self.weight = self.mass @ numpy.tile(numpy.zeros(d) if gravity is None else gravity, len(grid.nodes))
        self.u = [-k * (step or 0.0) * speed for k in range(2)]  # now, and a step before
        self.v = [speed, speed]

    def predict(self):
        """Displacements at the end of the coming step without contact."""
        load = self.weight.copy()
        if self.step is not None:
            past, v_past = self._past()
            load -= self.mass @ (1.5 / self.step * past + v_past) + self.damping * (self.stiffness @ past)
        self.without = numpy.zeros(len(load))
        self.without[self.free] = self.solve(load[self.free])
        return self.without

    def finish(self, force):
        """Takes the step that was predicted, with the forces on the touching nodes [N]."""
        pushing = numpy.flatnonzero(force.ravel())
        u = self.without.copy()
        u[self.free] += force.ravel()[pushing] @ self.answers[pushing]
        if self.step is not None:
            self.v = [1.5 / self.step * u + self._past()[0], self.v[0]]
        self.u = [u, self.u[0]]

    def _past(self):
        h = self.step
        return (-4 * self.u[0] + self.u[1]) / (2 * h), (-4 * self.v[0] + self.v[1]) / (2 * h)

    def advance(self, gap):
        """One step. gap: of points (n, d) the distances outside of the rigid shape (n) and its outward normals (n, d),
        at the step's end. Returns the force on each touching node [N] (n, d)."""
        u = self.predict()
        rest = self.grid.nodes[self.touching]
        shape = rest.shape
        without = rest + u.reshape(-1, self.d)[self.touching]
        with_force, force = without, numpy.zeros(shape)
        for _ in range(25):  # the normals follow the nodes
            distance, normal = gap(with_force)
            first = distance - numpy.einsum("ia,ia->i", normal, with_force - without)
            along = numpy.zeros((force.size, shape[0]))
            along[numpy.arange(force.size), numpy.repeat(numpy.arange(shape[0]), self.d)] = normal.ravel()
            pressing, self.active = complementarity(along.T @ self.compliance @ along, first, self.active)
            force = pressing[:, None] * normal
            moved = without + (self.compliance @ force.ravel()).reshape(shape)
            change = abs(moved - with_force).max()
            with_force = moved
            if change < 1e-11:
                break
        self.finish(force)
        return force


def sphere(centre, radius):
    """The gap to a rigid ball."""
    def gap(points):
        off = points - centre
        length = numpy.linalg.norm(off, axis=1)
        return length - radius, off / length[:, None]
    return gap

