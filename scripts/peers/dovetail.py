"""The benchmark program of the particle engine, of this tree or an earlier one."""
import json
import os

from peers.processes import attempt, call, fail, pinned, root

program = root / "build/native/benchmarks/dem/dem"
first_skin = 0.1  # of programs that have no option for it


def build():
    call(["cmake", "--preset", "native"], cwd=root)
    jobs = len(os.sched_getaffinity(0))
    call(["cmake", "--build", "--preset", "native", "--target", "dem_benchmark", "--parallel", jobs], cwd=root)


def takes_skin(benchmark):
    """Exits unless it is a benchmark program that knows the study of peers."""
    good, text = attempt([benchmark, "--help"])
    if not good or "--scene" not in text or "--copies" not in text:
        fail(2, f"{benchmark} is no benchmark program `dem` with the study of peers")
    return "--skin" in text


def rate(benchmark, scene, skin, folder, with_copy=False):
    """Million particle steps per second, and bytes held per particle. @param skin  None: has no such option"""
    command = [benchmark, "--study", "peers", "--bed", folder, "--scene", scene.ours, "--repeat", 1]
    for option, key in (("--steps", "steps"), ("--copies", "copies"), ("--warm-up", "warm")):
        command += [option, scene.variables.get(key, 1)]
    if skin is not None:
        command += ["--skin", skin]
    summary = folder / "ours.json"
    summary.unlink(missing_ok=True)
    pinned(command, folder, with_copy, ["--summary", summary])
    row = json.loads(summary.read_text())["scenes"][0]
    return row["million_steps_per_s"], row["bytes_held_per_particle"]
