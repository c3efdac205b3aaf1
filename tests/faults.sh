#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds the program to its promise that nothing is lost: lets system calls fail, kills it, damages its
# files, starts it twice. Installs what is missing, builds, takes up to an hour and a half.
#   bash tests/faults.sh              all checks, a drawn part of the cases (always the same)
#   bash tests/faults.sh --quick      a minute's part
#   bash tests/faults.sh --all        every call and more moments: two to three hours
#   bash tests/faults.sh --only kills            one check: failing_calls, kills, damages, two_writers
#                                                or reader
#   bash tests/faults.sh --only kills --case JOB FAULT    one case, as a failure names it
# Ends with 1 if anything failed.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
install_packages "${packages[@]}" python3 hdf5-tools
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
PYTHONDONTWRITEBYTECODE=1 python3 "$root/tests/faults/check.py" "$root/build/release/tesserae" "$out" "$@"
