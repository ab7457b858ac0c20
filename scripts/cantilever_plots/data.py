"""The case, the published figures, and readers for what a run writes. Needs the standard library only, until arrays
are asked for."""

import csv
import json
import math

LENGTH, SIDE, YOUNG = 12.0, 0.8, 1e8  # m, m, Pa
RADIUS, START_X, START_Y = 0.1, 0.2, 0.2  # m
WEIGHT = 2 * 2e4 * math.pi / 6 * (2 * RADIUS) ** 3 * 9.81  # of both particles, N
BENDING = YOUNG * SIDE**4 / 12  # EI, N m^2
START_ENERGY = 0.8716  # J, exact

# Cheng et al., CMAME 403 (2023) 115651, and the output deposited with it, as in benchmarks/cantilever/README.md:
# largest total energy before leaving (J), and time-mean error against the static formula, arm from the clamp (m).
PUBLISHED_PEAK = {0.0: 4965.0, 10.0: 1.99}
PUBLISHED_ERROR = {0.0: 0.052, 4.0: 0.0175, 10.0: 0.0049}
PUBLISHED_SECONDS = 398_000 * 0.026  # steps until leaving x seconds per step


class DataError(Exception):
    """A file that is missing or cannot be read; says which."""


def static_sag(arm):
    """F a^3 / (3 EI): sag of the axis under both particles at distance `arm` from the clamp, m."""
    return WEIGHT * arm**3 / (3 * BENDING)


def read_table(path):
    """Columns of a CSV file by name, as lists of text. Lines that start with # are skipped."""
    if not path.is_file():
        raise DataError(f"{path} is missing")
    with open(path, encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(line for line in stream if not line.startswith("#")))
    if len(rows) < 2:
        raise DataError(f"{path} holds no rows")
    header, body = rows[0], rows[1:]
    for number, row in enumerate(body, start=2):
        if len(row) != len(header):
            raise DataError(f"{path}: row {number} has {len(row)} fields instead of {len(header)}")
    return {name: [row[k] for row in body] for k, name in enumerate(header)}


def numbers(table, name, path):
    """One column as an array."""
    import numpy

    try:
        return numpy.array([float(text) for text in table[name]])
    except KeyError:
        raise DataError(f"{path} has no column {name}") from None
    except ValueError as error:
        raise DataError(f"{path}, column {name}: {error}") from None


class Run:
    """One run: time series as arrays by column name, summary, and the beam's frames if there are any."""

    def __init__(self, folder):
        missing = [name for name in ("series.csv", "summary.json") if not (folder / name).is_file()]
        if missing:
            raise DataError(f"{folder} lacks {' and '.join(missing)}; write it with "
                            f"cantilever --out {folder} --summary {folder / 'summary.json'}")
        self.folder = folder
        path = folder / "series.csv"
        table = read_table(path)
        self.series = {name: numbers(table, name, path) for name in table}
        try:
            summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
            self.results, self.settings = summary["results"], summary["settings"]
        except (ValueError, KeyError) as error:
            raise DataError(f"{folder / 'summary.json'} is no summary of a run: {error}") from None

    def __getitem__(self, name):
        if name not in self.series:
            raise DataError(f"{self.folder / 'series.csv'} has no column {name}")
        return self.series[name]

    @property
    def name(self):
        """Scheme and width, for legends."""
        width = float(self.settings["cg_width_diameters"])
        scheme = "the paper's scheme" if self.settings["scheme"] == "paper" else "conservative scheme"
        return f"{scheme}, c = {width:g} d" if width > 0 else f"{scheme}, c = 0"


class Reference:
    """One of the authors' runs; y is counted from the clamp here (from mid-span in the file)."""

    def __init__(self, path, width):
        table = read_table(path)
        self.width = width
        self.time = numbers(table, "t_s", path)
        self.x = [numbers(table, f"x{i}_m", path) for i in (1, 2)]
        self.y = [numbers(table, f"y{i}_m", path) + LENGTH / 2 for i in (1, 2)]
        self.z = [numbers(table, f"z{i}_m", path) for i in (1, 2)]
        self.energy = numbers(table, "Etot_J", path)
        self.energy[0] = START_ENERGY  # its first row lacks the energy of the overlap
        self.on_beam = (self.y[0] <= LENGTH) & (self.y[1] <= LENGTH)


def read_references(folder):
    """The authors' runs, narrow kernels first."""
    found = []
    for path in folder.glob("cantilever_c*d.csv"):
        try:
            found.append(Reference(path, float(path.name[len("cantilever_c"):-len("d.csv")])))
        except ValueError:
            raise DataError(f"{path}: no number in the name, as in cantilever_c10d.csv") from None
    if not found:
        raise DataError(f"{folder} has no cantilever_c*d.csv")
    return sorted(found, key=lambda reference: reference.width)
