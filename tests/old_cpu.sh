#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# old_cpu.sh PROGRAM: on a CPU that it was not built for the program says so and ends, before any
# instruction runs that such a CPU lacks.
set -euo pipefail
program=$1
fail() { echo "old CPU: $*" >&2; exit 1; }

# The check is the first initialiser, and nothing runs before it: no code of that kind has a
# section of its own, no function is chosen while the program is loaded.
first=$(readelf -rW "$program" | awk '$3 == "R_X86_64_RELATIVE" {print $1, $4}' |
    awk -v begin="$(readelf -SW "$program" | sed -n 's/.* \.init_array  *INIT_ARRAY  *\([0-9a-f]*\).*/\1/p')" \
        '$1 ~ "0*" begin "$" {print $2}')
check=$(nm -C "$program" | sed -n 's/^0*\([0-9a-f]*\) t (anonymous namespace)::require_cpu()$/\1/p')
[ -n "$check" ] && [ "$first" = "$check" ] || fail "initialiser $first is the first, the check is $check"
! readelf -SW "$program" | grep -q '\.preinit_array' || fail "there is code before the initialisers"
! readelf -rW "$program" | grep -q R_X86_64_IRELATIV || fail "functions are chosen before the check"
# Neither the check nor what it calls of its own has an instruction with a VEX or EVEX prefix.
! objdump -d --disassemble-all "$program" --start-address="0x$check" --stop-address=$((0x$check + 256)) |
    sed -n '/require_cpu/,/^$/p' | grep -qE '\s(v[a-z]+|shlx|shrx|sarx|rorx|mulx|andn|bzhi)\s' ||
    fail "the check itself is compiled for newer CPUs"

# In an emulated one.
emulator=$(command -v qemu-x86_64-static || command -v qemu-x86_64) || {
    echo "no qemu-x86_64: no older CPU is emulated"
    exit 0
}
for cpu in Nehalem SandyBridge; do
    status=0
    said=$("$emulator" -cpu $cpu "$program" --version 2>&1) || status=$?
    [ $status = 1 ] && grep -q 'this CPU lacks x86-64-v3' <<<"$said" || fail "$cpu: $status: $said"
done
said=$("$emulator" -cpu Haswell "$program" --version 2>/dev/null) || fail "Haswell: it does not run"
grep -q '^tesserae ' <<<"$said" || fail "Haswell: $said"
