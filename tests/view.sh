#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds the page of `tesserae view` against the renderer, in Debian's chromium without a screen and
# with software GL. Installs what is missing, builds, takes a few minutes.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
install_packages "${packages[@]}" chromium chromium-driver python3-selenium python3-openimageio python3-h5py python3-numpy
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# Debian's own Python, for which those packages are.
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$root/tests/view/check_pages.py" "$root/build/release/tesserae" "$out"
