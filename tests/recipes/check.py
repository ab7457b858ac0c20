#!/usr/bin/env python3
"""check.py NAME PROGRAM SCENES FOLDER: runs the scene of a recipe and compares it with the calculation by hand of its page."""
import csv
import json
import math
import pathlib
import subprocess
import sys


class Run:
    """What a run has written: its complete scene, and its series by column."""

    def __init__(self, program, scene, folder, changes=()):
        command = [program, "run", str(scene), "--out", str(folder), "--replace"]
        for change in changes:
            command += ["--set", change]
        said = subprocess.run(command, capture_output=True, text=True)
        if said.returncode != 0:
            sys.exit(f"{scene}: exit status {said.returncode}\n{said.stdout}\n{said.stderr}")
        text = (folder / "scene.json").read_text()
        self.scene = json.loads("\n".join(line for line in text.splitlines() if not line.startswith("//")))
        self.summary = json.loads((folder / "summary.json").read_text())
        with open(folder / "series.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.column = {name: [float(row[name]) for row in rows] for name in rows[0]}

    def last(self, name):
        return self.column[name][-1]

    def time_at(self, values, level):
        """First instant at which values reach a level, between rows by linear interpolation."""
        t = self.column["time_s"]
        i = next(i for i, value in enumerate(values) if value >= level)
        return t[i - 1] + (level - values[i - 1]) / (values[i] - values[i - 1]) * (t[i] - t[i - 1])


class Cells:
    """What dovetail cell has written about cells and tests, and the mean curves of the tests."""

    def __init__(self, program, file, folder, changes=()):
        command = [program, "cell", str(file), "--out", str(folder)]
        for change in changes:
            command += ["--set", change]
        said = subprocess.run(command, capture_output=True, text=True)
        if said.returncode != 0:
            sys.exit(f"{file}: exit status {said.returncode}\n{said.stdout}\n{said.stderr}")
        self.folder = folder
        self.found = json.loads((folder / "cells.json").read_text())

    def of_test(self, name, number):
        return self.found["tests"][name][number]["mean"]

    def curve(self, name):
        with open(self.folder / f"{name}.csv") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))


failures = []


def compare(what, value, by_hand, band):
    """Prints a line, and notes a failure where |value/by_hand - 1| exceeds the band."""
    off = value / by_hand - 1.0
    print(f"{what}: {value:.6g}, by hand {by_hand:.6g}, {100 * off:+.3g} % (band {100 * band:.3g} %)")
    if not abs(off) <= band:
        failures.append(what)


def beam(run):
    r = run("beam.json", 'height="36 mm"', "stages.0.kinetic=1e-6")
    solid = r.scene["solids"][0]
    (x0, y0, z0), (x1, y1, z1) = solid["box"]
    length, width, depth, modulus = x1 - x0, y1 - y0, z1 - z0, solid["material"]["youngs_modulus"]
    of_beam = solid["material"]["density"] * length * width * depth
    weight = 9.81 * (r.summary["momentum"]["mass_kg"] - of_beam)
    compare("force on the beam", -r.last("on_beam_z_N"), weight, 1e-3)
    compare("force of the supports", r.last("left_z_N") + r.last("right_z_N"), weight, 1e-3)
    bending = 5 * weight * length**3 / (384 * modulus * width * depth**3 / 12)
    shear = weight * length / 8 / (5 / 6 * width * depth * modulus / 2)
    compare("sag", -r.last("middle_uz_m"), bending + shear, 0.02)


def wave(run):
    r = run("wave.json")
    modulus, d, v0 = 1e8, 0.4, 0.05
    density = 2500 * math.pi / 6
    c = math.sqrt(modulus / density)
    period = 8.86 * d / c
    end = v0 * period
    start = r.column["grain_y_m"][0]
    for name, place, values in (
        ("grain", start, [y - start for y in r.column["grain_y_m"]]),
        ("near", 13.2, r.column["near_uy_m"]),
        ("far", 16.0, r.column["far_uy_m"]),
    ):
        compare(f"arrival, {name}", r.time_at(values, 0.5 * end), 0.5 * period + (place - 0.2) / c, 0.012)
        if name != "far":
            compare(f"displacement, {name}", values[-1], end, 0.003)
    energy = r.last("bar_kinetic_J") + r.last("bar_elements_J")
    compare("energy of the pulse", energy, 1.5 * density * 4 * d * d * c * v0**2 * period, 0.03)
    echo = r.last("particles_kinetic_J") + r.last("particles_contacts_J")
    print(f"echo: {echo / energy:.3g} of the energy")
    if not echo < 1e-3 * energy:
        failures.append("echo")


def footing(run):
    r = run("footing.json")
    c, half, thick, h, wide = 2e3, 0.4, 0.12, 0.1, 1.99
    late = [k for k, t in enumerate(r.column["time_s"]) if t > 0.9]

    def mean(name):
        return sum(r.column[name][k] for k in late) / len(late)

    volume = 2.4 * thick * 1.2
    weight = 9.81 * (r.summary["momentum"]["mass_kg"] - 1800 * volume)
    pressure = -mean("on_clay_z_N") / (wide * thick)
    compare("pressure of the gravel", pressure, weight / (wide * thick), 0.02)
    compare("load of the footing", -mean("footing_z_N") / (half * thick),
            (2 + math.pi) * c * (1 + 0.5 * h / half) + pressure, 0.05)


def repose(run):
    r = run("repose.json", "time=2.2")
    base, d, half = 72, 0.01, 0.12
    mass = r.summary["momentum"]["mass_kg"] - base * 2500 * math.pi / 6 * d**3
    q = r.last("inner_particles") / r.last("all_particles")
    edge = (3 - 4 * q) / (4 * q - 1)
    height = 3 * (r.last("particles_gravity_J") / mass / 9.81 - 0.5 * d) * (1 + edge) / (1 + edge + edge * edge)
    compare("angle of repose", math.degrees(math.atan((1 - edge) * height / half)), 28.0, 4 / 28)
    compare("height at the edges over 1.25 diameters", edge * height, 1.25 * d, 0.6)


def oedometer(run):
    r = run("oedometer.json")
    d, k, layers, spheres, pressure = 0.01, 1e5, 8, 16, 1e4
    area = 4 * d * 2 * math.sqrt(3) * d
    modulus = 3 * 4 / 9 * math.sqrt(2) * k / d
    height = (layers - 1) * math.sqrt(2 / 3) * d
    compare("force on the lid", r.last("lid_z_N"), pressure * area, 1e-3)
    compare("settlement", -r.last("lid_uz_m"), pressure * height / modulus + 2 * pressure * area / (spheres * k), 1e-3)


def triaxial(run):
    r = run("triaxial.json", "strain=0.08", "time=0.267")
    edge, angles, across = 0.06, [], []
    for k in range(len(r.column["time_s"])):
        x, y, z = (edge + r.column[f"{c}_u{c}_m"][k] for c in "xyz")
        if z > 0.96 * edge:
            continue
        lateral = 0.5 * (r.column["x_x_N"][k] / (y * z) + r.column["y_y_N"][k] / (x * z))
        axial = r.column["z_z_N"][k] / (x * y)
        across.append(lateral)
        angles.append(math.degrees(math.asin((axial - lateral) / (axial + lateral))))
    compare("lateral pressure", sum(across) / len(across), 1e4, 0.06)
    compare("friction angle", sum(angles) / len(angles), 22.3, 0.1)


def shear(run):
    r = run("shear.json", "way=6.5 mm", "time=0.325")
    late = [k for k, u in enumerate(r.column["lower_ux_m"]) if u < -4.5e-3]
    ratio = [(r.column["lower_x_N"][k] + r.column["floor_x_N"][k]) / r.column["lid_z_N"][k] for k in late]
    compare("shear over normal stress", sum(ratio) / len(ratio), 0.404, 0.15)
    normal = [r.column["lid_z_N"][k] for k in late]
    compare("normal force", sum(normal) / len(normal), 1e4 * 0.15 * 0.036, 0.02)


def conveyor(run):
    r = run("../belt.json")
    mass, v = r.summary["momentum"]["mass_kg"], 0.3
    compare("velocity", r.last("beads_vx_m_per_s"), v, 5e-3)
    compare("weight on the belt", -r.last("belt_z_N"), mass * 9.81, 5e-3)
    compare("work of the belt", -r.last("particles_work_of_walls_and_drives_minus_J"), mass * v * v, 5e-3)


def cells(r):
    def mean(values):
        return sum(values) / len(values)

    sand = r.found["cells"]["sand"]
    diameter, k, ratio = 1e-2, 2e5, 0.5
    dense = mean(sand["contacts per grain"]) * mean(sand["solid fraction"]) * 1e-6 * k / (math.pi * diameter)
    compare("K of uniform strain", mean(sand["K of the Voigt tangent, MPa"]), dense / 3, 0.02)
    compare("G of uniform strain", mean(sand["G of the Voigt tangent, MPa"]), dense * (1 + 1.5 * ratio) / 5, 0.03)
    at = min(range(len(sand["secants"][0]["strain"])), key=lambda i: abs(sand["secants"][0]["strain"][i] - 3e-4))
    bulk, shear = (mean([one[name][at] for one in sand["secants"]]) for name in ("bulk_Pa", "shear_Pa"))
    before, after = r.curve("oedometer")[:2]
    more = {axis: float(before[f"sigma_{axis}_Pa"]) - float(after[f"sigma_{axis}_Pa"]) for axis in ("xx", "yy", "zz")}
    confined = bulk + 4 * shear / 3
    compare("oedometer, modulus of the first step", more["zz"] / float(after["strain"]), confined, 0.04)
    at_rest = (bulk - 2 * shear / 3) / confined
    compare("oedometer, side over axial pressure of the first step", (more["xx"] + more["yy"]) / 2 / more["zz"], at_rest, 0.08)
    sine = math.sin(math.radians(r.of_test("triaxial", "dilatancy angle")))
    largest = r.of_test("triaxial", "friction angle, last quarter") + 10 * 2 * sine / (1 - sine)
    compare("friction angle, largest", r.of_test("triaxial", "friction angle, largest"), largest, 0.08)


def main():
    name, program, scenes, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    folder.mkdir(parents=True, exist_ok=True)
    runs = iter(range(100))
    if name == "cells":
        cells(Cells(program, scenes / "cells.json", folder / "0", ["number=2"]))
    else:
        globals()[name](lambda scene, *changes: Run(program, scenes / scene, folder / str(next(runs)), changes))
    if failures:
        sys.exit("beyond the band: " + ", ".join(failures))


main()
