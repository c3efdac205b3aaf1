// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tesserae {

/// Some of the islands that are solved side by side, by their places among them: a bit each.
class Members {
  public:
    static constexpr int kMost = 16;

    constexpr Members() = default;
    /// Returns the first `count` islands.
    static constexpr Members first(int count) { return Members((std::uint32_t{1} << count) - 1); }
    static constexpr Members only(int member) { return Members(std::uint32_t{1} << member); }

    constexpr bool any() const { return bits_ != 0; }
    constexpr bool has(int member) const { return (bits_ >> member & 1) != 0; }
    constexpr bool has_all(Members others) const { return (others - *this).bits_ == 0; }
    /// Returns those for which the condition holds.
    template <class Condition>
    constexpr Members where(const Condition& condition) const {
        Members some;
        for (const int member : *this)
            if (condition(member)) some = some | only(member);
        return some;
    }

    friend constexpr Members operator|(Members a, Members b) { return Members(a.bits_ | b.bits_); }
    friend constexpr Members operator&(Members a, Members b) { return Members(a.bits_ & b.bits_); }
    friend constexpr Members operator-(Members a, Members b) { return Members(a.bits_ & ~b.bits_); }
    friend constexpr bool operator==(Members, Members) = default;

    class Iterator {
      public:
        constexpr explicit Iterator(std::uint32_t bits) : bits_(bits) {}
        constexpr int operator*() const { return std::countr_zero(bits_); }
        constexpr Iterator& operator++() {
            bits_ &= bits_ - 1;
            return *this;
        }
        friend constexpr bool operator==(Iterator, Iterator) = default;

      private:
        std::uint32_t bits_;
    };
    constexpr Iterator begin() const { return Iterator(bits_); }
    constexpr Iterator end() const { return Iterator(0); }

  private:
    constexpr explicit Members(std::uint32_t bits) : bits_(bits) {}

    std::uint32_t bits_ = 0;
};

/// One item for each of the islands that are solved side by side.
template <class T>
class PerMember {
  public:
    constexpr T& operator[](std::size_t member) { return items_[member]; }
    constexpr const T& operator[](std::size_t member) const { return items_[member]; }
    constexpr T& operator[](int member) { return items_[static_cast<std::size_t>(member)]; }
    constexpr const T& operator[](int member) const {
        return items_[static_cast<std::size_t>(member)];
    }
    constexpr void fill(const T& item) { items_.fill(item); }

  private:
    std::array<T, Members::kMost> items_ = {};
};

}  // namespace tesserae
