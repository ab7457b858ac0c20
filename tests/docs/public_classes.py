"""Public classes of the library, from its headers."""
import re

_DEFINITION = re.compile(r"^(?:struct|class) (?:alignas\([^)]*\) )?(\w+)(?: final)?(?: : [^;{]*)?\s*\{", re.MULTILINE)


def headers_of(root, module):
    return sorted((root / "src" / module / "include").rglob("*.hpp"))


def classes_of(root, module):
    """{name: header} of a folder of src."""
    return {name: header for header in headers_of(root, module) for name in _DEFINITION.findall(header.read_text())}
