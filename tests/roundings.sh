#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that the compiler rounds to float wherever the sources say so. g++ 12 does not where it makes
# vectors of neighbouring doubles that become floats and then doubles again: it takes the first
# doubles for the last ones, and results are not those of other compilers.
#   bash tests/roundings.sh BUILD   fails and names the functions where the g++ of BUILD does so
# It compiles the program's sources again and reads what g++ writes about its vectors: some minutes
# on two cores. What was right stays so until its object in BUILD is compiled anew: the next run
# takes only what has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# places_in DUMP...: prints the functions in which a vector of doubles is made of a vector of floats
# that was itself made of doubles.
places_in() {
    awk '/^;; Function/ {
            delete narrow
            if (match($0, /\([A-Za-z0-9_.$]+,/)) name = substr($0, RSTART + 1, RLENGTH - 2)
        }
        / = \(vector\([0-9]+\) float\) / { narrow[$1] = 1 }
        / = \(vector\([0-9]+\) double\) / {
            from = $NF
            sub(/;$/, "", from)
            if (from in narrow) print name
        }' "$@" | sort -u
}
# dump FOLDER COMMAND: runs a compiler's command so that it writes there what it made vectors of.
dump() {
    mkdir -p "$1"
    eval "$2 -w -fdump-tree-vect -fdump-tree-slp1 -fdump-tree-slp2 -dumpdir $1/ -o $1/object"
}
# check OBJECT COMMAND: does so, and leaves the names of functions beside the list of what is right.
check() {
    local right dumped
    right=$known/$(sha256sum <<<"$1 $2" | cut -c -32)
    [ -e "$1" ] && [ "$right" -nt "$1" ] && return
    dumped=$(mktemp -d "$folder/XXXXXX")
    dump "$dumped" "$2" || exit 255
    # What has no loops has no vectors.
    cat "$dumped"/*t.* 2>/dev/null | places_in >"$dumped/places"
    rm -f "$dumped"/*t.*
    [ -s "$dumped/places" ] || touch "$right"
}

cd "$1"
# The objects of the program and the commands that compile them, without ccache and the lists of
# headers.
ninja -t commands tesserae | grep ' -c ' |
    sed -E 's/^.*ccache //; s/ -MD -MT [^ ]+ -MF [^ ]+//; s/^(.*) -o ([^ ]+)(.*)$/\2 \1\3/' >"$folder/commands"
[ -s "$folder/commands" ] || { echo "nothing is compiled in $1" >&2; exit 1; }

# A small program with such a place: if it is right, the compiler rounds and nothing is to be found.
cat >"$folder/small.cpp" <<'END'
struct Record { float a, b, c, d; };
__attribute__((noinline)) void take(const double* x, Record& record, double* from) {
    const double a = from[0] + x[0], b = from[1] + x[1], c = from[2] + x[2], d = from[3] + x[3];
    record = {float(a), float(b), float(c), float(d)};
    from[0] -= record.a, from[1] -= record.b, from[2] -= record.c, from[3] -= record.d;
}
int main() {
    const double thirds[4] = {1 / 3., 2 / 3., 4 / 3., 5 / 3.};
    double from[4] = {};
    Record record;
    take(thirds, record, from);
    return from[0] == -double(record.a) && from[3] == -double(record.d) ? 0 : 1;
}
END
# By the options that most sources of core have: what asks which CPU it is has others.
options=$(grep 'rooms/core' "$folder/commands" | sed -E 's/^[^ ]+ //; s/ -c .*//' | sort | uniq -c |
    sort -rn | sed -E '1!d; s/^ *[0-9]+ //')
eval "$options -w $folder/small.cpp -o $folder/small"
if "$folder/small"; then
    echo "this compiler rounds"
    exit 0
fi
dump "$folder/small_dump" "$options -c $folder/small.cpp"
[ -n "$(places_in "$folder"/small_dump/*t.*)" ] || { echo "the known place is not found" >&2; exit 1; }

export -f check dump places_in
export folder known=$PWD/roundings
mkdir -p "$known"
sed -E "s/'/'\\\\''/g; s/^([^ ]+) (.*)$/check \1 '\2'/" "$folder/commands" |
    xargs -d '\n' -n 1 -P "$(nproc)" bash -c
places=$(find "$folder" -name places -exec cat {} +)
if [ -n "$places" ]; then
    printf 'not rounded to float in:\n%s\n' "$(c++filt <<<"$places")" >&2
    exit 1
fi
