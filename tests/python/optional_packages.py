"""Scripts that need packages which need not be here."""
import contextlib
import os
import sys


@contextlib.contextmanager
def skips_without_packages(script):
    """Ends with 77, which ctest takes for skipped, where a package is missing; goes back to the script's folder."""
    try:
        yield
    except ModuleNotFoundError as error:
        if error.name.split(".")[0] in ("dovetail", "numpy"):
            raise
        print(f"{script.name} needs the Python package {error.name}, which is not here")
        sys.exit(77)
    finally:
        os.chdir(script.parent)
