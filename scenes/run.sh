#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs the main job: simulates, renders and previews a scene.
#   bash scenes/run.sh                          scenes/gallery/first.toml into out/first
#   bash scenes/run.sh SCENE.toml -o DIR ...    anything that `tesserae run` takes
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages "${packages[@]}"
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release
[ $# -gt 0 ] || set -- "$root/scenes/gallery/first.toml" -o "$root/out/first"
exec "$root/build/release/tesserae" run "$@"
