"""run_document.py DOCUMENT: runs the blocks of Python after <!-- tested -->, one after the other, beside the shipped
scenes.

77 if it imports a package that is not here.
"""
import os
import pathlib
import re
import sys
import tempfile

os.environ["MPLBACKEND"] = "Agg"
document = pathlib.Path(sys.argv[1])
blocks = re.compile(r"^<!-- tested -->\n```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
text, names = document.read_text(), {}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.symlink(os.environ["DOVETAIL_SCENES"], "scenes")
    try:
        for block in blocks.finditer(text):
            above = text.count("\n", 0, block.start(1))  # so that errors name the line of the document
            exec(compile("\n" * above + block[1], document, "exec"), names)
    except ModuleNotFoundError as error:
        if error.name.split(".")[0] in ("dovetail", "numpy"):
            raise
        print(f"{document.name} needs the Python package {error.name}, which is not here")
        sys.exit(77)
    finally:
        os.chdir(document.parent)
assert names, f"{document} has no block of Python to test"
