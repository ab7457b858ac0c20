"""Figures of the four studies, each from its CSV table."""

import matplotlib.pyplot as plt
import numpy
from cantilever_plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION, save

from .data import Study

CONSTRAINTS = {"penalty": (BLUE, "o"), "multiplier": (GREEN, "^"), "dashpot": (VERMILLION, "s"),
               "stress": (PURPLE, "D")}


def _legend_below(figure, handles, labels, columns):
    rows = -(-len(labels) // columns)
    figure.tight_layout(rect=(0, (0.14 + 0.21 * rows) / figure.get_figheight(), 1, 1))
    figure.legend(handles, labels, loc="lower center", ncol=columns, borderaxespad=0.3)


def _legend_of(figure, axes, columns):
    _legend_below(figure, *axes.get_legend_handles_labels(), columns)


def draw_widths(source, path):
    study = Study(source)
    figure, panels = plt.subplots(1, 3, figsize=(10.5, 3.9))
    width, paper = study["cg_width_elements"], study.where("scheme", "paper")
    for axes, column, title in zip(panels, ("waveform_error_fem", "energy_lost_fraction"),
                                   ("waveform error in the solid", "|energy lost| / input")):
        for name in ("penalty", "multiplier"):
            rows = study.where("constraint", name) & ~paper & study.finished
            colour, marker = CONSTRAINTS[name]
            axes.plot(width[rows], numpy.abs(study[column][rows]), color=colour, marker=marker, label=name,
                      markersize=8 if name == "penalty" else 5)
        rows = paper & study.finished
        axes.plot(width[rows], study[column][rows], color=VERMILLION, marker="s",
                  label="paper, as rebuilt here (impulse)")
        axes.set(yscale="log", title=title, xlabel="kernel width c / element")
    rows = paper & study.finished
    panels[2].plot(width[rows], study["paper_dissipated_fraction"][rows], color=VERMILLION, marker="s")
    panels[2].plot(width[rows], study["published_dissipated_fraction"][rows], color=BLACK, marker="x", linestyle="none",
                   markersize=8, label="authors' output")
    panels[2].set(title="fraction dissipated (impulse)", xlabel="kernel width c / element", ylim=(0, 0.7))
    handles, labels = panels[0].get_legend_handles_labels()
    more = panels[2].get_legend_handles_labels()
    _legend_below(figure, handles + more[0], labels + more[1], 4)
    return save(figure, path)


def draw_constraints(source, path):
    study = Study(source)
    figure, panels = plt.subplots(2, 2, figsize=(10, 7.2), sharex=True)
    columns = (("waveform_error_fem", "waveform error in the solid"), ("energy_lost_fraction", "|energy lost| / input"),
               ("reflected_energy_fraction", "reflected energy / input"), ("wall_seconds", "run time (s)"))
    forms = {"at-grains": ("gap at the particles", "-", True), "nodal": ("nodal gap", ":", False)}
    for axes, (column, title) in zip(panels.flat, columns):
        values = numpy.abs(study[column])
        for gap, (form, line, full) in forms.items():
            for name, (colour, marker) in CONSTRAINTS.items():
                rows = study.where("constraint", name) & study.where("gap", gap) & study.finished
                style = {"color": colour, "linestyle": line, "label": f"{name}, {form}"}
                if name == "multiplier":
                    if rows.any():
                        axes.plot([1e7, 1e12], 2 * [values[rows][0]], **style)
                    continue
                axes.plot(study["penalty_used_Pa_m2"][rows], values[rows], marker=marker,
                          markerfacecolor=colour if full else "white", **style)
        axes.set(xscale="log", yscale="log", title=title)
    for axes in panels[1]:
        axes.set_xlabel("penalty p, or strength of the dashpot (Pa/m²)")
    _legend_of(figure, panels[0, 0], 4)
    return save(figure, path)


SIZES = {"1": ("o", 1), "2": ("s", 2), "4": ("^", 4)}


def _draw_front(axes, seconds, values, front):
    order = numpy.argsort(seconds[front])
    axes.step(seconds[front][order], values[front][order], where="post", color=BLACK, linewidth=1, zorder=1,
              label="front: nothing is faster and better")


def draw_pareto(source, path):
    study = Study(source)
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.9))
    seconds, wide, paper = study["wall_seconds"], study["cg_width_elements"] > 0, study.where("scheme", "paper")
    columns = (("waveform_error_fem", "on_waveform_front", "waveform error in the solid"),
               ("energy_lost_fraction", "on_energy_front", "|energy lost| / input"))
    for axes, (column, front, title) in zip(panels, columns):
        values = numpy.abs(study[column])
        kinds = [(study.where("constraint", name) & ~paper & (wide == with_kernel), colour,
                  f"{name}, c = {1.5 if with_kernel else 0:g}")
                 for name, with_kernel, colour in (("penalty", False, BLUE), ("penalty", True, SKY),
                                                   ("multiplier", False, GREEN), ("multiplier", True, ORANGE))]
        kinds.append((paper, VERMILLION, "the paper's scheme"))
        for rows, colour, kind in kinds:
            for size, (marker, n) in SIZES.items():
                here = rows & study.where("particles_per_edge", size) & study.finished
                axes.plot(seconds[here], values[here], linestyle="none", marker=marker, color=colour, markersize=6.5,
                          markeredgecolor="white", markeredgewidth=0.5, zorder=2, label=kind if n == 1 else None)
        for size, (marker, n) in SIZES.items():
            axes.plot([], [], linestyle="none", marker=marker, color=GREY, label=f"{n}³ particles per element")
        _draw_front(axes, seconds, values, (study[front] == 1) & study.finished)
        axes.set(xscale="log", yscale="log", xlabel="run time, one thread (s)", title=title)
    _legend_of(figure, panels[0], 3)
    return save(figure, path)


OUTCOMES = {"finished": (BLUE, "o", "finished, bounded"), "not stable": (ORANGE, "D", "ran, energy not bounded"),
            "broke down": (VERMILLION, "X", "broke down, said when"), "refused": (GREY, "v", "refused before the run")}
TOP, FLOOR = 1e1, 1e-10


def _draw_group(axes, study, head, word, automatic):
    """Rows "<head>, <word> <x> …" with their outcomes; the automatic step is drawn hollow."""
    start = f"{head}, {word} "
    x, lost = [], numpy.abs(study["energy_lost_fraction"])
    for label in study.label:
        mine = label.startswith(start) and (label.endswith("dt auto") == automatic)
        x.append(float(label[len(start):].split()[0].rstrip(",")) if mine else numpy.nan)
    x = numpy.array(x)
    for outcome, (colour, marker, _) in OUTCOMES.items():
        rows = ~numpy.isnan(x) & study.where("outcome", outcome)
        y = numpy.clip(lost[rows], FLOOR, TOP) if outcome == "finished" else numpy.full(rows.sum(), TOP)
        axes.plot(numpy.maximum(x[rows], 1e-9), y, linestyle="none", marker=marker, color=colour, markersize=6.5,
                  markerfacecolor="white" if automatic or outcome == "refused" else colour, zorder=3)


def draw_stability(source, path):
    study = Study(source)
    words = (("dt at", "time step / critical step", "linear"),
             ("weight floor", "weight floor (0 at the left end)", "log"),
             ("stiffness ratio", "E of the solid / E of the particles", "log"),
             ("density ratio", "density of the solid / particles", "log"), ("penalty", "penalty (Pa/m²)", "log"))
    figure, panels = plt.subplots(2, 5, figsize=(13, 5.6), sharey=True, sharex="col")
    for row, head in zip(panels, ("penalty", "multiplier")):
        for axes, (word, title, scale) in zip(row, words):
            axes.set(xscale=scale, yscale="log", ylim=(FLOOR, 5 * TOP))
            for automatic in (False, True):
                _draw_group(axes, study, head, word, automatic)
        row[0].axvline(1, color=BLACK, linewidth=0.8, linestyle="--")
        row[0].set_title(f"{head}: |energy lost| / input; at the top: no result")
    for axes, (_, title, _) in zip(panels[1], words):
        axes.set_xlabel(title)
    panels[1, 4].axis("off")
    panels[0, 4].tick_params(labelbottom=True)
    panels[0, 4].set_xlabel(words[4][1])
    for colour, marker, name in OUTCOMES.values():
        panels[0, 0].plot([], [], linestyle="none", marker=marker, color=colour, label=name,
                          markerfacecolor="white" if marker == "v" else colour)
    panels[0, 0].plot([], [], linestyle="none", marker="o", color=BLUE, markerfacecolor="white", label="with --dt auto")
    _legend_of(figure, panels[0, 0], 5)
    return save(figure, path)


BY_NAME = {"widths": draw_widths, "constraints": draw_constraints, "pareto": draw_pareto, "stability": draw_stability}
