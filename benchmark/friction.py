"""Coulomb friction of an elastic body's nodes with a rigid ball, exact at the end of each step."""

import numpy

TOLERANCE = 1e-9  # of the largest force, and of the gaps and slips that it makes


def _basis(normal):
    """The normal and two tangents of each node, as columns (n, 3, 3)."""
    across = numpy.eye(3)[numpy.argmin(abs(normal), axis=1)]
    first = numpy.cross(normal, across)
    first /= numpy.linalg.norm(first, axis=1)[:, None]
    return numpy.stack([normal, first, numpy.cross(normal, first)], axis=2)


def _newton_rows(force, gap, slip, scale, friction):
    """Alart and Curnier's equations of nodes in touch, linearised: a dw + b dy = c, where w are gap and slips and y are
    normal force and tangential forces. Each of a and b: (n, 3, 3), c: (n, 3)."""
    count = len(gap)
    a, b, c = numpy.zeros((count, 3, 3)), numpy.zeros((count, 3, 3)), numpy.zeros((count, 3))
    a[:, 0, 0], c[:, 0] = 1.0, -gap
    pressing = force[:, 0] - scale * gap
    trial = force[:, 1:] - scale[:, None] * slip
    length = numpy.linalg.norm(trial, axis=1)
    sticks = length <= friction * pressing
    a[sticks, 1, 1] = a[sticks, 2, 2] = 1.0
    c[sticks, 1:] = -slip[sticks]
    s = numpy.flatnonzero(~sticks)
    way = trial[s] / length[s, None]
    across = (friction * pressing[s] / length[s])[:, None, None] * (
        numpy.eye(2) - numpy.einsum("ia,ib->iab", way, way))
    b[s[:, None, None], [[1], [2]], [[1, 2]]] = numpy.eye(2) - across
    b[s[:, None], [1, 2], 0] = -friction * way
    a[s[:, None, None], [[1], [2]], [[1, 2]]] = scale[s, None, None] * across
    a[s[:, None], [1, 2], 0] = friction * scale[s, None] * way
    c[s, 1:] = friction * pressing[s, None] * way - force[s, 1:]
    return a, b, c


class Grip:
    """The friction of a Body's touching nodes, whose three axes may be pushed, with a ball that does not turn.

    friction: the coefficient. The slip of a node in a step is its way less the ball's, along the ball's surface.
    """

    def __init__(self, body, centre, radius, friction):
        self.body, self.centre, self.radius, self.friction = body, centre, radius, friction
        self.compliance = body.compliance.copy()
        still = numpy.flatnonzero(body.pushed < 0)  # of planes of symmetry: no force acts there
        self.compliance[still, still] = self.compliance.diagonal().max()
        self.scale = 1 / self.compliance.diagonal().reshape(-1, 3).mean(axis=1)
        self.rest = body.grid.nodes[body.touching]
        self.force = numpy.zeros_like(self.rest)

    def advance(self, centre):
        """One step, at whose end the ball is at `centre`. Returns the force on each touching node [N] (n, 3)."""
        before = self.rest + self.body.u[0].reshape(-1, 3)[self.body.touching]
        free = self.rest + self.body.predict().reshape(-1, 3)[self.body.touching]
        way, force = centre - self.centre, self.force.copy()
        for _ in range(100):
            now = free + (self.compliance @ force.ravel()).reshape(-1, 3)
            off = now - centre
            distance = numpy.linalg.norm(off, axis=1)
            gap = distance - self.radius
            basis = _basis(off / distance[:, None])
            local = numpy.einsum("iab,ia->ib", basis, force)
            slip = numpy.einsum("iab,ia->ib", basis[:, :, 1:], now - before - way)
            which = numpy.flatnonzero(local[:, 0] - self.scale * gap > 0)
            lost, force = force, numpy.zeros_like(force)
            force[which], lost[which] = lost[which], 0.0
            opened = lost.any()
            if len(which) == 0:
                if not opened:
                    break
                continue
            a, b, c = _newton_rows(local[which], gap[which], slip[which], self.scale[which], self.friction)
            dofs = (3 * which[:, None] + numpy.arange(3)).ravel()
            size = len(dofs)
            a, b = (numpy.einsum("iab,icb->iac", rows, basis[which]) for rows in (a, b))  # of W's components
            within = self.compliance[numpy.ix_(dofs, dofs)].reshape(len(which), 3, size)
            matrix = numpy.matmul(a, within).reshape(size, size)
            own = numpy.arange(size).reshape(-1, 3)
            matrix[own[:, :, None], own[:, None, :]] += b
            if opened:  # what open nodes no longer push moves the others
                c += numpy.einsum("iab,ib->ia", a, (self.compliance[dofs] @ lost.ravel()).reshape(-1, 3))
            step = numpy.linalg.solve(matrix, c.ravel()).reshape(-1, 3)
            force[which] += step
            if not opened and abs(step).max() <= TOLERANCE * abs(force).max():
                break
        else:
            raise ArithmeticError(f"friction: no convergence, change {abs(step).max():.3g} N")
        self.centre, self.force = centre, force
        self.body.finish(force)
        return force
