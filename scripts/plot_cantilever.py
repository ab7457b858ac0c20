#!/usr/bin/env python3
"""Draws the figures of a cantilever run or study.

What it finds in DIR decides what it draws:
  series.csv and summary.json (and beam.pvd)  ->  trajectory.png, energy.png, overview.png
  widths.csv, pareto.csv, stability.csv, ablation.csv  ->  a PNG of the same name
"""

import argparse
import sys
from pathlib import Path

from cantilever_plots.data import DataError


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR", type=Path, help="what cantilever --out wrote; the PNGs go there too")
    parser.add_argument("--reference", metavar="DIR", type=Path,
                        help="folder with the authors' curves, cantilever_c*d.csv: they are drawn beside the run")
    parser.add_argument("--image", metavar="FILE.png", type=Path, help="another place for overview.png")
    return parser.parse_args()


def draw(arguments):
    """Returns the files written."""
    from cantilever_plots import overview_figure, run_figures, study_figures
    from cantilever_plots.data import Run, read_references

    folder = arguments.folder
    if not folder.is_dir():
        raise DataError(f"{folder} is no folder; name the one given to cantilever --out")
    references = read_references(arguments.reference) if arguments.reference else []
    written = [draw_study(folder / f"{name}.csv", folder / f"{name}.png")
               for name, draw_study in study_figures.BY_NAME.items() if (folder / f"{name}.csv").is_file()]
    if written and not (folder / "series.csv").is_file():
        return written
    run = Run(folder)
    written.append(run_figures.draw_trajectory(run, references, folder / "trajectory.png"))
    written.append(run_figures.draw_energy(run, references, folder / "energy.png"))
    written.append(overview_figure.draw_overview(run, references, arguments.image or folder / "overview.png"))
    return written


def main():
    arguments = parse_arguments()
    try:
        import matplotlib
    except ImportError:
        print(f"plot_cantilever: {sys.executable} has no matplotlib; install python3-matplotlib and run "
              "/usr/bin/python3 scripts/plot_cantilever.py", file=sys.stderr)
        return 2
    matplotlib.use("Agg")
    try:
        for file in draw(arguments):
            print(f"wrote {file}")
    except (DataError, OSError) as error:
        print(f"plot_cantilever: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
