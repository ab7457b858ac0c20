"""Runs scenes with the program dovetail and has it draw them."""

import json
import re
import subprocess
from pathlib import Path


def folder_of(picture):
    return Path("gallery-out") / picture.file


def run_command(picture):
    """Arguments of dovetail, as a reader would write them."""
    words = ["run", f"scenes/{picture.scene}.json"]
    for setting in picture.settings:
        words += ["--set", setting]
    if picture.contents:
        contents = ["grains", *picture.contents.split(",")]
        words += ["--set", "output.contents=" + json.dumps(contents, separators=(",", ":"))]
    return words + ["--out", str(folder_of(picture))]


def draw_command(picture):
    words = ["picture", str(folder_of(picture)), *picture.draw.split()]
    if picture.frame < 1.0:
        count = len(list((folder_of(picture) / "grains").glob("*.vtu")))
        words += ["--frame", str(round(picture.frame * (count - 1)))]
    return words


def film_command(picture):
    return ["picture", str(folder_of(picture)), *picture.draw.split(), "--film", "--size", "450", "400"]


def title(picture):
    text = Path(f"scenes/{picture.scene}.json").read_text(encoding="utf-8")
    return picture.heading or re.search(r'"title": "([^"]*)"', text).group(1)


def run(program, picture):
    if not (folder_of(picture) / "summary.json").exists():
        print("running", picture.file, flush=True)
        subprocess.run([program, *run_command(picture)], check=True, stdout=subprocess.DEVNULL)


def draw(program, picture, images):
    commands = {".png": draw_command(picture)}
    if picture.animated:
        commands[".gif"] = film_command(picture)
    for ending, command in commands.items():
        file = images / (picture.file + ending)
        file.unlink(missing_ok=True)
        subprocess.run([program, *command, "--out", str(file)], check=True)
