#!/usr/bin/env bash
# sixty_cases.sh VMESH SCRIPTS DATA: scripts/cohort on sixty cases of the shared data, two of them damaged. Needs
# Snakemake alone; 75 s of CPU.
set -euo pipefail
vmesh=$(realpath "$1") scripts=$(realpath "$2") data=$3
source "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
need_commands snakemake flock
if [[ ! -d "$data" ]]; then
  echo "SKIPPED: shared test data not found: $data (set the CMake cache variable VMESH_SHARED_DATA)"
  exit 77
fi

work=$(mktemp -d /tmp/vmesh-XXXXXX)
trap 'rm -rf "$work"' EXIT
export VMESH=$vmesh
cp -r "$data" "$work/data"
sed "s|DATA|data|g" "$(dirname "${BASH_SOURCE[0]}")/sixty_cases.yaml" >"$work/cohort.yaml"

# expect TEXT WHAT: runs the cohort and looks for the text, a regular expression, in what it says.
expect() {
  "$scripts/cohort/run" "$work/cohort.yaml" 2>"$work/log" || fail "the workflow ended with $?: $(<"$work/log")"
  grep -Eq "$1" "$work/log" || fail "$2: $(<"$work/log")"
}

expect "^60 cases: 58 ok, 2 failed" "not 58 surfaces and 2 failures"
grep -q "^Neuron_missing_ids: failed: Neuron_missing_ids.swc: line 42: its parent 7" "$work/log" ||
  fail "it is not said what is wrong with Neuron_missing_ids"
grep -q "^repeated_id: failed: repeated_id.swc: line 6: the id 4" "$work/log" ||
  fail "it is not said what is wrong with repeated_id"
(($(wc -l <"$work/results/table.csv") == 61)) || fail "the table has not 60 rows"
(($(find "$work/results/surfaces" -name '*.ply' | wc -l) == 58)) || fail "there are not 58 surfaces"
(($(find "$work/results/pictures" -name '*.png' | wc -l) == 58)) || fail "there are not 58 pictures"

find "$work/data" -exec touch {} +
expect "^Nothing to be done" "a second run does something, after all files were touched"

sed 's/-1$/-1 /;1i # changed' "$data/synthetic_trees/tree119.swc" >"$work/data/synthetic_trees/tree119.swc"
expect "^surface +1 " "one input changed, and not one surface was made"
echo "60 cases: 58 surfaces, 2 failures; nothing the second time; one case after a change; $SECONDS s"
