#!/bin/bash
# Slurm workers at one study: as many as there are places, each with the next run that nobody has. Submit it with a study:
#
#   sbatch --array=1-8 workers.sh sweep mutation.toml
#   sbatch --array=1-8 workers.sh run discrimination --replications 100
#
#SBATCH --job-name=farsa
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-%A_%a.out

"${FARSA:-farsa}" "$@" --threads "${SLURM_CPUS_PER_TASK:-1}" &
run=$!
stopped=no
trap 'stopped=yes; kill -TERM "$run" 2>/dev/null' TERM
wait "$run"
code=$?
while [ "$stopped" = yes ]; do
    # The signal ended the wait, not the run.
    stopped=no
    wait "$run"
    code=$?
done
if [ "$code" -eq 75 ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
    sleep 60
fi
exit "$code"
