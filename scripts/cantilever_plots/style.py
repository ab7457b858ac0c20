"""Colours that colour-blind readers can tell apart (Okabe and Ito), and common settings."""

import matplotlib.pyplot as plt

BLACK, GREY, LIGHT = "#000000", "#6e6e6e", "#d9d9d9"
BLUE, SKY, GREEN, ORANGE, VERMILLION, PURPLE = "#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7"
AUTHORS = {0.0: VERMILLION, 4.0: PURPLE, 10.0: "#B57B00"}  # by kernel width

plt.rcParams.update({
    "font.size": 10,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e8e8e8",
    "grid.linewidth": 0.8,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "lines.linewidth": 1.6,
    "figure.dpi": 110,
    "savefig.dpi": 110,
})


def save(figure, path):
    """Writes without the date and version of the tool, so that equal data give equal files."""
    figure.savefig(path, metadata={"Software": None})
    plt.close(figure)
    return path
