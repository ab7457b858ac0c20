#!/usr/bin/env python3
"""Draws error against run time of the solid elements from the CSV file of fem_error_time."""

import argparse
import csv
import sys
from pathlib import Path

COLOURS = {"hex8 standard": "#9a9a9a", "hex8 mean dilatation": "#1f77b4", "hex8 enhanced": "#c1440e",
           "hex8 reduced": "#bcbd22", "hex20": "#2ca02c", "hex27": "#17becf", "hex20 mean dilatation": "#8c564b",
           "hex27 mean dilatation": "#9467bd", "tet4": "#d0d0d0", "tet10": "#e377c2"}


def rows_of(path):
    """{case: {element: [(seconds, |error| in %)]}}, in the order of the file."""
    cases = {}
    try:
        with open(path, encoding="utf-8", newline="") as stream:
            for row in csv.DictReader(stream):
                points = cases.setdefault(row["case"], {}).setdefault(row["element"], [])
                points.append((float(row["seconds"]), abs(100.0 * float(row["error"]))))
    except (OSError, KeyError, TypeError, ValueError) as error:
        sys.exit(f"plot_fem.py: {path} cannot be used ({error}); write it with fem_error_time --csv FILE")
    if not cases:
        sys.exit(f"plot_fem.py: {path} has no rows; write it with fem_error_time --csv FILE")
    return cases


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument("--out", type=Path, default=Path("fem_error_time.png"))
    arguments = parser.parse_args()
    cases = rows_of(arguments.table)
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 2, figsize=(11, 8.6))
    for panel, (case, elements) in zip(axes.flat, cases.items()):
        for element, points in elements.items():
            shape = "o" if element.startswith("hex8") else "s" if element.startswith("hex") else "^"
            panel.loglog([t for t, _ in points], [e for _, e in points], marker=shape, markersize=4, linewidth=1.3,
                         color=COLOURS.get(element, "black"), label=element)
        panel.set_title(case)
        panel.set_xlabel("time to solution (s)")
        panel.set_ylabel("error (%)")
        panel.grid(True, which="major", alpha=0.3)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="lower center", ncol=5, frameon=False)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(arguments.out, dpi=130)


main()
