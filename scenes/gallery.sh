#!/usr/bin/env bash
# Makes the gallery's contact sheet, scenes/gallery/contact.jpg: a row of four moments for each film,
# in the order of the README. Takes some ten minutes on two cores; the films stay in out/gallery.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages "${packages[@]}"
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release

films=(first shapes drum tower dominoes polychora heap race turn)
moments=(12 37 62 92) # percent of a film
stills=()
for film in "${films[@]}"; do
    folder=$root/out/gallery/$film
    "$root/build/release/tesserae" run "$root/scenes/gallery/$film.toml" -o "$folder" \
        --size 480x270 --samples 8 >&2
    count=$(find "$folder/preview" -name '*.png' | wc -l)
    for moment in "${moments[@]}"; do
        stills+=(-i "$(printf '%s/preview/%s.%04d.png' "$folder" "$film" $((count * moment / 100)))")
    done
done

number=$((${#films[@]} * ${#moments[@]}))
scaled=$(for ((i = 0; i < number; ++i)); do printf "[%d:v]scale=240:135:flags=area[s%d];" "$i" "$i"; done)
inputs=$(for ((i = 0; i < number; ++i)); do printf "[s%d]" "$i"; done)
layout=$(for ((i = 0; i < number; ++i)); do
    printf '%d_%d|' $((i % ${#moments[@]} * 240)) $((i / ${#moments[@]} * 135))
done)
ffmpeg -hide_banner -loglevel error -y "${stills[@]}" -filter_complex \
    "$scaled${inputs}xstack=inputs=$number:layout=${layout%|}" \
    -q:v 4 -frames:v 1 -update 1 "$root/scenes/gallery/contact.jpg"
ls -l "$root/scenes/gallery/contact.jpg" >&2
