// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/kept_manifolds.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <span>
#include <utility>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/contacts/edge_judge.hpp"
#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

using Keeps = KeptManifold::Keeps;

/// Distances are good to less than this part of both bodies' radii (hyperbox_hyperbox.hpp,
/// convex_separation.hpp): what is farther apart by so much is so for every search.
constexpr double kDistanceSlack = 1e-8;

/// Points of bodies of such a size [m] are kept in float.
bool fits_floats(double radius) { return radius > 1e-30 && radius < 1e30; }

/// Spare records are at most so many, or one part in so many of those that are kept.
constexpr std::size_t kFewSpares = 64, kSpareManifolds = 16;

BodyPair pair_of(const KeptManifold& m) { return {m.a, m.b}; }

/// Goes through what was kept in the order of the pairs.
class Search {
  public:
    /// @param filled   those of the lists that have something
    Search(const std::vector<KeptManifolds>& lists, const std::vector<std::uint32_t>& filled,
           const BodyPair& first)
        : lists_(lists) {
        const auto place = std::partition_point(
            filled.begin(), filled.end(),
            [&](std::uint32_t list) { return pair_of(*lists[list].back()) < first; });
        list_ = place == filled.end() ? lists.size() : *place;
        if (list_ == lists.size()) return;
        const KeptManifolds& all = lists_[list_];
        place_ = static_cast<std::size_t>(
            std::partition_point(all.begin(), all.end(),
                                 [&](const auto& m) { return pair_of(*m) < first; }) -
            all.begin());
    }
    /// That of a pair, which follows the one before; null if there is none.
    const std::shared_ptr<const KeptManifold>* find(const BodyPair& pair) {
        for (; list_ < lists_.size(); ++list_, place_ = 0) {
            const KeptManifolds& all = lists_[list_];
            for (; place_ < all.size(); ++place_) {
                if (pair_of(*all[place_]) < pair) continue;
                ask_for_next(all);
                return pair_of(*all[place_]) == pair ? &all[place_] : nullptr;
            }
        }
        return nullptr;
    }

  private:
    /// Manifolds are anywhere in memory: what is read soon is on its way until then.
    void ask_for_next(const KeptManifolds& all) const {
        constexpr std::size_t kAhead = 2, kLine = 64;
        if (place_ + kAhead >= all.size()) return;
        const auto* const next = reinterpret_cast<const char*>(all[place_ + kAhead].get());
        for (std::size_t at = 0; at < sizeof(KeptManifold); at += kLine)
            __builtin_prefetch(next + at);
    }

    const std::vector<KeptManifolds>& lists_;
    std::size_t list_, place_ = 0;
};

/// Where b is, seen from a.
struct Relative {
    Vec4 offset;
    Rotor rotor;
};

/// How far any point of b is from where it was, at most.
double way(const KeptManifold& from, const Relative& to, double radius) {
    const Vec4 moved = to.offset - from.offset;
    return stable_norm(moved) + turned(from.rotor, to.rotor, radius);
}

bool is_normal_of_face(const Shape& shape, const Vec4& direction) {
    return std::visit(
        [&]<class S>(const S& s) {
            if constexpr (IsPolytope<S>) return is_face_normal(s, direction);
            return false;
        },
        shape);
}

/// The narrow phase of one range.
class KeptContacts {
  public:
    KeptContacts(const Simulation& simulation, const StepData& step, KeptManifolds& kept,
                 SpareManifolds& spare, std::vector<Contact>& list)
        : simulation_(simulation), step_(step), kept_(kept), spare_(spare), list_(list) {}

    /// How far a search for the pair's contacts looks [m], at most.
    double looks_to(const BodyPair& pair, const Margins& margins) const {
        return std::max(margins.if_one_stops, kKeptMargin * slop_of(pair));
    }

    /// Returns how far apart the balls about both are at least [m]; negative if they overlap or
    /// there is none about one of them.
    double between_balls(const BodyPair& pair) const {
        const TypeProperties& type_a = simulation_.type_of(pair.a);
        const TypeProperties& type_b = simulation_.type_of(pair.b);
        if (!type_a.bounded || !type_b.bounded) return -1;
        const double both = type_a.radius + type_b.radius;
        return (step_.position[pair.b] - step_.position[pair.a]).norm() -
               (1 + kDistanceSlack) * both;
    }

    /// @param last   what the sub-step before this one kept of the pair, or null
    /// @return how far apart both are at least [m], as far as it is known
    double find(const BodyPair& pair, const Margins& margins,
                const std::shared_ptr<const KeptManifold>* last) {
        const TypeProperties& type_a = simulation_.type_of(pair.a);
        const TypeProperties& type_b = simulation_.type_of(pair.b);
        const double slack = kDistanceSlack * (type_a.radius + type_b.radius);
        const double margin = margins.if_one_stops;
        if (!may_keep(pair, margins.as_they_move))
            return find_contacts_of(simulation_, step_, pair, margin, list_) - slack;
        const auto [a, b] = pair;
        if (a != turned_) from_turned_ = to_matrix(step_.rotor[a]), turned_ = a;
        const Mat4& from_a = from_turned_;
        const Relative now = {from_a.transpose() * (step_.position[b] - step_.position[a]),
                              reverse(step_.rotor[a]) * step_.rotor[b]};
        const double slop = slop_of(pair), most = kKeptMargin * slop;
        const bool stays = last && way(**last, now, type_b.radius) <= kKeptMotion / kSlop * slop;
        const bool is_known = stays && (*last)->keeps != Keeps::kUnknown;
        double apart = 0;
        if (is_known) keep(*last);
        const bool is_kept =
            is_known || (stays && keep_found(pair, {(*last)->offset, (*last)->rotor}, most, apart));
        if (!is_kept && !keep_found(pair, now, most, apart))
            return (apart - slack > margin
                        ? apart
                        : find_contacts_of(simulation_, step_, pair, margin, list_)) -
                   slack;
        const KeptManifold& m = *kept_[count_ - 1];
        if (m.keeps == Keeps::kNoFace)
            find_contacts_of(simulation_, step_, pair, margin, list_);
        else
            report(m, from_a, now, margin);
        return 0;
    }

    /// Takes what the list still had away behind the last one that is kept.
    void end() {
        for (std::size_t i = count_; i < kept_.size(); ++i) spare_.put(kept_[i]);
        kept_.resize(count_);
        if (kept_.capacity() > count_ + count_ / 8 + 4) kept_.shrink_to_fit();
    }

  private:
    /// Most are in the list at this place already. To count who has one more and one less costs as
    /// much as to move it.
    template <class Manifold>
    void keep(Manifold&& manifold) {
        if (count_ == kept_.size()) {
            kept_.push_back(std::forward<Manifold>(manifold));
        } else if (kept_[count_] != manifold) {
            spare_.put(kept_[count_]);
            kept_[count_] = std::forward<Manifold>(manifold);
        }
        ++count_;
    }

    double slop_of(const BodyPair& pair) const {
        return std::min(simulation_.type_of(pair.a).slop, simulation_.type_of(pair.b).slop);
    }
    /// Whether both are flat and whatever comes within the margin is within that of what is kept.
    bool may_keep(const BodyPair& pair, double margin) const {
        const TypeProperties& a = simulation_.type_of(pair.a);
        const TypeProperties& b = simulation_.type_of(pair.b);
        return a.flat && b.flat && fits_floats(std::min(a.radius, b.radius)) &&
               margin <= (kKeptMargin - kKeptMotion / kSlop) * slop_of(pair);
    }

    /// Keeps the manifold of the pair at a place, if there is one.
    /// @param apart   becomes what the search says
    bool keep_found(const BodyPair& pair, const Relative& at, double margin, double& apart) {
        const Shape& shape_a = simulation_.bodies.type_of(pair.a).shape;
        const Shape& shape_b = simulation_.bodies.type_of(pair.b).shape;
        const Vec4 here = Vec4::Zero();
        // Behind those of other pairs for a while: a list's memory is its range's, and no step
        // should have to ask for more because another thread has come to a range.
        const std::size_t first = list_.size();
        apart = find_contacts(pair.a, shape_a, {here, Rotor{}}, pair.b, shape_b,
                              {at.offset, at.rotor}, margin, list_);
        const std::span<const Contact> found(list_.begin() + static_cast<std::ptrdiff_t>(first),
                                             list_.end());
        TSR_ASSERT(found.size() <= kManifoldPoints);
        if (found.empty()) return false;
        const Vec4 normal = found[0].normal;
        const Vec4 into_b = -(to_matrix(at.rotor).transpose() * normal);
        const std::shared_ptr<KeptManifold> manifold = record();
        KeptManifold& m = *manifold;
        m.a = pair.a, m.b = pair.b, m.offset = at.offset, m.rotor = at.rotor;
        m.keeps = is_normal_of_face(shape_a, normal)   ? Keeps::kNormalOfA
                  : is_normal_of_face(shape_b, into_b) ? Keeps::kNormalOfB
                                                       : Keeps::kNoFace;
        m.normal = normal;
        m.count = m.no_internal_edge = 0;
        if (m.keeps != Keeps::kNoFace) {
            const Vec4 origin = origin_of(m);
            for (const Contact& c : found) {
                KeptPoint& point = m.points[m.count++];
                const Vec4 on_a = c.point - 0.5 * c.separation * normal;
                Eigen::Map<Eigen::Vector4f>(point.on_a.data()) = (on_a - origin).cast<float>();
                point.separation = static_cast<float>(c.separation);
                point.feature = c.feature;
            }
            m.no_internal_edge = no_internal_edge_of(m);
        }
        list_.resize(first);
        keep(manifold);
        return true;
    }

    /// Two bodies that are found anew in every step have the record of the step before the last.
    std::shared_ptr<KeptManifold> record() {
        if (count_ < kept_.size() && kept_[count_].use_count() == 1)
            return std::const_pointer_cast<KeptManifold>(std::move(kept_[count_]));
        return spare_.take();
    }

    /// What the points are counted from, in a's frame: floats of the smaller body's size tell them.
    Vec4 origin_of(const KeptManifold& m) const {
        const bool is_b = simulation_.type_of(m.b).radius < simulation_.type_of(m.a).radius;
        return is_b ? Vec4(m.offset) : Vec4(Vec4::Zero());
    }
    Vec4 on_a(const KeptPoint& point, const Vec4& origin) const {
        return origin + Eigen::Map<const Eigen::Vector4f>(point.on_a.data()).cast<double>();
    }

    /// See Contact.
    std::uint8_t no_internal_edge_of(const KeptManifold& m) const {
        const std::size_t count = m.count;
        const Mat4 to_b = to_matrix(m.rotor).transpose();
        const Vec4 normal = m.normal, offset = m.offset, origin = origin_of(m);
        std::array<Vec4, kManifoldPoints> in_a, in_b;
        for (std::size_t i = 0; i < count; ++i) {
            in_a[i] = on_a(m.points[i], origin);
            in_b[i] = to_b * (in_a[i] + m.points[i].separation * normal - offset);
        }
        const bool of_a = is_never_internal_edge(simulation_.bodies.type_of(m.a).shape, normal,
                                                 {in_a.data(), count}, simulation_.type_of(m.b));
        const bool of_b =
            is_never_internal_edge(simulation_.bodies.type_of(m.b).shape, -(to_b * normal),
                                   {in_b.data(), count}, simulation_.type_of(m.a));
        return static_cast<std::uint8_t>((of_a ? 1 : 0) | (of_b ? 2 : 0));
    }

    void report(const KeptManifold& m, const Mat4& from_a, const Relative& now, double margin) {
        // Where b was, to where it is.
        const Mat4 turn = to_matrix(now.rotor * reverse(m.rotor));
        const Vec4 found_normal = m.normal, found_offset = m.offset, origin = origin_of(m);
        const Vec4 normal = m.keeps == Keeps::kNormalOfA ? found_normal : Vec4(turn * found_normal);
        const Vec4 in_world = from_a * normal;
        for (const KeptPoint& p : m.found()) {
            const Vec4 of_a = on_a(p, origin);
            const Vec4 first = of_a + double{p.separation} * found_normal;
            const Vec4 of_b = now.offset + turn * (first - found_offset);
            const double separation = normal.dot(of_b - of_a);
            if (separation <= margin)
                list_.push_back({in_world, step_.position[m.a] + from_a * (0.5 * (of_a + of_b)),
                                 separation, m.a, m.b, p.feature, m.no_internal_edge, m.count});
        }
    }

    const Simulation& simulation_;
    const StepData& step_;
    KeptManifolds& kept_;
    SpareManifolds& spare_;
    std::vector<Contact>& list_;
    std::size_t count_ = 0;  ///< of kept_, so far
    // Pairs of a body follow each other.
    BodyId turned_ = std::numeric_limits<BodyId>::max();  ///< no body's number
    Mat4 from_turned_;
};

}  // namespace

void SpareManifolds::begin(std::size_t manifolds) {
    const std::size_t most = std::max(kFewSpares, manifolds / kSpareManifolds);
    list_.resize(list_.size() - std::min(list_.size(), taken_));
    list_.reserve(most);
    for (std::size_t i = 0; i < std::min(count_, put_.size()) && list_.size() < most; ++i)
        list_.push_back(std::move(put_[i]));
    put_.clear();
    put_.resize(most);
    taken_ = count_ = 0;
}

void SpareManifolds::put(std::shared_ptr<const KeptManifold>& manifold) {
    if (manifold.use_count() != 1) return;
    const std::size_t place = std::atomic_ref(count_).fetch_add(1);
    if (place < put_.size())
        put_[place] = std::const_pointer_cast<KeptManifold>(std::move(manifold));
}

std::shared_ptr<KeptManifold> SpareManifolds::take() {
    const std::size_t place = std::atomic_ref(taken_).fetch_add(1);
    if (place < list_.size()) return std::move(list_[list_.size() - 1 - place]);
    return std::make_shared<KeptManifold>();
}

void begin_kept(StepData& step, std::size_t grain, const std::vector<KeptManifolds>& last,
                SpareManifolds& spare) {
    std::size_t manifolds = 0;
    for (const KeptManifolds& list : step.kept) manifolds += list.size();
    spare.begin(manifolds);
    step.kept.resize((step.pairs.size() + grain - 1) / grain);
    step.filled.clear();
    for (std::uint32_t i = 0; i < last.size(); ++i)
        if (!last[i].empty()) step.filled.push_back(i);
}

void find_kept_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                        const std::vector<KeptManifolds>& last, std::span<KeptManifolds> lists,
                        SpareManifolds& spare, Clearances& clearances, std::vector<Contact>& list) {
    if (pairs.begin == pairs.end) return;
    for (KeptManifolds& unused : lists.subspan(1)) {
        for (auto& manifold : unused) spare.put(manifold);
        unused.clear();
    }
    KeptManifolds& kept = lists.front();
    const BodyPair& first = step.pairs[pairs.begin];
    Search kept_of(last, step.filled, first);
    Clearances::Search clearance_of(clearances, first);
    KeptContacts contacts(simulation, step, kept, spare, list);
    for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
        const BodyPair& pair = step.pairs[i];
        const auto* const kept_before = kept_of.find(pair);
        double apart = kept_before ? 0 : clearance_of.left(pair);
        const Margins margins = margins_of(simulation, step, pair.a, pair.b);
        const double looks_to = contacts.looks_to(pair, margins);
        if (!(apart > looks_to) && !kept_before) apart = contacts.between_balls(pair);
        if (!(apart > looks_to)) apart = contacts.find(pair, margins, kept_before);
        clearances.set(i, apart);
    }
    contacts.end();
}

}  // namespace tesserae
