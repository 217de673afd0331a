#!/usr/bin/env bash
# parts.sh VMESH SCRIPTS: one tree in one go, in parts on this machine, and in parts through a Slurm of this machine
# while a job, and a node with its job, are killed: three times the same bytes, and nothing done twice but what was
# killed. A minute or two.
set -euo pipefail
vmesh=$(realpath "$1") scripts=$(realpath "$2")
source "$(dirname "${BASH_SOURCE[0]}")/slurm.sh"
need_commands snakemake flock munged slurmctld slurmd sbatch
begin_test
export VMESH=$vmesh

options=(--vertices 40000 --set around=12 --memory 1000 --memory-whole 2000)

count_parts() { find "$1.parts/parts" -name 'part_*.vpart' | wc -l; }

in_one_go() {
  "$vmesh" synth --vertices 5000 --seed 1 -o "$work/tree.swc" --quiet
  "$vmesh" generate "$work/tree.swc" -o "$work/once.ply" --around 12 --quiet
  say "done in one go"
}

parts_here() { "$scripts/parts/run" "$work/tree.swc" -o "$work/here/whole.ply" "${options[@]}"; }

in_parts_here() {
  local whole=$work/here/whole.ply
  parts_here 2>"$work/here.log" || fail "the workflow ended with $?"
  (($(count_parts "$whole") >= 4)) || fail "there are only $(count_parts "$whole") parts"
  cmp "$work/once.ply" "$whole" || fail "in parts, the surface is another"
  parts_here 2>"$work/again.log"
  grep -q "Nothing to be done" "$work/again.log" || fail "a second run does something"
  rm "$whole" "$whole.parts/parts/part_00002.vsurf"
  parts_here 2>"$work/again.log"
  grep -Eq "^generate +1 " "$work/again.log" || fail "one part was lost, and not one was made again"
  cmp "$work/once.ply" "$whole" || fail "with a part made again, the surface is another"
  say "done in parts on this machine"
}

# Parts that take their time, so that there is one to kill, however fast the machine.
take_time() {
  printf '#!/usr/bin/env bash\n[[ "$*" == generate*.vpart* ]] && sleep 5\nexec %q "$@"\n' "$vmesh" >"$work/vmesh"
  chmod +x "$work/vmesh"
  export VMESH=$work/vmesh
}

in_parts_on_cluster() {
  local whole=$work/there/whole.ply lost made
  take_time
  start_slurm "$work/slurm"
  start_driver "$work/there.log" \
    "$scripts/parts/run" "$work/tree.swc" -o "$whole" "${options[@]}" --profile slurm
  wait_for 90 "a job of part 1" runs "$whole.parts" part_00001.vsurf
  kill_job "$(jobs_of "$whole.parts" part_00001.vsurf)"
  wait_for 90 "a job of part 3 or 4" runs "$whole.parts" 'part_0000[34].vsurf'
  lost=$(jobs_of "$whole.parts" 'part_0000[34].vsurf' | tail -n 1)
  kill_node_and_job "$lost"
  finish_driver
  cmp "$work/once.ply" "$whole" || fail "through Slurm, the surface is another"
  made=$(squeue --noheader --states all --format %A | wc -l)
  ((made == $(count_parts "$whole") + 3)) ||
    fail "$made jobs for splitting, joining, $(count_parts "$whole") parts and one of them again"
  say "done in parts through Slurm: the same bytes, one part made again for each that was killed"
}

in_one_go
in_parts_here
in_parts_on_cluster
