#!/usr/bin/env bash
# Installs what is missing, builds into build/bench, measures for some minutes, and writes
# bench/results. The machine should have nothing else to do; the load is noted in the results.
#   bash bench/run.sh
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
install_packages "${packages[@]}" libbenchmark-dev libbullet-dev python3-matplotlib python3-numpy

folder=$root/build/bench
results=$root/bench/results
raw=$folder/raw
build "$folder" benchmarks -DCMAKE_BUILD_TYPE=Release -DTESSERAE_BENCH=ON
mkdir -p "$results" "$raw"

load() { cut -d ' ' -f 1 /proc/loadavg; }
load_before=$(load)
"$folder/bench/accuracy" >"$raw/accuracy.csv"
for program in hot_loops contacts_double contacts_float; do
    "$folder/bench/$program" --benchmark_min_time=0.1 --benchmark_repetitions=7 \
        --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true \
        --benchmark_out="$raw/$program.json" --benchmark_out_format=json >/dev/null
done

# The first lines of every result.
commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo unknown)
changed=$(git -C "$root" status --porcelain -- core parallel render CMakeLists.txt bench/'*pp' 2>/dev/null || true)
{
    echo "# machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores"
    echo "# load average of one minute: $load_before before, $(load) after (one program of at most $(nproc) threads is ours)"
    cat "$folder/bench/build.txt"
    echo "# commit: $commit${changed:+ with uncommitted changes}"
    echo "# command: bash bench/run.sh"
} >"$raw/head.txt"
/usr/bin/python3 "$root/bench/report.py" "$raw/head.txt" "$raw/accuracy.csv" "$raw/hot_loops.json" \
    "$raw"/contacts_{double,float}.json "$results"
# Last, since it fails when the engines differ by more than their errors.
{ cat "$raw/head.txt"; "$folder/bench/box_against_bullet"; } >"$results/box_against_bullet.csv"
echo "wrote $results" >&2
