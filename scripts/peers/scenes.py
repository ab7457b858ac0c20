"""The scenes that both programs run."""
from dataclasses import dataclass


@dataclass
class Scene:
    name: str
    ours: str  # of the study of peers
    input: str  # of LAMMPS
    variables: dict
    least_skin: float = 0.0

    @property
    def kind(self):
        """Scenes of one kind differ in size alone, and run best with the same settings."""
        return self.ours, self.variables.get("law")


def scenes(folder, steps, beds):
    bed = {"steps": steps, "warm": 200, "data": folder / "bed.data"}
    drum = {"steps": steps, "warm": 100, "data": folder / "drum.data"}
    large = drum | {"copies": 50, "steps": max(10, steps // 3), "warm": 20}
    for copies in beds:
        yield Scene(f"bed {2 * copies}e4, linear + friction", "bed", "bed", bed | {"copies": copies, "law": "hooke"})
    yield Scene("bed 1e5, Hertz-Mindlin", "hertz", "bed", bed | {"copies": 5, "law": "hertz"})
    yield Scene("lattice, frictionless", "lattice", "lattice", {"steps": steps, "warm": 200})
    # LAMMPS does not look whether its list still holds: at small skins it does not.
    yield Scene("1:10, list made every 50 steps", "polydisperse", "polydisperse",
                {"steps": steps, "warm": 100, "data": folder / "poly.data"}, least_skin=0.1)
    yield Scene("flowing drum, 1e5", "drum", "drum", drum | {"copies": 5})
    yield Scene("flowing drum, 1e6", "drum", "drum", large)
