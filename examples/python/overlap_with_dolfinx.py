# %% [markdown]
# # A wave goes from grains into a bar of dolfinx
#
# Grains and bar share a layer, in which the weight of the grains falls from 1 to 0 and that of the bar grows from 0 to 1:
# the forms of dolfinx carry the weight 1 - w, and so do its masses. Dovetail ties the two by multipliers. Nothing else
# acts, so that both together keep their momentum.
#
# Needs python3-dolfinx (0.5 or later).

# %%
import dolfinx.fem as fem
import dolfinx.mesh as mesh
import dovetail as dv
import numpy as np
import ufl
from mpi4py import MPI

youngs_modulus, density, edge = 1e8, 1500.0, 0.1  # Pa, kg/m3, m: of the cells of the bar
across, along, shared = 2, 20, 6                  # cells; the last: of the overlap


class Bar:
    """Linearly elastic, from z = 0 upwards. Dovetail reads X, mass, cells and grain_weight, and calls forces and energy."""

    overlap = {"constraint": "multiplier"}

    def __init__(self, floor=1e-3):
        size = [across * edge, across * edge, along * edge]
        domain = mesh.create_box(MPI.COMM_SELF, [[0.0, 0.0, 0.0], size], [across, across, along])
        space, scalars = fem.VectorFunctionSpace(domain, ("CG", 1)), fem.FunctionSpace(domain, ("CG", 1))
        self.X = space.tabulate_dof_coordinates()
        self.u, v, w = fem.Function(space), ufl.TestFunction(space), fem.Function(scalars)
        s = self.X[:, 2] / (shared * edge)
        self.grain_weight = np.where(s > 1 + 1e-9, 0.0, floor + (1 - 2 * floor) * (1 - np.minimum(s, 1)))
        w.x.array[:] = self.grain_weight
        strain = lambda u: ufl.sym(ufl.grad(u))
        self.stored = fem.form(0.5 * (1 - w) * youngs_modulus * ufl.inner(strain(self.u), strain(self.u)) * ufl.dx)
        self.force = fem.form(-(1 - w) * youngs_modulus * ufl.inner(strain(self.u), strain(v)) * ufl.dx)
        ones = ufl.as_vector([1.0, 1.0, 1.0])
        self.mass = fem.assemble_vector(fem.form((1 - w) * density * ufl.inner(ones, v) * ufl.dx)).array[::3]
        cells = np.array([space.dofmap.cell_dofs(c) for c in range(domain.topology.index_map(3).size_local)])
        inside_out = np.linalg.det(self.X[cells[:, 1:]] - self.X[cells[:, :1]]) < 0
        cells[inside_out] = cells[inside_out][:, [0, 2, 1, 3]]
        self.cells = cells

    def forces(self, t, u, v):
        self.u.x.array[:] = u.ravel()
        return fem.assemble_vector(self.force).array.reshape(-1, 3)

    def energy(self, u):
        self.u.x.array[:] = u.ravel()
        return fem.assemble_scalar(self.stored)


# %% [markdown]
# The lattice, whose lowest layers start with a velocity.

# %%
d = 0.5 * edge  # of the grains: four to a face of a cell
layer, row, column = (n.ravel() for n in np.meshgrid(np.arange(-40, 2 * shared), *[np.arange(2 * across)] * 2,
                                                     indexing="ij"))
scene = {
    "contact": {"law": "linear", "stiffness": youngs_modulus * d, "bonded": True},
    "particles": [{"from": "list", "density": density * 6 / np.pi,
                   "spheres": {"at": d * (np.stack([column, row, layer], axis=-1) + 0.5), "radius": d / 2,
                               "velocity": np.where(layer < -36, 0.1, 0.0)[:, None] * [0, 0, 1]}}],
    "steps": {"dt": "5e-6 s"},
    "stages": [{"do": "run", "time": "14 ms"}],
}
run = dv.Run(scene, solids={"bar": Bar()})
energy, momentum = run.kinetic_energy, run.totals["momentum"]

# %% [markdown]
# The wave goes over.

# %%
lost = 0.0
print("time_ms  in_the_bar  residual_of_energy")
for made in run.steps(2800, every=280):
    ledger = run.ledger
    lost = max(lost, abs(ledger["residual"]))
    arrived = (ledger["bar: kinetic"] + ledger["bar: own forces"]) / energy
    print(f"{1e3 * run.time:6.2f}   {arrived:.3f}       {ledger['residual'] / energy:.1e}")

momentum_lost = np.linalg.norm(run.totals["momentum"] - momentum) / np.linalg.norm(momentum)
print(f"{100 * arrived:.0f} % of the energy are in the bar; lost: momentum {momentum_lost:.1e}, "
      f"energy {lost / energy:.1e} of what there was")
assert arrived > 0.4, "the wave has not come through"
assert momentum_lost <= 1e-13
assert lost <= 1e-4 * energy
