"""The overview: the beam with its two particles at four instants, and the total energy."""

import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, PowerNorm

from .data import BENDING, LENGTH, PUBLISHED_PEAK, RADIUS, SIDE, WEIGHT
from .style import AUTHORS, BLUE, GREY, LIGHT, VERMILLION, save
from .vtu import read_frames, read_vtu

STOPS = (0.2, 4.5, 8.5, 11.85)  # m, where particle 1 is when the beam is drawn
DEPTH = numpy.array([0.42, 0.30])  # oblique projection: where one metre in -x goes in the picture
SHADES = LinearSegmentedColormap.from_list("energy", ["#f4f6f8", "#a9c8e0", "#4a8fbf", "#0b4f86"])


def project(points):
    """Oblique view from the side x > 0 and above: y to the right, z up, −x into the depth."""
    return numpy.stack([points[:, 1] - DEPTH[0] * points[:, 0], points[:, 2] - DEPTH[1] * points[:, 0]], axis=1)


class Beam:
    """Outer faces of a deformed hexahedral mesh that the viewer sees."""

    def __init__(self, points, reference, elements, energy):
        self.faces, self.values = [], []
        for face, axis in (((1, 2, 6, 5), 0), ((4, 5, 6, 7), 2), ((2, 3, 7, 6), 1)):  # x+, z+, y+ of a brick
            outer = reference[:, axis].max()
            for element, value in zip(elements, energy):
                corners = element[list(face)]
                if numpy.allclose(reference[corners, axis], outer):
                    self.faces.append(project(points[corners]))
                    self.values.append(value)

    @classmethod
    def from_frame(cls, path):
        arrays = read_vtu(path)
        points, elements = arrays["Points"], arrays["connectivity"].reshape(-1, 8)
        return cls(points, points - arrays["displacement_m"], elements, arrays["strain_energy_J"])

    @classmethod
    def from_formula(cls, load_position):
        """The static Euler-Bernoulli shape under both particles at `load_position`."""
        nx, ny, nz = 2, 30, 2
        grid = numpy.meshgrid(numpy.linspace(-SIDE / 2, SIDE / 2, nx + 1), numpy.linspace(0, LENGTH, ny + 1),
                              numpy.linspace(-SIDE / 2, SIDE / 2, nz + 1), indexing="ij")
        reference = numpy.stack([axis.ravel() for axis in grid], axis=1)
        number = numpy.arange(len(reference)).reshape(nx + 1, ny + 1, nz + 1)
        a, b = slice(None, -1), slice(1, None)
        corners = ((a, a, a), (b, a, a), (b, b, a), (a, b, a), (a, a, b), (b, a, b), (b, b, b), (a, b, b))
        elements = numpy.stack([number[corner].ravel() for corner in corners], axis=1)
        y = reference[:, 1]
        inside = numpy.minimum(y, load_position)
        sag = WEIGHT / BENDING * (inside**2 * load_position / 2 - inside**3 / 6
                                  + (y - inside) * load_position**2 / 2)
        points = reference - sag[:, None] * [0, 0, 1]
        return cls(points, reference, elements, numpy.zeros(len(elements)))


def _stops(run):
    """[(time, particle centres, beam)] where particle 1 passes the STOPS it reached."""
    time, y = run["time_s"], run["y1_m"]
    frames = read_frames(run.folder / "beam.pvd") if (run.folder / "beam.pvd").is_file() else []
    stops = []
    for stop in STOPS:
        if stop > y.max() + 0.3:
            continue
        row = int(numpy.argmin(numpy.abs(y - stop)))
        if frames:
            row = int(numpy.argmin(numpy.abs(time - min((abs(t - time[row]), t) for t, _ in frames)[1])))
            file = min(frames, key=lambda frame: abs(frame[0] - time[row]))[1]
            beam = Beam.from_frame(file)
        else:
            beam = Beam.from_formula(min(y[row], LENGTH))
        centres = numpy.array([[run[f"{axis}{i}_m"][row] for axis in "xyz"] for i in (2, 1)])
        stops.append((time[row], centres, beam))
    return stops, bool(frames)


def _draw_particles(axes, centres):
    for centre in project(centres):
        for share in numpy.linspace(1, 0.15, 12):  # a highlight up to the left
            shade = numpy.array(plt.matplotlib.colors.to_rgb(VERMILLION))
            colour = shade * (0.72 + 0.28 * (1 - share)) + 0.45 * (1 - share) ** 1.5 * (1 - shade)
            axes.add_patch(plt.Circle(centre + RADIUS * (1 - share) * numpy.array([-0.35, 0.4]), RADIUS * share,
                                      facecolor=numpy.clip(colour, 0, 1), linewidth=0))


def _draw_stop(axes, time, centres, beam, norm):
    rest = [(LENGTH, SIDE / 2, -SIDE / 2), (LENGTH, SIDE / 2, SIDE / 2), (LENGTH, -SIDE / 2, SIDE / 2)]
    corners = numpy.array([[x, y, z] for y, x, z in rest])
    clamp = corners * [1, 0, 1]
    for start, end in zip(project(clamp), project(corners)):
        axes.plot(*zip(start, end), color=GREY, linewidth=0.7, linestyle=(0, (4, 3)), zorder=0)
    axes.add_collection(PolyCollection(beam.faces, array=numpy.array(beam.values), cmap=SHADES, norm=norm,
                                       edgecolors="#5c6b78", linewidths=0.45))
    wall = project(numpy.array([[0.55, 0, -0.55], [0.55, 0, 0.55], [-0.55, 0, 0.55], [-0.55, 0, -0.55]]))
    axes.add_patch(plt.Polygon(wall - [0.02, 0], facecolor=LIGHT, edgecolor=GREY, linewidth=0.6, zorder=0))
    _draw_particles(axes, centres)
    axes.text(12.5, 0.0, f"t = {time:.1f} s", va="center", fontsize=10)
    axes.set_xlim(-0.5, 13.6)
    axes.set_ylim(-0.92, 0.78)
    axes.set_aspect("equal")
    axes.axis("off")


def _draw_published(axes, width, peak, reference, end):
    """The authors' curve if there is one, else a line at its peak."""
    colour = AUTHORS[width]
    if reference:
        on = reference.on_beam & (reference.time <= end)
        axes.plot(reference.time[on], reference.energy[on], color=colour, linewidth=1.2)
    else:
        axes.axhline(peak, color=colour, linewidth=1.4, linestyle="--")
    text = f"authors, c = {width:g} d: up to {peak:g} J" if width else f"authors, c = 0: grows to {peak:g} J"
    axes.text(0.985 * end, peak * (1.45 if width else 0.4), text, color=colour, ha="right",
              va="bottom" if width else "top", fontsize=10, fontweight="bold")


def _draw_energy(axes, run, references):
    time, energy = run["time_s"], run["energy_total_J"]
    end = max(time[-1], 1e-3)
    curves = {reference.width: reference for reference in references}
    for width, peak in PUBLISHED_PEAK.items():
        _draw_published(axes, width, peak, curves.get(width), end)
    axes.plot(time, numpy.where(energy > 0, energy, numpy.nan), color=BLUE, linewidth=2.6)
    low = run.results.get("energy_min_J") or numpy.nanmin(energy)  # a run that broke down has no finite ones
    high = run.results.get("energy_max_J") or numpy.nanmax(energy)
    axes.text(0.985 * end, 0.62 * max(low, 0.2), f"Dovetail, {run.name}: {low:.5g} … {high:.5g} J", color=BLUE,
              ha="right", va="top", fontsize=10, fontweight="bold")
    axes.set_yscale("log")
    axes.set_ylim(min(0.1, 0.2 * max(low, 0.05)), max(2e4, 4 * high))
    axes.set_xlim(0, end)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("energy (J)")
    axes.set_title("Total energy, which nothing should change (exact: 0.8716 J)")


def draw_overview(run, references, path):
    stops, measured = _stops(run)
    height = 0.95 * len(stops) + 3.6
    figure = plt.figure(figsize=(9, height))
    top = 1 - 0.42 / height
    norm = PowerNorm(0.5, 0, max([max(beam.values) for _, _, beam in stops] + [1e-12]))
    for k, (time, centres, beam) in enumerate(stops):
        axes = figure.add_axes((0.02, top - 0.95 * (k + 1) / height, 0.97, 0.95 / height))
        _draw_stop(axes, time, centres, beam, norm)
    figure.text(0.03, 1 - 0.3 / height, "Two particles of 84 kg slide from the clamp to the free end"
                + (", to scale; blue: strain energy" if measured
                   else ", to scale; beam: static Euler-Bernoulli shape"), fontsize=10.5)
    energy = figure.add_axes((0.085, 0.55 / height, 0.885, 2.35 / height))
    _draw_energy(energy, run, references)
    return save(figure, path)
