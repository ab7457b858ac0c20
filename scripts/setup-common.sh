# Shared by the shell scripts here: packages, configuration, build. Source it; it does nothing by itself.
# shellcheck shell=bash disable=SC2034

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

build_packages=(g++ cmake ninja-build git libeigen3-dev libspectra-dev libsuitesparse-dev libvtk9-dev libhdf5-dev libgtest-dev
                nlohmann-json3-dev libfcl-dev libcgal-dev libmuparser-dev libceres-dev zlib1g-dev libopenblas0-serial)
python_packages=(python3-dev pybind11-dev python3-numpy)

say() { printf '\n== %s\n' "$*"; }
fail() {
  printf '%s: %s\n' "$(basename "$0")" "$2" >&2
  exit "$1"
}

# require_packages <package>…: installs those that are missing, as root or through sudo; exit 2 if that is impossible.
require_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "No Debian packages here: counting on your own compiler, CMake and libraries"
    return
  fi
  local missing=() package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  local as_root=(env DEBIAN_FRONTEND=noninteractive)
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
      as_root=(sudo "${as_root[@]}")
    else
      fail 2 "these Debian packages are missing and only root can install them: ${missing[*]}"
    fi
  fi
  say "Installing ${missing[*]}"
  { "${as_root[@]}" apt-get update -qq &&
      "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null; } ||
    fail 2 "apt-get could not install: ${missing[*]}"
}

# Options of the configuration that the script needs, whatever an earlier one of the folder has set.
needs=()

# build_preset <preset> [target…]: configures and builds with all cores.
build_preset() {
  local preset="$1"
  shift
  if [ ! -f "$root/build/$preset/CMakeCache.txt" ] && command -v ninja >/dev/null; then
    export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"
  fi
  say "Configuring build/$preset"
  (cd "$root" && cmake --preset "$preset" "${needs[@]}") || fail 1 "the configuration failed"
  say "Building with $(nproc) jobs"
  (cd "$root" && cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}) || fail 1 "the build failed"
}
