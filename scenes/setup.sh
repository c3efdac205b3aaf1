# Sourced by scenes/run.sh and tests/run.sh: installs what is missing (Debian 12) and builds.
# Sets `root` to the checkout. Costs under two seconds when there is nothing to do.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

packages=(
    g++ cmake ninja-build ccache pkg-config
    libtbb-dev libeigen3-dev libembree-dev libopenexr-dev libpng-dev libhdf5-dev zlib1g-dev
    libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libxxhash-dev
    libgtest-dev
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
    if [ "$id" != debian ] || [ "$version" != 12 ]; then
        echo "This script knows Debian 12 only; here is ${id:-an unknown system} ${version}." >&2
        echo "Install what these Debian packages hold, then build with cmake (see README.md):" >&2
        echo "  ${packages[*]}" >&2
        exit 1
    fi
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

# build FOLDER TARGET CMAKE-OPTIONS...: configures once, then builds what changed.
build() {
    local folder=$1 target=$2 log
    shift 2
    mkdir -p "$folder"
    log=$folder/configure.log
    if [ ! -f "$folder/build.ninja" ]; then
        cmake -S "$root" -B "$folder" -G Ninja "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
    fi
    cmake --build "$folder" --target "$target" >&2 || exit 1
}
