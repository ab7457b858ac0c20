"""docs/gallery.md"""

import shlex

import runs

HEAD = """# Gallery

Every picture is a frame of a [scene](../scenes/README.md). `scripts/gallery` draws them by these
commands and writes this page. Expected numbers are given with the scenes. The frames also open in
ParaView: see the [tutorial](tutorial.md#look-at-it).
"""


def quoted(words):
    return "dovetail " + " ".join(shlex.quote(word) for word in words)


def write(file, pictures):
    parts = [HEAD]
    for picture in pictures:
        title = runs.title(picture)
        commands = [runs.run_command(picture), runs.draw_command(picture)]
        parts.append(f"## {title}\n\n{picture.look}\n\n![{title}](images/gallery/{picture.file}.png)\n")
        if picture.animated:
            parts.append(f"![{title}, animated](images/gallery/{picture.file}.gif)\n")
            commands.append(runs.film_command(picture))
        lines = "\n".join(quoted(command) for command in commands)
        parts.append(f"```sh\n{lines}\n```\n")
    file.write_text("\n".join(parts), encoding="utf-8")
