"""How far something is: a line that is written over in a terminal, and one that is updated in a notebook."""

import sys
import time

from . import _core


def in_terminal():
    return sys.stdout.isatty() and sys.stderr.isatty()


def _notebook():
    """A line of a notebook, if this is one."""
    if "IPython" not in sys.modules:
        return None
    from IPython import get_ipython
    from IPython.display import display
    shell = get_ipython()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    return display({"text/plain": ""}, raw=True, display_id=True)


class Progress:
    """Label, part done and time to go, at most ten times a second; nothing elsewhere than in terminals and notebooks."""

    def __init__(self, label, total):
        self._label, self._total = label, total
        self._line = _notebook()
        self._shown = self._line is not None or in_terminal()
        self._start = time.monotonic()
        self._last = self._start - 1

    def update(self, done, note=""):
        now = time.monotonic()
        if not self._shown or now - self._last < 0.1:
            return
        self._last = now
        self._write(_core.progress_line(self._label, done / max(self._total, 1), now - self._start, note))

    def finish(self):
        if self._shown:
            self._write("")
        self._shown = False

    def _write(self, text):
        if self._line is not None:
            self._line.update({"text/plain": text}, raw=True)
        else:
            sys.stderr.write("\r\033[K" + text)
            sys.stderr.flush()
