#!/bin/bash
# A scene whose solid is shared by ranks: its results are those of one process, a killed rank ends all, and the run goes
# on on other ranks, as it does when its time was up. usage: on_ranks.sh PROGRAM MPIEXEC SCENE
set -u
program="$1" mpiexec="$2" scene="$3"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }
ranks() {
  local count="$1"
  shift
  "$mpiexec" --mca plm isolated --oversubscribe --allow-run-as-root -n "$count" "$program" "$@"
}
expect_same() {
  "$program" compare "$work/alone" "$1" --tolerance 1e-6 || fail "$1 differs from the run of one process"
}

"$program" run "$scene" --out "$work/alone" > "$work/alone.txt" || fail "one process fails"
ranks 2 run "$scene" --out "$work/two" > "$work/two.txt" 2>&1 || { cat "$work/two.txt"; fail "two ranks fail"; }
expect_same "$work/two"
grep -q 'on 2 ranks' "$work/two.txt" || fail "the ranks are not told of"
[ "$(grep -c '^files in' "$work/two.txt")" = 1 ] || fail "each rank writes its own summary"

ranks 3 run "$scene" --out "$work/three" > "$work/three.txt" 2>&1 &
run=$!
until [ -e "$work/three/checkpoint.state" ] || ! kill -0 "$run" 2> /dev/null; do sleep 0.02; done
mapfile -t processes < <(pgrep -f "^$program run $scene --out $work/three")
kill -9 "${processes[-1]}" || fail "the run was over before a rank could be killed"
wait "$run" && fail "a rank was killed and the run says that all is well"
grep -q 'the last checkpoint is of' "$work/three.txt" || { cat "$work/three.txt"; fail "no checkpoint is named"; }
ranks 2 resume "$work/three" > "$work/resumed.txt" 2>&1 || { cat "$work/resumed.txt"; fail "it does not go on"; }
expect_same "$work/three"

ranks 2 run "$scene" --out "$work/two" > "$work/again.txt" 2>&1 && fail "a run was overwritten"
[ "$(grep -c '^dovetail: there is a run in this folder' "$work/again.txt")" = 1 ] || { cat "$work/again.txt"; fail "no refusal"; }

ranks 3 run "$scene" --out "$work/short" --max-wall-seconds 0.3 > "$work/short.txt" 2>&1
status=$?
[ $status = 142 ] || { cat "$work/short.txt"; fail "its time was up, and the exit code is $status"; }
[ "$(grep -c 'its time was up at t = ' "$work/short.txt")" = 1 ] || { cat "$work/short.txt"; fail "no stop is told"; }
ranks 2 resume "$work/short" > "$work/resumed.txt" 2>&1 || { cat "$work/resumed.txt"; fail "it does not go on"; }
expect_same "$work/short"

sed 's/0.03\*t/0.04*t/' "$scene" > "$work/other.json"
one=(-n 1 "$program" run)
"$mpiexec" --mca plm isolated --oversubscribe --allow-run-as-root "${one[@]}" "$scene" --out "$work/both" : \
  "${one[@]}" "$work/other.json" --out "$work/both" > "$work/both.txt" 2>&1 && fail "ranks with different scenes run"
[ "$(grep -c 'rank 1 begins with another scene' "$work/both.txt")" = 1 ] || { cat "$work/both.txt"; fail "no refusal"; }
