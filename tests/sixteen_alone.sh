#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Whether what is compiled for AVX-512 stays where it is called from: the linker takes a function that
# several sources have from any of them, and another CPU would stop at it.
#   bash tests/sixteen_alone.sh LIBRARY   fails if its sixteen.cpp.o has such a function
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
ar p "$1" sixteen.cpp.o >"$folder/sixteen.o"
symbols=$(nm --defined-only "$folder/sixteen.o")
grep -q sweep_general <<<"$symbols" || { echo "no sweeps in $1" >&2; exit 1; }
# W, V and u are what others may have too, Dv16_f is a vector of sixteen floats.
if shared=$(grep -E ' [WVu] ' <<<"$symbols" | grep -v Dv16_f); then
    printf 'functions that other sources may have:\n%s\n' "$(c++filt <<<"$shared")" >&2
    exit 1
fi
