// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/algebra/bivector.hpp"
#include "core/shape/polychoron.hpp"
#include "render/description.hpp"

namespace tesserae::scenes {

/// `bytes` with control characters escaped, cut to at most `limit` bytes (and "...").
std::string printable(std::string_view bytes, std::size_t limit = 80);

/// Shortest decimal that reads back as the same double.
std::string toml_text(double value);
std::string toml_text(std::integral auto value) { return std::to_string(value); }
std::string toml_text(bool value);
std::string toml_text(std::string_view value);  ///< quoted, escaped
std::string toml_text(const char* value);
std::string toml_text(const Vec4& value);
std::string toml_text(const Vec2& value);
std::string toml_text(const std::array<std::int64_t, 2>& values);
std::string toml_text(const std::vector<Vec4>& values);
std::string toml_text(RegularPolychoron which);
std::string toml_text(const render::Color& value);
std::string toml_text(const Bivector& value);  ///< { xy = ..., ... }

/// Writes a scene's canonical text: every key in the caller's order.
class EffectiveWriter {
  public:
    /// Starts a table; `header` with its brackets.
    void table(std::string_view header);
    template <class T>
    void key(std::string_view name, const T& value) {
        line(name, toml_text(value));
    }
    void line(std::string_view name, std::string_view value);

    const std::string& text() const { return text_; }
    std::string take_text() { return std::move(text_); }

  private:
    std::string text_;
};

/// Returns lines that were written as a table's as an inline table: { key = value, ... }.
std::string inline_table(const EffectiveWriter& lines);

/// The lines of an effective scene that decide how bodies move, which is what a trajectory depends
/// on: not how they are shown or called, nor for how long they move.
std::string motion_part(std::string_view effective);

/// All lines of an effective scene but how long it lasts.
std::string without_duration(std::string_view effective);

/// An effective scene of a file, which may be older than this program, as this one writes it:
/// [physics] had a key `solver`.
std::string without_solver(std::string text);
/// An effective scene as it was hashed while [physics] had a key `solver`.
std::string with_solver(std::string effective);

/// The bodies of two effective scenes of the same motion have the same names.
bool same_body_names(std::string_view there, std::string_view here);

/// The first key in which two effective scenes differ, with both values: "render.samples: 16 there,
/// 4 here". Empty if they are equal.
std::string first_difference(const std::string& there, const std::string& here);
/// The same among the lines that decide motion.
std::string first_motion_difference(const std::string& there, const std::string& here);

}  // namespace tesserae::scenes
