"""Readers for what a run or a study of the wave benchmark writes."""

import json

import numpy
from cantilever_plots.data import DataError, numbers, read_table

NODES, PARTICLES, ALONE = 0, 1, 2  # column "model" of profile.csv


class Run:
    """One run: time series and velocity profiles as arrays by column name, and the summary."""

    def __init__(self, folder):
        names = ("series.csv", "profile.csv", "summary.json")
        missing = [name for name in names if not (folder / name).is_file()]
        if missing:
            raise DataError(f"{folder} lacks {' and '.join(missing)}; write it with "
                            f"wave_propagation --out {folder} --summary {folder / 'summary.json'}")
        self.folder = folder
        self.series = self._columns("series.csv")
        self.profile = self._columns("profile.csv")
        try:
            summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
            self.results, self.settings = summary["results"], summary["settings"]
            self.input = float(self.results["energy_input_J"])
        except (ValueError, KeyError, TypeError) as error:
            raise DataError(f"{folder / 'summary.json'} is no summary of a run: {error}") from None

    def _columns(self, name):
        table = read_table(self.folder / name)
        return {column: numbers(table, column, self.folder / name) for column in table}

    def __getitem__(self, name):
        if name not in self.series:
            raise DataError(f"{self.folder / 'series.csv'} has no column {name}")
        return self.series[name]

    @property
    def times(self):
        """Of the velocity profiles, s."""
        return numpy.unique(self.profile["time_s"])

    def layers(self, time, model):
        """(y, velocity, fraction of the particles) of one model at one time, by rising y."""
        rows = (self.profile["time_s"] == time) & (self.profile["model"] == model)
        return tuple(self.profile[name][rows] for name in ("y_m", "velocity_y_m_per_s", "particles_fraction"))

    @property
    def overlap(self):
        """Where both models are, (from, to) in m; None for particles alone."""
        if self.settings["full_dem"] == "yes":
            return None
        end = float(self.settings["dem_length_m"])
        return end - float(self.settings["overlap_m"]), end

    @property
    def name(self):
        """For legends."""
        n, c = int(self.settings["particles_per_edge"]), float(self.settings["cg_width_elements"])
        if self.settings["full_dem"] == "yes":
            return f"particles alone, {n}³ per element"
        scheme = "the paper's scheme" if self.settings["scheme"] == "paper" else self.settings["constraint"]
        return f"{scheme}, {n}³ particles per element, c = {c:g}"


class Study:
    """The rows of a study; numbers as arrays, text as lists."""

    def __init__(self, path):
        self.path, self.table = path, read_table(path)
        self.label, self.outcome = self.table["label"], self.table["outcome"]

    def __getitem__(self, name):
        return numbers(self.table, name, self.path)

    def where(self, column, *values):
        return numpy.array([text in values for text in self.table[column]])

    def labelled(self, text):
        return numpy.array([text in label for label in self.label])

    @property
    def finished(self):
        return self.where("outcome", "finished")
