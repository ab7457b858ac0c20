# %% [markdown]
# # A beam under grains, with a controller of one's own
#
# A beam between two supports carries a bed of grains. A controller presses on the grains in the middle so that the beam
# sags by 3 mm: the error of the sag and its integral set the force (PI control), twenty times in a hundredth of a second.

# %%
import matplotlib.pyplot as plt
import numpy as np

import dovetail as dv

# %% [markdown]
# ## Beam and grains
#
# Walls without friction hold the grains, so that the beam carries all that presses on them.

# %%
length, depth, height = 0.2, 0.03, 0.012
d = 0.01
ends = {name: {"name": name, "place": "box", "box": [[at - 1e-6, 0, -0.51 * height], [at + 1e-6, depth, -0.49 * height]]}
        for name, at in (("left", 0), ("right", length))}
rows = np.indices((round(length / d), round(depth / d), 3)).reshape(3, -1).T
smooth = {"law": "linear", "stiffness": "10 kN/m", "restitution": 0.3}
scene = {
    "gravity": [0, 0, -9.81],
    "contact": {**smooth, "friction": 0.3},
    "contacts": [{"between": "glass", "and": "wall", **smooth}],
    "particles": [{"from": "list", "density": 2500, "contact_material": "glass",
                   "spheres": [{"at": at, "radius": 0.49 * d} for at in (rows + 0.5) * d]}],
    "walls": [{"shape": "box", "box": [[0, 0, -0.05], [length, depth, 1]], "open": ["z-", "z+"],
               "contact_material": "wall"}],
    "solids": [{"name": "beam", "mesh": "box", "cells": [16, 2, 2], "box": [[0, 0, -height], [length, depth, 0]],
                "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": "50 MPa", "poisson_ratio": 0,
                             "density": 1000},
                "formulation": "enhanced", "mass_damping": 300, "sets": list(ends.values()),
                "supports": [{"on": "left"}, {"on": "right", "components": ["y", "z"]}]}],
    "couplings": [{"type": "surface", "solid": "beam", "on": "z+", "contact_material": "glass"}],
    "steps": {"safety": 0.7},
    "stages": [{"do": "run", "time": 1}],
}
run = dv.Run(scene)
beam = run.solids["beam"]
print(f"{len(run.grains)} grains, {len(beam)} nodes, step {run.dt:.2e} s")

# %% [markdown]
# ## The force
#
# It is shared by the grains near the middle. What the controller writes into `force` between steps, the function reads
# in each of them.

# %%
force = 0.0


@run.force
def press(t, x, v):
    near = np.abs(x[:, 0] - length / 2) < 3 * d
    f = np.zeros_like(x)
    f[near, 2] = -force / near.sum()
    return f


# %% [markdown]
# ## Control
#
# A beam between supports sags by F L³ / (48 E I): the force that is about to be needed sets the gains.

# %%
middle = np.argmin(np.linalg.norm(beam.X - [length / 2, depth / 2, -height / 2], axis=1))
target = 3e-3
stiffness = 48 * 50e6 * depth * height**3 / 12 / length**3
proportional, integral = 0.2 * stiffness, 12 * stiffness  # N/m, N/(m s)
every = max(1, round(5e-4 / run.macro_step))
pause = every * run.macro_step
kept, record = 0.0, []
for _ in run.steps(1000 * every, every=every):
    sag = -beam.u[middle, 2]
    error = target - sag
    kept += integral * error * pause
    force = max(0.0, proportional * error + kept)
    record.append((run.time, sag, force))
time, sags, forces = np.array(record).T

# %% [markdown]
# ## What it came to
#
# The supports carry beam, grains and force.

# %%
carried = beam.reactions()[:, 2].sum()
weight = 9.81 * run.totals["mass"]
print(f"sag {1e3 * sags[-1]:.3f} mm, force {forces[-1]:.2f} N, supports {carried:.2f} N, weight {weight:.2f} N")
assert abs(sags[-1] / target - 1) < 0.01
assert abs(carried / (weight + forces[-1]) - 1) < 0.02

# %% [markdown]
# The ledger has the work of the force, the totals its impulse, under the name of its function.

# %%
work = -run.ledger["particles: work of external forces (minus)"]
impulse = -run.totals["given"]["particles: press"]["linear"][2]
print(f"work {1e3 * work:.2f} mJ, impulse {impulse:.4f} N s; energy that no channel has {run.ledger['residual']:.1e} J")
assert abs(impulse / (forces[:-1].sum() * pause) - 1) < 1e-3
assert abs(run.ledger["residual"]) < 1e-3 * work

# %%
figure, (above, below) = plt.subplots(2, figsize=(8, 4.5), sharex=True, layout="constrained")
above.plot(time, 1e3 * sags, color="tab:blue")
above.axhline(1e3 * target, color="0.5", linestyle="--", label="wanted")
above.legend(frameon=False)
above.set_ylabel("sag, mm")
below.plot(time, forces, color="tab:orange")
below.set(xlabel="t, s", ylabel="force, N")
figure.savefig("beam_under_grains.png", dpi=150)
