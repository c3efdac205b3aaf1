#!/usr/bin/env bash
# Shows on bare systems of Debian 12 and 13 that both README commands, clang++ and the benchmarks
# work, how long each takes, and that the same film has the same hash on both. By hand, before a
# release: it needs root, debootstrap, some 10 GB and half an hour a system on two cores.
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

# bare_system SUITE: what debootstrap's smallest variant holds, and this tree in /tesserae.
bare_system() {
    local system=$folder/$1 mirror
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
    mkdir -p "$folder"
    if [ ! -e "$system/made" ]; then
        rm -rf "$system"
        debootstrap --variant=minbase "$1" "$system" "$mirror" >"$folder/$1.debootstrap.log" 2>&1 ||
            { tail "$folder/$1.debootstrap.log" >&2; return 1; }
        touch "$system/made"
    fi
    # A mirror may be an old copy, whose dates apt would refuse.
    echo 'Acquire::Check-Valid-Until "false";' >"$system/etc/apt/apt.conf.d/99old-copies"
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    rm -rf "$system/tesserae" "$folder/$1".*.log "$folder/$1".*.hash
    mkdir "$system/tesserae"
    git -C "$root" ls-files -z | tar -C "$root" --null -T - -c | tar -C "$system/tesserae" -x
    mount -t proc proc "$system/proc"
    mount --rbind /dev "$system/dev"
}

# step SUITE NAME COMMAND: runs it there, prints how long it took and how it ended.
failed=()
step() {
    local suite=$1 name=$2 begin=$SECONDS outcome=done
    chroot "$folder/$suite" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        bash -c "cd /tesserae && $3" >"$folder/$suite.$name.log" 2>&1 </dev/null ||
        { outcome="failed: see $folder/$suite.$name.log"; failed+=("$suite $name"); }
    printf '%-9s %-14s %5d s  %s\n' "$suite" "$name" $((SECONDS - begin)) "$outcome"
}

# hash_of SUITE BUILD: of a film made there by that build, into SUITE.BUILD.hash.
hash_of() {
    step "$1" "film-$2" "rm -rf out/film && build/$2/tesserae run scenes/gallery/first.toml -o out/film \
        --frames 0-23x8 --quiet && build/$2/tesserae hash out/film out/film/trajectory.h5"
    grep -E '^[0-9a-f]{32}  ' "$folder/$1.film-$2.log" >"$folder/$1.$2.hash" ||
        failed+=("$1 $2: no hash")
}

# Ninja and ccache are new there: everything is compiled.
for suite in "${suites[@]}"; do
    bare_system "$suite"
    step "$suite" install '. scenes/setup.sh && install_packages "${packages[@]}"'
    step "$suite" build-program '. scenes/setup.sh && build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release'
    step "$suite" scenes-run 'bash scenes/run.sh'
    step "$suite" build-tests '. scenes/setup.sh && build "$root/build/release" all'
    step "$suite" tests-run 'bash tests/run.sh'
    hash_of "$suite" release
    [ "$extent" != quick ] || continue
    step "$suite" clang '. scenes/setup.sh && install_packages clang && build "$root/build/clang" all \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ &&
        ctest --test-dir build/clang -L fast -j "$(nproc)" --output-on-failure'
    hash_of "$suite" clang
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
