#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the pictures of the manual from the scenes that its pages show, and puts them beside the pages.
#   bash scenes/manual/pictures.sh [PROGRAM] [THREADS]    PROGRAM: build/release/tesserae unless given
# Needs ffmpeg. Takes some minutes on two cores.
set -euo pipefail
manual=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "${1:-$manual/../../build/release/tesserae}")
options=(--quiet)
[ $# -lt 2 ] || options+=(--threads "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# Writes the scenes of a page, each to the file that is named behind ```toml, and joins them as the
# page's lines `cat PART PART > SCENE` do.
scenes_of() {
    awk '/^```toml ./ { file = $2; printf "" > file; next } /^```/ { file = "" } file { print > file }' "$manual/$1"
    local line
    grep -E '^cat [a-z0-9. -]+ > [a-z0-9.-]+$' "$manual/$1" | while read -r line; do
        read -r -a words <<< "$line"
        cat "${words[@]:1:${#words[@]}-3}" > "${words[-1]}"
    done
}

# Renders one frame of a scene and stores it as a JPEG: picture_of NAME SCENE FRAME OPTIONS...
picture_of() {
    local name=$1 scene=$2 frame=$3
    shift 3
    "$program" render "$scene.toml" -o "frames/$name" --frames "$frame" "${options[@]}" "$@" >&2
    # Two is ffmpeg's best quality but one, five still good: between them as large as 60 KB allow.
    local quality
    for quality in 2 3 4 5; do
        ffmpeg -hide_banner -loglevel error -y -i "$(printf 'frames/%s/preview/%s.%04d.png' "$name" "$scene" "$frame")" \
            -q:v "$quality" -frames:v 1 -update 1 "$manual/$name.jpg"
        [ "$(stat -c %s "$manual/$name.jpg")" -ge 60000 ] || break
    done
    ls -l "$manual/$name.jpg" >&2
}

scenes_of tutorial.md
picture_of tutorial-1 fall-1 0 --samples 64
picture_of tutorial-2 fall-2 0 --samples 64
"$program" simulate fall-3.toml -o fall-3.h5 "${options[@]}" >&2
picture_of tutorial-3 fall-3 12 --samples 64 --trajectory fall-3.h5
"$program" simulate fall-4.toml -o fall-4.h5 "${options[@]}" >&2
picture_of tutorial-4 fall-4 88 --samples 64 --trajectory fall-4.h5
picture_of tutorial-5 fall-5 150 --samples 64 --trajectory fall-4.h5
picture_of tutorial-6 fall-5 112 --samples 128 --trajectory fall-4.h5 \
    --integrator path --set render.bounces=6 --set render.clamp_indirect=3

scenes_of four-dimensions.md
for name in hover shadow standing; do
    picture_of "four-dimensions-$name" "see-$name" 0 --samples 64
done
picture_of four-dimensions-slices see-shadow 0 --samples 16 --size 960x450 \
    --set camera.slices=9 --set camera.slice_thickness=2

# The strip of README: three moments of its film.
awk '/^```toml fall.toml/ { on = 1; next } /^```/ { on = 0 } on' "$manual/../../README.md" > fall.toml
"$program" run fall.toml -o fall --size 640x400 --samples 32 --frames 12,38,89 "${options[@]}" >&2
ffmpeg -hide_banner -loglevel error -y -i fall/preview/fall.0012.png -i fall/preview/fall.0038.png \
    -i fall/preview/fall.0089.png -filter_complex "hstack=3,scale=1440:-1:flags=area" \
    -q:v 3 -frames:v 1 -update 1 "$manual/fall.jpg"

# The page of view, where there is a chromium.
if command -v chromium >/dev/null; then
    "$program" view "$manual/../gallery/first.toml" -o view.html "${options[@]}" >&2
    echo '<script>tesserae.ready.then(() => tesserae.page.goTo(1.292))</script>' >> view.html
    chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars \
        --window-size=1120,727 --virtual-time-budget=8000 --screenshot="$folder/view.png" "file://$folder/view.html" 2>/dev/null
    ffmpeg -hide_banner -loglevel error -y -i view.png -q:v 3 -frames:v 1 -update 1 "$manual/view.jpg"
fi
