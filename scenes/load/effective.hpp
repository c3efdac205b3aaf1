#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/algebra/bivector.hpp"
#include "render/description.hpp"

namespace tesserae::scenes {

/// `bytes` with control characters escaped, cut to at most `limit` bytes (and "...").
std::string printable(std::string_view bytes, std::size_t limit = 80);

/// Shortest decimal that reads back as the same double.
std::string toml_text(double value);
std::string toml_text(std::int64_t value);
std::string toml_text(bool value);
std::string toml_text(std::string_view value);  ///< quoted, escaped
std::string toml_text(const char* value);
std::string toml_text(const Vec4& value);
std::string toml_text(const render::Color& value);
std::string toml_text(const Bivector& value);  ///< { xy = ..., ... }

/// What a key of a scene decides.
enum class Part {
    kMotion,   ///< how bodies move: a trajectory depends on it
    kPicture,  ///< only how they are shown or called
};

/// Writes a scene's canonical text: every key in the caller's order, and apart from it the lines
/// that decide motion.
class EffectiveWriter {
  public:
    /// Starts a table; `header` with its brackets. A table of the picture part has no motion keys.
    void table(std::string_view header, Part part);
    template <class T>
    void key(Part part, std::string_view name, const T& value) {
        line(part, name, toml_text(value));
    }
    void line(Part part, std::string_view name, std::string_view value);

    const std::string& text() const { return text_; }
    const std::string& motion() const { return motion_; }
    std::string take_text() { return std::move(text_); }

  private:
    std::string text_, motion_;
};

/// The first key in which two effective scenes differ, with both values: "render.samples: 16 there,
/// 4 here". Empty if they are equal.
std::string first_difference(const std::string& there, const std::string& here);

}  // namespace tesserae::scenes
