"""Runs scenes with the program dovetail and has it draw them."""

import json
import re
import subprocess
from pathlib import Path

from PIL import Image


def folder_of(picture):
    return Path("gallery-out") / picture.file


def scene_file(picture):
    return Path(f"scenes/{picture.scene}.json")


def run_command(picture):
    """Arguments of dovetail, as a reader would write them."""
    words = ["run", str(scene_file(picture))]
    for setting in picture.settings:
        words += ["--set", setting]
    if picture.contents:
        contents = ["grains", *picture.contents.split(",")]
        words += ["--set", "output.contents=" + json.dumps(contents, separators=(",", ":"))]
    if picture.after:
        state = f"$PWD/gallery-out/{picture.after}/checkpoint.state"
        words += ["--set", f"particles.0.file={state}", "--set", f"solids.0.state.file={state}"]
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
    text = scene_file(picture).read_text(encoding="utf-8")
    return picture.heading or re.search(r'"title": "([^"]*)"', text).group(1)


def run(program, picture):
    if not (folder_of(picture) / "summary.json").exists():
        print("running", picture.file, flush=True)
        words = [word.replace("$PWD", str(Path.cwd())) for word in run_command(picture)]
        subprocess.run([program, *words], check=True, stdout=subprocess.DEVNULL)


def draw(program, picture, images):
    commands = {".png": draw_command(picture)}
    if picture.animated:
        commands[".gif"] = film_command(picture)
    for ending, command in commands.items():
        file = images / (picture.image + ending)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.unlink(missing_ok=True)
        subprocess.run([program, *command, "--out", str(file)], check=True)
    shrink(images / f"{picture.image}.png")


def shrink(file):
    """Fewer pixels and colours, so that the repository stays small."""
    image = Image.open(file).convert("RGB")
    size = (900, round(900 * image.height / image.width)) if image.width > 900 else image.size
    image = image.resize(size, Image.LANCZOS).quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    image.save(file, optimize=True)
