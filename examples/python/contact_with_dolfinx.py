# %% [markdown]
# # Grains hit a block of dolfinx
#
# The block is a solid of one's own: dolfinx assembles its forces, Dovetail steps it together with the grains, finds their
# contacts with its skin and gives the forces back by the transpose. Nothing holds the block, so that its momentum and
# energy and those of the grains must stay what they are together.
#
# Needs python3-dolfinx (0.5 or later).

# %%
import dolfinx.fem as fem
import dolfinx.mesh as mesh
import dovetail as dv
import numpy as np
import ufl
from mpi4py import MPI


class Block:
    """Neo-Hookean, 1 m x 1 m x 0.3 m, below z = 0. Dovetail reads X, mass and cells, and calls forces and energy."""

    def __init__(self, youngs_modulus=2e5, poisson_ratio=0.3, density=500.0):
        domain = mesh.create_box(MPI.COMM_SELF, [[0.0, 0.0, -0.3], [1.0, 1.0, 0.0]], [6, 6, 2])
        space = fem.VectorFunctionSpace(domain, ("CG", 1))
        self.u, v = fem.Function(space), ufl.TestFunction(space)
        mu = youngs_modulus / (2 * (1 + poisson_ratio))
        lame = youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
        F = ufl.Identity(3) + ufl.grad(self.u)
        J = ufl.det(F)
        stored = (0.5 * mu * (ufl.tr(F.T * F) - 3 - 2 * ufl.ln(J)) + 0.5 * lame * ufl.ln(J) ** 2) * ufl.dx
        self.stored, self.force = fem.form(stored), fem.form(-ufl.derivative(stored, self.u, v))
        ones = ufl.as_vector([1.0, 1.0, 1.0])
        self.X = space.tabulate_dof_coordinates()
        self.mass = density * fem.assemble_vector(fem.form(ufl.inner(ones, v) * ufl.dx)).array[::3]
        cells = np.array([space.dofmap.cell_dofs(c) for c in range(domain.topology.index_map(3).size_local)])
        edges = self.X[cells[:, 1:]] - self.X[cells[:, :1]]
        inside_out = np.linalg.det(edges) < 0
        cells[inside_out] = cells[inside_out][:, [0, 2, 1, 3]]
        self.cells = cells

    def forces(self, t, u, v):
        self.u.x.array[:] = u.ravel()
        return fem.assemble_vector(self.force).array.reshape(-1, 3)

    def energy(self, u):
        self.u.x.array[:] = u.ravel()
        return fem.assemble_scalar(self.stored)


# %% [markdown]
# Grains from numpy, and the run with the block in it.

# %%
random = np.random.default_rng(7)
places = np.stack(np.meshgrid(*[np.linspace(0.2, 0.8, 4)] * 2, [0.08, 0.2]), axis=-1).reshape(-1, 3)
scene = {
    "contact": {"law": "linear", "stiffness": 2e4},
    "particles": [{"from": "list", "density": 1000,
                   "spheres": {"at": places + random.uniform(-0.01, 0.01, places.shape), "radius": 0.05,
                               "velocity": [0.2, 0, -2]}}],
    "steps": {"dt": "2e-5 s"},
    "stages": [{"do": "run", "time": 1}],
}
run = dv.Run(scene, solids={"block": Block()})
block = run.solids["block"]
energy, momentum = run.kinetic_energy, run.totals["momentum"]
print(f"{len(run.grains)} grains, a block of {len(block)} nodes; limits of the step:")
for limit, owner in run.limits:
    print(f"  {limit:.3g} s: {owner}")

# %% [markdown]
# Both step together.

# %%
lost, strained = 0.0, 0.0
print("time_s  lowest_grain_m  strain_energy_J  residual_J")
for made in run.steps(10000, every=1000):
    ledger = run.ledger
    lost, strained = max(lost, abs(ledger["residual"])), max(strained, ledger["block: own forces"])
    print(f"{run.time:.3f}   {run.grains.x[:, 2].min():.4f}          {ledger['block: own forces']:.4f}           "
          f"{ledger['residual']:.1e}")

# %% [markdown]
# What is lost is round-off, and the error of the steps, which is of second order in them.

# %%
momentum_lost = np.linalg.norm(run.totals["momentum"] - momentum) / np.linalg.norm(momentum)
print(f"lost: momentum {momentum_lost:.1e}, energy {lost / energy:.1e} of what there was")
assert strained > 0.01 * energy, "the grains have not met the block"
assert momentum_lost <= 1e-13
assert lost <= 1e-5 * energy
