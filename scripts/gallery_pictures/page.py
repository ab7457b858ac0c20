"""docs/gallery.md"""

import shlex
import textwrap

import excerpt
import runs

HEAD = """# Gallery

Every picture is a frame of a [scene](../scenes/README.md), whose essential lines stand below it.
`scripts/gallery` draws them by these commands and writes this page. Expected numbers are given with
the scenes, which take less than half a minute unless a time is given. The frames also open in
ParaView: see the [tutorial](tutorial.md#look-at-it).
"""


def quoted(words):
    return "dovetail " + " ".join(f'"{word}"' if "$PWD" in word else shlex.quote(word) for word in words)


def wrapped(text):
    return textwrap.fill(text, 100, break_long_words=False, break_on_hyphens=False)


def section(picture):
    title = runs.title(picture)
    yield f"## {title}\n"
    yield wrapped(picture.look + (f" About {picture.long} of one core." if picture.long else "")) + "\n"
    yield f"![{title}](images/{picture.image}.png)\n"
    if picture.animated:
        yield f"![{title}, animated](images/{picture.image}.gif)\n"
    yield f"From [{picture.scene}.json](../scenes/{picture.scene}.json):\n"
    yield f"```js\n{excerpt.of(runs.scene_file(picture), picture.lines)}\n```\n"
    commands = [runs.run_command(picture), runs.draw_command(picture)]
    if picture.animated:
        commands.append(runs.film_command(picture))
    yield "```sh\n" + "\n".join(quoted(command) for command in commands) + "\n```\n"


def write(file, pictures):
    parts = [HEAD, *(part for picture in pictures for part in section(picture))]
    file.write_text("\n".join(parts), encoding="utf-8")
