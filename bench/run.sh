#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds into build/bench, measures, and writes bench/results. The machine
# should have nothing else to do; the load is noted in the results.
#   bash bench/run.sh              all parts
#   bash bench/run.sh accuracy     error against run time
#   bash bench/run.sh speed        the inner loops
#   bash bench/run.sh convex       pairs and towers of polychora, beside Bullet's and libccd's, a minute
#   bash bench/run.sh leave-out    what leaving out parts saves, two minutes
#   bash bench/run.sh rays         view, shadow and bounce rays
#   bash bench/run.sh extremes     stiff and extreme scenes
#   bash bench/run.sh joints       ropes and nets beside Bullet's, two minutes
#   bash bench/run.sh light        error of the traced light against samples, a minute
#   bash bench/run.sh picture      error of pictures against time, 4 minutes
#   bash bench/run.sh cycles       a still beside Blender's Cycles (installs it), 5 minutes; not one of all parts
#   bash bench/run.sh large        memory of a frame of 15360x8640, 2 minutes; not one of all parts
#   bash bench/run.sh gate         the gate of the dynamics: what got better or worse since the committed
#                                  table; fails if anything got worse, ten minutes; not one of all parts
#   bash bench/run.sh ablation     the gate without each mechanism of the contact solver, an hour and a half;
#                                  of the commit that had them all; not one of all parts
#   bash bench/run.sh bullet       a box in w = 0 beside Bullet's; fails if they differ
#   bash bench/run.sh peers        piles and walls beside Bullet's and ODE's, five minutes
#   bash bench/run.sh rest         how still stacks, walls and pyramids stand, the same, five minutes
#   bash bench/run.sh wall         a wall that settles, rests, is hit, beside Bullet's, ten minutes
#   bash bench/run.sh heaps        heaps that settle and rest, a pyramid that rests, beside Bullet's, 15 minutes
#   bash bench/run.sh scaling      the stages of a step against bodies and threads, twelve minutes
#   bash bench/run.sh scaling-million   the same for 10^6 bodies, few steps; not one of all parts
#   bash bench/run.sh scaling-16-cores  the same for 10^5 bodies, for a machine of many cores; not one of all parts
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
all=(accuracy speed convex leave-out rays extremes light picture bullet peers joints rest wall heaps scaling)
on_demand=(gate ablation cycles large scaling-million scaling-16-cores)
parts=("${all[@]}")
if [ $# != 0 ]; then
    case " ${all[*]} ${on_demand[*]} " in *" $1 "*) parts=("$1") ;; *)
        echo "usage: bash bench/run.sh [$(IFS='|'; echo "${all[*]}|${on_demand[*]}")]" >&2
        exit 2
        ;;
    esac
fi
install_packages "${packages[@]}" libbenchmark-dev libbullet-dev libccd-dev libode-dev python3-matplotlib python3-numpy python3-pil

folder=$root/build/bench
results=$root/bench/results
raw=$folder/raw
target=benchmarks
case "${parts[*]}" in gate | ablation) target=gate ;; esac
build "$folder" "$target" -DCMAKE_BUILD_TYPE=Release -DTESSERAE_BENCH=ON
mkdir -p "$results" "$raw"

load() { cut -d ' ' -f 1 /proc/loadavg; }

# head_of PART LOAD_BEFORE: the first lines of every result, into raw/head.txt.
head_of() {
    local commit changed
    commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo unknown)
    changed=$(git -C "$root" status --porcelain -- core parallel render scenes CMakeLists.txt bench/'*pp' bench/experiments 2>/dev/null || true)
    {
        echo "# machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
        echo "# load average of one minute: $2 before, $(load) after (one program of at most $(nproc) threads is ours)"
        cat "$folder/bench/build.txt"
        echo "# commit: $commit${changed:+ with uncommitted changes}"
        echo "# command: bash bench/run.sh $1"
    } >"$raw/head.txt"
}

accuracy() {
    "$folder/bench/accuracy" >"$raw/accuracy.csv"
    head_of accuracy "$1"
    /usr/bin/python3 -B "$root/bench/report_accuracy.py" "$raw/head.txt" "$raw/accuracy.csv" "$results/accuracy"
}

speed() {
    local program
    for program in hot_loops contacts_double contacts_float; do
        "$folder/bench/$program" --benchmark_min_time=0.1 --benchmark_repetitions=7 \
            --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true \
            --benchmark_out="$raw/$program.json" --benchmark_out_format=json >/dev/null
    done
    head_of speed "$1"
    /usr/bin/python3 -B "$root/bench/report.py" "$raw/head.txt" "$raw/hot_loops.json" \
        "$raw"/contacts_{double,float}.json "$results"
}

convex() {
    "$folder/bench/convex" >"$raw/convex.csv"
    head_of convex "$1"
    cat "$raw/head.txt" "$raw/convex.csv" >"$results/convex.csv"
}

leave-out() {
    "$folder/bench/leave_out" >"$raw/leave_out.csv"
    head_of leave-out "$1"
    cat "$raw/head.txt" "$raw/leave_out.csv" >"$results/leave_out.csv"
}

rays() {
    "$folder/bench/rays" >"$raw/rays.csv"
    head_of rays "$1"
    cat "$raw/head.txt" "$raw/rays.csv" >"$results/rays.csv"
}

extremes() {
    "$folder/bench/extremes" long >"$raw/extremes.csv"
    head_of extremes "$1"
    cat "$raw/head.txt" "$raw/extremes.csv" >"$results/extremes.csv"
    "$folder/bench/extremes" joints >"$raw/extreme_joints.csv"
    head_of extremes "$1"
    cat "$raw/head.txt" "$raw/extreme_joints.csv" >"$results/extreme_joints.csv"
}

light() {
    "$folder/bench/light_error" >"$raw/light_error.csv"
    head_of light "$1"
    cat "$raw/head.txt" "$raw/light_error.csv" >"$results/light_error.csv"
}

picture() {
    { "$folder/bench/picture_error" && "$folder/bench/traced_rays"; } |
        awk 'NR == 1 || !/^experiment,/' >"$raw/picture_error.csv"
    head_of picture "$1"
    /usr/bin/python3 -B "$root/bench/report_picture.py" "$raw/head.txt" "$raw/picture_error.csv" "$results"
}

cycles() {
    install_packages blender
    build "$folder" tesserae
    rm -rf "$raw/cycles"
    mkdir -p "$raw/cycles"
    blender -b --factory-startup -noaudio --python-exit-code 1 --python "$root/bench/cycles/compare.py" \
        -- "$folder/tesserae" "$raw/cycles" >"$raw/cycles.log"
    head_of cycles "$1"
    echo "# $(blender --version | head -1), Debian's package" >>"$raw/head.txt"
    /usr/bin/python3 -B "$root/bench/cycles/report.py" "$raw/head.txt" "$raw/cycles" "$results"
}

# The largest memory and the time of a tiny frame, and of large ones whose files are not kept.
large() {
    local scene=$root/scenes/gallery/first.toml size tile time_file=$raw/time.txt
    install_packages time
    build "$folder" tesserae
    "$folder/tesserae" simulate "$scene" -o "$raw/first.h5" --quiet
    echo "size,tile,resident_mb,wall_s,processor_s,file_mb" >"$raw/large.csv"
    for size in 64x36 15360x8640; do
        for tile in 32 512; do
            rm -rf "$raw/large"
            /usr/bin/time -f "%M %e %U %S" -o "$time_file" "$folder/tesserae" render "$scene" --quiet \
                --trajectory "$raw/first.h5" --frames 30 --samples 1 --size "$size" \
                --set "render.tile=$tile" -o "$raw/large"
            awk -v size="$size" -v tile="$tile" -v bytes="$(stat -c %s "$raw/large/frames/"*.exr)" \
                '{printf "%s,%d,%.1f,%.1f,%.1f,%.1f\n", size, tile, $1 / 1000, $2, $3 + $4, bytes / 1e6}' \
                "$time_file" >>"$raw/large.csv"
        done
    done
    rm -rf "$raw/large" "$raw/first.h5"
    head_of large "$1"
    cat "$raw/head.txt" "$raw/large.csv" >"$results/large_frame.csv"
}

# What the last commit measured, and now.
gate() {
    local status=0
    "$folder/bench/gate" >"$raw/gate.csv"
    head_of gate "$1"
    git -C "$root" show HEAD:bench/results/gate.csv >"$raw/gate_before.csv" 2>/dev/null ||
        cp "$raw/gate.csv" "$raw/gate_before.csv"
    /usr/bin/python3 -B "$root/bench/gate/report.py" "$raw/gate_before.csv" "$raw/gate.csv" || status=$?
    cat "$raw/head.txt" "$raw/gate.csv" >"$results/gate.csv"
    return $status
}

# The tree of the commit that switches.patch is of, with this room as it was when that came.
ablation() {
    local base=a4dd8c2 work=$root/build/ablation room
    room=$(git -C "$root" log --format=%H --diff-filter=A -- bench/ablation/switches.patch | tail -1)
    if [ ! -d "$work/tree" ]; then
        mkdir -p "$work/tree"
        git -C "$root" archive "$base" | tar x -C "$work/tree"
        git -C "$root" archive "${room:-HEAD}" bench | tar x -C "$work/tree"
        patch -d "$work/tree" -p1 -s <"$root/bench/ablation/switches.patch"
        cmake -S "$work/tree" -B "$work/tree/build/bench" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTESSERAE_BENCH=ON >"$work/configure.log"
    fi
    cmake --build "$work/tree/build/bench" --target gate >&2
    head_of ablation "$1"
    /usr/bin/python3 -B "$root/bench/ablation/ablate.py" "$work/tree/build/bench/bench/gate" "$work/raw" "$raw/head.txt" \
        "$results/ablation.csv"
}

bullet() {
    local status=0
    "$folder/bench/box_against_bullet" >"$raw/box_against_bullet.csv" || status=$?
    head_of bullet "$1"
    cat "$raw/head.txt" "$raw/box_against_bullet.csv" >"$results/box_against_bullet.csv"
    return $status
}

peers() {
    local scene
    for scene in sphere_pile box_wall; do
        "$folder/bench/peers_double" $scene 1000 all
        "$folder/bench/peers_float" $scene 1000
        "$folder/bench/peers_double" $scene 10000
    done | awk 'NR == 1 || !/^scene,/' >"$raw/peers.csv"
    head_of peers "$1"
    cat "$raw/head.txt" "$raw/peers.csv" >"$results/peers.csv"
}

joints() {
    "$folder/bench/joints" >"$raw/joints.csv"
    head_of joints "$1"
    cat "$raw/head.txt" "$raw/joints.csv" >"$results/joints.csv"
}

rest() {
    "$folder/bench/rest" >"$raw/rest.csv"
    head_of rest "$1"
    /usr/bin/python3 -B "$root/bench/report_rest.py" "$raw/head.txt" "$raw/rest.csv" "$results"
}

# over_time PART LOAD_BEFORE "SCENE COUNT REPEATS"...
over_time() {
    local part=$1 load_before=$2 run
    shift 2
    for run in "$@"; do
        # shellcheck disable=SC2086
        "$folder/bench/over_time" $run
    done | awk 'NR == 1 || !/^scene,/' >"$raw/$part.csv"
    head_of "$part" "$load_before"
    cat "$raw/head.txt" "$raw/$part.csv" >"$results/$part.csv"
}

wall() { over_time wall "$1" "box_wall 1000 3" "box_wall 10000 1"; }

heaps() { over_time heaps "$1" "tumbled_boxes 1000 3" "tumbled_boxes 10000 1" "box_pyramid 5050 1"; }

# scale PART LOAD_BEFORE SCENE,BODIES,SETTLE,STEPS...: 1, 2, 4, ... threads in turn, five times each.
scale() {
    local part=$1 load_before=$2 scene count settle steps
    shift 2
    for configuration in "$@"; do
        IFS=, read -r scene count settle steps <<<"$configuration"
        "$folder/bench/scaling" "$scene" "$count" "$(nproc)" "$settle" "$steps" 5
    done | awk 'NR == 1 || !/^scene,/' >"$raw/$part.csv"
    head_of "$part" "$load_before"
    /usr/bin/python3 -B "$root/bench/report_scaling.py" "$raw/head.txt" "$raw/$part.csv" "$results/$part"
}

scaling() {
    # Piles need time to come down; stacks and pyramids stand from the start.
    local -A settle=([gas]=120 [pile]=720 [boxes]=480 [stacks]=60 [pyramid]=60)
    local -A few=([gas]=60 [pile]=5 [boxes]=5 [stacks]=5 [pyramid]=5)
    local scene configurations=()
    for scene in gas pile boxes stacks pyramid; do
        configurations+=("$scene,100,${settle[$scene]},400" "$scene,1000,${settle[$scene]},100"
            "$scene,10000,${settle[$scene]},30" "$scene,50000,${settle[$scene]},${few[$scene]}"
            "$scene,100000,${settle[$scene]},${few[$scene]}")
    done
    scale scaling "$1" "${configurations[@]}"
}

scaling-million() { scale scaling-million "$1" gas,1000000,5,3 pile,1000000,45,3; }

scaling-16-cores() {
    scale scaling-16-cores "$1" boxes,100000,240,5 pyramid,100000,60,5 gas,100000,120,40 \
        stacks,100000,60,5 pile,100000,480,5
}

for part in "${parts[@]}"; do "$part" "$(load)"; done
echo "wrote $results" >&2
