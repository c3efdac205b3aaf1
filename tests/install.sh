#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install.sh CMAKE BUILD: what `cmake --install` puts into a folder is all that is used, and is used
# from there.
set -euo pipefail
cmake=$1 build=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "install: $*" >&2; exit 1; }

for component in program python; do
    "$cmake" --install "$build" --prefix "$folder/local" --component "$component" >/dev/null
done
cat >"$folder/expected" <<'FILES'
bin/tesserae
share/bash-completion/completions/tesserae
share/doc/tesserae/CHANGELOG.md
share/doc/tesserae/copyright
share/fish/vendor_completions.d/tesserae.fish
share/man/man1/tesserae.1
share/zsh/site-functions/_tesserae
FILES
# Where the Python module is built, it is installed too; its test is tests/python.
modules=$(cd "$folder/local" && ls -d lib/python3.*/site-packages/tesserae 2>/dev/null) || true
if [ -n "$modules" ]; then
    for file in __init__.py __init__.pyi py.typed rotor.py rotor.pyi _tesserae.pyi arguments.py page.py progress.py records.py settings.py; do
        echo "$modules/$file"
    done >>"$folder/expected"
    (cd "$folder/local" && ls "$modules"/_cpu.*.so "$modules"/_tesserae.*.so) >>"$folder/expected"
    LC_ALL=C sort -o "$folder/expected" "$folder/expected"
    PYTHONPATH=$folder/local/${modules%/tesserae} PYTHONDONTWRITEBYTECODE=1 \
        /usr/bin/python3 -c 'import tesserae as ts; assert len(ts.World()) == 0' || fail "Python cannot import what is installed"
fi
(cd "$folder/local" && find . -type f -printf '%P\n') | LC_ALL=C sort >"$folder/found"
diff "$folder/expected" "$folder/found" || fail "other files than expected"

# The libraries: beside these, the headers that the public ones include.
"$cmake" --install "$build" --prefix "$folder/development" --component development >/dev/null
type=$(sed -n 's/^CMAKE_BUILD_TYPE:STRING=//p' "$build/CMakeCache.txt" | tr '[:upper:]' '[:lower:]')
{
    for name in bivector body error joint picture report rotor scene settings shape threads \
        trajectory vector world; do
        echo "include/tesserae/$name.hpp"
    done
    for part in config config-version core core-$type parallel parallel-$type render render-$type \
        scenes scenes-$type; do
        echo "LIB/cmake/tesserae/tesserae-$part.cmake"
    done
    for room in core parallel render scenes; do echo "LIB/libtesserae_$room.a"; done
    echo share/doc/tesserae-dev/copyright
} | LC_ALL=C sort >"$folder/expected"
(cd "$folder/development" && find . -type f -printf '%P\n') |
    grep -Ev '^include/tesserae/(core|parallel|render|scenes)/' |
    sed 's,^lib\(/[^/]*-linux-gnu\|64\)\?/,LIB/,' | LC_ALL=C sort >"$folder/found"
diff "$folder/expected" "$folder/found" || fail "other files of the library than expected"
[ ! -e "$folder/development/include/tesserae/core/dynamics/stepper.hpp" ] ||
    fail "what no public header includes is installed"

# The program finds its libraries, and does the same as the build's.
program=$folder/local/bin/tesserae
for words in --version "reference man"; do
    [ "$("$program" $words)" = "$("$build/tesserae" $words)" ] || fail "tesserae $words: differs"
done
"$program" generate pile --bodies 20 >"$folder/pile.toml"
for at in "$program" "$build/tesserae"; do
    rm -f "$folder/pile.h5"
    "$at" simulate "$folder/pile.toml" -o "$folder/pile.h5" --set physics.duration=0.1 --quiet >/dev/null
    "$at" hash "$folder/pile.h5" >>"$folder/hashes"
done
[ "$(wc -l <"$folder/hashes")" = 2 ] || fail "no hashes"
[ "$(sort -u "$folder/hashes" | wc -l)" = 1 ] || fail "bodies move otherwise"

# Its pages and completions are found where programs look for them.
if command -v man >/dev/null; then
    [ "$(man -M "$folder/local/share/man" -w tesserae)" = "$folder/local/share/man/man1/tesserae.1" ] ||
        fail "man does not find its page"
fi
. "$folder/local/share/bash-completion/completions/tesserae"
complete -p tesserae >/dev/null || fail "bash has no completion"

# Where packages of Debian put them, a folder for its zsh.
"$cmake" --install "$build" --prefix "$folder/usr" >/dev/null
if [ -e /etc/debian_version ]; then
    [ -f "$folder/usr/share/zsh/vendor-completions/_tesserae" ] || fail "no completion for Debian's zsh"
fi
if [ -n "$modules" ] && [ -e /etc/debian_version ]; then
    [ -f "$folder/usr/lib/python3/dist-packages/tesserae/__init__.py" ] || fail "no module where Debian's Python looks"
fi
