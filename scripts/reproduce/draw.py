"""Draws deformed surfaces: seen from far away, shaded, coloured by a value at each node."""

import matplotlib
import matplotlib.ticker
from matplotlib.collections import LineCollection, PolyCollection
import numpy as np


class Camera:
    """Looks at the scene from `azimuth` degrees round the vertical (y), from the z axis towards x, and `elevation`
    above the horizon; parallel rays."""

    def __init__(self, azimuth, elevation):
        a, e = np.radians(azimuth), np.radians(elevation)
        self.back = np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])
        self.right = np.array([np.cos(a), 0, -np.sin(a)])
        self.up = np.cross(self.back, self.right)

    def project(self, places):
        return places @ np.array([self.right, self.up]).T


def seen(camera, places, triangles):
    """Triangles that face the camera, the farthest first; and the normals of all."""
    corners = places[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    order = np.argsort(corners.mean(axis=1) @ camera.back)
    return order[(normals @ camera.back)[order] > 0], normals


def draw_surface(axes, camera, places, triangles, values=None, colours=None, alpha=1.0):
    """values: (n) at the nodes, for `colours`, a ScalarMappable; without them the surface is grey."""
    corners = places[triangles]
    order, normals = seen(camera, places, triangles)
    light = camera.back + 0.6 * camera.up - 0.4 * camera.right
    shade = 0.62 + 0.38 * np.clip(normals @ light / np.linalg.norm(light), 0, 1)
    if values is None:
        faces = np.full((len(triangles), 4), 0.85)
    else:
        faces = colours.to_rgba(values[triangles].mean(axis=1))
    faces[:, :3] *= shade[:, None]
    faces[:, 3] = alpha
    edges = faces.copy()
    edges[:, :3] *= 0.85 if values is not None else 1.0
    axes.add_collection(PolyCollection(camera.project(corners[order]), facecolors=faces[order],
                                       edgecolors=edges[order], linewidths=0.25))


def draw_wires(axes, camera, places, triangles, colour):
    """The lines of the regular grid on the side of a box that is seen: the longest edge of each triangle, its diagonal,
    is left out."""
    triangles = triangles[seen(camera, places, triangles)[0]]
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    lengths = np.linalg.norm(places[edges[:, :, 0]] - places[edges[:, :, 1]], axis=2)
    keep = lengths < lengths.max(axis=1, keepdims=True) - 1e-6
    lines = np.unique(edges[keep], axis=0)
    axes.add_collection(LineCollection(camera.project(places[lines]), colors=colour, linewidths=0.6))


def frame_scene(axes, limits, scale=None):
    """limits: (left, right, bottom, top) [m], the same for all that is to be compared; scale: a bar of this length."""
    axes.set_aspect("equal")
    axes.set_xlim(limits[:2])
    axes.set_ylim(limits[2:])
    axes.set_xticks([])
    axes.set_yticks([])
    for side in axes.spines.values():
        side.set_color("0.8")
    if scale:
        x, y = limits[0] + 0.06 * (limits[1] - limits[0]), limits[2] + 0.06 * (limits[3] - limits[2])
        axes.plot([x, x + scale], [y, y], color="black", linewidth=1.5, solid_capstyle="butt")
        axes.text(x, y + 0.02 * (limits[3] - limits[2]), f"{100 * scale:.0f} cm", fontsize=7)


def limits_of(clouds, margin=0.012):
    """That hold all projected points of `clouds`."""
    points = np.concatenate([cloud.reshape(-1, 2) for cloud in clouds])
    (left, bottom), (right, top) = points.min(axis=0) - margin, points.max(axis=0) + margin
    return left, right, bottom, top


def colour_scale(largest, power=1.0):
    norm = matplotlib.colors.PowerNorm(power, 0, largest, clip=True)
    return matplotlib.cm.ScalarMappable(norm, matplotlib.colormaps["YlGnBu"])


def colour_bar(figure, colours, grid, label, **place):
    """Marks at round values, none above the largest: a mark there would be drawn at the end of the bar."""
    bar = figure.colorbar(colours, ax=grid, **place)
    largest = colours.norm.vmax
    bar.set_ticks([value for value in matplotlib.ticker.MaxNLocator(5).tick_values(0, largest) if value <= largest])
    bar.set_label(label, fontsize=9, labelpad=6)
    bar.ax.tick_params(labelsize=8)
