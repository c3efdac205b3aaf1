// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/key.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/toml_reader.hpp"

// Every table of a scene file has one list of its keys (picture_keys.hpp, body_keys.hpp): a
// function that calls visit(key, value, rule) for each. ReadKeys fills the values from a table of
// the file, WriteKeys makes its canonical text, DescribeKeys (reference.cpp) the reference: no key
// can be read and not written or not explained.
//
// A rule says what a value must be: Rule or Interval for reals, none where the type says all, or
// one of these, with functions of its own for how a key is read, written, or both:
//   rule.read(TableReader&, key, value&)         leaves the value where the key is absent
//   rule.write(EffectiveWriter&, key, value)     may write nothing
// Such a rule says in words what it takes: kAllowed and, where the value's type does not tell,
// kType; or it has `names`, `flags`, `interval` or `range`.
namespace tesserae::scenes {

/// Reads the keys of a list from a table. Errors are told by the table's finish().
struct ReadKeys {
    TableReader& reader;

    void operator()(const Key& key, auto& value) const {
        reader.collect([&] { reader.read(key.name, value); });
    }
    void operator()(const Key& key, auto& value, const auto& rule) const {
        reader.collect([&] {
            if constexpr (requires { rule.read(reader, key, value); })
                rule.read(reader, key, value);
            else if constexpr (requires { rule.read(reader, key.name, value); })
                rule.read(reader, key.name, value);
            else
                reader.read(key.name, value, rule);
        });
    }
    /// A key without a default.
    template <class T>
    void operator()(const Key& key, std::optional<T>& value, const auto& rule) const {
        if (reader.has(key.name)) (*this)(key, value.emplace(), rule);
    }
};

/// Writes the keys of a list.
struct WriteKeys {
    EffectiveWriter& out;

    void operator()(const Key& key, const auto& value) const { out.key(key.name, value); }
    void operator()(const Key& key, const auto& value, const auto& rule) const {
        if constexpr (requires { rule.write(out, key, value); })
            rule.write(out, key, value);
        else if constexpr (requires { rule.write(out, key.name, value); })
            rule.write(out, key.name, value);
        else
            out.key(key.name, value);
    }
    template <class T>
    void operator()(const Key& key, const std::optional<T>& value, const auto& rule) const {
        if (value) (*this)(key, *value, rule);
    }
};

/// Not written where it has its default: a key that is younger than scenes whose hashes stay.
struct RealOrUnwritten {
    Interval interval;
    double unwritten = 0;
    void read(TableReader& reader, const char* key, double& value) const {
        reader.read(key, value, interval);
    }
    void write(EffectiveWriter& out, const char* key, double value) const {
        if (value != unwritten) out.key(key, value);
    }
};

/// The same for colours, integers and switches.
struct ColorOrUnwritten {
    Interval interval;
    render::Color unwritten;
    void read(TableReader& reader, const char* key, render::Color& value) const {
        reader.read(key, value, interval);
    }
    void write(EffectiveWriter& out, const char* key, const render::Color& value) const {
        if ((value != unwritten).any()) out.key(key, value);
    }
};
struct IntegerOrUnwritten {
    IntegerRange range;
    std::int64_t unwritten = 0;
    void read(TableReader& reader, const char* key, std::integral auto& value) const {
        reader.read(key, value, range);
    }
    void write(EffectiveWriter& out, const char* key, std::integral auto value) const {
        if (static_cast<std::int64_t>(value) != unwritten) out.key(key, value);
    }
};
struct FalseOrUnwritten {
    static constexpr const char* kAllowed = "";

    void read(TableReader& reader, const char* key, bool& value) const { reader.read(key, value); }
    void write(EffectiveWriter& out, const char* key, bool value) const {
        if (value) out.key(key, value);
    }
};

/// A value of an enumeration; the names are in its order.
struct Names {
    std::span<const std::string_view> names;

    void read(TableReader& reader, const char* key, auto& value) const {
        auto index = static_cast<std::size_t>(value);
        reader.read(key, index, names);
        value = static_cast<std::remove_reference_t<decltype(value)>>(index);
    }
    void write(EffectiveWriter& out, const char* key, auto value) const {
        out.key(key, names[static_cast<std::size_t>(value)]);
    }
};

/// The first is not written: see RealOrUnwritten.
struct NamesOrUnwritten : Names {
    void write(EffectiveWriter& out, const char* key, auto value) const {
        if (static_cast<std::size_t>(value) != 0) Names::write(out, key, value);
    }
};

/// The name of a body. Whether there is one is seen once all bodies are there.
struct BodyName {
    static constexpr const char* kAllowed = "name of a body; of a lattice NAME.N";

    void read(TableReader& reader, const char* key, std::string& name) const {
        if (reader.read(key, name) && name.empty()) reader.fail(key, "expected a body's name");
    }
    void write(EffectiveWriter& out, const char* key, const std::string& name) const {
        if (!name.empty()) out.key(key, name);
    }
};

template <class T>
struct Flag {
    std::string_view name;
    bool T::*member;
};
/// The names of those flags that are set.
template <class T>
struct Flags {
    std::span<const Flag<T>> flags;
    const char* if_none = nullptr;  ///< the error of an empty list, if it is one

    void read(TableReader& reader, const char* key, T& value) const {
        if (!reader.has(key)) return;
        std::vector<std::string> given;
        std::vector<std::string_view> allowed;
        for (const auto& [name, member] : flags) allowed.push_back(name);
        reader.read(key, given, allowed);
        if (given.empty() && if_none != nullptr) reader.fail(key, if_none);
        for (const auto& [name, member] : flags)
            value.*member = std::find(given.begin(), given.end(), name) != given.end();
    }
    void write(EffectiveWriter& out, const char* key, const T& value) const {
        std::string text;
        for (const auto& [name, member] : flags)
            if (value.*member) text += (text.empty() ? "" : ", ") + toml_text(name);
        out.line(key, "[" + text + "]");
    }
};

/// A key that must be there.
template <class R>
struct Required {
    const char* expected;
    R rule;

    void read(TableReader& reader, const Key& key, auto& value) const {
        if (reader.require(key.name, expected)) ReadKeys{reader}(key, value, rule);
    }
    void write(EffectiveWriter& out, const Key& key, const auto& value) const {
        WriteKeys{out}(key, value, rule);
    }
};
// Until clang 17 guesses it.
template <class R>
Required(const char*, R) -> Required<R>;

}  // namespace tesserae::scenes
