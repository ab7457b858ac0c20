"""run_example.py SCRIPT [FIGURES]: runs a script of examples/python in a folder of its own, without a screen.

77 if it imports a package that is not here. With FIGURES the pictures that it saves are stored there.
"""
import os
import pathlib
import runpy
import shutil
import sys
import tempfile

from optional_packages import skips_without_packages

os.environ["MPLBACKEND"] = "Agg"
script = pathlib.Path(sys.argv[1]).resolve()
assert f"({script.name})" in (script.parent / "README.md").read_text(), f"{script.name} has no row in README.md beside it"
figures = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with skips_without_packages(script):
        runpy.run_path(str(script), run_name="__main__")
    if figures:
        figures.mkdir(parents=True, exist_ok=True)
    for picture in sorted(pathlib.Path(folder).glob("*.png")) if figures else []:
        shutil.copy(picture, figures)
        print(figures / picture.name)
