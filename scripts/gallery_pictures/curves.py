"""Curves of docs/recipes: computed values beside those by hand."""

import csv

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

HAND = {"color": "0.4", "linestyle": "--", "linewidth": 1.2}


def series(folder):
    with open(folder / "series.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: numpy.array([float(row[key]) for row in rows]) for key in rows[0]}


def finish(axes, x, y, legend="best"):
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(alpha=0.3)
    axes.legend(loc=legend)


def conveyor(table, figure):
    axes = figure.subplots()
    begin = table["time_s"][numpy.argmax(table["beads_vx_m_per_s"] > 1e-3) - 1]
    time = 1e3 * (table["time_s"] - begin)
    axes.plot(time, table["beads_vx_m_per_s"], label="beads, mean")
    axes.plot([0, 1e3 * 0.3 / (0.5 * 9.81), 400], [0, 0.3, 0.3], label="block that slips, by hand", **HAND)
    axes.set_xlim(-10, 200)
    finish(axes, "time since the belt moves (ms)", "velocity (m/s)")


def shear(table, figure):
    axes = figure.subplots()
    way = -1e3 * table["lower_ux_m"]
    ratio = -(table["lower_x_N"] + table["floor_x_N"]) / numpy.abs(table["lid_z_N"])
    axes.plot(way[1:], numpy.abs(ratio[1:]), label="shear box")
    axes.axhline(0.404, label="tan φ of the triaxial test", **HAND)
    axes.set_ylim(0, None)
    finish(axes, "displacement (mm)", "τ/σ")


def triaxial(table, figure):
    edges = [0.06 + table[f"{axis}_u{axis}_m"] for axis in "xyz"]
    stress = {axis: numpy.abs(table[f"{axis}_{axis}_N"]) / area
              for axis, area in zip("xyz", (edges[1] * edges[2], edges[0] * edges[2], edges[0] * edges[1]))}
    start = 1  # the row at the end of the first stage
    strain = 100 * (1 - edges[2] / edges[2][start])
    volume = edges[0] * edges[1] * edges[2]
    left, right = figure.subplots(1, 2)
    side = 0.5 * (stress["x"] + stress["y"])
    angle = numpy.degrees(numpy.arcsin((stress["z"] - side) / (stress["z"] + side)))
    left.plot(strain[start:], angle[start:], label="between walls")
    left.axhline(22.3, label="cell, largest", **HAND)
    finish(left, "axial strain (%)", "mobilised friction angle (°)")
    right.plot(strain[start:], 100 * (volume[start:] / volume[start] - 1), label="between walls")
    finish(right, "axial strain (%)", "change of volume (%)")


def wave(table, figure):
    axes = figure.subplots()
    time = 1e3 * table["time_s"]
    for k, (name, label, place) in enumerate((("grain_y_m", "grain at 4.2 m", 4.2), ("near_uy_m", "node at 13.2 m", 13.2),
                                              ("far_uy_m", "node at 16 m", 16.0))):
        axes.plot(time, 1e3 * (table[name] - table[name][0]), color=f"C{k}", label=label)
        half = 1e3 * (0.5 * 12.82e-3 + (place - 0.2) / 276.4)
        axes.plot(half, 0.5 * 0.6411, "o", color=f"C{k}", markersize=5)
    axes.axhline(0.6411, label="by hand; dots: half of it", **HAND)
    finish(axes, "time (ms)", "displacement (mm)", (0.31, 0.25))


CURVES = {"conveyor": ("belt", conveyor, (6, 3.3)), "shear-curve": ("recipes/shear", shear, (6, 3.3)),
          "triaxial-curve": ("recipes/triaxial", triaxial, (9, 3.3)), "wave-curve": ("recipes/wave", wave, (8, 3.3))}


def draw(name, runs, images):
    scene, plot, size = CURVES[name]
    figure = pyplot.figure(figsize=size)
    plot(series(runs / scene), figure)
    figure.tight_layout()
    figure.savefig(images / "recipes" / f"{name}.png", dpi=100)
    pyplot.close(figure)
