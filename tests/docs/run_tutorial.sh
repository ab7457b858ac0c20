#!/bin/bash
# run_tutorial.sh DOCUMENT FOLDER PROGRAM: does what the tutorial says, with the run of its scene shortened.
set -eu
programs="$(dirname "$3")"
export PATH="$programs:$PATH" OMP_NUM_THREADS=1
rm -rf "$2"
bash "$(dirname "$0")/extract.sh" "$1" "$2"
cd "$2"
grep -q '"time": "0.25 s"' cushion.json
sed -i 's/"time": "0.25 s"/"time": "0.01 s"/' cushion.json
bash -euo pipefail commands.sh > said 2>&1 || { cat said; exit 1; }
# wanted WORDS…: what the commands ought to have said.
wanted() {
  grep -q -- "$*" said || { cat said; echo "nothing says: $*"; exit 1; }
}
wanted "321 particles"
wanted "refused with code 2"
wanted "residual over all impulses"
wanted ": the same"
[ -s cushion-out/report.html ] && [ -s cushion-study/study.md ]
[ "$(grep -c finished cushion-study/study.md)" = 3 ]
