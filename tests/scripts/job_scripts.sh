#!/bin/sh
# The job scripts of docs/jobs/ with stand-ins for the commands of Slurm: queues, arrays, jobs that wait for others, are requeued and
# submit themselves again. The stand-ins refuse options that the scripts of today do not have.
. tests/scripts/functions.sh

tools=$scratch/tools
spool=$scratch/spool
mkdir "$tools" "$spool"
cp docs/jobs/*.sh "$scratch"

# sbatch: puts a job into the queue, as a file of assignments and a copy of the script.
cat >"$tools/sbatch" <<'END_OF_TOOL'
#!/bin/sh
parsable=no array="" after=""
while :; do
  case $1 in
    --parsable) parsable=yes ;;
    --array=*) array=${1#--array=} ;;
    --dependency=afterok:*) after=${1#--dependency=afterok:} ;;
    -*) echo "sbatch: unknown option $1" >&2; exit 1 ;;
    *) break ;;
  esac
  shift
done
[ -f "$1" ] || { echo "sbatch: no script '$1'" >&2; exit 1; }
job=$(($(cat "$SPOOL/last" 2>/dev/null || echo 100) + 1))
echo $job >"$SPOOL/last"
mkdir "$SPOOL/$job"
cp "$1" "$SPOOL/$job/slurm_script"
shift
: >"$SPOOL/$job/arguments"
for word in "$@"; do
  printf '%s\n' "$word" >>"$SPOOL/$job/arguments"
done
echo "$array" >"$SPOOL/$job/array"
echo "$after" >"$SPOOL/$job/after"
echo "${FLEXMECH_RUNS:-}" >"$SPOOL/$job/runs"
echo $job >>"$SPOOL/queue"
if [ $parsable = yes ]; then echo "$job;here"; else echo "Submitted batch job $job"; fi
END_OF_TOOL

# scontrol requeue JOB_TASK: the job is to be run once more.
cat >"$tools/scontrol" <<'END_OF_TOOL'
#!/bin/sh
[ "$1" = requeue ] && [ "$2" = "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" ] || { echo "scontrol: $*" >&2; exit 1; }
echo "$2" >>"$SPOOL/requeued"
END_OF_TOOL

# srun: a step of a job.
cat >"$tools/srun" <<'END_OF_TOOL'
#!/bin/sh
[ "$1" = --cpus-per-task=1 ] || { echo "srun: unknown option $1" >&2; exit 1; }
shift
echo "$*" >>"$SPOOL/steps"
exec "$@"
END_OF_TOOL
chmod +x "$tools"/*

# go JOB [TASK COUNT RESTARTS]: runs a job, or one of an array, with so much time that flexmech has a second or two, and one more for every
# restart; its output is kept.
go() {
  (
    job=$1
    SLURM_JOB_ID=$job
    SLURM_CPUS_PER_TASK=1
    export SLURM_JOB_ID SLURM_CPUS_PER_TASK
    runs=$(cat "$spool/$job/runs")
    more=0
    if [ -n "$runs" ]; then
      FLEXMECH_RUNS=$runs
      export FLEXMECH_RUNS
      more=$runs
    fi
    if [ $# -gt 1 ]; then
      SLURM_ARRAY_JOB_ID=$job
      SLURM_ARRAY_TASK_ID=$2
      SLURM_ARRAY_TASK_COUNT=$3
      more=$4
      [ "$4" -eq 0 ] || SLURM_RESTART_COUNT=$4
      export SLURM_ARRAY_JOB_ID SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_COUNT SLURM_RESTART_COUNT
    fi
    if [ "$tells" = yes ]; then
      SLURM_JOB_END_TIME=$(($(date +%s) + 302 + more))
      export SLURM_JOB_END_TIME
    fi
    cd "$place" || exit 9
    set --
    while read -r word; do
      set -- "$@" "$word"
    done <"$spool/$job/arguments"
    "${shell:-sh}" "$spool/$job/slurm_script" "$@" >>"$spool/$job/output" 2>&1 </dev/null
  )
}

# Runs the queue until it is empty. A job that waits for an array is run if all of that ended well.
serve() {
  while [ -s "$spool/queue" ]; do
    job=$(head -n 1 "$spool/queue")
    sed -i 1d "$spool/queue"
    after=$(cat "$spool/$job/after")
    if [ -n "$after" ] && [ "$(cat "$spool/$after/outcome")" != 0 ]; then
      echo "job $job waits for ever"
      return 1
    fi
    array=$(cat "$spool/$job/array")
    worst=0
    if [ -n "$array" ]; then
      for task in $(seq "${array#1-}"); do
        restarts=0
        while :; do
          : >"$spool/requeued"
          go "$job" "$task" "${array#1-}" $restarts
          status=$?
          [ -s "$spool/requeued" ] || break
          restarts=$((restarts + 1))
          echo "$task" >>"$spool/restarted"
        done
        [ $status -eq 0 ] || worst=$status
      done
    else
      go "$job"
      worst=$?
    fi
    echo $worst >"$spool/$job/outcome"
    echo "$worst" >>"$spool/outcomes"
  done
}

# submit COMMAND...: from a shell that is no job, in an empty queue.
submit() {
  rm -rf "$spool"
  mkdir "$spool"
  (
    cd "$place" || exit 9
    "$@"
  )
}

PATH=$tools:$PATH
SPOOL=$spool
FLEXMECH=$program
export PATH SPOOL FLEXMECH
unset SLURM_JOB_ID SLURM_ARRAY_TASK_ID SLURM_JOB_END_TIME FLEXMECH_RUNS

study() {
  beam_deck "VARY b $1" "CRANK 0 to 330 step 30" "SPEED 0 20" "REPORT frequencies" "REPORT kinematics" | sed 's/length=279.4/length=$b/'
}
place=$scratch/study
mkdir "$place"
# So many variants that they take about ten seconds of a processor, by a run of a hundred.
study "100 to 300 step 2" >"$scratch/probe.deck"
spend
begun=$spent
run 1 --out "$scratch/probe" --threads 1 "$scratch/probe.deck"
spend
step=$(awk -v took=$((spent - begun)) 'BEGIN { printf "%.4f\n", 2*(took < 20 ? 20 : took)/10000 }')
study "100 to 300 step $step" >"$place/my.deck"
run 1 --out "$scratch/whole" --threads 2 "$place/my.deck"

syntax() {
  for file in docs/jobs/*.sh; do
    sh -n "$file" || return 1
    ! command -v bash >/dev/null || bash -n "$file" || return 1
    ! command -v shellcheck >/dev/null || shellcheck "$file" || return 1
    # Slurm does not read directives behind the first command.
    awk '!/^#/ && NF { begun = 1 } begun && /^#SBATCH/ { exit 1 }' "$file" || { echo "$file: a directive behind a command"; return 1; }
    grep -q '^#SBATCH --time=' "$file" || { echo "$file: no time"; return 1; }
  done
}
check "what shells say of the scripts" syntax

joined() {
  [ "$(tail -n 1 "$spool/outcomes")" = "$1" ] || { cat "$spool"/*/output; return 1; }
  diff -rq -x '*.part*' "$place/outputs/my" "$scratch/whole/my"
}

array_with_limits() {
  tells=yes
  rm -rf "$place/outputs"
  submit sh "$scratch/array.sh" 2 my.deck && serve || return 1
  # The first part has failed rows, and so has the study.
  joined 1 || return 1
  [ -s "$spool/restarted" ] || { echo "no limit of time has come"; return 1; }
  grep -q 'stopped at its time limit of [0-9]*s' "$spool"/*/output || { echo "no job tells why it stopped"; return 1; }
  grep -q -e '--part 2/2 --resume --time-limit [0-9]*s --threads 1 my.deck' "$spool/steps" || { cat "$spool/steps"; return 1; }
}
check "an array whose jobs have too little time" array_with_limits

# An older Slurm does not tell when a job ends.
array_of_older() {
  tells=no
  rm -rf "$place/outputs"
  submit sh "$scratch/array.sh" 2 my.deck --set t=5 >"$scratch/told" && serve >"$scratch/told" && { echo "an unknown name was taken"; return 1; }
  submit sh "$scratch/array.sh" 4 my.deck --quiet && serve && joined 1 || return 1
  [ ! -e "$spool/restarted" ] && grep -q -e '--time-limit 3h50m' "$spool/steps"
}
check "an array where the end is not known" array_of_older

# A part that is refused ends the array, and nothing is joined.
array_refused() {
  tells=no
  rm -rf "$place/outputs"
  submit sh "$scratch/array.sh" 5000 my.deck --bad >"$scratch/told" && head -n 1 "$spool/queue" >"$spool/first" && echo 1-1 >"$spool/101/array"
  serve >"$scratch/told" && { echo "the array went on"; return 1; }
  grep -q 'waits for ever' "$scratch/told" && absent "$place/outputs"
}
check "an array that is refused" array_refused

mpi_with_limits() {
  tells=yes
  rm -rf "$place/outputs"
  submit sbatch "$scratch/mpi.sh" my.deck && serve || return 1
  joined 1 || return 1
  [ "$(head -n 1 "$spool/outcomes")" = 130 ] || { echo "the first job has had time for all"; return 1; }
  [ "$(wc -l <"$spool/steps")" -eq "$(wc -l <"$spool/outcomes")" ]
}
check "a job with ranks that submits itself again" mpi_with_limits

# A study of which nothing is ever ready is not submitted for ever.
never() {
  cat >"$tools/never" <<'END_OF_TOOL'
#!/bin/sh
exit 130
END_OF_TOOL
  chmod +x "$tools/never"
  (
    FLEXMECH=$tools/never
    export FLEXMECH
    submit sbatch "$scratch/mpi.sh" my.deck && serve || exit 1
    [ "$(wc -l <"$spool/outcomes")" -eq 20 ] || { echo "$(wc -l <"$spool/outcomes") jobs"; exit 1; }
    submit sh "$scratch/array.sh" 1 my.deck
    serve
    [ "$(wc -l <"$spool/restarted")" -eq 20 ] || { echo "$(wc -l <"$spool/restarted") restarts"; exit 1; }
  ) >"$scratch/told" || { cat "$scratch/told"; return 1; }
  grep -q 'waits for ever' "$scratch/told"
}
check "a study that makes no progress ends" never
