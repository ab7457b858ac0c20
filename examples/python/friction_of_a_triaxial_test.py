# %% [markdown]
# # Friction of grains from a triaxial test
#
# Which friction must grains have for a packing of them to answer as a measured one? The test is done on a cell of
# spheres that repeats; the fit is least squares with uncertainties. The measurement is made here, from a friction that
# is known and with noise, so that the answer can be checked. All quantities are SI.

# %%
import numpy as np

import dovetail as dv

# %% [markdown]
# ## The packing
#
# Prepared with little friction, and so dense; every test begins with a copy of it.

# %%
cell, = dv.make_cells({
    "grains": "spheres", "count": 120, "radius": {"smallest": "0.8 mm", "largest": "1.2 mm"}, "density": 2650,
    "contact": {"law": "linear", "modulus": "200 MPa", "friction": 0.5},
    "prepare": [{"pressure": "100 kPa", "friction": 0.1}],
})
print(f"{len(cell)} grains, solid fraction {cell.solid_fraction:.3f}, {cell.balance['coordination']:.2f} contacts each")

# %% [markdown]
# ## The test
#
# Shortened along z while both sides keep their pressure: the ratio q/p of deviator and mean pressure.

# %%
strains = np.linspace(0.0025, 0.02, 8)


def stress_ratio(friction):
    """q/p at the strains."""
    specimen = cell.copy()
    specimen.set_springs(friction=friction)
    pressures = -specimen.drive(strains, "triaxial", axis="z", pressure=1e5)["stress"][1:]
    axial, lateral = pressures[:, 2, 2], (pressures[:, 0, 0] + pressures[:, 1, 1]) / 2
    return (axial - lateral) / (axial + 2 * lateral) * 3


# %% [markdown]
# ## The measurement, and the fit
#
# A standard deviation of 0.02 in every ratio.

# %%
truth, deviation = 0.4, 0.02
measured = stress_ratio(truth) + np.random.default_rng(3).normal(0, deviation, strains.shape)
fit = dv.calibrate(stress_ratio, {"friction": (0.6, 0.1, 0.9, 0.04)}, targets=measured, uncertainty=deviation, tolerance=0.01,
                   title="Friction from triaxial compression")
print(fit)

# %%
found, uncertainty = fit.value["friction"], fit.uncertainty["friction"]
print(f"friction {found:.3f} ± {uncertainty:.3f}, in truth {truth}")
assert fit.converged
assert abs(found - truth) < 3 * uncertainty
assert uncertainty < 0.1 * truth
low, high = stress_ratio(0.2), stress_ratio(0.8)
assert (high[1:] > low[1:]).all()  # friction makes packings strong

# %%
try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError:
    raise SystemExit("the figure needs matplotlib")
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.errorbar(100 * strains, measured, deviation, fmt="ko", label="measured")
axes.plot(100 * strains, stress_ratio(found), label=f"friction {found:.2f} ± {uncertainty:.2f}")
axes.fill_between(100 * strains, low, high, alpha=0.2, label="0.2 to 0.8")
axes.set(xlabel="axial strain, %", ylabel="q/p")
axes.legend(frameon=False)
figure.savefig("friction_of_a_triaxial_test.png", dpi=150)
