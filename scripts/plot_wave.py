#!/usr/bin/env python3
"""Draws the figures of a wave run or study.

What it finds in DIR decides what it draws:
  series.csv, profile.csv and summary.json  ->  overview.png
  widths.csv, constraints.csv, pareto.csv, stability.csv  ->  a PNG of the same name
"""

import argparse
import sys
from pathlib import Path

from cantilever_plots.data import DataError


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="DIR", type=Path,
                        help="what wave_propagation --out wrote; the PNGs go there too")
    parser.add_argument("--beside", metavar="DIR", type=Path, help="another run, whose total energy is drawn as well")
    parser.add_argument("--image", metavar="FILE.png", type=Path, help="another place for overview.png")
    return parser.parse_args()


def draw(arguments):
    """Returns the files written."""
    from wave_plots import run_figures, study_figures
    from wave_plots.data import Run

    folder = arguments.folder
    if not folder.is_dir():
        raise DataError(f"{folder} is no folder; name the one given to wave_propagation --out")
    written = [draw_study(folder / f"{name}.csv", folder / f"{name}.png")
               for name, draw_study in study_figures.BY_NAME.items() if (folder / f"{name}.csv").is_file()]
    if written and not (folder / "series.csv").is_file():
        return written
    beside = Run(arguments.beside) if arguments.beside else None
    written.append(run_figures.draw_overview(Run(folder), beside, arguments.image or folder / "overview.png"))
    return written


def main():
    arguments = parse_arguments()
    try:
        import matplotlib
    except ImportError:
        print(f"plot_wave: {sys.executable} has no matplotlib; install python3-matplotlib and run "
              "/usr/bin/python3 scripts/plot_wave.py", file=sys.stderr)
        return 2
    matplotlib.use("Agg")
    try:
        for file in draw(arguments):
            print(f"wrote {file}")
    except (DataError, OSError) as error:
        print(f"plot_wave: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
