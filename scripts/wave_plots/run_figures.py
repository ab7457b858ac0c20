"""The overview of one run: the pulse on its way, and where its energy is."""

import matplotlib.pyplot as plt
import numpy
from cantilever_plots.style import BLACK, BLUE, LIGHT, ORANGE, SKY, VERMILLION, save

from .data import ALONE, NODES, PARTICLES

CHANNELS = (("particles, kinetic", "kinetic_particles_J", ORANGE),
            ("contacts, elastic", "elastic_contacts_J", "#F3CE7A"), ("solid, kinetic", "kinetic_solid_J", BLUE), ("solid, elastic", "elastic_solid_J", SKY))


def _instants(run):
    """Times of profiles: the pulse before the overlap, in it, and at the end."""
    times = run.times
    if run.overlap is None:
        return [times[len(times) // 3], times[2 * len(times) // 3], times[-1]]
    wanted = []
    for place in (0.62 * run.overlap[0], 0.5 * sum(run.overlap)):
        centres = []
        for time in times:
            models = [run.layers(time, model) for model in (NODES, PARTICLES)]
            y = numpy.concatenate([m[0] for m in models])
            weight = numpy.concatenate([models[0][1] ** 2 * (1 - models[0][2]), models[1][1] ** 2 * models[1][2]])
            centres.append((weight * y).sum() / max(weight.sum(), 1e-300))
        wanted.append(times[numpy.argmin(numpy.abs(numpy.array(centres) - place))])
    return [*wanted, times[-1]]


def _draw_pulse(axes, run, time, last):
    scale = 1e3  # mm/s
    y, v, share = run.layers(time, NODES)
    if last:
        alone = run.layers(time, ALONE)
        if len(alone[0]):
            axes.plot(alone[0], scale * alone[1], color=BLACK, linewidth=4.5, alpha=0.28, label="particles alone")
    if len(y):
        axes.plot(y, scale * v, color=BLUE, marker="s", markersize=3.2, linewidth=1.2, label="solid, node layers")
    y, v, share = run.layers(time, PARTICLES)
    axes.plot(y, scale * v, color=VERMILLION, marker="o", markersize=max(1.8, 3.8 - 0.03 * len(y)), linestyle="none",
              label="particles, layer means")
    if run.overlap:
        axes.axvspan(*run.overlap, color=LIGHT, alpha=0.55, linewidth=0, zorder=0)
    axes.text(0.992, 0.86, f"t = {1e3 * time:.1f} ms", transform=axes.transAxes, ha="right", va="top")


def _draw_energy(axes, run, beside):
    time = 1e3 * run["time_s"]
    layers = [100 * run[column] / run.input for _, column, _ in CHANNELS]
    kept = [k for k, layer in enumerate(layers) if layer.max() > 0]
    axes.stackplot(time, *[layers[k] for k in kept], colors=[CHANNELS[k][2] for k in kept],
                   labels=[CHANNELS[k][0] for k in kept], linewidth=0)
    axes.plot(time, 100 * run["energy_total_J"] / run.input, color=BLACK, linewidth=2, label="total")
    if beside:
        at, total = 1e3 * beside["time_s"], 100 * beside["energy_total_J"] / beside.input
        axes.plot(at, total, color=VERMILLION, linewidth=2, linestyle="--", label=f"total of {beside.name}")
    axes.set_xlim(0, time[-1])
    axes.set_ylim(0, 128)
    axes.set_yticks(range(0, 101, 25))
    axes.set_xlabel("time (ms)")
    axes.set_ylabel("energy (% of input)")
    axes.legend(loc="upper left", ncol=3, columnspacing=1.2)


def draw_overview(run, beside, path):
    figure, panels = plt.subplots(4, 1, figsize=(9, 8.2), height_ratios=(1, 1, 1, 2.1), layout="constrained")
    instants = _instants(run)
    end = max(run.layers(time, model)[0].max(initial=0.0) for time in instants for model in (NODES, PARTICLES))
    for axes, time in zip(panels, instants):
        _draw_pulse(axes, run, time, time == instants[-1])
        axes.set_xlim(0, end)
        axes.set_ylabel("v (mm/s)")
        if time != instants[-1]:
            axes.tick_params(labelbottom=False)
    limits = numpy.array([axes.get_ylim() for axes in panels[:3]])
    for axes in panels[:3]:
        axes.set_ylim(limits[:, 0].min(), limits[:, 1].max())
    panels[2].set_xlabel("y along the bar (m); grey: overlap, where particles hand over to the solid")
    panels[2].legend(loc="upper left", bbox_to_anchor=(0.0, 1.04))
    panels[0].set_title(f"A pulse goes from particles into an elastic solid: {run.name}")
    _draw_energy(panels[3], run, beside)
    error = run.results.get("waveform_error_fem")
    lost = run.results.get("energy_lost_fraction") or 0.0
    text = f"Energy: {abs(lost):.1e} of the input " + ("lost" if lost > 0 else "gained")
    if error is not None:
        text += f"; the wave in the solid differs by {100 * error:.2g} % from that of particles alone"
    panels[3].set_title(text)
    return save(figure, path)
