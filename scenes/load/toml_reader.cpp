// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/toml_reader.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/load/syntax_hint.hpp"

namespace tesserae::scenes {
namespace {

/// "file:line:column", or the --set that a value came from.
std::string place_of(const toml::source_region& region, const Origin& origin) {
    if (region.path) return *region.path;
    if (!region.begin) return origin.place;
    return fmt::format("{}:{}:{}", origin.place, region.begin.line + origin.lines_before,
                       region.begin.column);
}

/// An error with the place that it names.
PlacedError error_at(const toml::source_region& region, const Origin& origin,
                     const std::string& what) {
    const bool is_placed = !region.path && region.begin;
    constexpr auto kNowhere = std::numeric_limits<std::size_t>::max();
    return {fmt::format("{}: {}", place_of(region, origin), what),
            is_placed ? region.begin.line + origin.lines_before : kNowhere,
            is_placed ? region.begin.column : kNowhere};
}

void append_value(std::string& out, const toml::node& node, std::size_t limit) {
    if (out.size() > limit) return;
    if (const auto* array = node.as_array()) {
        out += '[';
        for (const auto& element : *array) {
            if (out.back() != '[') out += ", ";
            if (out.size() > limit) return;
            append_value(out, element, limit);
        }
        out += ']';
    } else if (const auto* table = node.as_table()) {
        out += "{ ";
        for (const auto& [key, value] : *table) {
            if (out.size() > limit) return;
            if (out.back() != ' ' || out.size() > 2) out += out.ends_with("{ ") ? "" : ", ";
            out += std::string(key.str()) + " = ";
            append_value(out, value, limit);
        }
        out += " }";
    } else if (const auto* text = node.as_string()) {
        out += toml_text(std::string_view(text->get()).substr(0, 2 * limit));
    } else if (const auto* integer = node.as_integer()) {
        out += toml_text(integer->get());
    } else if (const auto* real = node.as_floating_point()) {
        out += toml_text(real->get());
    } else if (const auto* flag = node.as_boolean()) {
        out += toml_text(flag->get());
    } else {
        out += "a date or time";
    }
}

std::string shown(const toml::node& node) {
    constexpr std::size_t kLimit = 60;
    std::string text;
    append_value(text, node, kLimit);
    return printable(text, kLimit);
}

std::string listed(std::span<const std::string_view> names) {
    std::string text;
    for (std::string_view name : names)
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
    return text;
}

std::string expected_text(Interval i) {
    const bool low = i.low != -kLargest, high = i.high != kLargest;
    const std::string at_least =
        i.low == kSmallest ? "> 0"
                           : fmt::format("{} {}", i.low_open ? ">" : ">=", toml_text(i.low));
    const std::string at_most = fmt::format("{} {}", i.high_open ? "<" : "<=", toml_text(i.high));
    if (low && high) return fmt::format("expected a number {} and {}", at_least, at_most);
    if (low) return fmt::format("expected a finite number {}", at_least);
    if (high) return fmt::format("expected a finite number {}", at_most);
    return "expected a finite number";
}

bool is_inside(double value, Interval i) {
    // False for NaN.
    return (i.low_open ? value > i.low : value >= i.low) &&
           (i.high_open ? value < i.high : value <= i.high);
}

}  // namespace

Interval interval_of(Rule rule) {
    if (rule == Rule::kPositive) return {kSmallest, kLargest};
    if (rule == Rule::kNonNegative) return {0, kLargest};
    return {};
}

TomlDocument::TomlDocument(std::string_view text, Origin origin) : origin_(std::move(origin)) {
    try {
        root_ = std::make_unique<toml::table>(toml::parse(text));
    } catch (const toml::parse_error& error) {
        throw error_at(error.source(), origin_,
                       fmt::format("not valid TOML: {}{}", printable(error.description(), 300),
                                   syntax_hint(error.description(), error.source().begin.line,
                                               error.source().begin.column, text)));
    }
}

TomlDocument::~TomlDocument() = default;

bool TomlDocument::is_empty() const { return root_->empty(); }

const toml::node* TableReader::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
    return table_.get(key);
}

bool TableReader::has(std::string_view key) { return find(key) != nullptr; }

bool TableReader::require(std::string_view key, std::string_view expected) {
    if (has(key)) return true;
    missing_.push_back(fmt::format("{} is missing; {}", key, expected));
    return false;
}

std::string TableReader::what_of(const toml::node& node, std::string_view key,
                                 std::string_view what) const {
    return fmt::format("{}: {} = {}: {}", subject_, printable(key), shown(node), what);
}

std::string TableReader::text_at(const toml::node& node, std::string_view key,
                                 std::string_view what) const {
    return fmt::format("{}: {}", place_of(node.source(), origin_), what_of(node, key, what));
}

void TableReader::fail_at(const toml::node& node, std::string_view key,
                          std::string_view what) const {
    throw error_at(node.source(), origin_, what_of(node, key, what));
}

std::string TableReader::remark(std::string_view key, std::string_view what) {
    const toml::node* node = find(key);
    return node == nullptr ? std::string() : text_at(*node, key, what);
}

void TableReader::fail(std::string_view key, std::string_view what) {
    const toml::node* node = find(key);
    if (node == nullptr) fail_here(fmt::format("{}: {}", key, what));
    fail_at(*node, key, what);
}

void TableReader::fail_here(std::string_view what) const {
    throw error_at(table_.source(), origin_, fmt::format("{}: {}", subject_, what));
}

PlacedError TableReader::unknown_key(const toml::key& key, const toml::node& node) const {
    std::string hint = did_you_mean(key.str(), known_);
    if (key == "key" && node.is_array_of_tables())
        hint = "; only the camera moves by keys, a body that is fixed moves at its velocity";
    if (hint.empty()) {
        hint = "; known here:";
        for (std::string_view name : known_) hint += fmt::format(" {}", name);
    }
    // A key from --set stands where its value does.
    return error_at(
        node.source().path ? node.source() : key.source(), origin_,
        what_of(node, key.str(),
                fmt::format("unknown {}{}",
                            node.is_table() || node.is_array_of_tables() ? "table" : "key", hint)));
}

void TableReader::finish() {
    bool is_known = true;
    for (const auto& [key, node] : table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
        is_known = false;
        errors_.add(unknown_key(key, node));
    }
    // Where a key is misspelt, what is missing is there.
    if (is_known)
        for (const std::string& missing : missing_) collect([&] { fail_here(missing); });
    errors_.require_none();
}

double TableReader::real_of(const toml::node& node, std::string_view key, Interval interval,
                            std::string_view expected) const {
    double value = 0;
    if (const auto* real = node.as_floating_point())
        value = real->get();
    else if (const auto* integer = node.as_integer())
        value = static_cast<double>(integer->get());
    else
        fail_at(node, key, fmt::format("wrong type; {}", expected));
    if (!is_inside(value, interval)) {
        const bool too_large =
            std::isfinite(value) && std::abs(value) > kLargest && interval.high == kLargest;
        const bool too_small = value > 0 && value < kSmallest && interval.low == kSmallest;
        fail_at(node, key,
                too_large   ? fmt::format("{}, at most {} in size", expected, toml_text(kLargest))
                : too_small ? fmt::format("{}, at least {}", expected, toml_text(kSmallest))
                            : std::string(expected));
    }
    return value + 0.0;  // -0 becomes 0: the same scene, the same bits
}

std::int64_t TableReader::integer_of(const toml::node& node, std::string_view key,
                                     IntegerRange range) const {
    const std::string expected =
        range.high == IntegerRange{}.high
            ? fmt::format("expected an integer >= {}", range.low)
            : fmt::format("expected an integer from {} to {}", range.low, range.high);
    const auto* integer = node.as_integer();
    if (integer == nullptr) fail_at(node, key, fmt::format("wrong type; {}", expected));
    if (integer->get() < range.low || integer->get() > range.high) fail_at(node, key, expected);
    return integer->get();
}

std::string TableReader::text_of(const toml::node& node, std::string_view key) const {
    const auto* text = node.as_string();
    if (text == nullptr) fail_at(node, key, "wrong type; expected a string");
    return text->get();
}

void TableReader::require_known(std::string_view word, const toml::node& node, std::string_view key,
                                std::span<const std::string_view> names) const {
    if (std::find(names.begin(), names.end(), word) != names.end()) return;
    fail_at(node, key,
            fmt::format("expected {}{}{}", names.size() > 1 ? "one of " : "", listed(names),
                        did_you_mean(word, names)));
}

const toml::array& TableReader::array_of(const toml::node& node, std::string_view key,
                                         std::size_t count, std::string_view expected) const {
    const auto* array = node.as_array();
    if (array == nullptr) fail_at(node, key, fmt::format("wrong type; {}", expected));
    if (array->size() != count)
        fail_at(node, key, fmt::format("has {} values; {}", array->size(), expected));
    return *array;
}

bool TableReader::read(std::string_view key, double& value, Interval interval) {
    const toml::node* node = find(key);
    if (node != nullptr) value = real_of(*node, key, interval, expected_text(interval));
    return node != nullptr;
}

bool TableReader::read(std::string_view key, double& value, Rule rule) {
    return read(key, value, interval_of(rule));
}

bool TableReader::read_reals(std::string_view key, double* values, std::size_t count,
                             Interval interval) {
    const toml::node* node = find(key);
    if (node != nullptr) read_array(*node, key, values, count, interval);
    return node != nullptr;
}

void TableReader::read_array(const toml::node& node, std::string_view key, double* values,
                             std::size_t count, Interval interval) const {
    const auto& array =
        array_of(node, key, count, fmt::format("expected an array of {} numbers", count));
    for (std::size_t i = 0; i < count; ++i)
        values[i] = real_of(*array.get(i), fmt::format("{}[{}]", key, i), interval,
                            expected_text(interval));
}

bool TableReader::read(std::string_view key, Vec4& value, Rule rule) {
    if (!read_reals(key, value.data(), 4, interval_of(rule))) return false;
    if (rule == Rule::kNonZero && value.cwiseAbs().maxCoeff() < kSmallest)
        fail(key, "expected a direction, not zero");
    return true;
}

bool TableReader::read(std::string_view key, Vec2& value, Rule rule) {
    return read_reals(key, value.data(), 2, interval_of(rule));
}

bool TableReader::read(std::string_view key, std::array<std::int64_t, 2>& values, Rule rule) {
    TSR_ASSERT(rule == Rule::kSides);
    return read(key, std::span<std::int64_t>(values), IntegerRange{3, 1'000'000});
}

bool TableReader::read(std::string_view key, std::vector<Vec4>& values) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* array = node->as_array();
    if (array == nullptr)
        fail_at(*node, key, "wrong type; expected an array of points, four numbers each");
    values.resize(array->size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string name = fmt::format("{}[{}]", key, i);
        read_array(*array->get(i), name, values[i].data(), 4, Interval{});
    }
    return true;
}

bool TableReader::read(std::string_view key, render::Color& value, Interval interval) {
    return read_reals(key, value.data(), 3, interval);
}

void TableReader::read_planes(const toml::node& node, std::string_view key, Bivector& value,
                              const char* example) const {
    constexpr std::array<std::string_view, 6> kPlanes = {"xy", "xz", "xw", "yz", "yw", "zw"};
    const std::array<double*, 6> parts = {&value.xy, &value.xz, &value.xw,
                                          &value.yz, &value.yw, &value.zw};
    const auto* table = node.as_table();
    if (table == nullptr)
        fail_at(node, key,
                fmt::format("wrong type; expected a table of planes such as {}", example));
    TableReader planes(*table, origin_, fmt::format("{}: {}", subject_, key));
    for (std::size_t i = 0; i < kPlanes.size(); ++i)
        planes.collect([&] { planes.read(kPlanes[i], *parts[i], Interval{}); });
    planes.finish();
}

bool TableReader::read(std::string_view key, Bivector& value, const char* example) {
    const toml::node* node = find(key);
    if (node != nullptr) read_planes(*node, key, value, example);
    return node != nullptr;
}

bool TableReader::read(std::string_view key, std::vector<Bivector>& values, const char* example) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* array = node->as_array();
    if (array != nullptr && array->empty()) fail_at(*node, key, "expected at least one turn");
    values.assign(array == nullptr ? 1 : array->size(), Bivector());
    if (array == nullptr) read_planes(*node, key, values.front(), example);
    for (std::size_t i = 0; array != nullptr && i < values.size(); ++i)
        collect([&] {
            read_planes(*array->get(i), fmt::format("{}[{}]", key, i), values[i], example);
        });
    return true;
}

bool TableReader::read(std::string_view key, bool& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* flag = node->as_boolean();
    if (flag == nullptr) fail_at(*node, key, "wrong type; expected true or false");
    value = flag->get();
    return true;
}

bool TableReader::read(std::string_view key, std::string& value) {
    const toml::node* node = find(key);
    if (node != nullptr) value = text_of(*node, key);
    return node != nullptr;
}

bool TableReader::read(std::string_view key, std::int64_t& value, IntegerRange range) {
    const toml::node* node = find(key);
    if (node != nullptr) value = integer_of(*node, key, range);
    return node != nullptr;
}

bool TableReader::read(std::string_view key, std::span<std::int64_t> values, IntegerRange range) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto& array = array_of(*node, key, values.size(),
                                 fmt::format("expected an array of {} integers", values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = integer_of(*array.get(i), fmt::format("{}[{}]", key, i), range);
    return true;
}

bool TableReader::read(std::string_view key, std::vector<std::string>& values,
                       std::span<const std::string_view> allowed) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* array = node->as_array();
    if (array == nullptr)
        fail_at(*node, key,
                fmt::format("wrong type; expected an array of {}",
                            allowed.empty() ? "strings" : listed(allowed)));
    values.clear();
    for (std::size_t i = 0; i < array->size(); ++i) {
        const std::string element = fmt::format("{}[{}]", key, i);
        values.push_back(text_of(*array->get(i), element));
        if (!allowed.empty()) require_known(values.back(), *array->get(i), element, allowed);
        if (std::find(values.begin(), values.end() - 1, values.back()) != values.end() - 1)
            fail_at(*array->get(i), element, "is listed twice");
    }
    return true;
}

bool TableReader::read(std::string_view key, std::size_t& value,
                       std::span<const std::string_view> names) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const std::string word = text_of(*node, key);
    require_known(word, *node, key, names);
    value = static_cast<std::size_t>(std::find(names.begin(), names.end(), word) - names.begin());
    return true;
}

bool TableReader::is_array(std::string_view key) {
    const toml::node* node = find(key);
    return node != nullptr && node->is_array();
}

const toml::table* TableReader::inner_table(std::string_view key, const char* example) {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    const auto* table = node->as_table();
    if (table == nullptr)
        fail_at(*node, key, fmt::format("wrong type; expected a table such as {}", example));
    return table;
}

const toml::table* TableReader::table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    const auto* table = node->as_table();
    if (table == nullptr) fail_at(*node, key, fmt::format("expected one table, [{}]", key));
    return table;
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) {
    std::vector<const toml::table*> all;
    const toml::node* node = find(key);
    if (node == nullptr) return all;
    const std::string expected =
        fmt::format("expected an array of tables, [[{}{}]]", key == "key" ? "camera." : "", key);
    const auto* array = node->as_array();
    if (array == nullptr) fail_at(*node, key, expected);
    for (std::size_t i = 0; i < array->size(); ++i) {
        const toml::node& element = *array->get(i);
        if (element.is_table())
            all.push_back(element.as_table());
        else
            collect([&] { fail_at(element, fmt::format("{}[{}]", key, i), expected); });
    }
    return all;
}

}  // namespace tesserae::scenes
