"""run_document.py DOCUMENT: runs the blocks of Python after <!-- tested -->, one after the other, beside the shipped
scenes.

77 if it imports a package that is not here.
"""
import os
import pathlib
import re
import sys
import tempfile

from optional_packages import skips_without_packages

os.environ["MPLBACKEND"] = "Agg"
document = pathlib.Path(sys.argv[1])
blocks = re.compile(r"^<!-- tested -->\n```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
text, names = document.read_text(), {}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.symlink(os.environ["DOVETAIL_SCENES"], "scenes")
    with skips_without_packages(document):
        for block in blocks.finditer(text):
            above = text.count("\n", 0, block.start(1))  # so that errors name the line of the document
            exec(compile("\n" * above + block[1], document, "exec"), names)
assert names, f"{document} has no block of Python to test"
