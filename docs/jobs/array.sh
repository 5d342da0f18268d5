#!/bin/sh
# A parameter study as an array of Slurm jobs, without MPI: every job computes a part of the variants, a last one joins the parts.
#
#     sh array.sh 16 my.deck [OPTION...]    submits 16 jobs, and one that waits for them; options are those of flexmech
#
# A job that has no time left goes back into the queue and goes on from its own results. Adapt the time, the processors and the
# memory of one job here, and how the tables are written at "join" below.
#SBATCH --job-name=flexmech
#SBATCH --time=04:00:00
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --requeue
#SBATCH --open-mode=append

program=${FLEXMECH:-flexmech}
spare=300         # seconds before the end of a job in which flexmech ends what it is at, a few variants
limit=3h50m       # where Slurm does not tell when a job ends (before 22.05): --time less a little
most_restarts=20  # of a job: one that computes nothing before its time is over would go on for ever

parts=$1
shift

if [ "$parts" = join ]; then
  # Exit status 1: all is written, and some rows could not be computed.
  exec "$program" --join --format plain "$@"
fi

if [ -z "$SLURM_ARRAY_TASK_ID" ]; then
  array=$(sbatch --parsable --array="1-$parts" "$0" "$parts" "$@") || exit
  # A semicolon and the name of the cluster may follow the number of the job.
  exec sbatch --dependency="afterok:${array%%;*}" "$0" join "$@"
fi

if [ -n "$SLURM_JOB_END_TIME" ]; then
  limit=$((SLURM_JOB_END_TIME - $(date +%s) - spare))s
fi
srun --cpus-per-task="$SLURM_CPUS_PER_TASK" "$program" --part "$SLURM_ARRAY_TASK_ID/$parts" --resume --time-limit "$limit" \
  --threads "$SLURM_CPUS_PER_TASK" "$@"
status=$?

case $status in
  1)
    # Some rows could not be computed: the part is complete all the same.
    exit 0 ;;
  130)
    if [ "${SLURM_RESTART_COUNT:-0}" -lt "$most_restarts" ]; then
      scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    else
      echo "part $SLURM_ARRAY_TASK_ID of $parts is not complete after $most_restarts restarts" >&2
    fi ;;
esac
exit $status
