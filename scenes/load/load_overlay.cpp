// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/load_parts.hpp"
#include "scenes/load/overlay_keys.hpp"

namespace tesserae::scenes {
namespace {

void load_captions(TableReader& overlay, const Origin& origin, Scene& scene) {
    std::vector<const toml::table*> tables;
    overlay.collect([&] { tables = overlay.tables("caption"); });
    for (std::size_t i = 0; i < tables.size(); ++i)
        overlay.collect([&] {
            TableReader reader(*tables[i], origin, fmt::format("overlay caption {}", i));
            Caption& caption = scene.overlay.captions.emplace_back();
            caption_keys(caption, ReadKeys{reader});
            if (!reader.has_errors() && !(caption.from < caption.to))
                reader.collect([&] {
                    reader.fail(reader.has("to") ? "to" : "from",
                                fmt::format("expected from < to, which are {} and {}",
                                            toml_text(caption.from), toml_text(caption.to)));
                });
            reader.finish();
        });
}

}  // namespace

void load_overlay(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto* table = root.table("overlay");
    if (table == nullptr) return;
    Overlay& overlay = scene.overlay;
    TableReader reader(*table, origin, "[overlay]");
    overlay_keys(overlay, ReadKeys{reader});
    load_captions(reader, origin, scene);
    reader.finish();
    // One that shows nothing is none.
    if (overlay.is_empty()) return;
    const WriteKeys write{out};
    out.table("[overlay]");
    overlay_keys(overlay, write);
    for (const Caption& caption : overlay.captions) {
        out.table("[[overlay.caption]]");
        caption_keys(caption, write);
    }
}

}  // namespace tesserae::scenes
