# SPDX-License-Identifier: Apache-2.0
# Sourced by scenes/run.sh and tests/run.sh: installs what is missing (Debian 12 and 13) and builds.
# Sets `root` to the checkout. Costs under two seconds when there is nothing to do.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# What is needed, by purpose, with the versions of Debian 12 and 13, both of which work; Ubuntu
# 24.04 has the same names and versions between these, but was not tried.
packages=(
    g++                   # a C++20 compiler: g++ 12.2, 14.2; clang++ 14, 19 do as well
    cmake ninja-build     # 3.25, 3.31
    pkg-config
    ccache                # what was compiled before is not compiled again; may be missing
    libtbb-dev            # threads: oneTBB 2021.8, 2022.1
    libeigen3-dev         # linear algebra: Eigen 3.4
    libqhull-dev          # hulls of polychora: Qhull 2020.2
    libembree-dev         # rays through a lens or a shutter: Embree 3.13, 4.3
    libopenexr-dev        # frames: OpenEXR 3.1
    libpng-dev zlib1g-dev # previews
    libfreetype-dev fonts-dejavu-core # text over previews: FreeType 2.12, 2.13
    ffmpeg                # films of previews: ffmpeg 5.1, 7.1; may be missing
    libhdf5-dev           # trajectories: HDF5 1.10, 1.14, without MPI
    libtomlplusplus-dev   # scene files: toml++ 3.3, 3.4
    libcli11-dev          # command line: CLI11 2.1, 2.4
    libfmt-dev            # text: fmt 9.1, 10.1
    nlohmann-json3-dev    # JSON 3.11
    libxxhash-dev         # hashes: xxHash 0.8
    gnuplot-nox           # tesserae plot, when it runs: gnuplot 5.4, 6.0
    pybind11-dev python3-dev python3-numpy # Python's module: pybind11 2.10, 2.13; may be missing
    libgtest-dev          # tests: GoogleTest 1.12, 1.16
)

missing_packages() {
    local package
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
    done
}

install_packages() {
    local id="" version="" missing as_root=()
    [ -r /etc/os-release ] && id=$(. /etc/os-release && echo "${ID:-}") &&
        version=$(. /etc/os-release && echo "${VERSION_ID:-}")
    case "$id $version" in
    "debian 12" | "debian 13") ;;
    *)
        echo "Packages are installed on Debian 12 and 13 only; here is ${id:-an unknown system} ${version}." >&2
        echo "This builds with what is there. Needed (scenes/setup.sh says what for): $*" >&2
        return
        ;;
    esac
    missing=$(missing_packages "$@")
    [ -z "$missing" ] && return
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing; as root: apt-get install" $missing >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "installing:" $missing >&2
    "${as_root[@]}" apt-get update -qq >&2
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends $missing >&2
}

# build FOLDER TARGET CMAKE-OPTIONS...: configures once, then builds what changed. Warnings stop a
# check of the project (CI=true), not a user.
build() {
    local folder=$1 target=$2 log
    shift 2
    [ -z "${CI:-}" ] || set -- -DCMAKE_COMPILE_WARNING_AS_ERROR=ON "$@"
    mkdir -p "$folder"
    log=$folder/configure.log
    if [ ! -f "$folder/build.ninja" ]; then
        cmake -S "$root" -B "$folder" -G Ninja "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
    fi
    cmake --build "$folder" --target "$target" >&2 || exit 1
}
