#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes films with a real Slurm, which it installs (Debian's), starts on the loopback address and
# stops again: one node of this machine, the usual plug-ins of a cluster but for cgroups. As root.
#   bash tests/slurm.sh            all of it, under five minutes once the program is built
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
began=$SECONDS

fail() {
    echo "tests/slurm.sh: $*" >&2
    exit 1
}
say() { echo "$((SECONDS - began)) s: $*"; }

# ---- Slurm ---------------------------------------------------------------------------------------
[ "$(id -u)" = 0 ] || fail "Slurm's daemons start jobs of a user only as root: run this as root"
(install_packages "${packages[@]}" slurm-wlm munge) ||
    fail "Slurm (Debian's slurm-wlm and munge) cannot be installed, so that nothing was tested"
for daemon in munged slurmctld slurmd; do
    command -v "$daemon" >/dev/null || fail "$daemon is not installed (packages slurm-wlm and munge)"
done
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release
program=$root/build/release/tesserae

place=$(mktemp -d /tmp/tesserae-slurm.XXXXXX)
daemons=()
stop_all() {
    local daemon
    for daemon in ${daemons[@]+"${daemons[@]}"}; do kill "$daemon" 2>/dev/null || true; done
    wait
    rm -rf "$place"
}
trap stop_all EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

mkdir -m 755 "$place/munge" "$place/state" "$place/spool"
chmod 755 "$place"
head -c 1024 /dev/urandom >"$place/munge/key"
chmod 400 "$place/munge/key"
node=$(hostname -s)
cores=$(nproc)
cat >"$place/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$place/munge/socket
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
SlurmctldLogFile=$place/slurmctld.log
SlurmdLogFile=$place/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=20
KillWait=2
SchedulerParameters=sched_min_interval=200000,batch_sched_delay=0
NodeName=$node NodeAddr=127.0.0.1 CPUs=$cores RealMemory=8000 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$place/slurm.conf

# A daemon in the foreground: this script's child, which it can stop.
munged --foreground --force --socket="$place/munge/socket" --key-file="$place/munge/key" \
    --pid-file="$place/munge/pid" --log-file="$place/munge/log" --seed-file="$place/munge/seed" \
    >/dev/null 2>&1 &
daemons+=($!)
slurmctld -D -c >/dev/null 2>&1 &
daemons+=($!)
start_slurmd() {
    slurmd -D >/dev/null 2>&1 &
    slurmd=$!
    daemons+=("$slurmd")
}
start_slurmd

# wait_until SECONDS WHAT COMMAND...: of which it shows the logs if it does not come true.
wait_until() {
    local end=$((SECONDS + $1)) what=$2
    shift 2
    until "$@" >/dev/null 2>&1; do
        if [ "$SECONDS" -ge "$end" ]; then
            tail -n 20 "$place"/*.log "$place"/*/submit/log/* >&2 || true
            squeue >&2 || true
            fail "$what: not in time"
        fi
        sleep 0.3
    done
}
node_is_up() { sinfo --noheader --format %T | grep -qE 'idle|mixed|allocated|completing'; }
queue_is_empty() { [ -z "$(squeue --noheader)" ]; }
frames_are() { [ "$(find "$film/frames" -name '*.exr' | wc -l)" -ge "$1" ]; }
wait_until 60 "Slurm's start" node_is_up
say "Slurm $(sinfo --version | cut -d ' ' -f 2) is up, $cores cores"

# ---- a film of 40 frames in 8 tasks --------------------------------------------------------------
scene="$place/it's a \"scène\".toml"
cat >"$scene" <<'END'
[scene]
name = "farm"
[physics]
duration = 2
steps_per_second = 60
[render]
size = [320, 180]
frames_per_second = 20
samples = 16
[[light]]
type = "sun"
direction = [0.4, -1, 0.5, 0.2]
strength = 3
[[light]]
type = "sky"
strength = 0.4
[[body]]
shape = "hyperplane"
normal = [0, 1, 0, 0]
[[lattice]]
shape = "hypersphere"
radius = 0.3
count = [4, 4, 4, 2]
spacing = [0.7, 0.7, 0.7, 0.7]
jitter = 0.1
position = [0, 2.5, 0, 0]
END
set_option=(--set render.samples=40)
"$program" run "$scene" -o "$place/local" "${set_option[@]}" --quiet >/dev/null
say "the local run is done"

film="$place/a 'shared' \"földer\""
submit=("$program" submit "$scene" -o "$film" --chunk 5 --cores 1 --max-running 2 "${set_option[@]}")
"${submit[@]}" --now
[ "$(wc -l <"$film/submit/tasks.txt")" = 8 ] || fail "not 8 tasks"
# The job runs what was submitted.
echo 'changed = "while it waits' >>"$scene"

wait_until 60 "the first frames" frames_are 3
"$program" status "$film" && fail "status says complete too early"
rendering=$(sed -n 2p "$film/submit/jobs")
running_task() { squeue --noheader --array --states=RUNNING --jobs "$rendering" --format %i | grep _ | head -n 1; }
wait_until 30 "a running task" running_task
killed=$(running_task)
scancel "$killed"
say "task $killed is killed"

# A complete frame, and one that is being written, go away under the tasks.
rm "$(find "$film/frames" -name '*.exr' | sort | head -n 1)"
partial() { find "$film/frames" -name '*.partial' | grep -m 1 .; }
wait_until 30 "an unfinished frame" partial
find "$film/frames" -name '*.partial' -exec rm -f {} +  # the task may have ended it meanwhile
say "a frame and all unfinished ones are deleted"

kill "$slurmd"
wait "$slurmd" || true
sleep 3
start_slurmd
say "slurmd was stopped and started"

wait_until 150 "the film" queue_is_empty
"$program" status "$film" || { tail -n 5 "$film"/submit/log/* >&2; fail "the film is not complete"; }
diff -r "$place/local/frames" "$film/frames" || fail "frames differ from the local run's"
diff -r "$place/local/preview" "$film/preview" || fail "previews differ from the local run's"
find "$film" -name '*.partial' | grep . && fail "unfinished files are left"
[ ! -e "$film/report.json" ] || fail "a task wrote a shared report"
say "40 frames, the bytes of the local run"

# Submitted again it does nothing.
sed -i '$d' "$scene"
before=$(cd "$film" && find frames preview trajectory.h5 submit -type f -exec stat -c '%n %Y' {} + | grep -v 'submit/[^l]' | sort)
scripts=$(cat "$film"/submit/*.sh "$film/submit/tasks.txt" | cksum)
"${submit[@]}" --now | grep -q "nothing to submit" || fail "a complete film was submitted again"
[ "$scripts" = "$(cat "$film"/submit/*.sh "$film/submit/tasks.txt" | cksum)" ] || fail "the scripts have changed"
after=$(cd "$film" && find frames preview trajectory.h5 submit -type f -exec stat -c '%n %Y' {} + | grep -v 'submit/[^l]' | sort)
[ "$before" = "$after" ] || fail "submitting again touched the film"
queue_is_empty || fail "submitting again queued jobs"
say "submitted again it does nothing"

# ---- what goes wrong -----------------------------------------------------------------------------
# expect STATUS WORDS COMMAND...
expect() {
    local status=$1 words=$2 found=0 said
    shift 2
    said=$("$@" 2>&1) || found=$?
    [ "$found" = "$status" ] || fail "\"$*\" ended with $found, expected $status: $said"
    grep -qF -- "$words" <<<"$said" || fail "\"$*\" said: $said; expected: $words"
}
mkdir "$place/nowhere"
cp "$film/submit/frames.sh" "$place/nowhere/slurm_script"
expect 1 "where all nodes see it" env SLURM_SUBMIT_DIR="$place/not there" SLURM_ARRAY_TASK_ID=0 \
    bash "$place/nowhere/slurm_script"
mv "$film/trajectory.h5" "$place/trajectory.h5"
expect 1 "run submit/simulate.sh first" bash "$film/submit/frames.sh" 0-4
touch "$film/trajectory.h5.partial"
expect 1 "is not complete" bash "$film/submit/frames.sh" 0-4
rm "$film/trajectory.h5.partial"
mv "$place/trajectory.h5" "$film/trajectory.h5"
sed -i 's/motion version/motion version 9/' "$film/submit/film.sh"
expect 1 "submit it again" bash "$film/submit/frames.sh" 0-4
expect 2 "another scene" "$program" submit "$scene" -o "$film" --set render.samples=4
say "what goes wrong is said"

# ---- any other farm ------------------------------------------------------------------------------
film="$place/other 'farm"
"$program" submit "$scene" -o "$film" --chunk 5 "${set_option[@]}" --for commands \
    >"$place/commands" 2>/dev/null
[ "$(wc -l <"$place/commands")" = 8 ] || fail "not 8 commands"
bash "$film/submit/simulate.sh" >/dev/null
xargs -d '\n' -P 2 -n 1 bash -c <"$place/commands" >/dev/null || fail "a command failed"
bash "$film/submit/finish.sh" >/dev/null || fail "finish.sh failed"
diff -r "$place/local/frames" "$film/frames" || fail "frames of commands differ"
say "the same film by commands"

# ---- what a task costs ---------------------------------------------------------------------------
# All of it is there: a task is its start.
start=$(date +%s%N)
for _ in 1 2 3 4 5; do bash "$film/submit/frames.sh" 0-4 >/dev/null; done
say "start-up of a task, on the node: $((($(date +%s%N) - start) / 5000000)) ms"
start=$(date +%s%N)
(cd "$film" && sbatch --cpus-per-task=1 --array=0-7 submit/frames.sh >/dev/null)
wait_until 60 "tasks with nothing to do" queue_is_empty
say "8 tasks with nothing to do, through Slurm: $((($(date +%s%N) - start) / 1000000)) ms"
say "green"
