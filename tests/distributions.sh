#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows on bare systems of Debian 12 and 13 that both README commands, clang++ and the benchmarks
# work, that the package for Debian does in a system that has nothing else, how long each takes, and
# that the same film has the same hash by all of them. By hand, before a release: it needs root,
# debootstrap, some 10 GB and half an hour a system on two cores.
#   bash tests/distributions.sh                  bookworm and trixie
#   bash tests/distributions.sh trixie           only this
#   bash tests/distributions.sh --quick [...]    without clang++ and the benchmarks
#   bash tests/distributions.sh --all [...]      tests/run.sh --all too: hours
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$root/build/distributions

# Everything is mounted in a namespace of our own, so that nothing is left mounted.
if [ -z "${TESSERAE_NAMESPACE:-}" ]; then
    command -v debootstrap >/dev/null || { echo "as root: apt-get install debootstrap" >&2; exit 1; }
    exec env TESSERAE_NAMESPACE=1 unshare --mount bash "${BASH_SOURCE[0]}" "$@"
fi
extent=usual suites=()
for argument in "$@"; do
    case $argument in --quick | --all) extent=${argument#--} ;; *) suites+=("$argument") ;; esac
done
[ ${#suites[@]} != 0 ] || suites=(bookworm trixie)

# base SUITE: what debootstrap's smallest variant holds, made once.
base() {
    local system=$folder/$1.base mirror
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
    mkdir -p "$folder"
    [ ! -e "$system/made" ] || return 0
    rm -rf "$system"
    debootstrap --variant=minbase "$1" "$system" "$mirror" >"$folder/$1.debootstrap.log" 2>&1 ||
        { tail "$folder/$1.debootstrap.log" >&2; return 1; }
    # A mirror may be an old copy, whose dates apt would refuse.
    echo 'Acquire::Check-Valid-Until "false";' >"$system/etc/apt/apt.conf.d/99old-copies"
    touch "$system/made"
}

# bare_system SUITE SYSTEM: a copy of the suite's base with an empty /tesserae, where there is none yet.
bare_system() {
    local system=$folder/$2
    base "$1"
    if [ ! -e "$system/made" ]; then
        rm -rf "$system" "$system.partial"
        cp -a "$folder/$1.base" "$system.partial"
        mv "$system.partial" "$system"
    fi
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    rm -rf "$system/tesserae" "$folder/$2".*.log "$folder/$2".*.hash
    mkdir "$system/tesserae"
    mount -t proc proc "$system/proc"
    mount --rbind /dev "$system/dev"
}

# with_tree SUITE: the system that all is built in, and this tree in /tesserae.
with_tree() {
    bare_system "$1" "$1"
    git -C "$root" ls-files -z | tar -C "$root" --null -T - -c | tar -C "$folder/$1/tesserae" -x
}

# step SYSTEM NAME COMMAND: runs it in /tesserae there, prints how long it took and how it ended.
failed=()
step() {
    local system=$1 name=$2 begin=$SECONDS outcome=done
    chroot "$folder/$system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        bash -c "cd /tesserae && $3" >"$folder/$system.$name.log" 2>&1 </dev/null ||
        { outcome="failed: see $folder/$system.$name.log"; failed+=("$system $name"); }
    printf '%-13s %-15s %5d s  %s\n' "$system" "$name" $((SECONDS - begin)) "$outcome"
}

# hash_of SYSTEM NAME PROGRAM SCENE: of a film made there by that program, into SYSTEM.NAME.hash.
hash_of() {
    step "$1" "film-$2" "rm -rf out/film && $3 run $4 -o out/film --frames 0-23x8 --quiet &&
        $3 hash out/film out/film/trajectory.h5"
    grep -E '^[0-9a-f]{32}  ' "$folder/$1.film-$2.log" >"$folder/$1.$2.hash" ||
        failed+=("$1 $2: no hash")
}

# package SUITE: packs the program, the module and the library, and installs them in a new system in
# which nothing was built: the program alone, the module, then what builds an example with component core.
package() {
    local user=$1.user
    step "$1" build-module '. scenes/setup.sh && build "$root/build/release" tesserae_python_package'
    step "$1" package 'rm -rf build/packages && cpack --config build/release/CPackConfig.cmake -B build/packages &&
        for file in build/packages/*.deb; do dpkg-deb --info $file && dpkg-deb --contents $file || exit; done'
    rm -rf --one-file-system "${folder:?}/$user"
    bare_system "$1" "$user"
    cp -r "$folder/$1"/tesserae/build/packages/*.deb "$root/scenes/gallery/first.toml" \
        "$root/tests/library/ball" "$folder/$user/tesserae" ||
        { failed+=("$1: no package"); return; }
    step "$user" install 'apt-get update -qq && apt-get install -y -qq --no-install-recommends ./tesserae_*.deb \
        fonts-dejavu-core && tesserae --version'
    hash_of "$user" package tesserae first.toml
    step "$user" module 'apt-get install -y -qq --no-install-recommends ./python3-tesserae_*.deb && python3 -c "
import tesserae as ts
world = ts.Scene.read(\"first.toml\").world()
assert world.step().contacts >= 0 and len(ts.Trajectory(\"out/film/trajectory.h5\")) > 1"'
    step "$user" library 'apt-get install -y -qq --no-install-recommends ./tesserae-dev_*.deb cmake make g++ &&
        cmake -S ball -B ball/build -DCMAKE_BUILD_TYPE=Release && cmake --build ball/build && ball/build/ball |
        grep "^0 touches 1"'
}

# Ninja and ccache are new there: everything is compiled.
for suite in "${suites[@]}"; do
    with_tree "$suite"
    step "$suite" install '. scenes/setup.sh && install_packages "${packages[@]}" dpkg-dev file'
    step "$suite" build-program '. scenes/setup.sh && build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release'
    step "$suite" scenes-run 'bash scenes/run.sh'
    package "$suite"
    step "$suite" build-tests '. scenes/setup.sh && build "$root/build/release" all'
    step "$suite" tests-run 'bash tests/run.sh'
    hash_of "$suite" release build/release/tesserae scenes/gallery/first.toml
    [ "$extent" != quick ] || continue
    step "$suite" clang '. scenes/setup.sh && install_packages clang && build "$root/build/clang" all \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ &&
        ctest --test-dir build/clang -L fast -j "$(nproc)" --output-on-failure'
    hash_of "$suite" clang build/clang/tesserae scenes/gallery/first.toml
    step "$suite" benchmarks 'bash bench/run.sh bullet && build/bench/bench/rays 100 &&
        build/bench/bench/peers_double box_wall 100 && build/bench/bench/contacts_float --benchmark_filter=sphere'
    [ "$extent" != all ] || step "$suite" tests-all 'bash tests/run.sh --all'
done

# Two lines, of the frames and of the trajectory, in every one of them.
for suite in "${suites[@]}"; do cat "$folder/$suite".*.hash; done | sort | uniq -c | tee "$folder/hashes"
[ "$(wc -l <"$folder/hashes")" = 2 ] || failed+=("the hashes differ")
if [ ${#failed[@]} != 0 ]; then
    printf 'failed: %s\n' "${failed[@]}" >&2
    exit 1
fi
