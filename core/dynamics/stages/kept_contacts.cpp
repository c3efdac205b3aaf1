#include "core/dynamics/stages/kept_contacts.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <span>
#include <utility>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/stages/contacts.hpp"
#include "core/dynamics/stages/seam_judge.hpp"

namespace tesserae {
namespace {

using Keeps = KeptManifold::Keeps;

/// Spare records of a kind are at most so many, or one part in so many of those that are kept.
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
            for (; place_ < all.size(); ++place_)
                if (!(pair_of(*all[place_]) < pair))
                    return pair_of(*all[place_]) == pair ? &all[place_] : nullptr;
        }
        return nullptr;
    }

  private:
    const std::vector<KeptManifolds>& lists_;
    std::size_t list_, place_ = 0;
};

/// Where b is, seen from a.
struct Relative {
    Vec4 offset;
    Rotor rotor;
};

/// How far any point of b is from where it was, at most: a rotor's difference is half the root of
/// the squares of both angles.
double way(const KeptManifold& from, const Relative& to, double radius) {
    const Rotor &r = to.rotor, &q = from.rotor;
    const double s = r.s - q.s, p = r.p - q.p;
    const Bivector b = r.b - q.b;
    const Vec4 moved = to.offset - from.offset;
    return stable_norm(moved) + 2 * radius * std::sqrt(s * s + dot(b, b) + p * p);
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

    /// Whether both are flat and whatever comes within the margin is within that of what is kept.
    bool may_keep(const BodyPair& pair, double margin) const {
        const TypeProperties& a = simulation_.type_of(pair.a);
        const TypeProperties& b = simulation_.type_of(pair.b);
        return a.flat && b.flat &&
               margin <= (kKeptMargin - kKeptMotion / kSlop) * std::min(a.slop, b.slop);
    }

    /// @param last   what the sub-step before this one kept of the pair, or null
    void find(const BodyPair& pair, double margin,
              const std::shared_ptr<const KeptManifold>* last) {
        const auto [a, b] = pair;
        if (a != turned_) from_turned_ = to_matrix(step_.rotor[a]), turned_ = a;
        const Mat4& from_a = from_turned_;
        const Relative now = {from_a.transpose() * (step_.position[b] - step_.position[a]),
                              reverse(step_.rotor[a]) * step_.rotor[b]};
        const TypeProperties &type_a = simulation_.type_of(a), &type_b = simulation_.type_of(b);
        const double slop = std::min(type_a.slop, type_b.slop);
        if (!last || !(way(**last, now, type_b.radius) <= kKeptMotion / kSlop * slop))
            keep(found_at(pair, now, kKeptMargin * slop));
        else if ((*last)->keeps == Keeps::kUnknown)
            keep(found_at(pair, {(*last)->offset, (*last)->rotor}, kKeptMargin * slop));
        else
            keep(*last);
        const KeptManifold& m = *kept_[count_ - 1];
        if (m.keeps == Keeps::kNoFace)
            return find_contacts_of(simulation_, step_, pair, margin, list_);
        if (!m.points.empty()) report(m, from_a, now, margin);
    }

    /// Takes what the list still had away behind the last one that is kept.
    void end() {
        for (std::size_t i = count_; i < kept_.size(); ++i) spare_.put(kept_[i]);
        kept_.resize(count_);
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

    std::shared_ptr<const KeptManifold> found_at(const BodyPair& pair, const Relative& at,
                                                 double margin) {
        const Shape& shape_a = simulation_.bodies.type_of(pair.a).shape;
        const Shape& shape_b = simulation_.bodies.type_of(pair.b).shape;
        const Vec4 here = Vec4::Zero();
        // Behind those of other pairs for a while: a list's memory is its range's, and no step
        // should have to ask for more because another thread has come to a range.
        const std::size_t first = list_.size();
        find_contacts(pair.a, shape_a, {here, Rotor{}}, pair.b, shape_b, {at.offset, at.rotor},
                      margin, list_);
        const std::span<const Contact> found(list_.begin() + static_cast<std::ptrdiff_t>(first),
                                             list_.end());
        Keeps keeps = Keeps::kNothing;
        Vec4 normal = here;
        if (!found.empty()) {
            normal = found[0].normal;
            const Vec4 into_b = -(to_matrix(at.rotor).transpose() * normal);
            keeps = is_normal_of_face(shape_a, normal)   ? Keeps::kNormalOfA
                    : is_normal_of_face(shape_b, into_b) ? Keeps::kNormalOfB
                                                         : Keeps::kNoFace;
        }
        const bool has_points = keeps == Keeps::kNormalOfA || keeps == Keeps::kNormalOfB;
        const std::shared_ptr<KeptManifold> manifold = record(has_points);
        KeptManifold& m = *manifold;
        m.a = pair.a, m.b = pair.b, m.offset = at.offset, m.rotor = at.rotor;
        m.keeps = keeps, m.normal = normal;
        m.points.clear(), m.no_seam = 0;
        if (has_points) {
            m.points.reserve(found.size());
            for (const Contact& c : found) {
                const Vec4 on_a = c.point - 0.5 * c.separation * normal;
                m.points.push_back({{on_a[0], on_a[1], on_a[2], on_a[3]}, c.separation, c.feature});
            }
            m.no_seam = no_seam_of(m);
        }
        list_.resize(first);
        return manifold;
    }

    /// Two bodies that are found anew in every step have the record of the step before the last.
    std::shared_ptr<KeptManifold> record(bool has_points) {
        if (count_ < kept_.size() && kept_[count_].use_count() == 1 &&
            has_points == (kept_[count_]->points.capacity() > 0))
            return std::const_pointer_cast<KeptManifold>(std::move(kept_[count_]));
        return spare_.take(has_points);
    }

    /// See Contact.
    std::uint8_t no_seam_of(const KeptManifold& m) const {
        const std::size_t count = m.points.size();
        if (count > kManifoldPoints) return 0;
        const Mat4 to_b = to_matrix(m.rotor).transpose();
        const Vec4 normal = m.normal, offset = m.offset;
        std::array<Vec4, kManifoldPoints> in_a, in_b;
        for (std::size_t i = 0; i < count; ++i) {
            in_a[i] = Vec4(m.points[i].on_a.data());
            in_b[i] = to_b * (in_a[i] + m.points[i].separation * normal - offset);
        }
        const bool of_a = is_never_seam(simulation_.bodies.type_of(m.a).shape, normal,
                                        {in_a.data(), count}, simulation_.type_of(m.b));
        const bool of_b = is_never_seam(simulation_.bodies.type_of(m.b).shape, -(to_b * normal),
                                        {in_b.data(), count}, simulation_.type_of(m.a));
        return static_cast<std::uint8_t>((of_a ? 1 : 0) | (of_b ? 2 : 0));
    }

    void report(const KeptManifold& m, const Mat4& from_a, const Relative& now, double margin) {
        // Where b was, to where it is.
        const Mat4 turn = to_matrix(now.rotor * reverse(m.rotor));
        const Vec4 found_normal = m.normal, found_offset = m.offset;
        const Vec4 normal = m.keeps == Keeps::kNormalOfA ? found_normal : Vec4(turn * found_normal);
        const Vec4 in_world = from_a * normal;
        for (const KeptPoint& p : m.points) {
            const Vec4 on_a(p.on_a.data());
            const Vec4 first = on_a + p.separation * found_normal;
            const Vec4 on_b = now.offset + turn * (first - found_offset);
            const double separation = normal.dot(on_b - on_a);
            if (separation <= margin)
                list_.push_back({in_world, step_.position[m.a] + from_a * (0.5 * (on_a + on_b)),
                                 separation, m.a, m.b, p.feature, m.no_seam,
                                 static_cast<std::uint8_t>(m.points.size())});
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
    for (Spares& spares : spares_) {
        auto& [list, put, taken, count] = spares;
        list.resize(list.size() - std::min(list.size(), taken));
        list.reserve(most);
        for (std::size_t i = 0; i < std::min(count, put.size()) && list.size() < most; ++i)
            list.push_back(std::move(put[i]));
        put.clear();
        put.resize(most);
        taken = count = 0;
    }
}

void SpareManifolds::put(std::shared_ptr<const KeptManifold>& manifold) {
    if (manifold.use_count() != 1) return;
    Spares& spares = spares_[manifold->points.capacity() > 0 ? 1 : 0];
    const std::size_t place = std::atomic_ref(spares.count).fetch_add(1);
    if (place < spares.put.size())
        spares.put[place] = std::const_pointer_cast<KeptManifold>(std::move(manifold));
}

std::shared_ptr<KeptManifold> SpareManifolds::take(bool has_points) {
    Spares& spares = spares_[has_points ? 1 : 0];
    const std::size_t place = std::atomic_ref(spares.taken).fetch_add(1);
    if (place < spares.list.size()) return std::move(spares.list[spares.list.size() - 1 - place]);
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
                        SpareManifolds& spare, std::vector<Contact>& list) {
    if (pairs.begin == pairs.end) return;
    for (KeptManifolds& unused : lists.subspan(1)) {
        for (auto& manifold : unused) spare.put(manifold);
        unused.clear();
    }
    KeptManifolds& kept = lists.front();
    Search search(last, step.filled, step.pairs[pairs.begin]);
    KeptContacts contacts(simulation, step, kept, spare, list);
    for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
        const BodyPair& pair = step.pairs[i];
        const double margin = margin_of(simulation, step, pair.a, pair.b);
        if (!contacts.may_keep(pair, margin)) {
            find_contacts_of(simulation, step, pair, margin, list);
            continue;
        }
        contacts.find(pair, margin, search.find(pair));
    }
    contacts.end();
}

}  // namespace tesserae
