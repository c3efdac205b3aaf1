// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/algebra/bivector.hpp"
#include "core/ranges.hpp"
#include "core/shape/room.hpp"
#include "render/description.hpp"
#include "scenes/load/error_list.hpp"
#include "scenes/load/toml_declarations.hpp"

namespace tesserae::scenes {

/// A closed interval that a real must lie in.
struct Interval {
    double low = -kLargest, high = kLargest;
    bool low_open = false, high_open = false;
};
Interval interval_of(Rule rule);
/// The same of an integer.
struct IntegerRange {
    std::int64_t low = 0, high = std::numeric_limits<std::int64_t>::max();
};

/// Where a piece of TOML text stands: file or "--set KEY=VALUE".
struct Origin {
    std::string place;
    std::size_t lines_before = 0;
};

/// A parsed piece of text. Depth and size of the text must have been checked.
class TomlDocument {
  public:
    /// @throws InputError   place:line:column: why it is not TOML
    TomlDocument(std::string_view text, Origin origin);
    ~TomlDocument();
    TomlDocument(const TomlDocument&) = delete;
    TomlDocument& operator=(const TomlDocument&) = delete;

    toml::table& root() { return *root_; }
    bool is_empty() const;
    const Origin& origin() const { return origin_; }

  private:
    Origin origin_;
    std::unique_ptr<toml::table> root_;
};

/// Reads one table's keys and knows which were asked for. Every function throws InputError:
/// `file:line:column: subject: key = VALUE: what was expected`; collect() keeps it for finish().
/// Keys that are absent leave the value as it was and return false.
class TableReader {
  public:
    /// @param subject   names the table in errors: "[physics]", "body 3 \"crate\""
    TableReader(const toml::table& table, const Origin& origin, std::string subject)
        : table_(table), origin_(origin), subject_(std::move(subject)) {}

    bool has(std::string_view key);
    /// Like `has`, and makes absence an error at the end, after misspelt keys had their say.
    bool require(std::string_view key, std::string_view expected);

    bool read(std::string_view key, double& value, Interval interval);
    bool read(std::string_view key, Vec4& value, Rule rule);
    bool read(std::string_view key, Vec2& value, Rule rule);
    bool read(std::string_view key, double& value, Rule rule);
    /// An array of points.
    bool read(std::string_view key, std::vector<Vec4>& values);
    bool read(std::string_view key, render::Color& value, Interval interval);
    /// @param example   what the error of a wrong type shows
    bool read(std::string_view key, Bivector& value, const char* example);
    /// One, or an array of them.
    bool read(std::string_view key, std::vector<Bivector>& values, const char* example);
    bool read(std::string_view key, bool& value);
    bool read(std::string_view key, std::string& value);
    bool read(std::string_view key, std::int64_t& value, IntegerRange range);
    bool read(std::string_view key, std::integral auto& value, IntegerRange range) {
        auto wide = static_cast<std::int64_t>(value);
        const bool is_given = read(key, wide, range);
        value = static_cast<std::remove_reference_t<decltype(value)>>(wide);
        return is_given;
    }
    /// The sides of polygons.
    bool read(std::string_view key, std::array<std::int64_t, 2>& values, Rule rule);
    /// An array of exactly so many integers.
    bool read(std::string_view key, std::span<std::int64_t> values, IntegerRange range);
    /// @param allowed   empty: any
    bool read(std::string_view key, std::vector<std::string>& values,
              std::span<const std::string_view> allowed);
    /// One of the names; the value is its index.
    bool read(std::string_view key, std::size_t& value, std::span<const std::string_view> names);
    bool is_array(std::string_view key);

    /// Has `work` read the keys of the table that a key holds.
    /// @param example   what the error of a wrong type shows
    template <class Work>
    bool read_inside(std::string_view key, const char* example, const Work& work) {
        const toml::table* const inner = inner_table(key, example);
        if (inner == nullptr) return false;
        TableReader reader(*inner, origin_, subject_ + ": " + std::string(key));
        work(reader);
        reader.finish();
        return true;
    }

    /// The subtable of that name, if there is one.
    const toml::table* table(std::string_view key);
    /// The tables of an array of tables, in file order.
    std::vector<const toml::table*> tables(std::string_view key);

    [[noreturn]] void fail(std::string_view key, std::string_view what);
    [[noreturn]] void fail_here(std::string_view what) const;
    /// What fail() would say; empty where the key is absent.
    std::string remark(std::string_view key, std::string_view what);
    /// Runs `work`; its InputError is thrown by finish(), with all others of the table.
    template <class Work>
    void collect(const Work& work) {
        errors_.collect(work);
    }
    bool has_errors() const { return !errors_.is_empty(); }
    /// Refuses unknown keys, or else missing ones, and tells what was collected.
    void finish();

  private:
    const toml::node* find(std::string_view key);
    const toml::table* inner_table(std::string_view key, const char* example);
    std::string what_of(const toml::node& node, std::string_view key, std::string_view what) const;
    std::string text_at(const toml::node& node, std::string_view key, std::string_view what) const;
    PlacedError unknown_key(const toml::key& key, const toml::node& node) const;
    [[noreturn]] void fail_at(const toml::node& node, std::string_view key,
                              std::string_view what) const;
    double real_of(const toml::node& node, std::string_view key, Interval interval,
                   std::string_view expected) const;
    std::int64_t integer_of(const toml::node& node, std::string_view key, IntegerRange range) const;
    std::string text_of(const toml::node& node, std::string_view key) const;
    void require_known(std::string_view word, const toml::node& node, std::string_view key,
                       std::span<const std::string_view> names) const;
    const toml::array& array_of(const toml::node& node, std::string_view key, std::size_t count,
                                std::string_view expected) const;
    void read_array(const toml::node& node, std::string_view key, double* values, std::size_t count,
                    Interval interval) const;
    bool read_reals(std::string_view key, double* values, std::size_t count, Interval interval);
    void read_planes(const toml::node& node, std::string_view key, Bivector& value,
                     const char* example) const;

    const toml::table& table_;
    const Origin& origin_;
    std::string subject_;
    std::vector<std::string_view> known_;
    std::vector<std::string> missing_;
    ErrorList errors_;
};

}  // namespace tesserae::scenes
