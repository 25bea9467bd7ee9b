#!/bin/bash
# SPDX-License-Identifier: MIT
# Submits a command of catena as a job array of N tasks, and a job that puts the parts together after all tasks have succeeded.
#   submit.sh N MERGE COMMAND [OPTIONS...]
#   submit.sh 8 "ffmpeg -framerate 25 -i out/%03d.png out/turn.mp4" render scene.json --frames 240 --orbit 360 -o out/%03d.png
#   submit.sh 8 "catena merge out/lines.csv" trace flow.vdb --field velocity --seeds seeds.csv -o out/lines.csv
#   submit.sh 8 "catena study merge out/part* -o out/all" study simulate study.json -o out/partSHARD
set -euo pipefail
[ $# -ge 3 ] || { sed -n 4p "$0" >&2; exit 2; }
tasks=$1 merge=$2; shift 2
array=$(sbatch --parsable --array="1-$tasks" "$(dirname "$0")/shard.sh" "$@")
merge=$(sbatch --parsable --dependency="afterok:$array" --job-name=catena-merge --wrap "$merge")
echo "array $array, merge $merge"
