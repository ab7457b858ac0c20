"""python3 scripts/gallery_pictures PROGRAM [--recipes | PICTURE…]: see scripts/gallery."""

import sys
from pathlib import Path

import curves
import page
import runs
from pictures import PICTURES
from recipes import RECIPES

IMAGES = Path("docs/images")


def draw_recipes(program):
    for picture in RECIPES:
        runs.run(program, picture)
        runs.draw(program, picture, IMAGES)
    runs.run(program, next(picture for picture in PICTURES if picture.file == "belt"))
    for name in curves.CURVES:
        curves.draw(name, Path("gallery-out"), IMAGES)
    return 0


def main(program, *names):
    if names == ("--recipes",):
        return draw_recipes(program)
    known = [picture.file for picture in PICTURES]
    unknown = set(names) - set(known)
    if unknown:
        print(f"gallery: no picture {', '.join(sorted(unknown))}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    for picture in PICTURES:
        if not names or picture.file in names:
            runs.run(program, picture)
            runs.draw(program, picture, IMAGES)
    if not names:
        page.write(Path("docs/gallery.md"), PICTURES)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
