#!/bin/bash
# SPDX-License-Identifier: MIT
# Job arrays of assets/cluster under a Slurm of this machine: images and a table of lines, with a task that is killed and one that is
# requeued while they run, must have the bytes of one process. As root:  tests/slurm/check_slurm.sh [PROGRAM]
# Exit code 77, with one sentence, where there is no Slurm.
set -euo pipefail
tree=$(cd "$(dirname "$0")/../.." && pwd)
. "$tree/tests/slurm/slurm.sh"
reason=$(missing_slurm)
[ -z "$reason" ] || { echo "skipped: $reason"; exit 77; }
CATENA=$(realpath "${1:-$tree/build/release/catena}")
export CATENA
folder=$(mktemp -d)
chmod 755 "$folder"  # munged runs as another user
finish() { stop_slurm "$folder/slurm"; rm -rf "$folder"; }
trap finish EXIT
start_slurm "$folder/slurm"
cd "$folder"
mkdir images whole

cat >scene.json <<'END'
{"fields": {"v": {"analytic": "abc"}, "f": {"analytic": "sphere", "resolution": 96}}, "volumes": [{"field": "f"}],
 "streamlines": [{"field": "v", "seeds": [[1, 0, 0]]}]}
END
pattern='{"sphere": {"center": [0, 0, 0], "radius": 1, "count": 2000}}'
render=(render scene.json --size 240x160 --frames 16 --orbit 360 --elevation 20)
trace=(trace scene.json --field v --length 20 --seeds "$pattern")

# submit N MERGE COMMAND...: sets `array` and `merge`
submit() {
  local said
  said=$("$tree/assets/cluster/submit.sh" "$@")
  array=$(sed 's/array \([0-9]*\),.*/\1/' <<<"$said") merge=$(sed 's/.*merge //' <<<"$said")
}
# Waits until a task runs its program; prints the id of the process.
process_of() {
  local pid
  for _ in $(seq 200); do
    pid=$(pgrep -f -- "^$CATENA .*--shard $1\$" | head -1) && [ -n "$pid" ] && { echo "$pid"; return; }
    sleep 0.05
  done
  echo "shard $1 did not start" >&2
  return 1
}
# Waits for the end of all jobs.
wait_for_jobs() {
  for _ in $(seq 600); do
    [ -n "$(squeue -h)" ] || return 0
    sleep 0.2
  done
  squeue >&2
  return 1
}
equal() { cmp -s "$1" "$2" || { echo "$1 differs from $2" >&2; exit 1; }; }

"$CATENA" "${render[@]}" -o whole/%02d.png >/dev/null
"$CATENA" "${trace[@]}" -o whole/lines.csv >/dev/null

submit 4 "ls images/*.png | wc -l >images/count" "${render[@]}" -o images/%02d.png
process_of 2/4 >/dev/null
scontrol requeue "${array}_2"
scontrol show job "${array}_2" | grep -q "Restarts=1" || { echo "task 2 was not requeued" >&2; exit 1; }
sleep 1
scontrol update "JobId=${array}_2" StartTime=now  # Slurm starts a requeued job after two minutes
wait_for_jobs
[ "$(cat images/count)" = 16 ] || { echo "$(cat images/count) images; 16 were expected" >&2; exit 1; }
for image in whole/*.png; do equal "$image" "images/${image#whole/}"; done
echo "16 images of 4 tasks, one of them requeued: the bytes of one process"

submit 4 "$CATENA merge lines.csv" "${trace[@]}" -o lines.csv
kill -9 "$(process_of 1/4)"
sleep 1
for _ in $(seq 100); do
  [ -n "$(squeue -h -t R,PD,CG -j "$array" 2>/dev/null)" ] || break
  sleep 0.2
done
[ ! -e lines.csv ] || { echo "merged although a task was killed" >&2; exit 1; }
scancel "$merge"
SHARDS=4 sbatch --parsable --array=1 "$tree/assets/cluster/shard.sh" "${trace[@]}" -o lines.csv >/dev/null
wait_for_jobs
"$CATENA" merge lines.csv
equal whole/lines.csv lines.csv
echo "a table of 4 tasks, one of them killed and submitted again: the bytes of one process"
