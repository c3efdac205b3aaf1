// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/error.hpp"

// Values as bytes, lowest byte first. One text lists what is written and read: it calls an archive,
// a ByteWriter or a ByteReader, with each member.
namespace tesserae {

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends values to bytes.
class ByteWriter {
  public:
    static constexpr bool kReads = false;

    explicit ByteWriter(std::string& bytes) : bytes_(bytes) {}

    template <PlainNumber T>
    void operator()(const T& value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof value);
        bytes_.append(raw, sizeof raw);
    }
    std::size_t count(std::size_t items) {
        (*this)(static_cast<std::uint64_t>(items));
        return items;
    }

  private:
    std::string& bytes_;
};

/// Takes values from the front of bytes.
class ByteReader {
  public:
    static constexpr bool kReads = true;

    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    /// @throws InputError   the bytes have ended
    template <PlainNumber T>
    void operator()(T& value) {
        if (bytes_.size() < sizeof(T)) throw InputError("world: the bytes end too early");
        if constexpr (std::is_same_v<T, bool>)
            value = bytes_[0] != 0;
        else
            std::memcpy(&value, bytes_.data(), sizeof(T));
        bytes_.remove_prefix(sizeof(T));
    }
    /// Returns the number of items that follow, of at least one byte each.
    std::size_t count(std::size_t) {
        std::uint64_t items = 0;
        (*this)(items);
        if (items > bytes_.size()) throw InputError("world: the bytes end too early");
        return items;
    }
    bool is_at_end() const { return bytes_.empty(); }

  private:
    std::string_view bytes_;
};

template <class Archive, int kSize, int kOptions>
void archive(Archive& of, Eigen::Matrix<double, kSize, 1, kOptions>& v) {
    for (int i = 0; i < kSize; ++i) of(v[i]);
}
template <class Archive>
void archive(Archive& of, Bivector& b) {
    for (double* part : {&b.xy, &b.xz, &b.xw, &b.yz, &b.yw, &b.zw}) of(*part);
}
template <class Archive>
void archive(Archive& of, Rotor& r) {
    of(r.s), archive(of, r.b), of(r.p);
}
template <class Archive, PlainNumber T>
void archive(Archive& of, T& value) {
    of(value);
}
template <class Archive, class T, std::size_t kSize>
void archive(Archive& of, std::array<T, kSize>& items) {
    for (T& item : items) archive(of, item);
}
/// The list grows item by item: a false count takes no memory.
template <class Archive, class T>
void archive(Archive& of, std::vector<T>& items) {
    const std::size_t count = of.count(items.size());
    if constexpr (Archive::kReads) items.clear();
    for (std::size_t i = 0; i < count; ++i) {
        if constexpr (Archive::kReads) items.emplace_back();
        archive(of, items[i]);
    }
}
/// The alternative's number, and its value.
template <class Archive, class... Alternatives>
void archive(Archive& of, std::variant<Alternatives...>& value) {
    auto index = static_cast<std::uint8_t>(value.index());
    of(index);
    if constexpr (Archive::kReads) {
        if (index >= sizeof...(Alternatives)) throw InputError("world: the bytes are damaged");
        std::uint8_t i = 0;
        (void)((i++ == index ? (value.template emplace<Alternatives>(), true) : false) || ...);
    }
    std::visit([&](auto& alternative) { archive(of, alternative); }, value);
}

}  // namespace tesserae
