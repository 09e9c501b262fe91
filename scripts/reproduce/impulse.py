"""The answer of the free body to an impulse on one surface node, and how fast it runs along the surface."""

import numpy as np


def node_at(model, place):
    return int(np.argmin(np.linalg.norm(model.rest - place, axis=1)))


def elastic(model, degree, times, length):
    """Displacement (steps, n, 3) [m, B] at `times` [s] after 1 N on a degree of freedom during [0, length)."""
    w, sigma = model.w, model.decay
    damped = np.sqrt(np.abs(w**2 - sigma**2))
    over = w <= sigma  # an overdamped mode has two real rates

    def held(t):
        # Response of q'' + 2 sigma q' + w^2 q = 1 from rest, at t >= 0.
        t = max(t, 0.0)
        slow, fast = -sigma + damped, -sigma - damped
        oscillating = np.exp(-sigma * t) * (np.cos(damped * t) + sigma / damped * np.sin(damped * t))
        creeping = (slow * np.exp(fast * t) - fast * np.exp(slow * t)) / (slow - fast)
        return (1 - np.where(over, creeping, oscillating)) / w**2

    amplitude = np.array([held(t) - held(t - length) for t in times])  # (steps, r)
    return ((amplitude * model.shapes[degree]) @ model.shapes.T).reshape(len(times), -1, 3)


def rigid(model, degree, times, length):
    """The same of the rigid motion: its velocity [m/s, B] is reached during the force, then it drifts."""
    node, axis = divmod(degree, 3)
    force = np.eye(3)[axis]
    spin = np.linalg.solve(model.inertia, np.cross(model.rest[node], force))
    velocity = length * (force / model.mass + np.cross(spin, model.rest))  # (n, 3)
    drift = np.array([t - length / 2 if t > length else t * t / (2 * length) for t in times])
    return drift[:, None, None] * velocity


def theoretical_speeds(material):
    """Rayleigh, shear and dilatational wave [m/s]."""
    e, nu, rho = (material[key] for key in ("youngs_modulus", "poisson_ratio", "density"))
    mu, la = e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))
    shear, dilatational = np.sqrt(mu / rho), np.sqrt((la + 2 * mu) / rho)
    q = np.linspace(0.1, 1, 1_000_001)  # (c / shear)^2
    excess = (2 - q) ** 2 - 4 * np.sqrt(1 - q) * np.sqrt(1 - q * (shear / dilatational) ** 2)
    return shear * np.sqrt(q[np.argmax(excess >= 0)]), shear, dilatational


def first_peaks(model, degree, dt):
    """Distance [m] and time of the first peak [s] of every node of the tapped face: the first maximum of the length of
    the total displacement that is at least 30 % of the largest while a Rayleigh wave runs over the face
    (docs/check.md; precompute/check/wave_speed.cpp)."""
    node = degree // 3
    source = model.rest[node]
    away = model.rest - source
    distance = np.linalg.norm(away, axis=1)
    outward = source / np.linalg.norm(source)
    seen = (distance > 0) & (distance <= 1.1 * np.linalg.norm(source))
    seen &= np.abs(away @ outward) <= 0.2 * distance
    duration = 2 * np.linalg.norm(source) / theoretical_speeds(model.material)[0]
    times = dt * np.arange(1, int(duration / dt) + 4)
    total = elastic(model, degree, times, dt) + rigid(model, degree, times, dt)
    moved = np.linalg.norm(total, axis=2)
    found = []
    for i in np.flatnonzero(seen):
        m = moved[:, i]
        tops = (m[1:-1] > 0.3 * m.max()) & (m[1:-1] >= m[:-2]) & (m[1:-1] > m[2:])
        if not tops.any():
            continue
        s = 1 + int(np.argmax(tops))
        bend = m[s - 1] - 2 * m[s] + m[s + 1]
        found.append((distance[i], dt * (s + 1 + 0.5 * (m[s - 1] - m[s + 1]) / bend)))
    return np.array(found)


def fitted_speed(passages):
    """Speed [m/s] and start [s] of the line time = start + distance / speed."""
    slope, start = np.polyfit(passages[:, 0], passages[:, 1], 1)
    return 1 / slope, start
