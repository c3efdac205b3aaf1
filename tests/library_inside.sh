#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# library_inside.sh CMAKE BUILD: a project that has the sources of tesserae as a part of its own
# builds the library that it asks for and nothing else, and prints what the same source prints in
# this build, although it is not optimised.
set -euo pipefail
cmake=$1 build=$2
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "library_inside: $*" >&2; exit 1; }

{ "$cmake" -S "$here/library/inside" -B "$folder" -G Ninja -DTESSERAE_SOURCE="$here/.." \
    -DCMAKE_CXX_FLAGS=-O0 && "$cmake" --build "$folder" -j 2; } >"$folder/log" 2>&1 ||
    { tail -40 "$folder/log" >&2; fail "is not built"; }
[ "$("$folder/ball")" = "$("$build/tests/library_ball")" ] || fail "the ball is elsewhere"
targets=$("$cmake" --build "$folder" --target help)
for target in tesserae_parallel tests_core install/local; do
    ! grep -q "^$target: " <<<"$targets" || fail "has a target $target"
done
grep -q '^tesserae_core: ' <<<"$targets" || fail "has no target tesserae_core"
grep -q '^CMAKE_BUILD_TYPE:STRING=$' "$folder/CMakeCache.txt" || fail "chooses a build type"
