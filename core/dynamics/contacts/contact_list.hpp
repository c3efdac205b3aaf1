// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {

/// A list of contacts in the order in which they are added. Data that the points of two bodies
/// share are stored once. All points but the first are stored relative to it, in float: rounding
/// moves them by 6e-8 of their distance from it. They are read as Contacts, by value.
class ContactList {
  public:
    class Iterator {
      public:
        Iterator(const ContactList& list, std::size_t place) : list_(&list), place_(place) {}
        Contact operator*() const { return (*list_)[place_]; }
        Iterator& operator++() {
            ++place_;
            return *this;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

      private:
        const ContactList* list_;
        std::size_t place_;
    };
    /// Contacts that follow each other.
    struct Part {
        Iterator first, last;
        Iterator begin() const { return first; }
        Iterator end() const { return last; }
    };

    /// The contacts begin <= i < end, which share their bodies and their normal.
    struct Run {
        std::size_t begin, end;
        BodyId a, b;

        std::size_t size() const { return end - begin; }
    };

    /// The replacement of all contacts [begin, end) of one pair by others.
    struct Replacement {
        std::size_t begin, end;
        std::span<const Contact> by;
    };

    ContactList() = default;
    explicit ContactList(std::span<const Contact> contacts) {
        for (const Contact& contact : contacts) push_back(contact);
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    Contact operator[](std::size_t i) const {
        const std::uint32_t place = place_of_shared_[i];
        const Head& head = heads_[place];
        const NoInternalEdge& no_internal_edge = no_internal_edges_[place];
        return {shared_[place].normal,
                point(i),
                separation(i),
                head.a,
                head.b,
                feature(i),
                no_internal_edge.seen_from,
                no_internal_edge.points};
    }
    /// Returns the run of a contact, from that contact on and at most up to `limit`. Stages that
    /// need little of each point go from run to run.
    Run run(std::size_t i, std::size_t limit) const {
        const std::uint32_t place = place_of_shared_[i];
        return {i, std::min(end_of_run(place), limit), heads_[place].a, heads_[place].b};
    }
    /// Fetches ahead the data that a contact shares, which are read first.
    [[gnu::always_inline]] void prefetch(std::size_t i) const {
        const std::uint32_t place = place_of_shared_[i];
        const auto* const shared = reinterpret_cast<const char*>(&shared_[place]);
        __builtin_prefetch(&heads_[place]);
        __builtin_prefetch(shared);
        __builtin_prefetch(shared + sizeof(Shared) - 1);
    }
    /// Returns the number of all runs; nth_run() returns one of them.
    std::size_t run_count() const { return shared_size_; }
    Run nth_run(std::size_t n) const {
        return {heads_[n].first, end_of_run(n), heads_[n].a, heads_[n].b};
    }
    /// Returns the number of the run that a contact is in.
    std::uint32_t run_of(std::size_t i) const { return place_of_shared_[i]; }
    /// Returns the end of the contacts of the pair of contact i.
    std::size_t end_of_pair(std::size_t i) const {
        std::size_t end = i;
        do end = run(end, size_).end;
        while (end < size_ && pair(end) == pair(i));
        return end;
    }
    std::pair<BodyId, BodyId> pair(std::size_t i) const {
        const Head& head = heads_[place_of_shared_[i]];
        return {head.a, head.b};
    }
    /// Returns the pair's Contact::no_internal_edge if contacts [begin, end) are all the points for
    /// which it was found, else 0.
    unsigned no_internal_edge(std::size_t begin, std::size_t end) const {
        const NoInternalEdge& no_internal_edge = no_internal_edges_[place_of_shared_[begin]];
        return no_internal_edge.points == end - begin ? no_internal_edge.seen_from : 0u;
    }
    const PackedVec4& normal(std::size_t i) const { return shared_[place_of_shared_[i]].normal; }
    Vec4 point(std::size_t i) const {
        const std::uint32_t place = place_of_shared_[i];
        if (heads_[place].first == i) return shared_[place].place;
        const auto& [x, y, z, w] = further_[further_at(i)].from_first;
        return shared_[place].place + assembled(x, y, z, w);
    }
    double separation(std::size_t i) const {
        const std::uint32_t place = place_of_shared_[i];
        if (heads_[place].first == i) return shared_[place].separation;
        return std::bit_cast<double>(further_[further_at(i)].separation);
    }
    std::uint32_t feature(std::size_t i) const {
        const std::uint32_t place = place_of_shared_[i];
        return heads_[place].first == i ? heads_[place].feature : further_[further_at(i)].feature;
    }
    Part part(std::size_t begin, std::size_t end) const { return {{*this, begin}, {*this, end}}; }
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size_}; }

    /// Empties the list and keeps memory for about as many contacts as there were.
    void restart() {
        prepare(place_of_shared_, size_);
        prepare(heads_, shared_size_);
        prepare(shared_, shared_size_);
        prepare(no_internal_edges_, shared_size_);
        prepare(further_, size_ - shared_size_);
        size_ = shared_size_ = 0;
    }
    void push_back(const Contact& contact) {
        if (place_of_shared_.size() == size_) place_of_shared_.emplace_back();
        const bool is_shared = size_ > 0 && share(contact, (*this)[size_ - 1]);
        if (is_shared) {
            if (further_.size() == size_ - shared_size_) further_.emplace_back();
        } else {
            if (shared_.size() == shared_size_)
                heads_.emplace_back(), shared_.emplace_back(), no_internal_edges_.emplace_back();
            ++shared_size_;
        }
        write(contact, {size_++, shared_size_ - 1}, !is_shared);
    }
    /// Appends lists one behind the other. No two of them may have contacts of the same two bodies.
    /// @param for_each_range   (count, grain, work): as Schedule::for_each_range()
    /// @param ratio            number of all contacts divided by the number after this, about
    template <class Loop>
    void append(const Loop& for_each_range, std::span<const std::vector<Contact>> lists,
                double ratio) {
        starts_.assign(lists.size() + 1, {size_, shared_size_});
        for_each_range(lists.size(), 1, [&](auto range) {
            for (std::size_t i = range.begin; i < range.end; ++i)
                starts_[i + 1] = {lists[i].size(), shared_by(lists[i])};
        });
        for (std::size_t i = 1; i < starts_.size(); ++i) {
            starts_[i].point += starts_[i - 1].point;
            starts_[i].shared += starts_[i - 1].shared;
        }
        grow_to(starts_.back(), ratio);
        for_each_range(lists.size(), 1, [&](auto range) {
            for (std::size_t i = range.begin; i < range.end; ++i) write(lists[i], starts_[i]);
        });
        size_ = starts_.back().point;
        shared_size_ = starts_.back().shared;
    }

    /// Does replacements in place: a second list of all contacts would be a tenth of a step's
    /// memory.
    /// @param all   ascending
    void replace(std::span<const Replacement> all) {
        moves_.clear(), starts_.clear();
        Start by = {0, 0};  // down where it wraps
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& [begin, end, contacts] = all[i];
            const std::size_t next = i + 1 < all.size() ? all[i + 1].begin : size_;
            starts_.push_back({begin + by.point, shared_at(begin) + by.shared});
            by.point += contacts.size() - (end - begin);
            by.shared += shared_by(contacts) - (shared_at(end) - shared_at(begin));
            moves_.push_back({{end, shared_at(end)}, {next, shared_at(next)}, by});
        }
        grow_to({size_ + by.point, shared_size_ + by.shared}, 1);
        size_ += by.point;
        shared_size_ += by.shared;
        move(
            place_of_shared_, [](const Start& start) { return start.point; },
            [](std::uint32_t& place, const Start& way) { place += place_of(way.shared); });
        move(
            heads_, [](const Start& start) { return start.shared; },
            [](Head& head, const Start& way) { head.first += place_of(way.point); });
        move(
            shared_, [](const Start& start) { return start.shared; }, [](Shared&, const Start&) {});
        move(
            no_internal_edges_, [](const Start& start) { return start.shared; },
            [](NoInternalEdge&, const Start&) {});
        move(
            further_, [](const Start& start) { return start.point - start.shared; },
            [](Further&, const Start&) {});
        for (std::size_t i = 0; i < all.size(); ++i) write(all[i].by, starts_[i]);
    }

  private:
    /// The first part of the data that points share: many stages go through all contacts and need
    /// this part only.
    struct Head {
        BodyId a, b;
        std::uint32_t first;    ///< place of the first point
        std::uint32_t feature;  ///< of the first point
    };
    /// The second part of the data that points share.
    struct Shared {
        PackedVec4 normal;
        PackedVec4 place;  ///< of the first point
        double separation;
    };
    /// The members of Contact about internal edges.
    struct NoInternalEdge {
        std::uint8_t seen_from = 0, points = 0;
    };
    /// A point that is not the first.
    struct Further {
        std::array<float, 4> from_first;          ///< [m]
        std::array<std::uint32_t, 2> separation;  ///< a double's bits, without its alignment
        std::uint32_t feature;
    };
    /// The places of a list's first contact and of its shared data. The place of the first Further
    /// is their difference.
    struct Start {
        std::size_t point, shared;
    };

    /// A move of the contacts from `begin` to `end` by `way` places; where `way` wraps, they go
    /// down.
    struct Move {
        Start begin, end, way;
    };

    /// Moves items. Those that go down are moved from the first to the last, those that go up from
    /// the last to the first, so that none is overwritten before it has moved.
    /// @param place_in   returns the place of a Start in `items`
    template <class Item, class PlaceIn, class Mend>
    void move(std::vector<Item>& items, const PlaceIn& place_in, const Mend& mend) {
        const auto move_one = [&](const Move& m, std::size_t i) {
            Item item = items[i];
            mend(item, m.way);
            items[i + place_in(m.way)] = item;
        };
        const auto goes_up = [&](const Move& m) {
            return static_cast<std::ptrdiff_t>(place_in(m.way)) > 0;
        };
        for (const Move& m : moves_)
            for (std::size_t i = place_in(m.begin); !goes_up(m) && i < place_in(m.end); ++i)
                move_one(m, i);
        for (auto m = moves_.rbegin(); m != moves_.rend(); ++m)
            for (std::size_t i = place_in(m->end); goes_up(*m) && i-- > place_in(m->begin);)
                move_one(*m, i);
    }

    std::size_t end_of_run(std::size_t n) const {
        return n + 1 < shared_size_ ? heads_[n + 1].first : size_;
    }
    /// Returns the place in further_ of a point that is not the first of its run.
    std::size_t further_at(std::size_t i) const { return i - place_of_shared_[i] - 1; }
    void grow_to(Start end, double ratio) {
        grow(place_of_shared_, size_, end.point, ratio);
        grow(heads_, shared_size_, end.shared, ratio);
        grow(shared_, shared_size_, end.shared, ratio);
        grow(no_internal_edges_, shared_size_, end.shared, ratio);
        grow(further_, size_ - shared_size_, end.point - end.shared, ratio);
    }

    /// Returns the place of a contact's shared data, also for the end.
    std::size_t shared_at(std::size_t i) const {
        return i < size_ ? place_of_shared_[i] : shared_size_;
    }
    static std::uint32_t place_of(std::size_t i) { return static_cast<std::uint32_t>(i); }
    /// Compares the normals as one vector: number by number it would be four branches.
    static bool have_same_normal(const Contact& c, const Contact& d) {
        simd::Double4 n, m;
        std::memcpy(&n, c.normal.data(), sizeof n);
        std::memcpy(&m, d.normal.data(), sizeof m);
        return simd::lanes_set(n == m) == 0xf;
    }
    static bool share(const Contact& c, const Contact& d) {
        return c.a == d.a && c.b == d.b && have_same_normal(c, d);
    }
    static std::size_t shared_by(std::span<const Contact> list) {
        std::size_t count = list.empty() ? 0 : 1;
        for (std::size_t i = 1; i < list.size(); ++i) count += share(list[i - 1], list[i]) ? 0 : 1;
        return count;
    }
    void write(std::span<const Contact> list, Start start) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const bool is_first = i == 0 || !share(list[i - 1], list[i]);
            if (i > 0 && is_first) ++start.shared;
            write(list[i], {start.point + i, start.shared}, is_first);
        }
    }
    void write(const Contact& c, Start at, bool is_first) {
        place_of_shared_[at.point] = place_of(at.shared);
        Shared& shared = shared_[at.shared];
        if (is_first) {
            heads_[at.shared] = {c.a, c.b, place_of(at.point), c.feature};
            shared = {c.normal, c.point, c.separation};
            no_internal_edges_[at.shared] = {c.no_internal_edge, c.no_internal_edge_points};
            return;
        }
        Further& further = further_[further_at(at.point)];
        Eigen::Map<Eigen::Vector4f>(further.from_first.data()) =
            (c.point - shared.place).cast<float>();
        further.separation = std::bit_cast<std::array<std::uint32_t, 2>>(c.separation);
        further.feature = c.feature;
    }

    // The used items come first. The items behind them stay, to be overwritten.
    std::size_t size_ = 0, shared_size_ = 0;
    std::vector<std::uint32_t> place_of_shared_;  ///< of every contact
    std::vector<Head> heads_;                     ///< of every run; so are the next two
    std::vector<Shared> shared_;
    std::vector<NoInternalEdge> no_internal_edges_;
    std::vector<Further> further_;
    std::vector<Start> starts_;
    std::vector<Move> moves_;
};

}  // namespace tesserae
