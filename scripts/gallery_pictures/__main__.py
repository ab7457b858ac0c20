"""python3 scripts/gallery_pictures PROGRAM [PICTURE…]: see scripts/gallery."""

import sys
from pathlib import Path

import page
import runs
from pictures import PICTURES

IMAGES = Path("docs/images")


def main(program, *names):
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
