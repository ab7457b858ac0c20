# %% [markdown]
# # The band of a cell
#
# A cell of discs that repeats is shortened while its sides keep their pressure. It hardens, dilates, and softens; by
# then the shear is no longer everywhere, as it was at first. All quantities are SI.

# %%
import numpy as np

import dovetail as dv

# %%
cell, = dv.make_cells({
    "grains": "discs", "count": 900, "radius": {"smallest": "3 mm", "largest": "7 mm"}, "density": 2650,
    "thickness": "10 cm", "contact": {"law": "linear", "modulus": "600 MPa", "friction": 0.55},
    "prepare": [{"pressure": "100 kPa", "friction": 0}],
})
pressure, diameter = cell.pressure, 2 * cell.radius.mean()
moduli = cell.moduli(cell.elastic_tangent())
print(f"{len(cell)} discs, K = {moduli['bulk'] / 1e6:.0f} MPa, G = {moduli['shear'] / 1e6:.0f} MPa")

# %% [markdown]
# ## The test
#
# At every output the centres and periods are kept.

# %%
kept = []
test = cell.drive(np.linspace(0.001, 0.06, 60), "biaxial", axis="y", pressure=pressure,
                  each=lambda state: kept.append((cell.x, cell.lattice)))
axial, side = -test["stress"][:, 1, 1], -test["stress"][:, 0, 0]
ratio = (axial - side) / (axial + side)
peak = ratio.argmax()
volume = np.log(test["volume"] / test["volume"][0])
print(f"largest stress ratio {ratio[peak]:.3f} at {100 * test['strain'][peak]:.1f} %, {ratio[-10:].mean():.3f} at the end")
print(f"volume grows by {100 * volume[-1]:.1f} %")

# %% [markdown]
# ## Where it shears
#
# Between two outputs, each grain and its neighbours have the deformation that fits their distances best; of its
# symmetric part what is left without the trace is the shear. Half of all shear is in that share of the grains: 0.5 if it
# is the same everywhere.


# %%
def shear_of_grains(before, after):
    """Deviatoric strain around each grain from one output to another. (N)"""
    (x, H), (y, G) = kept[before], kept[after]
    F = G @ np.linalg.inv(H)
    branch = x[None] - x[:, None]
    branch -= np.round(branch @ np.linalg.inv(H).T) @ H.T
    moved = y[None] - y[:, None]
    moved -= np.round((moved - branch @ F.T) @ np.linalg.inv(G).T) @ G.T
    near = np.linalg.norm(branch, axis=2) < 2.2 * diameter
    a, b = branch[:, :, :2] * near[:, :, None], moved[:, :, :2]
    local = np.einsum("ijk,ijl->ikl", b, a) @ np.linalg.inv(np.einsum("ijk,ijl->ikl", a, a))
    strain = (local + local.transpose(0, 2, 1)) / 2 - np.eye(2)
    return np.hypot(strain[:, 0, 0] - strain[:, 1, 1], 2 * strain[:, 0, 1])


def share_with_half(shear):
    part = np.cumsum(np.sort(shear)[::-1]) / shear.sum()
    return (np.searchsorted(part, 0.5) + 1) / len(shear)


first, last = shear_of_grains(0, 3), shear_of_grains(45, 60)
print(f"half of the shear in {share_with_half(first):.2f} of the grains at first, {share_with_half(last):.2f} at the end")

# %% [markdown]
# ## Checks

# %%
work = test["work"][-1] - test["work"][0]
spent = sum(test[name][-1] - test[name][0] for name in ("friction", "damping", "stored", "kinetic"))
assert abs(work - spent) < 1e-3 * work
assert 0.25 < ratio[peak] < 0.6
assert ratio[-10:].mean() < 0.95 * ratio[peak]
assert volume[-1] > 0.005
assert share_with_half(last) < share_with_half(first) < 0.5

# %%
try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError:
    raise SystemExit("the figure needs matplotlib")
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.plot(100 * test["strain"], ratio)
left.set(xlabel="axial strain, %", ylabel="(σ₂ − σ₁)/(σ₂ + σ₁)")
x, H = kept[60]
x = x - np.floor(x @ np.linalg.inv(H).T) @ H.T
shown = right.scatter(1e3 * x[:, 0], 1e3 * x[:, 1], c=last, s=18, cmap="magma")
right.set(aspect="equal", xlabel="x, mm", ylabel="y, mm")
figure.colorbar(shown, label="shear from 4.5 to 6 %")
figure.savefig("band_of_a_cell.png", dpi=150)
