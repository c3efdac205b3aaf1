#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs the tests.
#   bash tests/run.sh           the fast set, release build
#   bash tests/run.sh --slow    the slow set too
#   bash tests/run.sh --all     the fast set under g++ and clang++, debug and release, and under the
#                               address, undefined and thread sanitizers; one that fails does not
#                               stop the others
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
. "$root/tests/tsan_tbb.sh"

# test_build FOLDER LABELS CMAKE-OPTIONS...
# Two tests at once suit two cores: most have one thread, few have more and those are short.
test_build() {
    local folder=$root/build/$1 labels=$2
    shift 2
    echo "== $folder" >&2
    (build "$folder" all "$@") && ctest --test-dir "$folder" --label-regex "$labels" \
        --no-tests=error --output-on-failure -j "$(nproc)" --progress
}

# check FOLDER CMAKE-OPTIONS...: the fast set; remembers in `failed` that it failed.
failed=()
check() {
    local folder=$1
    shift
    test_build "$folder" fast "$@" || failed+=("$folder")
}

case "${1:-}" in
"")
    install_packages "${packages[@]}"
    test_build release fast -DCMAKE_BUILD_TYPE=Release
    ;;
--slow)
    install_packages "${packages[@]}" python3 python3-h5py \
        mypy python3-nbclient python3-ipykernel python3-matplotlib
    test_build release "fast|slow" -DCMAKE_BUILD_TYPE=Release
    ;;
--all)
    export CI=true  # warnings are errors
    install_packages "${packages[@]}" clang libclang-rt-dev dpkg-dev
    clang=(-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++)
    # With Eigen's assertions and the standard library's. Unoptimised the tests would take an hour.
    debug=(-DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1 -D_GLIBCXX_ASSERTIONS")
    check release -DCMAKE_BUILD_TYPE=Release
    build "$root/build/release" headers_alone || failed+=(headers_alone)
    check debug "${debug[@]}" -DCMAKE_UNITY_BUILD=OFF  # every source compiles alone
    check clang -DCMAKE_BUILD_TYPE=Release "${clang[@]}"
    check clang-debug "${debug[@]}" "${clang[@]}"
    check asan -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTESSERAE_SANITIZE=address,undefined
    if build_tbb_for_tsan; then
        LD_LIBRARY_PATH=$root/build/tsan-tbb/build/lib_relwithdebinfo \
            TSAN_OPTIONS=suppressions=$root/tests/tsan.supp \
            check tsan -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTESSERAE_SANITIZE=thread
    else
        failed+=(tsan-tbb)
    fi
    if [ ${#failed[@]} != 0 ]; then
        echo "failed: ${failed[*]}" >&2
        exit 1
    fi
    ;;
*)
    echo "usage: bash tests/run.sh [--slow | --all]" >&2
    exit 2
    ;;
esac
