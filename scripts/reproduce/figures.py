"""The figures of the page: each function draws one picture into `folder`."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import draw
import impulse

LARGEST = 100_000  # bytes of a picture
IMPULSE_TIMES = (0.002, 0.006, 0.010, 0.016, 0.030, 0.060)  # s
SHOWN_DENT = 0.05  # m, to which the largest displacement of the impulse response is exaggerated


def save(figure, folder, name):
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=92)
    plt.close(figure)
    pack(path, path)


def pack(source, path):
    """With a palette: it looks the same."""
    picture = Image.open(source).convert("RGB")
    picture.quantize(255, Image.Quantize.MAXCOVERAGE, kmeans=3, dither=Image.Dither.NONE).save(path, optimize=True)
    if path.stat().st_size > LARGEST:
        raise SystemExit(f"reproduce: {path} has {path.stat().st_size} bytes, more than {LARGEST}")


def tapped_degree(model):
    """The node in the middle of the left face, pushed to the right."""
    return 3 * impulse.node_at(model, [model.rest[:, 0].min(), 0, 0])


def impulse_figures(folder, model):
    """Figures 3 to 5: the whole answer, its rigid component, its elastic component; same times, view and colours."""
    degree = tapped_degree(model)
    elastic = impulse.elastic(model, degree, IMPULSE_TIMES, model.dt)
    rigid = impulse.rigid(model, degree, IMPULSE_TIMES, model.dt)
    factor = SHOWN_DENT / np.linalg.norm(elastic + rigid, axis=2).max()
    camera = draw.Camera(-40, 22)
    shown = [model.rest + factor * field for field in (elastic + rigid, rigid, elastic)]
    limits = draw.limits_of([camera.project(cloud) for cloud in shown])
    sizes = 1000 * np.linalg.norm(elastic + rigid, axis=2)  # mm
    colours = draw.colour_scale(sizes.max(), 0.5)
    for name, field, wires in (("figure-3", elastic + rigid, False), ("figure-4", elastic + rigid, True),
                               ("figure-5", elastic, False)):
        figure, rows = plt.subplots(2, 3, figsize=(7.6, 5.3), layout="constrained")
        for axes, u, drift, time in zip(rows.flat, field, rigid, IMPULSE_TIMES):
            values = 1000 * np.linalg.norm(u, axis=1)
            draw.draw_surface(axes, camera, model.rest + factor * u, model.triangles,
                              None if wires else values, colours, 0.55 if wires else 1.0)
            if wires:
                draw.draw_wires(axes, camera, model.rest + factor * drift, model.triangles, "tab:red")
            draw.frame_scene(axes, limits, 0.05)
            axes.set_title(f"{1000 * time:.0f} ms", fontsize=10)
        if not wires:
            draw.colour_bar(figure, colours, rows, "displacement (mm) after 1 N during 2 ms", shrink=0.8, pad=0.02)
        save(figure, folder, name)
    return factor


def wave_figure(folder, model):
    """When the first peak passes a node of the tapped face, over its distance; speeds [m/s] by sampling interval."""
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    speeds = {}
    ends = np.array([0, 0.066])
    for dt, colour, mark in ((model.dt, "tab:blue", "o"), (model.dt / 10, "tab:orange", ".")):
        passages = impulse.first_peaks(model, tapped_degree(model), dt)
        speed, start = impulse.fitted_speed(passages)
        speeds[dt] = speed
        axes.plot(100 * passages[:, 0], 1000 * passages[:, 1], mark, color=colour, markersize=4, alpha=0.6,
                  label=f"sampled every {1000 * dt:g} ms: {speed:.1f} m/s")
        axes.plot(100 * ends, 1000 * (start + ends / speed), color=colour, linewidth=1)
    rayleigh, shear, dilatational = impulse.theoretical_speeds(model.material)
    for speed, style, name in ((rayleigh, "--", "Rayleigh"), (dilatational, ":", "dilatational")):
        axes.plot(100 * ends, 1000 * ends / speed, style, color="0.4", linewidth=1, label=f"{name} wave: {speed:.2f} m/s")
    axes.set_xlabel("distance along the face (cm)")
    axes.set_ylabel("time of the first peak (ms)")
    axes.set_xlim(0, 6.6)
    axes.set_ylim(0, None)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, "wave-speed")
    return speeds


def largest_shown(run, times):
    """Displacement of any node at `times` [m]."""
    return max(np.linalg.norm(run.displacement[run.frame(t)], axis=1).max() for t in times)


def sequence(folder, name, rows, times, camera, exaggeration, like=None):
    """Pictures of runs at `times` [s]. rows: (label, run, triangles) each; axes and colours are the same in all, and
    those of the rows `like` where another figure is to be compared with."""
    clouds = [[camera.project(run.places(run.frame(t), exaggeration)) for t in times] for _, run, _ in like or rows]
    colours = draw.colour_scale(1000 * max(largest_shown(run, times) for _, run, _ in like or rows), 0.6)
    box = row_limits(clouds, clouds[0])
    height = 0.35 + 1.45 * (box[3] - box[2]) / (box[1] - box[0])  # of a row, in inches
    figure, grid = plt.subplots(len(rows), len(times), figsize=(1.55 * len(times) + 0.9, height * len(rows) + 0.1),
                                layout="constrained", squeeze=False)
    for (label, run, triangles), cloud, line in zip(rows, clouds, grid):
        limits = row_limits(clouds, cloud)
        for axes, time in zip(line, times):
            axes.set_title(f"{time:.2f} s", fontsize=9)
            frame = run.frame(time)
            values = 1000 * np.linalg.norm(run.displacement[frame], axis=1)
            draw.draw_surface(axes, camera, run.places(frame, exaggeration), triangles, values, colours)
            tip = camera.project(run.tip[frame])
            axes.plot(*tip, "o", color="tab:red", markersize=4)
            draw.frame_scene(axes, limits, 0.05 if axes is line[0] else None)
        line[0].set_ylabel(label, fontsize=9)
    draw.colour_bar(figure, colours, grid, "displacement (mm)", shrink=0.9, pad=0.01)
    save(figure, folder, name)


def row_limits(clouds, cloud):
    """Frames of one size for all rows, each about the middle of its own row: objects stand side by side."""
    boxes = np.array([draw.limits_of(row) for row in clouds])
    half = np.array([(boxes[:, 1] - boxes[:, 0]).max(), (boxes[:, 3] - boxes[:, 2]).max()]) / 2
    left, right, bottom, top = draw.limits_of(cloud)
    x, y = (left + right) / 2, (bottom + top) / 2
    return x - half[0], x + half[0], y - half[1], y + half[1]


def over_time(folder, name, curves, ylabel):
    """curves: (label, time, values, style) each."""
    figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
    for label, time, values, style in curves:
        axes.plot(time, values, style, linewidth=1.2, label=label)
    axes.set_xlabel("time (s)")
    axes.set_ylabel(ylabel)
    axes.set_xlim(0, None)
    axes.set_ylim(0, None)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, name)
