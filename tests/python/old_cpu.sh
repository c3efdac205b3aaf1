#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# old_cpu.sh MODULES PYTHON: on a CPU that it was not built for, importing the module raises
# ImportError, before anything runs that such a CPU lacks.
set -euo pipefail
modules=$1 python=$2
fail() { echo "old CPU: $*" >&2; exit 1; }

# _cpu has no instruction with a VEX or EVEX prefix, and no library of ours.
check=$(ls "$modules"/tesserae/_cpu.*.so)
! objdump -d "$check" | grep -qE '\s(v[a-z]+|shlx|shrx|sarx|rorx|mulx|andn|bzhi)\s' ||
    fail "the check itself is compiled for newer CPUs"
! readelf -d "$check" | grep NEEDED | grep -qvE 'lib(c|m|stdc\+\+|gcc_s|python[0-9.]*)\.so' || fail "the check needs other libraries"
# It is the first that the package imports.
first=$(grep -nE '^(from|import) ' "$modules/tesserae/__init__.py" | head -1)
grep -q 'from \. import _cpu' <<<"$first" || fail "the package imports before the check: $first"

emulator=$(command -v qemu-x86_64-static || command -v qemu-x86_64) || {
    echo "no qemu-x86_64: no older CPU is emulated"
    exit 0
}
program='
try:
    import tesserae
    print("imported")
except ImportError as error:
    print("ImportError:", error)'
# Python itself may be built for the CPU of this machine, and numpy chooses by CPU.
said=$(PYTHONPATH=$modules "$emulator" -cpu Nehalem "$python" -c "$program") || fail "Nehalem: Python ended with status $?"
grep -q 'ImportError: tesserae: this CPU lacks x86-64-v3' <<<"$said" || fail "Nehalem: $said"
