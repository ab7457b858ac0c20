"""docs/gallery.md"""

import shlex

from runs import command

HEAD = """# Gallery

Every picture is a frame of a [scene](../scenes/README.md), drawn by `scripts/gallery`, which writes
this page. Expected numbers are given with the scenes. The commands write frames for ParaView: see
the [tutorial](tutorial.md#look-at-it).
"""


def quoted(words):
    return " ".join(shlex.quote(word) for word in words)


def write(file, pictures, titles):
    """`titles` by scene."""
    parts = [HEAD]
    for picture in pictures:
        title = picture.heading or titles[picture.scene]
        parts.append(f"## {title}\n\n{picture.look}\n\n![{title}](images/gallery/{picture.file}.png)\n")
        if picture.animated:
            parts.append(f"![{title}, animated](images/gallery/{picture.file}.gif)\n")
        parts.append(f"```sh\ndovetail {quoted(command(picture))}\n```\n")
    file.write_text("\n".join(parts), encoding="utf-8")
