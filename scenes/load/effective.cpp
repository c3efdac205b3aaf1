// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/effective.hpp"

#include <fmt/format.h>

#include <charconv>

namespace tesserae::scenes {
namespace {

std::string list(const double* values, int count) {
    std::string text = "[";
    for (int i = 0; i < count; ++i) {
        if (i > 0) text += ", ";
        text += toml_text(values[i]);
    }
    return text + "]";
}

/// Which lines of an effective text are looked at.
enum class Lines {
    kAll,
    kMotion,  ///< those that decide how bodies move
    kLook,    ///< all but how long the scene lasts
    kNames,   ///< those that give bodies their names
};

/// Walks the lines of an effective text and knows in which table it is.
class Walker {
  public:
    Walker(std::string_view text, Lines lines) : rest_(text), lines_(lines) { next(); }

    bool at_end() const { return at_end_; }
    std::string_view line() const { return line_; }
    /// The key of a line "key = value"; empty for headers.
    std::string_view key() const { return before_equals(); }
    std::string_view value() const { return line_.substr(line_.find('=') + 2); }
    /// "render", "body 3 \"crate\"".
    std::string where() const {
        if (header_.empty()) return "the text";
        if (!header_.starts_with("[[")) return std::string(header_.substr(1, header_.size() - 2));
        std::string text = fmt::format("{} {}", header_.substr(2, header_.size() - 4), index_);
        return name_.empty() ? text : fmt::format("{} {}", text, name_);
    }

    void next() {
        do next_line();
        while (!at_end_ && !is_looked_at());
    }

  private:
    void next_line() {
        // A name is known to the lines after it, so that a changed name shows as a change.
        if (key() == "name") name_ = value();
        do {
            at_end_ = rest_.empty();
            const auto end = rest_.find('\n');
            line_ = rest_.substr(0, end);
            rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
        } while (line_.empty() && !at_end_);
        if (!line_.starts_with('[')) return;
        index_ = line_ == header_ ? index_ + 1 : 0;
        header_ = line_;
        name_ = {};
    }

    bool is_looked_at() const {
        const bool is_of_bodies = header_ == "[[body]]" || header_ == "[[lattice]]";
        switch (lines_) {
            case Lines::kAll:
                return true;
            case Lines::kMotion:
                if (header_ == "[physics]") return key() != "duration";
                if (header_ == "[[joint]]") return key() != "name";
                return is_of_bodies && key() != "name" && key() != "material" &&
                       key() != "visible" && key() != "hue_jitter";
            case Lines::kLook:
                return header_ != "[physics]" || key() != "duration";
            case Lines::kNames:
                return is_of_bodies && key() == "name";
        }
        return true;
    }

    std::string_view before_equals() const {
        const auto at = line_.find(" = ");
        if (line_.starts_with('[') || at == std::string_view::npos) return {};
        return line_.substr(0, at);
    }

    std::string_view rest_, line_, header_, name_;
    Lines lines_;
    std::size_t index_ = 0;
    bool at_end_ = false;
};

/// `a` has a key before what `b` goes on with: one that is written only where it is set.
bool has_one_more(Walker a, const Walker& b) {
    a.next();
    return a.key().empty() ? a.line() == b.line() : a.key() == b.key();
}

/// The first line in which two texts differ; empty if they are equal.
std::string difference(Walker a, Walker b) {
    while (!a.at_end() && !b.at_end() && a.line() == b.line()) a.next(), b.next();
    if (a.at_end() && b.at_end()) return {};
    const auto shown = [](const Walker& w) {
        return w.at_end() ? std::string("nothing") : printable(w.line());
    };
    if (!a.key().empty() && a.key() != b.key() && has_one_more(a, b))
        return fmt::format("{}: {} there, nothing here", a.where(), shown(a));
    if (!b.key().empty() && a.key() != b.key() && has_one_more(b, a))
        return fmt::format("{}: nothing there, {} here", b.where(), shown(b));
    if (a.at_end() || b.at_end() || a.key().empty() || a.key() != b.key())
        return fmt::format("{}: {} there, {} here", a.at_end() ? b.where() : a.where(), shown(a),
                           shown(b));
    return fmt::format("{}.{}: {} there, {} here", a.where(), a.key(), printable(a.value()),
                       printable(b.value()));
}

}  // namespace

std::string printable(std::string_view bytes, std::size_t limit) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        // Cut before a character, never inside one (UTF-8 continues with bytes 10xxxxxx).
        if (text.size() >= limit && (static_cast<unsigned char>(bytes[i]) & 0xc0) != 0x80)
            return text + "...";
        const char c = bytes[i];
        const auto code = static_cast<unsigned char>(c);
        if (c == '\n')
            text += "\\n";
        else if (c == '\t')
            text += "\\t";
        else if (c == '\r')
            text += "\\r";
        else if (code < 0x20 || code == 0x7f)
            text += fmt::format("\\u{:04X}", code);
        else
            text += c;
    }
    return text;
}

std::string toml_text(double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, result.ptr);
}

std::string toml_text(bool value) { return value ? "true" : "false"; }
std::string toml_text(const char* value) { return toml_text(std::string_view(value)); }

std::string toml_text(std::string_view value) {
    std::string text = "\"";
    for (char c : value) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            text += '\\', text += c;
        else if (code < 0x20 || code == 0x7f)
            text += fmt::format("\\u{:04X}", code);
        else
            text += c;
    }
    return text + "\"";
}

std::string toml_text(const Vec4& value) { return list(value.data(), 4); }
std::string toml_text(const Vec2& value) { return list(value.data(), 2); }
std::string toml_text(const std::array<std::int64_t, 2>& values) {
    return fmt::format("[{}, {}]", values[0], values[1]);
}

std::string toml_text(const std::vector<Vec4>& values) {
    std::string text = "[";
    for (const Vec4& value : values) text += (text.size() > 1 ? ", " : "") + toml_text(value);
    return text + "]";
}

std::string toml_text(RegularPolychoron which) {
    return toml_text(kRegularNames[static_cast<std::size_t>(which) - 1]);
}
std::string toml_text(const render::Color& value) { return list(value.data(), 3); }

std::string toml_text(const Bivector& b) {
    return fmt::format("{{ xy = {}, xz = {}, xw = {}, yz = {}, yw = {}, zw = {} }}",
                       toml_text(b.xy), toml_text(b.xz), toml_text(b.xw), toml_text(b.yz),
                       toml_text(b.yw), toml_text(b.zw));
}

void EffectiveWriter::table(std::string_view header) {
    const std::string_view gap = text_.empty() ? "" : "\n";
    text_.append(gap).append(header).append("\n");
}

void EffectiveWriter::line(std::string_view name, std::string_view value) {
    text_.append(name).append(" = ").append(value).append("\n");
}

std::string inline_table(const EffectiveWriter& lines) {
    std::string text = "{ ";
    for (const char c : lines.text()) text += c == '\n' ? std::string(", ") : std::string(1, c);
    if (text.ends_with(", ")) text.resize(text.size() - 2);
    return text + " }";
}

namespace {

std::string part_of(std::string_view effective, Lines lines) {
    std::string part;
    for (Walker at(effective, lines); !at.at_end(); at.next()) part.append(at.line()).append("\n");
    return part;
}

}  // namespace

std::string motion_part(std::string_view effective) { return part_of(effective, Lines::kMotion); }
std::string without_duration(std::string_view effective) {
    return part_of(effective, Lines::kLook);
}

std::string without_solver(std::string text) {
    const auto physics = text.find("[physics]\n");
    if (physics == std::string::npos) return text;
    const auto begin = text.find("\nsolver = ", physics);
    if (begin >= text.find("\n\n", physics)) return text;  // npos too
    return text.erase(begin, text.find('\n', begin + 1) - begin);
}

std::string with_solver(std::string effective) {
    const auto next = effective.find("\nintegrator = ", effective.find("[physics]\n"));
    if (next != std::string::npos) effective.insert(next, "\nsolver = \"impulse\"");
    return effective;
}

std::string first_difference(const std::string& there, const std::string& here) {
    return difference(Walker(there, Lines::kAll), Walker(here, Lines::kAll));
}

bool same_body_names(std::string_view there, std::string_view here) {
    return difference(Walker(there, Lines::kNames), Walker(here, Lines::kNames)).empty();
}

std::string first_motion_difference(const std::string& there, const std::string& here) {
    return difference(Walker(there, Lines::kMotion), Walker(here, Lines::kMotion));
}

}  // namespace tesserae::scenes
