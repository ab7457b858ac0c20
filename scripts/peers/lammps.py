"""LAMMPS: Debian's, one of the same source for this machine's processor, and what they say of their speed."""
import os
import re
import shutil
import subprocess
import sys

from peers.processes import attempt, fail, pinned, root

inputs = root / "benchmarks/dem/peers"
keyring = "/usr/share/keyrings/debian-archive-keyring.gpg"
flags = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -march=native", "-DBUILD_MPI=off",
         "-DBUILD_OMP=on", "-DPKG_GRANULAR=on", "-DPKG_OPT=on", "-DPKG_OPENMP=on", "-DWITH_JPEG=off", "-DWITH_PNG=off",
         "-DWITH_FFMPEG=off", "-DWITH_GZIP=off"]
# The package OPT has no granular style, so that `-sf opt` changes nothing.
plain = [{"newton": "off"}, {"newton": "on"}]
with_omp = plain + [setting | {"suffix": "omp"} for setting in plain]


def version(program):
    """@returns None unless the program is LAMMPS"""
    good, text = attempt([program, "-h"])
    found = re.search(r"Massively Parallel Simulator - (.*)", text)
    return found.group(1).strip() if good and found else None


def styles(program):
    """The settings that it may run with."""
    return with_omp if re.search(r"\bOPENMP\b", attempt([program, "-h"])[1]) else plain


def debians():
    if not shutil.which("lmp"):
        install = ["apt-get", "install", "-y", "-qq", "--no-install-recommends", "lammps"]
        try:
            done = subprocess.run(install, stdout=sys.stderr).returncode == 0
        except OSError:
            done = False
        if not done:
            fail(2, "lmp is missing and cannot be installed; install the Debian package lammps")
    return shutil.which("lmp")


def step(what, command, folder):
    print(f"compare-peers: {what}", file=sys.stderr)
    good, text = attempt(command, cwd=folder)
    if not good:
        fail(1, f"{what} failed ({' '.join(str(c) for c in command)}):\n{text[-800:]}\n"
                "give a LAMMPS that is already built by --lammps FILE")


def download(folder):
    """The source package, under lists of its own: those of the system stay as they are."""
    release = dict(line.strip().split("=", 1) for line in open("/etc/os-release") if "=" in line)
    codename = release.get("VERSION_CODENAME", "").strip('"')
    if release.get("ID") != "debian" or not codename:
        fail(2, "the source of LAMMPS is that of Debian, and this is none; give a LAMMPS by --lammps FILE")
    source = folder / "sources.list"
    source.write_text(f"deb-src [signed-by={keyring}] http://deb.debian.org/debian {codename} main\n")
    for name in ("lists/partial", "cache/archives/partial"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    options = ["-o", f"Dir::Etc::sourcelist={source}", "-o", "Dir::Etc::sourceparts=/dev/null",
               "-o", f"Dir::State::lists={folder / 'lists'}", "-o", f"Dir::Cache={folder / 'cache'}",
               "-o", "APT::Update::Error-Mode=any"]
    step("reading Debian's list of sources", ["apt-get", "update", "-q"] + options, folder)
    step("fetching the source of LAMMPS", ["apt-get", "source", "-q", "--download-only"] + options + ["lammps"], folder)


def native(folder):
    """LAMMPS of Debian's source for this machine's processor, built in the folder once."""
    program = folder / "build/lmp"
    if program.exists() and version(program):
        return program
    print("compare-peers: LAMMPS for this processor is built now, once: 6 to 20 minutes on one core", file=sys.stderr)
    missing = [name for name in ("cmake", "dpkg-source", "g++") if not shutil.which(name)]
    if missing:
        fail(2, f"building LAMMPS needs {', '.join(missing)}; install cmake, dpkg-dev and g++, or give --lammps FILE")
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / "src"
    if not source.exists():
        download(folder)
        unpacked = folder / "src.part"
        shutil.rmtree(unpacked, ignore_errors=True)
        package = sorted(folder.glob("lammps_*.dsc"))[-1]
        step("unpacking it", ["dpkg-source", "-x", package.name, unpacked.name], folder)
        unpacked.rename(source)
    ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
    step("configuring it", ["cmake", "-S", source / "cmake", "-B", folder / "build"] + ninja + flags, folder)
    jobs = len(os.sched_getaffinity(0))
    step("building it", ["cmake", "--build", folder / "build", "--parallel", jobs, "--target", "lmp"], folder)
    return program


def rate(program, scene, setting, folder, with_copy=False, **more):
    """Million particle steps per second, without the steps of warm-up. @param more  further variables of the input"""
    command = [program, "-in", inputs / f"{scene.input}.in", "-log", "none"]
    variables = scene.variables | {"newton": setting["newton"], "skin": setting["skin"]} | more
    for key, value in variables.items():
        command += ["-var", key, value]
    if setting.get("suffix") == "omp":
        command += ["-sf", "omp", "-pk", "omp", 1]
    text = pinned(command, folder, with_copy)
    loops = re.findall(r"Loop time of ([\d.eE+-]+) on 1 procs for (\d+) steps with (\d+) atoms", text)
    if len(loops) != 2:
        fail(1, f"{program} says no times of its runs: {text[-800:]}")
    seconds, steps, particles = loops[1]
    return float(particles) * float(steps) / float(seconds) / 1e6
