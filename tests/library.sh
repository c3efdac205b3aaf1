#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# library.sh CMAKE BUILD: projects that use the library as installed, and as a part of their own.
# They print what the same source prints in this build, and write the files that the program writes.
#
# BUILD is the folder of a build of everything. The example that takes core alone is configured as if
# the libraries of the other components were not there.
set -euo pipefail
cmake=$1 build=$2
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "library: $*" >&2; exit 1; }

# make NAME SOURCE ARGUMENT...: builds a project; its messages are shown if it fails.
make() {
    local name=$1 source=$2
    shift 2
    { "$cmake" -S "$source" -B "$folder/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" &&
        "$cmake" --build "$folder/$name" -j 2; } >"$folder/$name.log" 2>&1 ||
        { tail -40 "$folder/$name.log" >&2; fail "$name is not built"; }
}
# refuse NAME ARGUMENT...: what find_package says where it finds nothing.
refuse() {
    local name=$1
    shift
    "$cmake" -S "$folder/asks" -B "$folder/$name" -G Ninja -DCMAKE_PREFIX_PATH="$folder/local" "$@" \
        >"$folder/$name.log" 2>&1 && fail "$name is found"
    tr -s ' \n' ' ' <"$folder/$name.log"
}
same() { # FILE FILE WHAT
    cmp -s "$1" "$2" || { head -5 "$1" "$2" >&2; fail "$3: differs"; }
}

"$cmake" --install "$build" --prefix "$folder/local" --component development >/dev/null
"$build/tests/library_ball" >"$folder/expected"
grep -q '^0 touches 1' "$folder/expected" || fail "the ball does not touch the floor"

# core alone: nothing else is looked for.
others=()
for name in TBB OpenEXR embree PNG ZLIB Freetype HDF5 tomlplusplus CLI11 nlohmann_json GTest Threads; do
    others+=("-DCMAKE_DISABLE_FIND_PACKAGE_$name=ON")
done
for compiler in g++ clang++; do
    if ! command -v "$compiler" >/dev/null; then
        echo "library: $compiler is not installed: left out"
        continue
    fi
    make "ball-$compiler" "$here/library/ball" -DCMAKE_CXX_COMPILER="$compiler" \
        -DCMAKE_PREFIX_PATH="$folder/local" "${others[@]}" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
    "$folder/ball-$compiler/ball" >"$folder/found"
    same "$folder/expected" "$folder/found" "the ball by $compiler"
done

# Everything, against the program.
"$build/tesserae" generate pile --bodies 20 >"$folder/pile.toml"
sets=()
for set in physics.duration=0.3 render.size=[40,30] render.samples=2; do
    sets+=(--set "$set")
done
mkdir "$folder/out"
"$build/tesserae" simulate "$folder/pile.toml" "${sets[@]}" -o "$folder/film.h5" --quiet >/dev/null
"$build/tesserae" render "$folder/pile.toml" "${sets[@]}" --trajectory "$folder/film.h5" \
    -o "$folder/film" --quiet >/dev/null
make uses "$here/library/film" -DCMAKE_PREFIX_PATH="$folder/local"
"$folder/uses/film" "$folder/film/scene.toml" "$folder/out" >"$folder/found"
bodies=$("$build/tesserae" info "$folder/film.h5" --json | grep -o '"bodies":[0-9]*' | cut -d: -f2)
[ "$bodies" -ge 20 ] || fail "the program tells of $bodies bodies"
printf '%s\n' "$bodies of $bodies bodies are where the trajectory has them" "5 layers" >"$folder/told"
same "$folder/told" "$folder/found" "what the film tells"
[ "$("$build/tesserae" hash "$folder/film.h5" | cut -d' ' -f1)" = \
    "$("$build/tesserae" hash "$folder/out/film.h5" | cut -d' ' -f1)" ] || fail "bodies move otherwise"
frames=("$folder"/film/frames/*.exr)
[ ${#frames[@]} = 9 ] || fail "${#frames[@]} frames"
same "${frames[-1]}" "$folder/out/last.exr" "the last frame"

# What is missing is told.
mkdir "$folder/asks"
cat >"$folder/asks/CMakeLists.txt" <<'ASKS'
cmake_minimum_required(VERSION 3.25)
project(asks LANGUAGES CXX)
find_package(tesserae ${ASKED_VERSION} REQUIRED COMPONENTS ${ASKED})
ASKS
[[ $(refuse unknown -DASKED=shapes) == *'there is no component "shapes": expected core, parallel, render, scenes'* ]] ||
    fail "an unknown component is not told"
[[ $(refuse newer -DASKED=core -DASKED_VERSION=0.99) == *'"0.99"'* ]] || fail "an old version is not told"
[[ $(refuse needs -DASKED=parallel -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON) == *TBB* ]] ||
    fail "a missing library is not told"
rm "$(find "$folder/local" -name tesserae-scenes.cmake)"
[[ $(refuse absent -DASKED=scenes) == *'component "scenes" is not installed here'* ]] ||
    fail "a component that is not installed is not told"
make rest "$folder/asks" -DCMAKE_PREFIX_PATH="$folder/local"
