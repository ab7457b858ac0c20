"""python3 scripts/gallery_pictures PROGRAM [PICTURE…]: see scripts/gallery."""

import sys
from pathlib import Path

import page
import runs
from images import save_animation, save_picture
from pictures import PICTURES
from stage import Stage

IMAGES = Path("docs/images/gallery")


def draw(picture, run):
    count = run.frame_count()
    stage = Stage(picture, run)
    shown = round(picture.frame * (count - 1))
    save_picture(stage.draw(shown), IMAGES / f"{picture.file}.png")
    if picture.animated:
        stage = Stage(picture, run, (450, 340))
        stage.draw(shown)
        save_animation((stage.draw(k) for k in range(count)), IMAGES / f"{picture.file}.gif")


def main(program, *names):
    known = [picture.file for picture in PICTURES]
    unknown = set(names) - set(known)
    if unknown:
        print(f"gallery: no picture {', '.join(sorted(unknown))}; there are {', '.join(known)}", file=sys.stderr)
        return 2
    IMAGES.mkdir(parents=True, exist_ok=True)
    titles = {}
    for picture in PICTURES:
        run = runs.run(program, picture)
        titles[picture.scene] = run.scene["title"]
        if not names or picture.file in names:
            draw(picture, run)
            print("drawn", picture.file, flush=True)
    page.write(Path("docs/gallery.md"), PICTURES, titles)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
