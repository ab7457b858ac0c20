#!/usr/bin/env python3
"""Draws the picture of one of the examples drum, hopper, column and footing from what it wrote with --out DIR."""

import argparse
import csv
import sys
from pathlib import Path

DIAMETER, GRAVITY = 2e-3, 9.81  # of the beads, m; m/s^2
LAW, RUN = "#333333", "#c1440e"


class DataError(Exception):
    """A file that is missing or cannot be read; says which."""


def read(folder, name):
    """Columns of a CSV file as arrays, by name. Lines that start with # are skipped."""
    import numpy

    path = folder / f"{name}.csv"
    if not path.is_file():
        raise DataError(f"{path} is missing; write it with the example's --out {folder}")
    with open(path, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(line for line in stream if not line.startswith("#")))
    try:
        return {key: numpy.array([float(row[k]) for row in rows[1:]]) for k, key in enumerate(rows[0])}
    except (ValueError, IndexError) as error:
        raise DataError(f"{path} is no table of an example: {error}") from None


def draw_beads(axes, beads, keep, colour, across="x_m", label=None, largest=None):
    """Beads in a slice as discs to scale, coloured by `colour`. Returns what a colour bar needs."""
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle

    chosen = [k for k in range(len(keep)) if keep[k]]
    discs = PatchCollection([Circle((1e3 * beads[across][k], 1e3 * beads["z_m"][k]), 1e3 * beads["radius_m"][k])
                             for k in chosen], cmap="viridis", edgecolor="white", linewidth=0.15)
    discs.set_array([colour[k] for k in chosen])
    discs.set_clim(0.0, largest)
    axes.add_collection(discs)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("x (mm)")
    axes.set_ylabel("z (mm)")
    if label:
        axes.figure.colorbar(discs, ax=axes, label=label, shrink=0.75, pad=0.02)
    return discs


def draw_drum(folder, figure):
    import numpy

    beads, series, layers = (read(folder, name) for name in ("drum_particles", "drum", "drum_layers"))
    left, right = figure.subplots(1, 2, width_ratios=[1.15, 1])
    draw_beads(left, beads, numpy.ones(len(beads["x_m"]), bool), beads["speed_m_per_s"], label="speed (m/s)")
    radius = 1e3 * numpy.max(numpy.hypot(beads["x_m"], beads["z_m"]) + beads["radius_m"])
    turn = numpy.linspace(0, 2 * numpy.pi, 200)
    left.plot(radius * numpy.cos(turn), radius * numpy.sin(turn), color=LAW)
    steady = series["time_s"] > 0.4 * series["time_s"][-1]
    angle = numpy.mean(series["surface_deg"][steady])
    slope = numpy.tan(numpy.radians(angle))
    left.plot([-0.8 * radius, 0.8 * radius], [0.8 * radius * slope, -0.8 * radius * slope], "--", color=RUN)
    left.set_title(f"surface at {angle:.1f}°")
    right.plot(series["time_s"], series["surface_deg"], color=RUN, label="slope of the surface")
    right.plot(series["time_s"], series["centre_of_mass_deg"], color="tab:blue", label="centre of mass")
    right.axvspan(0.4 * series["time_s"][-1], series["time_s"][-1], color="0.88", label="averaged")
    right.set_xlabel("time (s)")
    right.set_ylabel("angle (degrees)")
    right.set_ylim(numpy.min(series["surface_deg"]) - 6, None)
    right.legend(loc="lower right", framealpha=1)
    inset = right.inset_axes([0.1, 0.1, 0.33, 0.3])
    inset.plot(layers["speed_m_per_s"], layers["depth_m"] / DIAMETER, ".-", color=RUN, markersize=3)
    inset.axvline(0.0, color="0.7", linewidth=0.8)
    inset.set_ylim(12, 0)
    inset.set_title("speed (m/s) over depth (d)", fontsize=8)
    inset.tick_params(labelsize=7)


def draw_hopper(folder, figure):
    import numpy

    beads, series, rates = (read(folder, name) for name in ("hopper_particles", "hopper", "hopper_rates"))
    left, middle, right = figure.subplots(1, 3, width_ratios=[1.3, 1, 1])
    draw_beads(left, beads, numpy.abs(beads["y_m"]) < DIAMETER, beads["speed_m_per_s"], label="speed (m/s)",
               largest=0.3)
    hole, edge = 500 * rates["hole_m"][-1], 1e3 * numpy.max(numpy.hypot(beads["x_m"], beads["y_m"]) + beads["radius_m"])
    for side in (-1, 1):
        left.plot([side * hole, side * edge, side * edge], [0, 0, 1e3 * numpy.max(beads["z_m"])], color=LAW)
    left.set_title("slice through the middle")
    for diameter in rates["hole_m"]:
        mine = series["hole_m"] == diameter
        middle.plot(series["time_s"][mine], 1e3 * series["discharged_kg"][mine], label=f"D = {diameter/DIAMETER:.0f} d")
    middle.set_xlabel("time (s)")
    middle.set_ylabel("discharged (g)")
    middle.legend(frameon=False)
    size, root = rates["hole_m"] / DIAMETER, (1e3 * rates["rate_kg_per_s"]) ** 0.4
    slope, offset = numpy.polyfit(size, root, 1)
    ends = numpy.array([-offset / slope, size[-1] + 0.5])
    right.plot(ends, slope * ends + offset, color=LAW, linewidth=1, label=f"straight line: k = {ends[0]:.2f}")
    right.plot(size, root, "o", color=RUN, label="runs")
    right.set_xlim(0, ends[1])
    right.set_ylim(0, None)
    right.set_xlabel("D/d")
    right.set_ylabel("rate$^{2/5}$, rate in g/s")
    right.legend(frameon=False, loc="upper left")


def draw_column(folder, figure):
    import numpy

    table, series = read(folder, "column_runout"), read(folder, "column")
    names = sorted(path.name[:-len("_start.csv")] for path in folder.glob("column_*_start.csv"))
    if not names:
        raise DataError(f"{folder} holds no column_*_start.csv")
    grid = figure.add_gridspec(2, 2, height_ratios=[1, 1.1])
    reach = 1.35e3 * numpy.max(series["radius_m"])
    start, end, axes = read(folder, names[-1] + "_start"), read(folder, names[-1]), figure.add_subplot(grid[0, :])
    for beads, colours in ((start, "Greys"), (end, "viridis")):
        front = numpy.abs(beads["y_m"]) < DIAMETER
        discs = draw_beads(axes, beads, front, numpy.hypot(beads["x_m"], beads["y_m"]) / DIAMETER)
        discs.set_cmap(colours)
        if beads is start:
            discs.set_clim(-12, 36)
    axes.set_xlim(-reach, reach)
    axes.set_title(f"slice through the middle, a = {table['aspect'][-1]:.2f}: standing (grey) and after the collapse",
                   fontsize=10)
    axes = figure.add_subplot(grid[1, 0])
    for aspect in table["aspect"]:
        mine = series["aspect"] == aspect
        axes.plot(series["time_s"][mine], 1e3 * series["radius_m"][mine], label=f"a = {aspect:.2f}")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("radius (mm)")
    axes.legend(frameon=False, fontsize=8)
    axes = figure.add_subplot(grid[1, 1])
    a = numpy.linspace(0.05, 1.1 * numpy.max(table["aspect"]), 400)
    axes.plot(a, numpy.where(a < 1.7, 1.24 * a, 1.6 * numpy.sqrt(a)), color=LAW, label="Lube et al. 2004")
    axes.plot(table["aspect"], table["runout"], "o", color=RUN, label="runs")
    axes.set_xlabel("a = height / radius")
    axes.set_ylabel("$(r_\\infty - r_0)/r_0$")
    axes.legend(frameon=False, fontsize=8)


def draw_section(axes, nodes, y, colour):
    """A box of cells where it is cut by one of its planes of nodes: the grid of the nodes there, displaced."""
    import numpy

    here = numpy.abs(nodes["Y_m"] - y) < 1e-9
    X, Z = nodes["X_m"][here], nodes["Z_m"][here]
    x, z = 1e3 * (X + nodes["ux_m"][here]), 1e3 * (Z + nodes["uz_m"][here])
    for lines, along in ((Z, X), (X, Z)):
        for value in numpy.unique(numpy.round(lines, 9)):
            row = numpy.flatnonzero(numpy.abs(lines - value) < 1e-9)
            row = row[numpy.argsort(along[row])]
            axes.plot(x[row], z[row], color=colour, linewidth=0.9)


def draw_footing(folder, figure):
    import numpy

    grains, soil, plate, series = (read(folder, name)
                                   for name in ("footing_grains", "footing_soil", "footing_plate", "footing"))
    left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
    middle = 0.5 * numpy.max(soil["Y_m"])
    draw_beads(left, grains, numpy.abs(grains["y_m"] - middle) < 0.01, grains["speed_m_per_s"], label="speed (m/s)",
               largest=0.2)
    draw_section(left, soil, middle, RUN)
    draw_section(left, plate, middle, LAW)
    left.autoscale_view()
    left.set_title("cut through the middle: plate, grains, overlap, soil", fontsize=10)
    right.plot(1e3 * series["depth_m"], 1e-3 * series["load_N"], color=RUN)
    right.set_xlabel("depth of the plate (mm)")
    right.set_ylabel("load (kN)")
    right.set_xlim(0, None)
    right.set_ylim(0, None)


FIGURES = {"drum": (draw_drum, (10, 4.4)), "hopper": (draw_hopper, (12, 4.2)), "column": (draw_column, (10, 5.2)),
           "footing": (draw_footing, (10, 5.4))}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("example", choices=sorted(FIGURES))
    parser.add_argument("folder", metavar="DIR", type=Path, help="what the example wrote with --out")
    parser.add_argument("image", metavar="FILE.png", type=Path, nargs="?", help="default: DIR/EXAMPLE.png")
    arguments = parser.parse_args()
    try:
        import matplotlib
    except ImportError:
        print(f"plot_dem: {sys.executable} has no matplotlib; install python3-matplotlib and run "
              "/usr/bin/python3 scripts/plot_dem.py", file=sys.stderr)
        return 2
    matplotlib.use("Agg")
    from matplotlib import pyplot

    draw, size = FIGURES[arguments.example]
    image = arguments.image or arguments.folder / f"{arguments.example}.png"
    figure = pyplot.figure(figsize=size, layout="constrained")
    figure.get_layout_engine().set(wspace=0.08)
    try:
        draw(arguments.folder, figure)
        figure.savefig(image, dpi=100)
    except (DataError, OSError) as error:
        print(f"plot_dem: {error}", file=sys.stderr)
        return 2
    print(f"wrote {image}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
