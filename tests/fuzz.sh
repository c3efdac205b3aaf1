#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Gives every reader of files and options damaged input, by clang's libFuzzer under the address and
# undefined sanitizers, and prints what came of it. The targets are in tests/fuzz.
#   bash tests/fuzz.sh [SECONDS] [TARGET...]   for so long each (default: 60, all targets)
# What was learnt is kept in build/fuzz/learnt, and the next run starts from it. Ends with status 1
# if a target crashed, took more than ten seconds or 2 GB: its input is then in build/fuzz/crashes,
# and `build/fuzz/tests/fuzz/fuzz_TARGET FILE` shows what it does.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"

seconds=60
if [[ "${1:-}" =~ ^[1-9][0-9]*$ ]]; then
    seconds=$1
    shift
elif [[ "${1:-}" == -* ]]; then
    echo "usage: bash tests/fuzz.sh [SECONDS] [TARGET...]" >&2
    exit 2
fi

install_packages "${packages[@]}" clang libclang-rt-dev
folder=$root/build/fuzz
build "$folder" fuzz -DTESSERAE_FUZZ=ON -DTESSERAE_SANITIZE=address,undefined \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1"
mapfile -t targets <"$folder/fuzz_targets"
[ $# = 0 ] || targets=("$@")

# What targets start from: what is committed, what the program writes, scenes, known words.
seeds=$folder/seeds
rm -rf "$seeds"
mkdir -p "$seeds/scene"
"$folder/tests/fuzz/fuzz_seeds" "$seeds"
cp "$root"/scenes/gallery/*.toml "$seeds/scene"
grep -hoE '"[A-Za-z0-9_.-]+"' "$root"/scenes/load/*.hpp "$root"/scenes/load/*.cpp \
    "$root"/scenes/program/command_line.cpp "$root"/render/file/*.cpp | sort -u >"$folder/words"

export ASAN_OPTIONS=quarantine_size_mb=16:allocator_may_return_null=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export UBSAN_OPTIONS=print_stacktrace=1
# number NAME: of libFuzzer's last statistics.
number() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }

crashed=0
printf '%-18s %12s %8s %8s %8s %8s\n' target executions seconds corpus edges crashes
for target in "${targets[@]}"; do
    program=$folder/tests/fuzz/fuzz_$target learnt=$folder/learnt/$target
    crashes=$folder/crashes/$target log=$folder/$target.log
    [ -x "$program" ] || { echo "no target is called $target" >&2; exit 2; }
    mkdir -p "$learnt" "$crashes" "$seeds/$target" "$root/tests/fuzz/corpus/$target"
    begin=$SECONDS status=0
    # HDF5 leaks what it has read of a damaged file, which is also seen when the program ends.
    leaks=1
    [[ $target != traj* && $target != resume ]] || leaks=0
    ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=$leaks "$program" "$learnt" "$root/tests/fuzz/corpus/$target" "$seeds/$target" \
        -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=2048 \
        -malloc_limit_mb=1536 -detect_leaks=$leaks \
        -dict="$folder/words" -artifact_prefix="$crashes/" -print_final_stats=1 \
        -close_fd_mask=1 >/dev/null 2>"$log" || status=$?
    edges=$(grep -oE ' cov: [0-9]+' "$log" | tail -n 1 | grep -oE '[0-9]+' || echo 0)
    printf '%-18s %12s %8s %8s %8s %8s\n' "$target" "$(number number_of_executed_units)" \
        $((SECONDS - begin)) "$(find "$learnt" -type f | wc -l)" "$edges" "$((status != 0))"
    if [ "$status" != 0 ]; then
        crashed=1
        grep -E -A 12 'ERROR|runtime error|broken promise|what\(\)|Test unit written' "$log" >&2 || tail -n 20 "$log" >&2
    fi
done
exit $crashed
