#!/bin/bash
# A run of any length as a chain of Slurm jobs under one number: before the time limit the run writes a checkpoint and
# stops, the job goes back into the queue, and goes on from the checkpoint when it starts again.
#
#   sbatch --ntasks=16 --cpus-per-task=4 --time=24:00:00 bench/slurm/job.sh CASE.yaml OUT [option of rhegma run]...
#
# RHEGMA names the program (default: rhegma in the PATH), LAUNCH the launcher (default: mpirun). The output directory
# must be one that all nodes see. A run that fails is not put back.
#SBATCH --job-name=rhegma
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR2@300
#SBATCH --output=rhegma-%j.log

set -u
case=$1
out=$2
shift 2
program=${RHEGMA:-rhegma}
launch=${LAUNCH:-mpirun -n ${SLURM_NTASKS:-1}}
export OMP_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}

# Go on if there is something to go on from; the first time, and after a loss before the first checkpoint, begin.
where=(-o "$out")
if ls "$out"/checkpoints/step-*.h5 >/dev/null 2>&1; then
    where=(--restart "$out")
fi
echo "job ${SLURM_JOB_ID:-none}, start ${SLURM_RESTART_COUNT:-0}: ${where[*]}"

$launch "$program" run "$case" "${where[@]}" "$@" &
run=$!
# Slurm sends USR2 to this script 300 s before the limit (or up to a minute earlier); the launcher passes it on.
trap 'kill -USR2 $run' USR2
wait $run
status=$?
while kill -0 $run 2>/dev/null; do # the signal ended the wait, not the run
    wait $run
    status=$?
done

# Exit status 3: stopped when asked to, with a checkpoint to go on from.
if [ $status = 3 ]; then
    echo "job ${SLURM_JOB_ID:-none}: back into the queue"
    scontrol requeue "$SLURM_JOB_ID"
    sleep 60 # Slurm ends the job here
fi
exit $status
