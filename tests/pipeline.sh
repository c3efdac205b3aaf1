#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Takes every scene of the gallery, small, through the whole program built with sanitizers: run,
# continue, change of look, parts, join, film, view, plot, export, hash, diff, plan, info, submit.
#   bash tests/pipeline.sh             address+undefined, then thread
#   bash tests/pipeline.sh address     only this
#   bash tests/pipeline.sh thread      only this
#   bash tests/pipeline.sh PROGRAM     a program that is built already
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
. "$root/tests/tsan_tbb.sh"

# through PROGRAM SCENE: every command on one scene; a sanitizer's finding ends the process by 99.
through() {
    local program=$1 scene=$2 out name
    name=$(basename "$scene" .toml)
    out=$work/$name
    # Small enough that a minute of a sanitized program does it.
    local small=(--size 48x27 --samples 2 --threads 2 --quiet)
    local set=()
    ! grep -q '^\[physics\]' "$scene" || set=(--set physics.duration=0.2)
    local longer=(${set[@]+--set physics.duration=0.3})
    step() { "$program" "$@" >>"$work/$name.log" 2>&1 || { echo "$name: $1 ended with $?"; return 1; }; }
    step info "$scene" && step hash "$scene" && step plan "$scene" --threads 2 "${set[@]}" &&
        step run "$scene" -o "$out" "${small[@]}" "${set[@]}" &&
        step run "$scene" -o "$out" "${small[@]}" "${longer[@]}" &&
        step run "$scene" -o "$out" "${small[@]}" "${longer[@]}" --set camera.field_of_view=40 &&
        step run "$scene" -o "$out" "${small[@]}" "${longer[@]}" --draft &&
        step status "$out" && step hash "$out" && step info "$out/frames/$name.0000.exr" || return 1
    for k in 1 2 3; do
        step render "$scene" -o "$out/parts" --tiles $k/3 --frames 0 "${small[@]}" "${set[@]}" || return 1
    done
    step join "$out/parts" && step diff "$out/parts" "$out/parts" &&
        step submit "$scene" -o "$out/farm" --for commands "${set[@]}" &&
        step view "$scene" -o "$out/page.html" --threads 2 --quiet "${set[@]}" || return 1
    [ -e "$out/trajectory.h5" ] || return 0
    step plot "$out/trajectory.h5" -o "$out/plot.svg" && step hash "$out/trajectory.h5" &&
        step info "$out/trajectory.h5" &&
        step export "$out/trajectory.h5" --format ply --frames 0 -o "$out/ply" --threads 2 --quiet
}

# all_through NAME PROGRAM: every scene; prints how long it took and how it ended.
failed=()
all_through() {
    local begin=$SECONDS scene count=0
    work=$(mktemp -d)
    for scene in "$root"/scenes/gallery/*.toml; do
        through "$2" "$scene" || failed+=("$1 $(basename "$scene"): see $work")
        count=$((count + 1))
    done
    echo "$1: $count scenes through the program in $((SECONDS - begin)) s"
    [ ${#failed[@]} != 0 ] || rm -rf "$work"
}

# Optimised more the program takes twice as long to compile, and the scenes are small.
options=(-DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1")
export ASAN_OPTIONS=exitcode=99 UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS="exitcode=99 suppressions=$root/tests/tsan.supp"
case "${1:-all}" in
address | thread | all)
    install_packages "${packages[@]}" dpkg-dev
    if [ "${1:-all}" != thread ]; then
        (build "$root/build/asan" tesserae "${options[@]}" -DTESSERAE_SANITIZE=address,undefined)
        all_through address+undefined "$root/build/asan/tesserae"
    fi
    if [ "${1:-all}" != address ]; then
        build_tbb_for_tsan
        (build "$root/build/tsan" tesserae "${options[@]}" -DTESSERAE_SANITIZE=thread)
        LD_LIBRARY_PATH=$root/build/tsan-tbb/build/lib_relwithdebinfo \
            all_through thread "$root/build/tsan/tesserae"
    fi
    ;;
*)
    all_through "$1" "$(realpath "$1")"
    ;;
esac
if [ ${#failed[@]} != 0 ]; then
    printf 'failed: %s\n' "${failed[@]}" >&2
    exit 1
fi
