#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# commit.sh CMAKE: the commit that the build writes into the program is that of its sources, and
# the same one is not written twice.
set -euo pipefail
cmake=$1
script=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/scenes/program/commit.cmake
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
mkdir -p "$folder/tree/below"
cd "$folder/tree"

# expect SOURCES TEXT: what is written for them.
expect() {
    "$cmake" -DSOURCE="$1" -DOUTPUT="$folder/commit.cpp" -P "$script"
    grep -qF "kCommit{$2};" "$folder/commit.cpp" ||
        { echo "expected $2, found:" >&2; cat "$folder/commit.cpp" >&2; exit 1; }
}

expect "$PWD" '"", false'  # no repository
command -v git >/dev/null || exit 0
git init -q
expect "$PWD" '"", false'  # no commit yet
echo 1 >file
git add file
git -c user.name=nobody -c user.email=nobody@example.org commit -q -m one
id=$(git rev-parse --short=12 HEAD)
expect "$PWD" "\"$id\", false"
touch -d 2000-01-01 "$folder/commit.cpp"
expect "$PWD" "\"$id\", false"
[ "$(date -r "$folder/commit.cpp" +%Y)" = 2000 ] || { echo "written though it is the same" >&2; exit 1; }
expect "$PWD/below" '"", false'  # in a repository of something else
echo 2 >untracked
expect "$PWD" "\"$id\", false"
echo 2 >file
expect "$PWD" "\"$id\", true"

# Without git.
mkdir "$folder/bin"
ln -s "$(command -v grep)" "$folder/bin/grep"
(PATH=$folder/bin && expect "$folder/tree" '"", false')
