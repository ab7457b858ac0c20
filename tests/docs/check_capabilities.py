#!/usr/bin/env python3
"""check_capabilities.py ROOT: docs/capabilities.md names every public class of dem and fem, and keys that exist."""
import pathlib
import re
import sys

from public_classes import classes_of

root = pathlib.Path(sys.argv[1])
page = (root / "docs/capabilities.md").read_text()
keys = set(re.findall(r"^\| `([\w-]+)`", (root / "docs/scene-keys.md").read_text(), re.MULTILINE))
faults = []

classes = {**classes_of(root, "dem"), **classes_of(root, "fem")}
named = set(re.findall(r"`(\w+)`", page))
faults += [f"{header.relative_to(root)}: {name} is not on the page" for name, header in classes.items() if name not in named]

for row in re.findall(r"^\| `.*\|$", page, re.MULTILINE):
    cells = [cell.strip() for cell in row.strip("|").split(" | ")]
    for name in re.findall(r"`(\w+)`", cells[0]):
        if name not in classes:
            faults.append(f"{name} is on the page, but in no header of dem and fem")
    if not cells[2].startswith("none"):
        for path in re.findall(r"`([\w.]+)`", cells[2]):
            if not all(part in keys for part in path.split(".")):
                faults.append(f"there is no key {path}")

print("\n".join(faults) or f"{len(classes)} classes, all on the page")
sys.exit(1 if faults else 0)
