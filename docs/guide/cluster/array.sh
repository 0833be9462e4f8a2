#!/bin/bash
# A Slurm array of replications: one task, one seed. Submit it with the experiment and what else `farsa run` is to know:
#
#   sbatch --array=1-20 array.sh discrimination --set evolution.mutation_rate=0.02
#
#SBATCH --job-name=farsa
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
# SIGTERM 60 s before the time is up, so that the last checkpoint is not an old one. It goes to this script (B:).
#SBATCH --signal=B:TERM@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=slurm-%A_%a.out

# All tasks are given one number of replications: the largest task that was asked for, or more.
replications=${FARSA_REPLICATIONS:-$SLURM_ARRAY_TASK_MAX}

# In the background: bash handles a signal at once only while it waits.
"${FARSA:-farsa}" run "$@" --replications "$replications" --replication "$SLURM_ARRAY_TASK_ID" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --out "${FARSA_RUNS:-runs}" &
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

# 75: stopped after a checkpoint, start me again. Anything else is the task's end: 0 when all is done, 2 for a wrong
# configuration, which no second start would mend.
if [ "$code" -eq 75 ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
    # Slurm ends what is requeued; an exit now would be taken for the task's end.
    sleep 60
fi
exit "$code"
