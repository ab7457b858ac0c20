"""check_installed.py FOLDER | --deb PACKAGES FOLDER: a Python that knows nothing of the build runs a scene.

FOLDER has the installed module. With --deb it lies in the Debian package of the folder PACKAGES, below /usr.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

SCENE = """
import sys
sys.path.insert(0, sys.argv[1])
import dovetail
assert dovetail.__file__.startswith(sys.argv[1]), dovetail.__file__
ball = {"at": [0, 0, 0.05], "radius": 0.01, "velocity": [0, 0, -1]}
run = dovetail.Run({"contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.5},
                    "particles": [{"from": "list", "density": 2500, "spheres": [ball]}],
                    "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
                    "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1}]})
run.advance(6000)
assert abs(run.grains.v[0, 2] - 0.5) < 0.01, run.grains.v
"""


def check(folder):
    for name in ("__init__.py", "py.typed", "_core.pyi"):
        assert (folder / "dovetail" / name).is_file(), f"{name} is missing in {folder}/dovetail"
    bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-c", SCENE, str(folder)], check=True, env=bare, cwd="/")


def check_deb(packages, folder):
    deb, = packages.glob("python3-dovetail_*.deb")
    depends = subprocess.run(["dpkg-deb", "-f", deb, "Depends"], check=True, capture_output=True, text=True).stdout
    for package in ("libc6 ", "libstdc++6 ", "python3 (>=", "python3 (<<", "python3-numpy"):
        assert package in depends, f"{deb.name} does not depend on {package.strip()}: {depends}"
    with tempfile.TemporaryDirectory() as root:
        subprocess.run(["dpkg-deb", "-x", deb, root], check=True)
        check(pathlib.Path(root) / "usr" / folder)


if sys.argv[1] == "--deb":
    check_deb(pathlib.Path(sys.argv[2]), sys.argv[3])
else:
    check(pathlib.Path(sys.argv[1]))
print("it runs")
