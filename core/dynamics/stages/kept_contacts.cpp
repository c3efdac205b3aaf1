#include "core/dynamics/stages/kept_contacts.hpp"

#include <algorithm>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/stages/contacts.hpp"

namespace tesserae {
namespace {

using Keeps = KeptManifold::Keeps;

BodyPair pair_of(const KeptManifold& m) { return {m.a, m.b}; }

/// Goes through what was kept in the order of the pairs.
class Search {
  public:
    Search(const std::vector<KeptManifolds>& lists, const BodyPair& first) : lists_(lists) {
        const auto ends_before = [&](const KeptManifolds& list) {
            return list.manifolds.empty() || pair_of(list.manifolds.back()) < first;
        };
        while (list_ < lists_.size() && ends_before(lists_[list_])) ++list_;
        if (list_ == lists_.size()) return;
        const std::vector<KeptManifold>& all = lists_[list_].manifolds;
        place_ = static_cast<std::size_t>(
            std::partition_point(all.begin(), all.end(),
                                 [&](const KeptManifold& m) { return pair_of(m) < first; }) -
            all.begin());
    }
    /// That of a pair, which follows the one before; null if there is none.
    const KeptManifold* find(const BodyPair& pair) {
        for (; list_ < lists_.size(); ++list_, place_ = 0) {
            const std::vector<KeptManifold>& all = lists_[list_].manifolds;
            for (; place_ < all.size(); ++place_)
                if (!(pair_of(all[place_]) < pair))
                    return pair_of(all[place_]) == pair ? &all[place_] : nullptr;
        }
        return nullptr;
    }
    /// Those of the manifold that was found last.
    const KeptPoint* points() const { return lists_[list_].points.data(); }

  private:
    const std::vector<KeptManifolds>& lists_;
    std::size_t list_ = 0, place_ = 0;
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
    return stable_norm(to.offset - from.offset) + 2 * radius * std::sqrt(s * s + dot(b, b) + p * p);
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
                 std::vector<Contact>& list, std::vector<Contact>& found)
        : simulation_(simulation), step_(step), kept_(kept), list_(list), found_(found) {}

    /// Whether both are flat and whatever comes within the margin is within that of what is kept.
    bool may_keep(const BodyPair& pair, double margin) const {
        const TypeProperties& a = simulation_.type_of(pair.a);
        const TypeProperties& b = simulation_.type_of(pair.b);
        return a.flat && b.flat &&
               margin <= (kKeptMargin - kKeptMotion / kSlop) * std::min(a.slop, b.slop);
    }

    void find(const BodyPair& pair, double margin, const KeptManifold* last,
              const KeptPoint* points) {
        const auto [a, b] = pair;
        const Mat4 from_a = to_matrix(step_.rotor[a]);
        const Relative now = {from_a.transpose() * (step_.position[b] - step_.position[a]),
                              reverse(step_.rotor[a]) * step_.rotor[b]};
        const TypeProperties &type_a = simulation_.type_of(a), &type_b = simulation_.type_of(b);
        const double slop = std::min(type_a.slop, type_b.slop);
        if (last && way(*last, now, type_b.radius) <= kKeptMotion / kSlop * slop) {
            KeptManifold& m = kept_.manifolds.emplace_back(*last);
            if (m.keeps == Keeps::kUnknown)
                find_again(m, kKeptMargin * slop);
            else
                keep_points(m, points);
        } else {
            KeptManifold& m = kept_.manifolds.emplace_back();
            m.a = a, m.b = b, m.offset = now.offset, m.rotor = now.rotor;
            find_again(m, kKeptMargin * slop);
        }
        const KeptManifold& m = kept_.manifolds.back();
        if (m.keeps == Keeps::kNoFace)
            return find_contacts_of(simulation_, step_, pair, margin, list_);
        if (m.count > 0) report(m, from_a, now, margin);
    }

  private:
    void keep_points(KeptManifold& m, const KeptPoint* points) {
        const KeptPoint* const from = points + m.first;
        m.first = static_cast<std::uint32_t>(kept_.points.size());
        kept_.points.insert(kept_.points.end(), from, from + m.count);
    }

    /// All but where it was found.
    void find_again(KeptManifold& m, double margin) {
        const Shape& shape_a = simulation_.bodies.type_of(m.a).shape;
        const Shape& shape_b = simulation_.bodies.type_of(m.b).shape;
        const Vec4 here = Vec4::Zero();
        found_.clear();
        find_contacts(m.a, shape_a, {here, Rotor{}}, m.b, shape_b, {m.offset, m.rotor}, margin,
                      found_);
        m.first = static_cast<std::uint32_t>(kept_.points.size());
        m.count = 0;
        m.keeps = Keeps::kNothing;
        if (found_.empty()) return;
        const Vec4& normal = found_[0].normal;
        const Vec4 into_b = -(to_matrix(m.rotor).transpose() * normal);
        m.keeps = is_normal_of_face(shape_a, normal)   ? Keeps::kNormalOfA
                  : is_normal_of_face(shape_b, into_b) ? Keeps::kNormalOfB
                                                       : Keeps::kNoFace;
        if (m.keeps == Keeps::kNoFace) return;
        m.normal = normal;
        m.count = static_cast<std::uint32_t>(found_.size());
        for (const Contact& c : found_) {
            const Vec4 on_a = c.point - 0.5 * c.separation * normal;
            kept_.points.push_back({{on_a[0], on_a[1], on_a[2], on_a[3]}, c.separation, c.feature});
        }
    }

    void report(const KeptManifold& m, const Mat4& from_a, const Relative& now, double margin) {
        // Where b was, to where it is.
        const Mat4 turn = to_matrix(now.rotor) * to_matrix(m.rotor).transpose();
        const Vec4 normal = m.keeps == Keeps::kNormalOfA ? m.normal : Vec4(turn * m.normal);
        const Vec4 in_world = from_a * normal;
        for (std::uint32_t i = m.first; i < m.first + m.count; ++i) {
            const KeptPoint& p = kept_.points[i];
            const Vec4 on_a(p.on_a.data());
            const Vec4 first = on_a + p.separation * m.normal;
            const Vec4 on_b = now.offset + turn * (first - m.offset);
            const double separation = normal.dot(on_b - on_a);
            if (separation <= margin)
                list_.push_back({in_world, step_.position[m.a] + from_a * (0.5 * (on_a + on_b)),
                                 separation, m.a, m.b, p.feature});
        }
    }

    const Simulation& simulation_;
    const StepData& step_;
    KeptManifolds& kept_;
    std::vector<Contact>& list_;
    std::vector<Contact>& found_;  ///< of one pair
};

}  // namespace

void begin_kept(const StepData& step, std::size_t grain, std::vector<KeptManifolds>& kept) {
    kept.resize((step.pairs.size() + grain - 1) / grain);
    for (KeptManifolds& list : kept) list.manifolds.clear(), list.points.clear();
}

void find_kept_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                        const std::vector<KeptManifolds>& last, KeptManifolds& kept,
                        std::vector<Contact>& list) {
    if (pairs.begin == pairs.end) return;
    Search search(last, step.pairs[pairs.begin]);
    // A thread's own, from range to range: no step should have to ask for memory.
    static thread_local std::vector<Contact> found;
    KeptContacts contacts(simulation, step, kept, list, found);
    for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
        const BodyPair& pair = step.pairs[i];
        const double margin = margin_of(simulation, step, pair.a, pair.b);
        if (!contacts.may_keep(pair, margin)) {
            find_contacts_of(simulation, step, pair, margin, list);
            continue;
        }
        const KeptManifold* const known = search.find(pair);
        contacts.find(pair, margin, known, known ? search.points() : nullptr);
    }
}

}  // namespace tesserae
