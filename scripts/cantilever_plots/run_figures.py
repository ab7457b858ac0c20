"""Trajectory and energies of one run."""

import matplotlib.pyplot as plt
import numpy

from .data import LENGTH, START_ENERGY, START_X, static_sag
from .style import AUTHORS, BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION, save

TINY = 1e-9


def author_colour(reference):
    return AUTHORS.get(reference.width, GREY)


def author_name(reference):
    return f"authors, c = {reference.width:g} d" if reference.width else "authors, c = 0"


def _draw_height(axes, run, references):
    y = numpy.linspace(0.2, LENGTH, 200)
    for reference in references:
        axes.plot(reference.y[0][reference.on_beam], reference.z[0][reference.on_beam], color=author_colour(reference),
                  linewidth=0.8, label=author_name(reference))
    axes.plot(run["y1_m"], run["z1_m"], color=BLUE, label="this run, particle 1")
    axes.plot(run["y2_m"], run["z2_m"], color=SKY, linestyle=(0, (3, 4)), label="this run, particle 2")
    axes.plot(y, run["z1_m"][0] - static_sag(y), color=BLACK, linewidth=1, linestyle="--",
              label=r"static, $z_0 - F y^3/3EI$")
    axes.set_ylabel("height z (m)")
    axes.legend(loc="lower left", ncol=2)


def _draw_departure(axes, run, references):
    for reference in references:
        on, z0 = reference.on_beam, reference.z[0][0]
        axes.plot(reference.y[0][on], 1e3 * (reference.z[0][on] - z0 + static_sag(reference.y[0][on])),
                  color=author_colour(reference), linewidth=0.8)
    for i, colour, line in ((1, BLUE, "-"), (2, SKY, (0, (3, 4)))):
        y, z = run[f"y{i}_m"], run[f"z{i}_m"]
        axes.plot(y, 1e3 * (z - z[0] + static_sag(y)), color=colour, linestyle=line)
    axes.axhline(0, color=BLACK, linewidth=1, linestyle="--")
    axes.set_ylabel("z over static (mm)")


def _draw_lateral(axes, run, references):
    largest = TINY
    for reference in references:
        for x, y, start in zip(reference.x, reference.y, (START_X, -START_X)):
            off = 1e3 * (x - start)[reference.on_beam]
            axes.plot(y[reference.on_beam], off, color=author_colour(reference), linewidth=0.8)
            largest = max(largest, numpy.abs(off).max())
    for i, start, colour, line in ((1, START_X, BLUE, "-"), (2, -START_X, SKY, (0, (3, 4)))):
        off = 1e3 * (run[f"x{i}_m"] - start)
        axes.plot(run[f"y{i}_m"], off, color=colour, linestyle=line)
        largest = max(largest, numpy.abs(off).max())
    if largest < 1e-3:
        axes.set_ylim(-1, 1)
    axes.set_ylabel("sideways drift (mm)")
    axes.set_xlabel("y along the beam, from the clamp (m)")


def draw_trajectory(run, references, path):
    figure, (height, departure, lateral) = plt.subplots(
        3, 1, figsize=(8, 8.4), sharex=True, height_ratios=(3, 2, 2), layout="constrained")
    _draw_height(height, run, references)
    _draw_departure(departure, run, references)
    _draw_lateral(lateral, run, references)
    lateral.set_xlim(0, LENGTH * 1.01)
    height.set_title(f"Two particles sliding over a cantilever: {run.name}")
    return save(figure, path)


CHANNELS = (("kinetic, particles", "kinetic_particles_J", 1, BLUE, "-"),
            ("gravity, given up", "gravity_particles_J", -1, GREY, "-"),
            ("elastic, beam", "elastic_beam_J", 1, GREEN, "-"),
            ("kinetic, beam", "kinetic_beam_J", 1, ORANGE, "-"),
            ("elastic, contacts", "elastic_contacts_J", 1, PURPLE, "-"),
            ("made by the coupling", "made_by_coupling_J", 1, VERMILLION, "--"),
            ("lost in dashpots", "dashpots_J", 1, SKY, "--"))


def _positive(values):
    return numpy.where(values > TINY, values, numpy.nan)


def _draw_channels(axes, run):
    time = run["time_s"]
    for label, column, sign, colour, line in CHANNELS:
        values = _positive(sign * run[column])
        if numpy.isfinite(values).any():
            axes.plot(time, values, color=colour, linestyle=line, linewidth=1.2, label=label)
    axes.plot(time, _positive(run["energy_total_J"]), color=BLACK, linewidth=2, label="total")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1e-3)
    axes.set_ylabel("energy (J)")
    axes.legend(loc="lower left", ncol=4, bbox_to_anchor=(0, 1.0))


def draw_energy(run, references, path):
    figure, (channels, drift) = plt.subplots(2, 1, figsize=(8, 7.6), sharex=True, layout="constrained")
    _draw_channels(channels, run)
    for reference in references:
        if reference.width in (0.0, 10.0):
            drift.plot(reference.time[reference.on_beam],
                       _positive(numpy.abs(reference.energy / START_ENERGY - 1))[reference.on_beam],
                       color=author_colour(reference), linewidth=1, label=author_name(reference))
    time, total = run["time_s"], run["energy_total_J"]
    drift.plot(time, _positive(numpy.abs(total / total[0] - 1)), color=BLUE, linewidth=1,
               label="this run, total energy")
    if numpy.abs(run["made_by_coupling_J"]).max() + numpy.abs(run["dashpots_J"]).max() > 0:
        drift.plot(time, _positive(numpy.abs(run["ledger_residual_J"] / total[0])), color=BLACK, linewidth=0.8,
                   label="this run, booked channels counted")
    drift.set_yscale("log")
    drift.set_ylim(bottom=1e-8)
    drift.set_ylabel("|E − E(0)| / E(0)")
    drift.set_xlabel("time (s)")
    drift.set_xlim(0, max(time[-1], 1e-3))
    drift.legend(loc="lower left", ncol=2, bbox_to_anchor=(0, 1.0))
    figure.suptitle(f"Energy: {run.name}", x=0.01, ha="left", fontsize=10.5)
    return save(figure, path)
