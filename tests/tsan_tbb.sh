# SPDX-License-Identifier: Apache-2.0
# Sourced after scenes/setup.sh: oneTBB for ThreadSanitizer.
#
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
