// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/edge_judge.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/dynamics/contacts/rims.hpp"

namespace tesserae {
namespace {

/// Cosines of angles. Within the first two directions are one (1e-4 rad), within the second a
/// normal is meant to be that of a face (0.05 rad), beyond the third it pushes along the face more
/// than up (60 degrees).
constexpr double kSame = 1 - 5e-9, kNear = 0.99875, kSteep = 0.5;

/// What a manifold that is kept is no internal edge by: a smaller angle (0.03 rad) and a deeper rim
/// than kNear and kSkin, by ten times what kKeptMotion lets change.
constexpr double kSurelyNear = 0.99955, kDeepSkin = kSkin + 10 * kKeptMotion;

/// A part of a body's least half-size [m].
double part_of(const TypeProperties& type, double part) { return part / kSlop * type.slop; }

/// A body where it is.
struct Placed {
    const Shape& shape;
    Pose pose;

    Placed(const Simulation& simulation, const StepData& step, BodyId id)
        : shape(simulation.bodies.type_of(id).shape), pose{step.position[id], step.rotor[id]} {}

    Vec4 to_own(const Vec4& direction) const {
        return to_matrix(pose.rotor).transpose() * direction;
    }
    /// The face that looks most along a direction, in the world.
    std::optional<Face> face_towards(const Vec4& direction) const {
        return std::visit(
            [&]<class S>(const S& s) -> std::optional<Face> {
                if constexpr (!HasFaces<S>) {
                    return std::nullopt;
                } else if constexpr (!S::kBounded) {
                    return face_along(s, direction);
                } else {
                    const Mat4 axes = to_matrix(pose.rotor);
                    const Face own = face_along(s, axes.transpose() * direction);
                    const Vec4 normal = axes * own.normal;
                    return Face{normal, own.offset + normal.dot(pose.position)};
                }
            },
            shape);
    }
    /// The same, if its normal is near to the direction.
    std::optional<Face> face_near(const Vec4& direction) const {
        const std::optional<Face> face = face_towards(direction);
        return face && face->normal.dot(direction) >= kNear ? face : std::nullopt;
    }
    double distance_to(const Vec4& point) const {
        return std::visit(
            [&]<class S>(const S& s) {
                if constexpr (S::kBounded)
                    return signed_distance(s, to_own(point - pose.position));
                else
                    return signed_distance(s, point);
            },
            shape);
    }
    /// How far it reaches along a direction from its centre, which may be nearer to one side.
    double reach_along(const Vec4& direction) const {
        const Vec4 own = to_own(direction);
        return std::visit([&](const auto& s) { return own.dot(support(s, own)); }, shape);
    }
    /// Of its lowest point over a face's plane.
    double height_over(const Face& face) const {
        return face.normal.dot(pose.position) - face.offset - reach_along(-face.normal);
    }
    /// Of its highest point under a face's plane.
    double depth_under(const Face& face) const {
        return face.offset - face.normal.dot(pose.position) - reach_along(face.normal);
    }
};

/// Out of the other body: all contacts of a meeting have one normal.
Vec4 normal_of(const StepData& step, const Meeting& m) {
    const Contact contact = step.contacts[m.begin];
    return contact.b == m.body ? contact.normal : Vec4(-contact.normal);
}

/// Where the surface of the other body is.
Vec4 point_below(const Contact& contact, BodyId body) {
    const double half = contact.b == body ? -0.5 : 0.5;
    return contact.point + half * contact.separation * contact.normal;
}

ContactList::Part contacts_of(const StepData& step, const Meeting& m) {
    return step.contacts.part(m.begin, m.end);
}

/// Of the deepest point, at least 0.
double depth_of(const StepData& step, const Meeting& m) {
    double depth = 0;
    for (const Contact c : contacts_of(step, m)) depth = std::max(depth, -c.separation);
    return depth;
}

/// The face that the body lies on, if the meeting is one with ground.
std::optional<Face> ground_face(const Simulation& simulation, const StepData& step,
                                const Meeting& m) {
    const std::optional<Face> face =
        Placed(simulation, step, m.other).face_near(normal_of(step, m));
    if (!face) return std::nullopt;
    // No part of it hangs down beside the face.
    const double height = Placed(simulation, step, m.body).height_over(*face);
    if (height < -depth_of(step, m) - simulation.type_of(m.body).slop) return std::nullopt;
    return face;
}

/// Whether two faces are in one plane, where a body is.
bool are_flush(const Face& face, const Face& other, const Simulation& simulation,
               const StepData& step, BodyId body) {
    if (face.normal.dot(other.normal) < kSame) return false;
    const Vec4& at = step.position[body];
    const double rise = face.normal.dot(at) - face.offset - (other.normal.dot(at) - other.offset);
    return std::abs(rise) <= part_of(simulation.type_of(body), kFlush);
}

/// Of the other body's surface where a contact is.
double height_over(const Face& face, const Contact& contact, BodyId body) {
    return face.normal.dot(point_below(contact, body)) - face.offset;
}

/// The face of a body that does not move that rises from the ground's plane where they meet, as a
/// floor does from a ramp: if all points of the meeting are near it, and no deeper in that body.
std::optional<Face> rising_face(const Face& ground, const Simulation& simulation,
                                const StepData& step, const Meeting& m) {
    if (simulation.type_of(m.other).movable) return std::nullopt;
    const TypeProperties& type = simulation.type_of(m.body);
    const Placed other(simulation, step, m.other);
    if (other.depth_under(ground) >= -part_of(type, kFlush)) return std::nullopt;
    const std::optional<Face> face = other.face_towards(ground.normal);
    if (!face || !(face->normal.dot(ground.normal) > kSteep)) return std::nullopt;
    const double skin = part_of(type, kSkin);
    if (depth_of(step, m) > skin) return std::nullopt;
    for (const Contact c : contacts_of(step, m))
        if (!(height_over(*face, c, m.body) >= -skin)) return std::nullopt;
    return face;
}

/// Whether the meeting is an internal edge, as a face of the body's ground tells.
bool is_internal_edge_at(const Face& ground, const Simulation& simulation, const StepData& step,
                         const Meeting& m) {
    const Vec4 normal = normal_of(step, m);
    if (ground.normal.dot(normal) >= kSame) return false;
    const ContactList::Part contacts = contacts_of(step, m);
    const double flush = part_of(simulation.type_of(m.body), kFlush);
    const Placed other(simulation, step, m.other);
    const std::optional<Face> face = other.face_near(ground.normal);
    // No part of a body is over its own face, but a point may be by what the bodies lean.
    if (!face || !are_flush(*face, ground, simulation, step, m.body))
        for (const Contact c : contacts)
            if (height_over(ground, c, m.body) > flush) return false;
    // The points may be few of those where the bodies touch: nor may the other body rise there, but
    // by a face that the body comes to.
    if (!face) {
        if (other.depth_under(ground) >= -flush) return true;
        const std::optional<Face> rising = rising_face(ground, simulation, step, m);
        return rising && rising->normal.dot(normal) < kSame;
    }
    if (face->normal.dot(normal) >= kSame) return false;
    const double skin = part_of(simulation.type_of(m.body), kSkin);
    for (const Contact c : contacts)
        if (!(height_over(*face, c, m.body) >= -skin)) return false;
    return true;
}

/// Whether all points on a shape are near another rim of the face that they lie on.
template <HasFaces S>
bool lie_on_a_rim(const S& shape, const Pose& pose, BodyId body, const ContactList::Part& contacts,
                  double depth) {
    const Mat4 turn = to_matrix(pose.rotor).transpose();
    std::uint64_t faces = ~std::uint64_t{0};
    for (const Contact c : contacts) {
        faces &= faces_near(shape, turn * (point_below(c, body) - pose.position), depth);
        if (std::popcount(faces) < 2) return false;  // none but the face itself
    }
    return true;
}

}  // namespace

bool is_never_internal_edge(const Shape& shape, const Vec4& normal, std::span<const Vec4> points,
                            const TypeProperties& body) {
    const double depth = part_of(body, kDeepSkin);
    return std::visit(
        [&]<class S>(const S& s) {
            if constexpr (!HasFaces<S> || !S::kBounded) {
                return true;
            } else {
                if (!(normal.dot(face_along(s, normal).normal) >= kSurelyNear)) return false;
                std::uint64_t faces = ~std::uint64_t{0};
                for (const Vec4& point : points) faces &= faces_near(s, point, depth);
                return std::popcount(faces) < 2;
            }
        },
        shape);
}

bool may_be_internal_edge(const Simulation& simulation, const StepData& step, const Meeting& m) {
    const unsigned seen_from = m.other < m.body ? 1 : 2;
    if (step.contacts.no_internal_edge(m.begin, m.end) & seen_from) return false;
    const Placed other(simulation, step, m.other);
    const double depth = part_of(simulation.type_of(m.body), kSkin);
    return std::visit(
        [&]<class S>(const S& s) {
            if constexpr (!HasFaces<S> || !S::kBounded) {
                return false;
            } else {
                const Vec4 normal = other.to_own(normal_of(step, m));
                return normal.dot(face_along(s, normal).normal) < kNear ||
                       lie_on_a_rim(s, other.pose, m.body, contacts_of(step, m), depth);
            }
        },
        other.shape);
}

void EdgeJudge::clear() {
    corrections.clear();
    contacts.clear();
}

void EdgeJudge::judge(const Simulation& simulation, const StepData& step,
                      std::span<const Meeting> meetings) {
    find_ground(simulation, step, meetings);
    joined_.clear();
    for (const Ground& ground : grounds_)
        if (!ground.is_internal_edge && !is_joined(*ground.meeting))
            join_floor(ground.face, simulation, step, meetings);
    for (const Meeting& m : meetings) {
        if (!m.may_be_internal_edge || is_joined(m)) continue;
        const auto told = std::find_if(grounds_.begin(), grounds_.end(), [&](const Ground& g) {
            return !g.is_internal_edge && g.meeting != &m &&
                   is_internal_edge_at(g.face, simulation, step, m);
        });
        if (told != grounds_.end()) correct_edge(told->face, simulation, step, m);
    }
}

void EdgeJudge::find_ground(const Simulation& simulation, const StepData& step,
                            std::span<const Meeting> meetings) {
    grounds_.clear();
    for (const Meeting& m : meetings)
        if (const std::optional<Face> face = ground_face(simulation, step, m))
            grounds_.push_back({&m, *face, false});
    for (Ground& ground : grounds_)
        for (const Ground& other : grounds_)
            if (ground.meeting->may_be_internal_edge && &ground != &other &&
                is_internal_edge_at(other.face, simulation, step, *ground.meeting))
                ground.is_internal_edge = true;
}

bool EdgeJudge::is_joined(const Meeting& m) const {
    return std::find(joined_.begin(), joined_.end(), &m) != joined_.end();
}

/// All that does not move and has a face in the plane of the given one.
void EdgeJudge::find_floor(const Face& face, const Simulation& simulation, const StepData& step,
                           std::span<const Meeting> meetings) {
    floor_.clear();
    for (const Meeting& m : meetings) {
        if (simulation.type_of(m.other).movable || is_joined(m)) continue;
        const std::optional<Face> own = Placed(simulation, step, m.other).face_towards(face.normal);
        if (own && are_flush(*own, face, simulation, step, m.body))
            floor_.push_back({&m, *own, {}});
    }
}

/// The contacts that the body would have with a hyperplane in the face's place, if there is floor
/// under all of them.
void EdgeJudge::join_floor(const Face& face, const Simulation& simulation, const StepData& step,
                           std::span<const Meeting> meetings) {
    find_floor(face, simulation, step, meetings);
    if (floor_.size() < 2) return;
    const BodyId body = meetings[0].body;
    double margin = 0;
    for (const Floor& f : floor_)
        margin =
            std::max(margin, margins_of(simulation, step, body, f.meeting->other).as_they_move);
    // A wall's face ends at the floor, into which the body has sunk.
    const TypeProperties& type = simulation.type_of(body);
    double beside = part_of(type, kFlush);
    for (const Meeting& m : meetings) beside += depth_of(step, m);
    beside = std::min(beside, part_of(type, kSkin));
    find_on_plane(face, simulation, step, body, floor_[0].meeting->other, margin);
    for (const Contact& c : on_plane_) {
        const Vec4 point = point_below(c, 0);
        const auto under = std::find_if(floor_.begin(), floor_.end(), [&](const Floor& f) {
            return Placed(simulation, step, f.meeting->other).distance_to(point) <= beside;
        });
        if (under == floor_.end() && c.feature == kRimAhead) continue;
        if (under == floor_.end()) return;
        under->points |= 1u << (&c - on_plane_.data());
    }
    if (on_plane_.empty()) return;
    for (const Floor& f : floor_) stand_on(f, simulation, step);
}

void EdgeJudge::find_on_plane(const Face& face, const Simulation& simulation, const StepData& step,
                              BodyId body, BodyId ground, double margin) {
    const Placed placed(simulation, step, body);
    Hyperplane plane;
    plane.normal = face.normal;
    plane.offset = face.offset;
    on_plane_.clear();
    find_contacts(0, placed.shape, placed.pose, 1, plane, placed.pose, margin, on_plane_);
    if (simulation.needs.rims) add_rim_ahead_on_plane(simulation, step, body, ground, on_plane_);
}

/// The points of on_plane_ that are over one part of the floor.
void EdgeJudge::stand_on(const Floor& floor, const Simulation& simulation, const StepData& step) {
    const Meeting& m = *floor.meeting;
    const auto first = static_cast<std::uint32_t>(contacts.size());
    const BodyId a = std::min(m.body, m.other), b = std::max(m.body, m.other);
    const Placed placed_a(simulation, step, a), placed_b(simulation, step, b);
    const bool face_of_b = m.other == b;
    const Vec4 outward = (face_of_b ? placed_b : placed_a).to_own(floor.face.normal);
    const double margin = margins_of(simulation, step, a, b).as_they_move;
    for (std::size_t i = 0; i < on_plane_.size(); ++i) {
        const Contact& c = on_plane_[i];
        const Vec4 on_body = c.point - 0.5 * c.separation * c.normal;
        const double separation = floor.face.normal.dot(on_body) - floor.face.offset;
        if ((floor.points >> i & 1u) == 0 || separation > margin) continue;
        const std::uint32_t feature =
            c.feature == kRimAhead
                ? kRimAhead
                : feature_over_face(placed_a.shape, placed_b.shape, face_of_b, outward, c.feature);
        contacts.push_back({face_of_b ? Vec4(-floor.face.normal) : floor.face.normal,
                            on_body - 0.5 * separation * floor.face.normal, separation, a, b,
                            feature});
    }
    finish(m, first, floor.face.normal.dot(normal_of(step, m)));
    joined_.push_back(&m);
}

/// The points over a face of the other body that rises from the ground: also those that are beside
/// it but may come over it within the sub-step. There the face is covered by the ground.
void EdgeJudge::rise_on(const Face& face, const Simulation& simulation, const StepData& step,
                        const Meeting& m) {
    const Placed other(simulation, step, m.other);
    const double margin = margins_of(simulation, step, m.body, m.other).as_they_move;
    find_on_plane(face, simulation, step, m.body, m.other, margin);
    Floor floor{&m, face, 0};
    for (std::size_t i = 0; i < on_plane_.size(); ++i)
        if (other.distance_to(point_below(on_plane_[i], 0)) <= margin) floor.points |= 1u << i;
    stand_on(floor, simulation, step);
}

/// The points over the other body's own face. There are none if the body reaches over that face's
/// rim by nothing to speak of, as most do that touch at an edge.
void EdgeJudge::correct_edge(const Face& ground, const Simulation& simulation, const StepData& step,
                             const Meeting& m) {
    const Vec4& up = ground.normal;
    const auto first = static_cast<std::uint32_t>(contacts.size());
    const Vec4 normal = normal_of(step, m);
    const auto face = Placed(simulation, step, m.other).face_near(up);
    if (!face)
        if (const auto rising = rising_face(ground, simulation, step, m))
            return rise_on(*rising, simulation, step, m);
    const double flush = part_of(simulation.type_of(m.body), kFlush);
    if (face && (face->normal.dot(normal) > kSteep || depth_of(step, m) > flush)) {
        const BodyId a = std::min(m.body, m.other), b = std::max(m.body, m.other);
        const Placed placed_a(simulation, step, a), placed_b(simulation, step, b);
        find_contacts_over_face(a, placed_a.shape, placed_a.pose, b, placed_b.shape, placed_b.pose,
                                m.other == b, face->normal,
                                margins_of(simulation, step, a, b).as_they_move, contacts);
    }
    finish(m, first, up.dot(normal));
}

/// The contacts made since `first` take the place of the meeting's.
void EdgeJudge::finish(const Meeting& m, std::uint32_t first, double cosine) {
    std::sort(contacts.begin() + first, contacts.end(),
              [](const Contact& c, const Contact& d) { return c.feature < d.feature; });
    corrections.push_back(
        {m.begin, m.end, first, static_cast<std::uint32_t>(contacts.size()), cosine});
}

}  // namespace tesserae
