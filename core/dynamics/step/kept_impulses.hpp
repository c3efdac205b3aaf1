// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/algebra/vector.hpp"
#include "core/body_id.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {

/// The impulses on b from which a contact point's rows start, and with which they end. Every point
/// has two of them in memory, so that friction is kept in float, as a part of the normal impulse.
struct ContactImpulse {
    double normal = 0;                ///< [N s], >= 0
    std::array<float, 4> slope = {};  ///< friction impulse over the normal one, world

    Vec4 tangent() const { return normal * assembled(slope[0], slope[1], slope[2], slope[3]); }
};
/// Returns the ContactImpulse of a normal and a friction impulse.
/// @param tangent   [N s], zero where the normal impulse is
inline ContactImpulse contact_impulse(double normal, const Vec4& tangent) {
    ContactImpulse impulse{normal};
    if (!(normal > 0)) return impulse;
    Eigen::Map<Eigen::Vector4f>(impulse.slope.data()) = (tangent / normal).cast<float>();
    return impulse;
}

/// The impulses, > 0, with which a contact point's rows ended: the next step's solver starts from
/// them.
struct KeptImpulse : ContactImpulse {
    BodyId a = 0, b = 0;        ///< a < b
    std::uint32_t feature = 0;  ///< which point of the pair; stays the same while the features do
};

/// A list of KeptImpulse ascending by (a, b, feature). Bodies are stored once for impulses that
/// follow each other. They are read as KeptImpulse, by value.
class KeptImpulses {
  public:
    /// The bodies of the impulses from `first` to the next run's first. A pair may have more than
    /// one run.
    struct Run {
        BodyId a, b;
        std::uint32_t first;
    };
    struct Size {
        std::size_t runs = 0, impulses = 0;

        friend Size operator+(const Size& s, const Size& t) {
            return {s.runs + t.runs, s.impulses + t.impulses};
        }
    };
    class Iterator {
      public:
        Iterator(const KeptImpulses& list, Size at) : list_(&list), at_(at) {}
        KeptImpulse operator*() const { return list_->read(at_); }
        Iterator& operator++() {
            if (++at_.impulses == list_->end_of(at_.runs)) ++at_.runs;
            return *this;
        }
        friend bool operator==(const Iterator& i, const Iterator& j) {
            return i.at_.impulses == j.at_.impulses;
        }

      private:
        const KeptImpulses* list_;
        Size at_;
    };

    std::size_t size() const { return impulses_.size(); }
    bool empty() const { return impulses_.empty(); }
    Iterator begin() const { return {*this, {}}; }
    Iterator end() const { return {*this, {runs_.size(), size()}}; }
    /// Returns the i-th impulse, in a time that grows with the logarithm of their number.
    KeptImpulse operator[](std::size_t i) const {
        const auto next = std::partition_point(runs_.begin(), runs_.end(),
                                               [&](const Run& run) { return run.first <= i; });
        return read({static_cast<std::size_t>(next - runs_.begin()) - 1, i});
    }

    const std::vector<Run>& runs() const { return runs_; }
    std::size_t end_of(std::size_t run) const {
        return run + 1 < runs_.size() ? runs_[run + 1].first : size();
    }
    const ContactImpulse& impulse(std::size_t i) const { return impulses_[i]; }
    std::uint32_t feature(std::size_t i) const { return features_[i]; }

    void push_back(const KeptImpulse& impulse) {
        if (runs_.empty() || runs_.back().a != impulse.a || runs_.back().b != impulse.b)
            runs_.push_back({impulse.a, impulse.b, static_cast<std::uint32_t>(size())});
        impulses_.push_back(impulse);
        features_.push_back(impulse.feature);
    }
    /// Empties the list and reserves memory for so many.
    void reserve_anew(const Size& size) {
        tesserae::reserve_anew(runs_, size.runs);
        tesserae::reserve_anew(impulses_, size.impulses);
        tesserae::reserve_anew(features_, size.impulses);
    }
    /// Resizes the list. All items must then be put: their old values may be lost.
    void resize_anew(const Size& size) {
        tesserae::resize_anew(runs_, size.runs);
        tesserae::resize_anew(impulses_, size.impulses);
        tesserae::resize_anew(features_, size.impulses);
    }
    void put(std::size_t place, const Run& run) { runs_[place] = run; }
    void put(std::size_t place, const ContactImpulse& impulse, std::uint32_t feature) {
        impulses_[place] = impulse;
        features_[place] = feature;
    }

  private:
    KeptImpulse read(const Size& at) const {
        const Run& run = runs_[at.runs];
        return {impulses_[at.impulses], run.a, run.b, features_[at.impulses]};
    }

    std::vector<Run> runs_;
    std::vector<ContactImpulse> impulses_;
    std::vector<std::uint32_t> features_;
};

}  // namespace tesserae
