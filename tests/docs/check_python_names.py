#!/usr/bin/env python3
"""check_python_names.py ROOT [--module]: docs/python-names.md names every public class of C++, and none that is not there.
With --module also every public name of the module dovetail, which Python must find, and every member of Run, and none
that is not there.
"""
import pathlib
import re
import sys

from public_classes import classes_of, headers_of

MODULES = ("arlequin", "calibration", "cg", "coupling", "dem", "fem", "hierarchical", "io", "mpm", "picture", "report",
           "rve", "solid_io", "surface")  # not scene, which is all said, nor foundations


def text_of(root, module):
    """Of all public headers of a folder of src, or of all folders."""
    folders = [module] if (root / "src" / module / "include").is_dir() and module else [f.name for f in (root / "src").iterdir()]
    return "\n".join(path.read_text() for folder in folders for path in headers_of(root, folder))


def said_by_capabilities(root):
    """Classes of dem and fem with a key, and those that are parts of others."""
    page = (root / "docs/capabilities.md").read_text()
    rows = [line for line in page.splitlines() if not re.match(r"^\| `.*\| none[^|]*\|$", line)]
    return set(re.findall(r"`(\w+)`", "\n".join(rows)))


def rows_of(page):
    for line in re.findall(r"^\| `.*\|$", page, re.MULTILINE):
        yield [re.findall(r"`([^`]+)`", cell) for cell in line.strip("|").split(" | ")]


def check_cpp(root, page):
    faults = []
    known = {module: classes_of(root, module) for module in MODULES}
    here = {name.split("::")[-1] for name in re.findall(r"`([\w:]+)`", page)}
    covered = said_by_capabilities(root)
    for module, classes in known.items():
        missing = [name for name in classes if name not in here and not (module in ("dem", "fem") and name in covered)]
        faults += [f"{module}::{name} is not in docs/python-names.md: give it a name in Python, or say there that it has none"
                   for name in missing]
    lists = page[page.index("## Said by a scene"):]
    all_classes = set().union(*known.values())
    faults += [f"{name} is on the page, but no class" for name in re.findall(r"`([A-Z]\w+)`", lists) if name not in all_classes]
    for _, cpp, *_ in rows_of(page):
        for name in cpp:
            module, _, last = name.rpartition("::")
            if not re.search(rf"\b{last}\b", text_of(root, module)):
                faults.append(f"{name} is on the page, but in no header")
    return faults


def check_module(page):
    import dovetail
    from dovetail import _core
    wanted = set(dovetail.__all__) | {f"Run.{member}" for member in dir(dovetail.Run) if not member.startswith("_")}
    page_names = [name for python, *_ in rows_of(page) for name in python]
    faults = [f"{name} has no row in docs/python-names.md" for name in sorted(wanted - set(page_names))]
    for name in sorted(set(page_names)):
        owner, _, member = name.rpartition(".")
        holder = getattr(dovetail, owner, getattr(_core, owner, None)) if owner else dovetail
        if not hasattr(holder, member) and not (not owner and hasattr(_core, member)):
            faults.append(f"{name} is on the page, but not in the module")
        if page_names.count(name) > 1:
            faults.append(f"{name} is on the page twice")
    return faults


def main():
    root = pathlib.Path(sys.argv[1])
    page = (root / "docs/python-names.md").read_text()
    faults = check_cpp(root, page) + (check_module(page) if "--module" in sys.argv else [])
    print("\n".join(faults) or "all names are on the page")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
