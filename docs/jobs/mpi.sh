#!/bin/sh
# A parameter study as one Slurm job of many MPI ranks; flexmech has to be built by `make MPI=yes`.
#
#     sbatch mpi.sh my.deck [OPTION...]    options are those of flexmech
#
# A job that has no time left submits itself again and goes on from its own results, and so does one that is sent SIGTERM before
# its end. Adapt the number of ranks, the threads of a rank and the time here.
#SBATCH --job-name=flexmech
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
#SBATCH --signal=TERM@120
#SBATCH --open-mode=append

program=${FLEXMECH:-flexmech}
spare=300         # seconds before the end of the job in which ranks end what they are at, a variant or a few
limit=3h50m       # where Slurm does not tell when the job ends (before 22.05): --time less a little
most_runs=20      # a study of which nothing is computed before the time is over would go on for ever

if [ -n "$SLURM_JOB_END_TIME" ]; then
  limit=$((SLURM_JOB_END_TIME - $(date +%s) - spare))s
fi
# Where srun does not start MPI programs: mpirun "$program" …
srun --cpus-per-task="$SLURM_CPUS_PER_TASK" "$program" --resume --time-limit "$limit" --threads "$SLURM_CPUS_PER_TASK" "$@"
status=$?

if [ $status -eq 130 ]; then
  FLEXMECH_RUNS=$((${FLEXMECH_RUNS:-1} + 1))
  export FLEXMECH_RUNS
  if [ "$FLEXMECH_RUNS" -le "$most_runs" ]; then
    sbatch "$0" "$@"
  else
    echo "the study is not complete after $most_runs jobs" >&2
  fi
fi
exit $status
