// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/scene_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/process/memory.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::uint64_t kMaxFileBytes = 256'000'000;
constexpr std::size_t kMaxBodyTables = 1'000'000;
/// Dots of a key, nested arrays and inline tables. Real scenes have 3; the parser's stack holds
/// more than a thousand.
constexpr int kMaxDepth = 32;
/// Values (counted by their = and , signs) outside [[body]] and [[joint]] tables, and in one body.
/// The parser takes some 150 bytes for each, and its time grows with the square of the dotted keys
/// among them.
constexpr std::size_t kMaxRestValues = 400'000;
constexpr std::size_t kMaxRestKeys = 100'000;
constexpr std::size_t kMaxBodyValues = 4'000;
/// Joints are many and small. They are parsed with the rest, together.
constexpr std::size_t kMaxJointTables = 200'000;
constexpr std::size_t kMaxJointValues = 400, kMaxValuesOfJoints = 4'000'000;
/// Bodies parsed at a time: many enough to make a call's own cost small.
constexpr std::size_t kBodiesInPiece = 200;

[[noreturn]] void fail_with(const std::filesystem::path& file, const std::string& reason) {
    throw InputError(fmt::format("{}: {}", printable(file.string(), 400), reason));
}

/// Closes on every way out.
struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

/// Goes through a text once, token by token, keeping count of what the limits are about.
class Cutter {
  public:
    Cutter(std::string_view text, const std::string& place) : text_(text), place_(place) {}

    SceneText cut() {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
        while (at_ < text_.size()) statement();
        end_piece(text_.size());
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(std::size_t at, const std::string& what) const {
        throw InputError(
            fmt::format("{}:{}:{}: {}", place_, line_ + 1, at - line_start_ + 1, what));
    }

    /// One statement with its line break: header, key and value, comment, or nothing.
    void statement() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
        if (at_ < text_.size() && text_[at_] == '[') header();
        int depth = 0, dots = 0;
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '\n') {
                count_line();
                dots = 0;
                if (depth > 0) continue;
                ++at_;
                return;
            }
            if (c == '#')
                skip_comment();
            else if (c == '"' || c == '\'')
                skip_string(c);
            else if (c == '.')
                count_dot(++dots);
            else if (c == '[' || c == '{')
                count_level(++depth);
            else if (c == ']' || c == '}')
                depth = std::max(depth - 1, 0);
            else if (c == '=' || c == ',')
                count_value(c);
            if (c == '[' || c == '{' || c == ']' || c == '}' || c == '=' || c == ',') dots = 0;
        }
    }

    /// Leaves at_ on the last byte before the line break.
    void skip_comment() {
        while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
    }

    /// At a quote; leaves at_ on the string's last byte. A one-line string without an end stops
    /// before the line break: the parser will report it.
    void skip_string(char quote) {
        const char triple[] = {quote, quote, quote};
        const std::string_view three(triple, 3);
        const bool multi_line = text_.substr(at_, 3) == three;
        for (at_ += multi_line ? 3 : 1; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            const bool more = at_ + 1 < text_.size();
            if (c == '\\' && quote == '"' && more && text_[at_ + 1] != '\n') {
                ++at_;
            } else if (c == '\n' && multi_line) {
                count_line();
            } else if (c == '\n') {
                --at_;
                return;
            } else if (c == quote && !multi_line) {
                return;
            } else if (c == quote && text_.substr(at_, 3) == three) {
                at_ += 2;
                // Up to two more quotes belong to the string.
                for (int i = 0; i < 2 && text_.substr(at_ + 1, 1) == three.substr(0, 1); ++i) ++at_;
                return;
            }
        }
    }

    void count_line() {
        ++line_;
        line_start_ = at_ + 1;
    }

    void count_dot(int dots) const {
        if (dots > kMaxDepth) fail(at_, fmt::format("a key has more than {} dots", kMaxDepth));
    }

    void count_level(int depth) const {
        if (depth > kMaxDepth) fail(at_, fmt::format("nested deeper than {} levels", kMaxDepth));
    }

    void count_body_value() {
        if (++body_values_ > kMaxBodyValues)
            fail(at_, fmt::format("a body with more than {} values", kMaxBodyValues));
    }

    void count_joint_value() {
        if (++joint_values_ > kMaxJointValues)
            fail(at_, fmt::format("a joint with more than {} values", kMaxJointValues));
        if (++values_of_joints_ > kMaxValuesOfJoints)
            fail(at_, fmt::format("joints with more than {} values", kMaxValuesOfJoints));
    }

    void count_value(char sign) {
        if (in_bodies_) return count_body_value();
        if (in_joint_) return count_joint_value();
        if (sign == '=') ++rest_keys_;
        if (++rest_values_ > kMaxRestValues || rest_keys_ > kMaxRestKeys)
            fail(at_,
                 fmt::format("more than {} keys or {} values outside [[body]] and [[joint]] tables",
                             kMaxRestKeys, kMaxRestValues));
    }

    /// At a line that starts with '[' outside any value: decides to which piece the table belongs.
    void header() {
        std::string name;
        for (std::size_t i = at_; i < text_.size() && name.size() < 16; ++i) {
            const char c = text_[i];
            if (c == '\n' || c == '#') break;
            if (c != ' ' && c != '\t' && c != '\r' && c != '"' && c != '\'') name += c;
        }
        if (name == "[[body]]") {
            in_joint_ = false;
            if (++result_.body_count > kMaxBodyTables)
                fail(at_,
                     fmt::format("more than {} [[body]] tables; a [[lattice]] makes many alike",
                                 kMaxBodyTables));
            if (!in_bodies_ || bodies_in_piece_ == kBodiesInPiece) {
                end_piece(line_start_);
                in_bodies_ = true;
                bodies_in_piece_ = 0;
            }
            ++bodies_in_piece_;
            body_values_ = 0;
            return;
        }
        const bool of_a_body = name.starts_with("[body.") || name.starts_with("[[body.");
        if (in_bodies_ && of_a_body) return count_body_value();
        if (in_bodies_) end_piece(line_start_);
        in_bodies_ = false;
        if (name == "[[joint]]") {
            if (++joints_ > kMaxJointTables)
                fail(at_, fmt::format("more than {} [[joint]] tables", kMaxJointTables));
            in_joint_ = true;
            joint_values_ = 0;
            return;
        }
        in_joint_ = in_joint_ && (name.starts_with("[joint.") || name.starts_with("[[joint."));
        if (in_joint_) return count_joint_value();
        if (++rest_keys_ > kMaxRestKeys)
            fail(at_,
                 fmt::format("more than {} tables and keys outside [[body]] and [[joint]] tables",
                             kMaxRestKeys));
    }

    void end_piece(std::size_t end) {
        const std::string_view piece = text_.substr(piece_start_, end - piece_start_);
        if (in_bodies_) {
            result_.bodies.push_back({piece, piece_line_});
            result_.rest.append(line_ - piece_line_, '\n');
        } else {
            result_.rest.append(piece);
        }
        piece_start_ = end;
        piece_line_ = line_;
    }

    std::string_view text_;
    const std::string& place_;
    SceneText result_;
    std::size_t at_ = 0, line_ = 0, line_start_ = 0;  ///< byte; lines from 0
    bool in_bodies_ = false, in_joint_ = false;
    std::size_t piece_start_ = 0, piece_line_ = 0, bodies_in_piece_ = 0;
    std::size_t body_values_ = 0, rest_values_ = 0, rest_keys_ = 0;
    std::size_t joints_ = 0, joint_values_ = 0, values_of_joints_ = 0;
};

}  // namespace

std::string read_scene_file(const std::filesystem::path& file) {
    // Not blocking, so that opening a fifo without a writer returns.
    const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
    if (descriptor.number < 0)
        fail_with(file, fmt::format("cannot be read: {}", std::strerror(errno)));
    struct stat status = {};
    if (::fstat(descriptor.number, &status) != 0)
        fail_with(file, fmt::format("cannot be read: {}", std::strerror(errno)));
    if (S_ISDIR(status.st_mode)) fail_with(file, "is a folder; expected a scene file (TOML)");
    if (!S_ISREG(status.st_mode)) fail_with(file, "is not a regular file; expected a scene file");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > kMaxFileBytes)
        fail_with(file,
                  fmt::format("has {} bytes; a scene file has at most {}", size, kMaxFileBytes));
    // The text, its pieces with their tables, and the effective text.
    constexpr std::uint64_t kCopies = 6;
    if (kCopies * size > available_memory())
        fail_with(file, fmt::format("reading it takes about {} bytes of memory, {} are free",
                                    kCopies * size, available_memory()));

    std::string text(size, '\0');
    std::size_t got = 0;
    while (got < size) {
        const ssize_t n = ::read(descriptor.number, text.data() + got, size - got);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail_with(file, fmt::format("cannot be read: {}", std::strerror(errno)));
        if (n == 0) break;  // became shorter meanwhile
        got += static_cast<std::size_t>(n);
    }
    text.resize(got);
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        fail_with(file, "is UTF-16 text; save it as UTF-8");
    if (const auto nul = text.find('\0'); nul != std::string::npos)
        fail_with(file,
                  fmt::format("is not text: byte {} is zero; expected a scene file (TOML)", nul));
    return text;
}

SceneText cut_scene_text(std::string_view text, const std::string& place) {
    return Cutter(text, place).cut();
}

}  // namespace tesserae::scenes
