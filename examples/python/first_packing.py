# %% [markdown]
# # A first packing: the angle of repose
#
# Grains that numpy has placed fall on a rough base with free edges. What flows over the edges is removed; the slope of
# the heap that stays is the angle of repose. The slab repeats along y. All quantities are SI.

# %%
import matplotlib.pyplot as plt
import numpy as np

import dovetail as dv

# %% [markdown]
# ## Grains
#
# Every grain lies anywhere in a cubic cell of its own, so that no two overlap. The base is a layer of equal spheres.

# %%
rng = np.random.default_rng(1)
d, half, width, layers = 0.01, 0.08, 0.03, 8


def cells(n_z):
    """Centres of cubic cells of size d in rows along x, y and z, from z = 0 up. (N, 3)"""
    rows = np.indices((round(2 * half / d), round(width / d), n_z)).reshape(3, -1).T
    return (rows + [0.5, 0.5, 0.0]) * d - [half, 0, 0]


base = cells(1)
x = cells(layers) + [0, 0, d]
radius = rng.uniform(0.4, 0.5, len(x)) * d
x += rng.uniform(-1, 1, x.shape) * (d / 2 - radius)[:, None]


def spheres(centres, radii):
    return [{"at": at, "radius": r} for at, r in zip(centres, radii)]


# %% [markdown]
# ## The scene
#
# It says what a scene file says, with arrays wherever a file has lists. The drive without a velocity holds the base.

# %%
scene = {
    "gravity": [0, 0, -9.81],
    "periodic": {"box": [[-half, 0, 0], [half, width, 1]], "axes": ["y"]},
    "contact": {"law": "linear", "stiffness": "5 kN/m", "restitution": 0.4, "friction": 0.5,
                "rolling": {"friction": 0.1, "stiffness_ratio": 0.3}},
    "particles": [
        {"from": "list", "name": "base", "density": 2500, "spheres": spheres(base, np.full(len(base), d / 2))},
        {"from": "list", "density": 2500, "spheres": spheres(x, radius)},
    ],
    "drives": [{"group": "base"}],
    "outlets": [{"region": [[-4 * half, 0, -0.5], [4 * half, width, -0.05]]}],
    "stages": [{"do": "run", "time": 2}],
}
run = dv.Run(scene)
print(f"{len(run.grains)} grains, step {run.dt:.2e} s, limited by {run.limits[0][1]}")

# %% [markdown]
# ## Until it rests
#
# Two hundredths of a second at a time, until all grains together have a hundred-thousandth of the energy of a fall by
# one diameter.

# %%
every = round(0.02 / run.macro_step)
for made in run.steps(150 * every, every=every):
    at_rest = run.kinetic_energy < 1e-5 * run.totals["mass"] * 9.81 * d
    if at_rest or made % (10 * every) == 0:
        print(f"t = {run.time:.2f} s: {len(run.grains)} grains, {run.kinetic_energy:.1e} J")
    if at_rest:
        break
print(f"energy that no channel has: {run.ledger['residual']:.1e} J")

# %% [markdown]
# ## The slope
#
# The highest point of each column of cells, and a line through both flanks.

# %%
grains = run.grains
place, size = grains.x, grains.radius
column = np.floor((place[:, 0] + half) / d).astype(int)
columns = np.arange(round(2 * half / d))
top = np.array([np.max((place[:, 2] + size)[column == c], initial=d / 2) for c in columns])
across = (columns + 0.5) * d - half
slope, height = np.polyfit(np.abs(across), top, 1)
angle = np.degrees(np.arctan(-slope))
print(f"angle of repose: {angle:.1f} degrees, height {1e3 * height:.0f} mm")
assert 20 < angle < 36, angle

# %%
figure, axes = plt.subplots(figsize=(8, 3.2), layout="constrained")
is_base = grains.id < len(base)
for some, colour in ((is_base, "0.6"), (~is_base, "tab:orange")):
    for (px, _, pz), r in zip(1e3 * place[some], 1e3 * size[some]):
        axes.add_patch(plt.Circle((px, pz), r, facecolor=colour, edgecolor="0.3", linewidth=0.4))
line = np.array([-half, 0, half])
axes.plot(1e3 * line, 1e3 * (height + slope * np.abs(line)), "k--", label=f"{angle:.0f}°")
axes.set(aspect="equal", xlabel="x, mm", ylabel="z, mm", xlim=(-1150 * half, 1150 * half), ylim=(-10, None))
axes.legend(frameon=False)
figure.savefig("first_packing.png", dpi=150)
