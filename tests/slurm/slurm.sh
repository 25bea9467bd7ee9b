# SPDX-License-Identifier: MIT
# A Slurm of this machine alone, for tests as root: start_slurm FOLDER, then sbatch and the other clients work; stop_slurm ends it. All
# files, ports and sockets are its own, so that an installed Slurm is not touched.

# Prints why no Slurm can be started here; nothing if one can.
missing_slurm() {
  local program
  for program in slurmctld slurmd sbatch munged; do
    command -v "$program" >/dev/null || { echo "$program is not installed (packages slurmctld slurmd slurm-client munge)"; return; }
  done
  [ "$(id -u)" = 0 ] || echo "Slurm is started as root"
}

start_slurm() {
  local folder=$1 host
  host=$(hostname -s)
  mkdir -p "$folder"/{munge,state,spool}
  dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 status=none
  chmod 700 "$folder/munge"; chmod 600 "$folder/munge/key"; chown -R munge: "$folder/munge"
  # the socket is in a folder that everyone can enter
  mkdir -p "$folder/socket"; chmod 755 "$folder" "$folder/socket"; chown munge: "$folder/socket"
  runuser -u munge -- munged --force --socket="$folder/socket/munge" --key-file="$folder/munge/key" --pid-file="$folder/munge/pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
  cat >"$folder/slurm.conf" <<END
ClusterName=catena
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$folder/socket/munge
SlurmUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=2
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
  export SLURM_CONF=$folder/slurm.conf
  slurmctld -c
  slurmd
  local second
  for second in $(seq 30); do
    [ "$(sinfo -h -o %T 2>/dev/null)" = idle ] && return 0
    sleep 1
  done
  tail -n 5 "$folder/slurmctld.log" "$folder/slurmd.log" >&2
  return 1
}

# stop_slurm FOLDER
stop_slurm() {
  local pid
  for pid in "$1"/slurmd.pid "$1"/slurmctld.pid "$1"/munge/pid; do
    [ -s "$pid" ] && kill "$(cat "$pid")" 2>/dev/null || true
  done
  sleep 1
}
