"""Figures of the four studies, each from its CSV table."""

import matplotlib.pyplot as plt
import numpy

from .data import PUBLISHED_ERROR, PUBLISHED_PEAK, PUBLISHED_SECONDS, START_ENERGY, numbers, read_table
from .style import BLACK, BLUE, GREEN, GREY, ORANGE, SKY, VERMILLION, save

VARIANTS = {"conservative": (BLUE, "o", "conservative (symmetric kernel)"),
            "conservative, linear": (SKY, "^", "linear correction instead"),
            "conservative, no correction": (GREEN, "v", "no correction instead"),
            "paper": (VERMILLION, "s", "paper, as rebuilt here")}


class Study:
    """The rows of a study; numbers as arrays, text as lists."""

    def __init__(self, path):
        self.path, self.table = path, read_table(path)
        self.label, self.outcome = self.table["label"], self.table["outcome"]

    def __getitem__(self, name):
        return numbers(self.table, name, self.path)

    def where(self, column, value):
        return numpy.array([text == value for text in self.table[column]])

    @property
    def ran(self):
        return ~(self.where("outcome", "refused") | self.where("outcome", "broke down"))


def _log_with_zeros(axes, x, values, floor, **style):
    """A log axis has no zero: zeros are drawn on the floor, hollow."""
    zero = values <= floor
    axes.plot(x, numpy.where(zero, floor, values), **style)
    axes.plot(x[zero], numpy.full(zero.sum(), floor), color="white", linestyle="none", marker=style.get("marker", "o"),
              markersize=0.55 * style.get("markersize", 6), zorder=4)
    return zero.any()


def _legend_below(figure, axes, columns):
    handles, labels = axes.get_legend_handles_labels()
    rows = -(-len(labels) // columns)
    height = (0.12 + 0.21 * rows) / figure.get_figheight()
    figure.tight_layout(rect=(0, height, 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=columns, borderaxespad=0.3)


def draw_widths(source, path):
    study = Study(source)
    figure, panels = plt.subplots(1, 3, figsize=(10, 3.9))
    columns = (("time_mean_error_m", 1e3, 1, "error against the static formula (mm)"),
               ("energy_drift_relative", 1, 1e-6, "largest |E − E(0)| / E(0)"),
               ("lateral_drift_m", 1e3, 1e-7, "largest sideways drift (mm)"))
    for axes, (column, scale, floor, title) in zip(panels, columns):
        zeros = False
        for variant, (colour, marker, name) in VARIANTS.items():
            rows = numpy.array([label.rsplit(", c =", 1)[0] == variant for label in study.label]) & study.ran
            if not rows.any():
                continue
            zeros |= _log_with_zeros(axes, study["cg_width_diameters"][rows], scale * study[column][rows], floor,
                                     color=colour, marker=marker, label=name, zorder=3)
        published = {"time_mean_error_m": {c: scale * e for c, e in PUBLISHED_ERROR.items()},
                     "energy_drift_relative": {c: e / START_ENERGY - 1 for c, e in PUBLISHED_PEAK.items()}}
        if column in published:
            axes.plot(*zip(*published[column].items()), color=BLACK, marker="x", linestyle="none", markersize=7,
                      label="authors' output", zorder=5)
        axes.set_yscale("log")
        axes.set_ylim(bottom=0.6 * floor)
        axes.set_title(title)
        if zeros:
            axes.text(0.98, 0.03, "hollow: 0", transform=axes.transAxes, ha="right", color=GREY, fontsize=9)
        axes.set_xlabel("kernel width c / d")
        axes.set_xlim(left=-0.8)
    _legend_below(figure, panels[0], 3)
    return save(figure, path)


MESHES = {"2,15,1": ("o", "2 × 15 × 1"), "2,30,2": ("s", "2 × 30 × 2"), "4,60,4": ("^", "4 × 60 × 4")}
ELEMENTS = {"hex8": ORANGE, "hybrid8": BLUE}


def _draw_front(axes, seconds, values, front):
    order = numpy.argsort(seconds[front])
    axes.step(seconds[front][order], values[front][order], where="post", color=BLACK, linewidth=1, zorder=1,
              label="front: nothing is faster and better")


def draw_pareto(source, path):
    study = Study(source)
    seconds = study["wall_seconds"]
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.6))
    drift = PUBLISHED_PEAK[10.0] / START_ENERGY - 1
    columns = (("time_mean_error_dynamic_m", 1e3, "on_error_front", "error against the moving-mass beam (mm)",
                1e3 * PUBLISHED_ERROR[10.0], "authors' code, 10 d:\n4.9 mm (static formula)"),
               ("energy_drift_relative", 1, "on_drift_front", "largest |E − E(0)| / E(0)", drift,
                f"authors' code, 10 d:\n{drift:.2g}"))
    for axes, (column, scale, front, title, published, text) in zip(panels, columns):
        values, ran = scale * study[column], study.where("outcome", "finished")
        for element, colour in ELEMENTS.items():
            for mesh, (marker, name) in MESHES.items():
                rows = study.where("element", element) & study.where("mesh", mesh) & ran
                axes.plot(seconds[rows], values[rows], linestyle="none", marker=marker, markersize=5.5, color=colour,
                          markeredgecolor="white", markeredgewidth=0.5, label=f"{element}, {name}", zorder=2)
        _draw_front(axes, seconds, values, (study[front] == 1) & ran)
        axes.plot(PUBLISHED_SECONDS, published, color=VERMILLION, marker="X", markersize=9, linestyle="none")
        axes.annotate(text, (PUBLISHED_SECONDS, published), xytext=(-9, 0), textcoords="offset points", ha="right",
                      va="center", color=VERMILLION, fontsize=9)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlim(right=3 * PUBLISHED_SECONDS)
        axes.set_ylim(top=max(axes.get_ylim()[1], 3 * published))
        axes.set_xlabel("run time, one thread (s)")
        axes.set_title(title)
    _legend_below(figure, panels[0], 4)
    return save(figure, path)


OUTCOMES = {"finished": (BLUE, "o", "finished, bounded"), "not stable": (ORANGE, "D", "ran, energy not bounded"),
            "broke down": (VERMILLION, "X", "broke down, said when"), "refused": (GREY, "v", "refused before the run")}


def draw_stability(source, path):
    study = Study(source)
    groups = (("dt at", "dt_factor", "time step / critical step", "linear"),
              ("stiffness ratio", "stiffness_ratio", "contact stiffness / (E d)", "log"),
              ("width", "cg_width_diameters", "kernel width c / d", "log"))
    drift = numpy.array([float(text) if text not in ("nan", "") else numpy.inf
                         for text in study.table["energy_drift_relative"]])
    top, floor = 1e4, 1e-9
    figure, panels = plt.subplots(1, 3, figsize=(10, 3.9), sharey=True)
    for axes, (head, column, title, scale) in zip(panels, groups):
        mine = numpy.array([label.startswith(head) for label in study.label])
        x = numpy.array([float(text.split()[0]) if text != "auto" else numpy.nan for text in study.table[column]])
        for outcome, (colour, marker, name) in OUTCOMES.items():
            rows = mine & study.where("outcome", outcome)
            values = numpy.full(rows.sum(), top) if outcome in ("refused", "broke down") else drift[rows]
            axes.plot(x[rows], numpy.clip(values, floor, top), linestyle="none", marker=marker, color=colour,
                      markersize=7, label=name, zorder=3,
                      markerfacecolor="white" if outcome == "refused" else colour)
        axes.set(xscale=scale, yscale="log", ylim=(floor, 3 * top), xlabel=title)
    panels[0].axvline(1, color=BLACK, linewidth=0.8, linestyle="--")
    panels[0].set_title("largest |E − E(0)| / E(0); at the top: no run")
    _legend_below(figure, panels[0], 4)
    return save(figure, path)


def _draw_ablation_panel(axes, study, rows, names):
    made = (study["made_by_coupling_J"] - study["dashpots_J"])[rows]
    departure = (study["energy_drift_relative"] * study["energy_initial_J"])[rows]
    places, floor = numpy.arange(len(made))[::-1], 1e-6
    for sign, colour, name in ((1, VERMILLION, "created"), (-1, SKY, "destroyed")):
        size = numpy.where(sign * made > floor, sign * made, 0)
        axes.barh(places, numpy.maximum(size, floor) - floor, left=floor, color=colour, height=0.62, label=name)
    axes.plot(numpy.maximum(departure, floor), places, linestyle="none", marker="D", color=BLACK, markersize=4.5,
              label="largest |E − E(0)| on the way")
    axes.set_xscale("log")
    axes.set_xlim(left=floor)
    axes.set_yticks(places, names)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("energy (J)")


def draw_ablation(source, path):
    study = Study(source)
    widths = study["cg_width_diameters"]
    kinds = sorted(set(widths))
    figure, panels = plt.subplots(1, len(kinds), figsize=(10, 4.6), sharey=True, squeeze=False)
    for axes, width in zip(panels[0], kinds):
        rows = (widths == width) & study.ran
        names = [label.rsplit(", c =", 1)[0] for label, use in zip(study.label, rows) if use]
        _draw_ablation_panel(axes, study, rows, names)
        axes.set_title(f"c = {width:g} d" if width else "c = 0")
    figure.suptitle("Energy that each part of the paper's scheme makes, until the particles leave "
                    f"(start: {START_ENERGY} J)", x=0.01, ha="left", fontsize=10.5)
    _legend_below(figure, panels[0][0], 3)
    return save(figure, path)


BY_NAME = {"widths": draw_widths, "pareto": draw_pareto, "stability": draw_stability, "ablation": draw_ablation}
