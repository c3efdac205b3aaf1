#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#   bash tests/run.sh           the fast set, release build
#   bash tests/run.sh --slow    the slow set too
#   bash tests/run.sh --all     the fast set under g++ and clang++, debug and release, and under the
#                               address, undefined and thread sanitizers
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"

# test_build FOLDER LABELS CMAKE-OPTIONS...
test_build() {
    local folder=$root/build/$1 labels=$2
    shift 2
    echo "== $folder" >&2
    build "$folder" "$@"
    ctest --test-dir "$folder" --label-regex "$labels" --output-on-failure -j "$(nproc)" --progress
}

case "${1:-}" in
"")
    install_packages "${packages[@]}"
    test_build release fast -DCMAKE_BUILD_TYPE=Release
    ;;
--slow)
    install_packages "${packages[@]}"
    test_build release "fast|slow" -DCMAKE_BUILD_TYPE=Release
    ;;
--all)
    install_packages "${packages[@]}" clang libclang-rt-14-dev
    test_build release fast -DCMAKE_BUILD_TYPE=Release
    test_build debug fast -DCMAKE_BUILD_TYPE=Debug
    test_build clang fast -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
    test_build clang-debug fast -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
    test_build asan fast -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTESSERAE_SANITIZE=address,undefined
    TSAN_OPTIONS=suppressions=$root/tests/tsan.supp \
        test_build tsan fast -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTESSERAE_SANITIZE=thread
    ;;
*)
    echo "usage: bash tests/run.sh [--slow | --all]" >&2
    exit 2
    ;;
esac
