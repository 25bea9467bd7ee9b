#!/bin/bash
# SPDX-License-Identifier: MIT
# A task of a Slurm job array: a command of catena on the task's share of the work. SHARD in an argument becomes the number of the task.
#   sbatch --array=1-8 shard.sh render scene.json --frames 240 --orbit 360 -o out/%03d.png
#   SHARDS=8 sbatch --array=3 shard.sh ...           # one of the eight tasks again
#SBATCH --job-name=catena
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
exec "${CATENA:-catena}" "${@//SHARD/$SLURM_ARRAY_TASK_ID}" --shard "$SLURM_ARRAY_TASK_ID/${SHARDS:-$SLURM_ARRAY_TASK_COUNT}"
