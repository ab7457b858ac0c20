#!/bin/bash
# run_readme.sh DOCUMENT FOLDER PROGRAM: does what the README says of scenes, with shorter runs.
set -eu
rm -rf "$2"
bash "$(dirname "$0")/extract.sh" "$1" "$2"
cd "$2"
mkdir -p build/release/programs
ln -s "$3" build/release/programs/dovetail
sed -i 's|^\(dovetail new plate mine.json\).*|\1; sed -i "s/\\"20 ms\\"/\\"0.2 ms\\"/" mine.json|' commands.sh
OMP_NUM_THREADS=1 bash -euo pipefail commands.sh > said 2>&1 || { cat said; exit 1; }
grep -q '"0.2 ms"' mine.json && grep -q "they differ" said
[ -s mine-out/grains.pvd ] && [ -s mine-out/report.html ]
[ "$(grep -c finished mine-study/study.md)" = 3 ]
