# %% [markdown]
# # A contact law of one's own
#
# Grains with rough faces stiffen as they are pressed together: F = k δ (1 + δ²/h²). The law is a function of numpy
# arrays, which is asked once a step for all pairs of grains and once for each wall. All quantities are SI.

# %%
import time

import matplotlib.pyplot as plt
import numpy as np

import dovetail as dv

# %% [markdown]
# ## The law
#
# Numbers with defaults are its parameters. Limits of the step follow from the stiffness, the slope of the force; the
# ledger closes with the energy that the overlap stores and the power that the dashpot takes.


# %%
def dashpot(c, k, zeta):
    """N s/m"""
    return 2 * zeta * np.sqrt(k * c.effective_mass)


def slope(c, k, h):
    """N/m"""
    return k * (1 + 3 * (c.overlap / h) ** 2)


@dv.contact_law(stiffness=slope, damping=dashpot, torques=False)
def rough(c, k=2e3, h=1e-4, zeta=0.0):
    squared = (c.overlap / h) ** 2
    spring = k * c.overlap * (1 + squared)
    seen = c.seen(slope(c, k, h))
    force = np.maximum(spring - c.engagement * dashpot(c, k, zeta) * seen, 0)
    return {"force": force,
            "elastic_energy": 0.5 * k * c.overlap ** 2 * (1 + squared / 2),
            "dissipated_power": (spring - force) * seen}


# %% [markdown]
# ## Two grains that meet
#
# Without a dashpot they part as fast as they came, and the deepest overlap follows from their energy.

# %%
def scene(spheres, **more):
    return {"particles": [{"from": "list", "density": 2500, "spheres": spheres}],
            "stages": [{"do": "run", "time": 1}], **more}


r, v = 0.005, 0.5
two = dv.Run(scene([{"at": [0, 0, 0], "radius": r, "velocity": [v, 0, 0]}, {"at": [2.01 * r, 0, 0], "radius": r}],
                   steps={"dt": 1e-6}), contact_law=rough)
overlap, force = [], []
for _ in two.steps(2000):
    (x, y), f = two.grains.x[:, 0], two.grains.f[1, 0]
    overlap.append(max(2 * r - (y - x), 0))
    force.append(f)
overlap, force = np.array(overlap), np.array(force)
k, h = rough.parameters["k"], rough.parameters["h"]
energy = 0.25 * two.grains.mass[0] * v ** 2
deepest = h * np.sqrt(np.sqrt(1 + 4 * energy / (k * h ** 2)) - 1)
print(f"deepest overlap {1e6 * overlap.max():.2f} µm, by energy {1e6 * deepest:.2f} µm")
assert abs(overlap.max() / deepest - 1) < 1e-4
np.testing.assert_allclose(two.grains.v[:, 0], [0, v], atol=1e-4 * v)
assert abs(two.ledger["residual"]) < 1e-5 * energy

# %% [markdown]
# ## Beside the library's law
#
# The library's linear spring, written in numpy in the same order of operations, gives the same digits.


# %%
@dv.contact_law(stiffness="k", torques=False)
def spring(c, k=2e3):
    return {"force": k * c.overlap, "elastic_energy": 0.5 * k * c.overlap ** 2}


rng = np.random.default_rng(3)
cells = np.indices((10, 10, 12)).reshape(3, -1).T * 2 * r + r
bed = scene([{"at": at, "radius": one} for at, one in zip(cells.tolist(), rng.uniform(0.8 * r, r, len(cells)))],
            gravity=[0, 0, -9.81], steps={"dt": 2e-5},
            walls=[{"shape": "box", "box": [[0, 0, 0], [20 * r, 20 * r, 1]], "open": ["z+"]}])
linear = {"law": "linear", "stiffness": 2e3}
runs = {"library": dv.Run({**bed, "contact": linear}), "numpy": dv.Run(bed, contact_law=spring)}
for name, run in runs.items():
    begin = time.perf_counter()
    run.advance(1500)
    print(f"{name}: {1e3 * (time.perf_counter() - begin) / 1500:.2f} ms a step of {len(run.grains)} grains")
np.testing.assert_array_equal(runs["library"].grains.x, runs["numpy"].grains.x)

# %% [markdown]
# ## A bed that settles
#
# Without a dashpot the grains bounce on and on; with one they settle. Parameters are given in a call.

# %%
height, moves = {}, {}
for name, zeta in {"no dashpot": 0.0, "ζ = 0.3": 0.3}.items():
    run = dv.Run(bed, contact_law=rough(zeta=zeta))
    height[name] = [(run.time, run.grains.x[:, 2].mean()) for _ in run.steps(5000, every=100)]
    moves[name] = run.kinetic_energy
    turned_over = run.ledger["residual"] / (run.totals["mass"] * 9.81 * 0.06)
    print(f"{name}: {run.kinetic_energy:.1e} J, residual {turned_over:.1e} of the weight times the height")
    assert abs(turned_over) < 1e-2
assert moves["ζ = 0.3"] < 0.3 * moves["no dashpot"]

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.2), layout="constrained")
left.plot(1e6 * overlap, force, label="two grains")
line = np.linspace(0, overlap.max(), 100)
left.plot(1e6 * line, k * line, "k--", label="F = k δ")
left.set(xlabel="overlap, µm", ylabel="force, N")
for name, values in height.items():
    right.plot(*np.transpose(values) * [[1e3], [1e3]], label=name)
right.set(xlabel="time, ms", ylabel="mean height, mm")
for axes in (left, right):
    axes.legend(frameon=False)
figure.savefig("own_contact_law.png", dpi=150)
