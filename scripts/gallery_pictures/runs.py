"""Runs scenes with the program dovetail and reads what they wrote."""

import json
import subprocess
import xml.etree.ElementTree as xml
from pathlib import Path


def command(picture):
    """Arguments of dovetail, as a reader would write them."""
    words = ["run", f"scenes/{picture.scene}.json"]
    for setting in picture.settings:
        words += ["--set", setting]
    if picture.contents:
        contents = ["grains", *picture.contents.split(",")]
        words += ["--set", "output.contents=" + json.dumps(contents, separators=(",", ":"))]
    return words + ["--out", f"gallery-out/{picture.file}"]


class Run:
    """A folder of a run that is done: `scene` in full with SI values, and its frames."""

    def __init__(self, folder):
        self.folder = Path(folder)
        text = (self.folder / "scene.json").read_text(encoding="utf-8")
        self.scene = json.loads("\n".join(line for line in text.splitlines() if not line.startswith("//")))

    def series(self, name):
        """[(time in s, path)] of <name>.pvd, empty if there is none."""
        file = self.folder / f"{name}.pvd"
        if not file.exists():
            return []
        sets = xml.parse(file).getroot().iter("DataSet")
        return [(float(item.get("timestep")), self.folder / item.get("file")) for item in sets]

    def frame_count(self):
        return len(self.series("grains"))


def run(program, picture):
    folder = Path("gallery-out") / picture.file
    if not (folder / "summary.json").exists():
        print("running", picture.file, flush=True)
        subprocess.run([program, *command(picture)], check=True, stdout=subprocess.DEVNULL)
    return Run(folder)
