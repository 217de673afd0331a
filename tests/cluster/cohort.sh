#!/usr/bin/env bash
# cohort.sh VMESH SCRIPTS: scripts/cohort on this machine, then through a Slurm of this machine while a job, the
# controller and a node with its job are killed; the results must be the same, byte by byte. About a minute and a half.
set -euo pipefail
vmesh=$(realpath "$1") scripts=$(realpath "$2")
source "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
need_commands snakemake flock munged slurmctld slurmd sbatch

begin_test
export VMESH=$vmesh

make_inputs() {
  mkdir "$work/trees"
  for seed in 1 2; do "$vmesh" synth --vertices 150 --seed "$seed" -o "$work/trees/small_$seed.swc" --quiet; done
  for seed in 1 2; do "$vmesh" synth --vertices 10000 --seed "$seed" -o "$work/trees/long_$seed.swc" --quiet; done
  { cat "$work/trees/small_1.swc" && echo "151 3 0 zero 0 1 150"; } >"$work/trees/damaged.swc"
  cat >"$work/cohort.yaml" <<CONFIG
inputs:
  - files: trees/*.swc
picture: {width: 200, height: 150}
cases:
  long_*: {options: {around: 12}}
CONFIG
}

cohort() {
  "$scripts/cohort/run" "$work/cohort.yaml" "$@"
}

# Rows of the table without what a case costs, which differs from run to run.
results_in_table() {
  python3 -c 'import csv, sys
for row in csv.DictReader(open(sys.argv[1])):
    print({name: value for name, value in row.items() if name not in ("seconds", "cpu_seconds", "peak_memory_mb")})' "$1"
}

same_results() {
  diff <(results_in_table "$1/table.csv") <(results_in_table "$2/table.csv") || fail "the tables differ"
  local folder
  for folder in surfaces pictures; do
    diff -r "$1/$folder" "$2/$folder" || fail "$folder differ"
  done
}

run_locally() {
  cohort -o "$work/here" 2>"$work/here.log"
  grep -q "5 cases: 4 ok, 1 failed" "$work/here.log" || fail "not what was expected of the cohort on this machine"
  grep -q '^damaged,failed,3,.*zero' "$work/here/table.csv" || fail "the table does not say what is damaged"
  cohort -o "$work/here" 2>"$work/again.log"
  grep -q "Nothing to be done" "$work/again.log" || fail "a second run does something"
  touch "$work"/trees/*
  cohort -o "$work/here" 2>"$work/again.log"
  grep -q "Nothing to be done" "$work/again.log" || fail "a run after touching the files does something"
}

only_long_jobs_run() {
  local running
  running=$(squeue --noheader --format %A)
  [[ -n "$running" && "$(sort <<<"$running")" == "$(jobs_of "$work/there" 'status/long_.*surface' | sort)" ]]
}

run_on_cluster() {
  start_slurm "$work/slurm"
  start_driver "$work/there.log" "$scripts/cohort/run" "$work/cohort.yaml" -o "$work/there" --profile slurm
  wait_for 60 "a job of long_1" runs "$work/there" status/long_1.surface
  kill_job "$(jobs_of "$work/there" status/long_1.surface)"
  # While nothing begins or ends: the state of the jobs is saved five seconds later, and what the controller forgets
  # runs twice, on a node that Slurm then drains for it.
  wait_for 120 "a time when only the long cases are left" only_long_jobs_run
  sleep 6
  kill_and_restart_controller
  local lost
  lost=$(jobs_of "$work/there" status/long_ | tail -n 1)
  [[ -n "$lost" ]] || fail "the long cases are too short: none was left to kill"
  kill_node_and_job "$lost"
  finish_driver
  grep -q "Trying to restart" "$work/there.log" || fail "the job that was killed was not tried again"
}

change_one_input() {
  "$vmesh" synth --vertices 160 --seed 9 -o "$work/trees/small_2.swc" --quiet
  cohort -o "$work/there" --profile slurm 2>"$work/changed.log"
  grep -Eq '^surface +1 ' "$work/changed.log" || fail "one input changed, and not one surface was made"
}

make_inputs
run_locally
say "done on this machine"
run_on_cluster
same_results "$work/here" "$work/there"
say "done through Slurm, the results are the same"
change_one_input
say "one input changed, one case made again"
