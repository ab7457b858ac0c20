"""Lines of a scene file."""

import re
import textwrap


def balance(line):
    code = re.sub(r"//.*", "", line)
    return sum(code.count(c) for c in "[{") - sum(code.count(c) for c in "]}")


def block(lines, text, name):
    """The line that has this text, and those after it until its brackets are closed."""
    first = next((k for k, line in enumerate(lines) if text in line), None)
    if first is None:
        raise SystemExit(f"gallery: {name} has no line with {text}")
    last, depth = first, balance(lines[first])
    while depth > 0:
        last += 1
        depth += balance(lines[last])
    found = textwrap.dedent("\n".join(lines[first : last + 1]))
    while depth < 0:  # brackets of what is around it
        found = found.rstrip(", \n")[:-1]
        depth += 1
    return found


def of(file, texts):
    lines = file.read_text(encoding="utf-8").splitlines()
    return "\n".join(block(lines, text, file) for text in texts)
