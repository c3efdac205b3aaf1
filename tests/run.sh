#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#   bash tests/run.sh           the fast set, release build
#   bash tests/run.sh --slow    the slow set too
#   bash tests/run.sh --all     the fast set under g++ and clang++, debug and release, and under the
#                               address, undefined and thread sanitizers; one that fails does not
#                               stop the others
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"

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

# ThreadSanitizer sees a hand-off between threads only in code that it instrumented, and Debian's
# oneTBB is not: with it, each correct hand-off in a task, graph or pipeline is reported as a race,
# and suppressions for the task scheduler's frames would hide every race inside a task as well. So
# oneTBB is built from the source of the same Debian package with the sanitizer in it, and no
# suppression is needed but for Embree's (tsan.supp). What is still not seen: races inside Embree,
# HDF5, OpenEXR, libpng and zlib, races on paths that no test takes, and races between pieces of
# work that happen to be ordered by the scheduler's own locks in the run at hand. Ordering by bare
# fences, which the sanitizer does not know, occurs only in oneTBB's sleeping threads.
build_tbb_for_tsan() {
    local folder=$root/build/tsan-tbb version site suite
    [ -e "$folder/build/lib_relwithdebinfo/libtbb.so.12" ] && return
    version=$(dpkg-query -W -f '${source:Version}' libtbb-dev) || return
    rm -rf "$folder" && mkdir -p "$folder/lists/partial" "$folder/cache" || return
    # From the mirror that the binary packages come from.
    local key=/usr/share/keyrings/debian-archive-keyring.gpg
    suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
    site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' "Codename: $suite" | head -n 1)
    echo "deb-src [signed-by=$key] $site $suite main" >"$folder/sources"
    local apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources" -o Dir::Etc::SourceParts=/dev/null
        -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder/cache")
    "${apt[@]}" update >&2 && (cd "$folder" && "${apt[@]}" source "onetbb=$version") >&2 || return
    # Without a libtbbmalloc beside it, oneTBB takes its memory from malloc, which is watched.
    cmake -S "$folder"/onetbb-*/ -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DTBB_SANITIZE=thread -DCMAKE_CXX_FLAGS=-Wno-tsan -DTBB_ENABLE_IPO=OFF -DTBB_TEST=OFF \
        -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
        -DTBB_OUTPUT_DIR_BASE=lib >"$folder/configure.log" 2>&1 ||
        { cat "$folder/configure.log" >&2; return 1; }
    cmake --build "$folder/build" --target tbb >&2
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
