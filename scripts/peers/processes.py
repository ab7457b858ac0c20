"""Programs that are run: what goes wrong with them, and on which core."""
import contextlib
import os
import subprocess
import sys
from pathlib import Path

root = Path(__file__).resolve().parent.parent.parent
environment = {"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"}
cores = sorted(os.sched_getaffinity(0))


def fail(status, text):
    print(f"compare-peers: {text}", file=sys.stderr)
    sys.exit(status)


def attempt(command, **options):
    """Whether the command ended well, and what it printed."""
    try:
        result = subprocess.run([str(c) for c in command], capture_output=True, text=True, errors="replace", **options)
    except OSError as error:
        return False, str(error)
    return result.returncode == 0, result.stdout + result.stderr


def call(command, **options):
    good, text = attempt(command, **options)
    if not good:
        fail(1, f"{' '.join(str(c) for c in command)}: {text[-800:]}")
    return text


@contextlib.contextmanager
def copy_on_core(core, wanted, command, folder):
    """Keeps the command running on a core, again and again, until the block is left."""
    if not wanted:
        yield
        return
    loop = ["/bin/sh", "-c", 'while "$@"; do :; done', "copy", "taskset", "-c", str(core)] + [str(c) for c in command]
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(loop, cwd=folder, env=environment, stdout=quiet, stderr=quiet, start_new_session=True)
    try:
        yield
    finally:
        subprocess.run(["/bin/kill", "--", f"-{process.pid}"], stderr=quiet)
        process.wait()


def pinned(command, folder, with_copy, summary=()):
    """What the command prints, run on the first core. The copy beside it has no `summary`, options that name a file."""
    with copy_on_core(cores[-1], with_copy, command, folder):
        return call(["taskset", "-c", str(cores[0])] + list(command) + list(summary), cwd=folder, env=environment)


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} cores"
