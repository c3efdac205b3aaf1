// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/rims.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <utility>

#include "core/contact/manifold.hpp"
#include "core/dynamics/motion/free_rotation.hpp"
#include "core/dynamics/step/room.hpp"
#include "core/shape/ball_product.hpp"

namespace tesserae {
namespace {

/// A surface that turns by less than this part of the overlap that is left alone does not roll, nor
/// does a body that turns by more than this angle [rad]: where it will be then says little.
constexpr double kRolls = 1e-3, kMostTurn = 1;
/// Of how fast a body rolls, what its ground may turn by.
constexpr double kTurnsLittle = 0.01;
/// Of how fast a body rolls, by what its ground may turn it in a sub-step: more, and it is pressed
/// or jammed between others too, whose impulses are not looked at.
constexpr double kMostTurned = 0.5;
/// Parts of the overlap that is left alone, by which a rim may come to be too deep where there is
/// no point: a twentieth of the half-size.
constexpr double kTooDeep = 10;
/// How far a point over a face may be off it, as a part of the body's bounding radius: contacts are
/// kept in float.
constexpr double kOverFace = 1e-6;
/// Of the angle between a contact's normal and that of a face that it is of: 1e-4 rad.
constexpr double kFaceNormalCosine = 1 - 5e-9;
/// Of the farthest point of a ball along a direction, what one on its rim has of that at least; and
/// what the direction has in the ball's plane: less, and all of the rim is as far.
constexpr double kOnRim = 1 - 1e-6, kLeans = 1e-5;

const BallProduct* ball_product(const Simulation& simulation, BodyId id) {
    return std::visit(
        []<class S>(const S& shape) -> const BallProduct* {
            if constexpr (std::derived_from<S, BallProduct>)
                return &shape;
            else
                return nullptr;
        },
        simulation.bodies.type_of(id).shape);
}

/// Whether a body rolls on another, which is left at rest here: what turns, or is round and yields,
/// changes normal and points in ways of its own, which would drive bodies that jam.
bool rolls(const Simulation& simulation, const StepData& step, BodyId id, BodyId on) {
    const TypeProperties &type = simulation.type_of(id), &ground = simulation.type_of(on);
    if (!type.has_rim || !type.movable || (ground.movable && !ground.flat)) return false;
    const double turning = norm(step.angular_velocity[id]), angle = step.h * turning;
    return norm(step.angular_velocity[on]) <= kTurnsLittle * turning && angle < kMostTurn &&
           type.arm * angle > kRolls * type.slop;
}

/// Whether a point of another body is straight over a face of this one.
/// @param into     this one, the contact's normal
/// @param height   of the point over it
/// @param off      which that may be off by [m]
bool is_over_face(const Simulation& simulation, const StepData& step, BodyId id, const Vec4& point,
                  const Vec4& into, double height, double off) {
    return std::visit(
        [&]<class S>(const S& shape) {
            if constexpr (!S::kBounded) {
                return true;
            } else if constexpr (HasFaces<S>) {
                const Mat4 to_own = to_matrix(step.rotor[id]).transpose();
                const Vec4 outward = to_own * -into;
                return face_along(shape, outward).normal.dot(outward) >= kFaceNormalCosine &&
                       std::abs(signed_distance(shape, to_own * (point - step.position[id])) -
                                height) <= off;
            } else {
                return false;
            }
        },
        simulation.bodies.type_of(id).shape);
}

struct Spin {
    Mat4 rotation;
    Bivector omega;  ///< world [rad/s]
};

/// As the contacts of a run leave a body, if their impulses are the last ones again.
Spin spin_now(const Simulation& simulation, const StepData& step, const ContactList::Run& run,
              BodyId id) {
    Bivector sum;
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const ContactImpulse& last = step.impulses[i];
        const Vec4 on_b = last.normal * step.contacts.normal(i) + last.tangent();
        sum += wedge(step.contacts.point(i) - step.position[id], id == run.b ? on_b : Vec4(-on_b));
    }
    return {to_matrix(step.rotor[id]),
            step.angular_velocity[id] + angular_response(simulation, step, id, sum)};
}

/// A sub-step later, if nothing else happens.
Spin spin_ahead(const Simulation& simulation, const StepData& step, BodyId id, Bivector omega) {
    Rotor rotor = step.rotor[id];
    for (int half = 0; half < 2; ++half)
        turn_freely(simulation.type_of(id), simulation.settings.integrator, 0.5 * step.h, rotor,
                    omega);
    return {to_matrix(rotor), omega};
}

/// What becomes of a point that touches.
struct Way {
    double nearer;  ///< by which the surfaces come nearer than the points do [m]
    Vec4 change;    ///< of the velocity, by turning, of the material that touches [m/s]
};

/// Of a point of a surface that is on the rim of a ball, that is, which another one follows.
/// @param point   from the body's centre
/// @param out     of the body, into what it rolls on
std::optional<Way> way_of(const BallProduct& shape, const Spin& now, const Spin& ahead, double h,
                          const Vec4& point, const Vec4& out) {
    const Vec4 own = now.rotation.transpose() * point;
    const Vec4 down = now.rotation.transpose() * out, down_ahead = ahead.rotation.transpose() * out;
    Vec4 next = own;
    bool on_rim = false;
    for (const BallFactor& ball : shape) {
        const Vec4 part = ball.axes.cwiseProduct(down);
        const double leans = part.norm();
        if (ball.dimensions == 1 || leans < kLeans || own.dot(part) < kOnRim * ball.radius * leans)
            continue;
        next += support(ball, down_ahead) - ball.axes.cwiseProduct(own);
        on_rim = true;
    }
    if (!on_rim) return std::nullopt;
    const Vec4 velocity = velocity_at(now.omega, point);
    return Way{next.dot(down_ahead) - out.dot(point + h * velocity),
               velocity_at(ahead.omega, ahead.rotation * next) - velocity};
}

/// All heights are along the normal out of the body, from its centre.
/// @param is_over   whether a point so high is straight over the ground's face
template <class IsOver>
void add_ahead(const Simulation& simulation, const StepData& step, BodyId id, const Vec4& out,
               const IsOver& is_over, std::size_t first, std::vector<Contact>& list) {
    const BallProduct& shape = *ball_product(simulation, id);
    const Bivector& omega = step.angular_velocity[id];
    const Vec4 centre = step.position[id];
    const auto advance = [&](const Vec4& r) { return step.h * out.dot(velocity_at(omega, r)); };
    double held = kMiss;  // how much nearer the centre may come, as far as the points know
    std::size_t nearest = first, farthest = first;
    for (std::size_t i = first; i < list.size(); ++i) {
        held = std::min(held, list[i].separation - advance(list[i].point - centre));
        if (list[i].separation < list[nearest].separation) nearest = i;
        if (list[i].separation > list[farthest].separation) farthest = i;
    }
    Contact ahead = list[nearest];
    const double face = out.dot(ahead.point - centre) + 0.5 * ahead.separation;
    const Mat4 then = spin_ahead(simulation, step, id, omega).rotation;
    const Vec4 own = support(shape, then.transpose() * out), r = to_matrix(step.rotor[id]) * own;
    const double left = face - out.dot(then * own) + kTooDeep * simulation.type_of(id).slop;
    const double height = face - out.dot(r);
    if (!(left < held) || !is_over(Vec4(centre + r), height)) return;
    ahead.separation = std::max(left + advance(r), std::min(height, 0.0));
    ahead.point = centre + r + (height - 0.5 * ahead.separation) * out;
    ahead.feature = kRimAhead;
    if (list.size() - first == kManifoldPoints)
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(farthest));
    list.push_back(ahead);
}

void aim_rim(const Simulation& simulation, StepData& step, std::size_t n, bool is_a) {
    const ContactList::Run run = step.contacts.nth_run(n);
    const BodyId id = is_a ? run.a : run.b, on = is_a ? run.b : run.a;
    const unsigned alone = simulation.type_of(on).movable ? 1 : 0;
    if (step.company[id] > alone || !rolls(simulation, step, id, on)) return;
    const BallProduct& shape = *ball_product(simulation, id);
    const Spin now = spin_now(simulation, step, run, id);
    if (norm(now.omega - step.angular_velocity[id]) > kMostTurned * norm(step.angular_velocity[id]))
        return;
    const Spin ahead = spin_ahead(simulation, step, id, now.omega);
    const Vec4 normal = step.contacts.normal(run.begin), out = is_a ? normal : Vec4(-normal);
    const double off = kOverFace * simulation.type_of(id).radius;
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const double separation = step.contacts.separation(i);
        const Vec4 point = step.contacts.point(i) - 0.5 * separation * out;
        const auto way = way_of(shape, now, ahead, step.h, point - step.position[id], out);
        if (!way || !is_over_face(simulation, step, on, point, out, separation, off)) continue;
        step.rises[i] = std::max(0.0, way->nearer / step.h);
        const Vec4 slip = (is_a ? -0.5 : 0.5) * way->change;
        step.rim_slips[i] = slip - normal.dot(slip) * normal;
    }
}

}  // namespace

void add_rim_ahead(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                   std::size_t first, std::vector<Contact>& list) {
    if (list.size() == first) return;
    for (const auto& [id, on] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)}) {
        if (simulation.type_of(on).movable || !rolls(simulation, step, id, on)) continue;
        const Vec4 out = id == pair.a ? list[first].normal : Vec4(-list[first].normal);
        const double off = kOverFace * simulation.type_of(id).radius;
        // Named anew: clang 14 lets no lambda have a structured binding.
        const auto is_over = [&, ground = on](const Vec4& point, double height) {
            return is_over_face(simulation, step, ground, point, out, height, off);
        };
        return add_ahead(simulation, step, id, out, is_over, first, list);
    }
}

void add_rim_ahead_on_plane(const Simulation& simulation, const StepData& step, BodyId id,
                            BodyId ground, std::vector<Contact>& list) {
    if (list.empty() || !rolls(simulation, step, id, ground)) return;
    const Vec4 out = list[0].normal;
    add_ahead(
        simulation, step, id, out, [](const Vec4&, double) { return true; }, 0, list);
}

void count_company(const Simulation& simulation, StepData& step) {
    step.company.assign(simulation.bodies.size(), 0);
    for (std::size_t n = 0; n < step.contacts.run_count(); ++n) {
        const ContactList::Run run = step.contacts.nth_run(n);
        if (!simulation.type_of(run.a).movable || !simulation.type_of(run.b).movable) continue;
        for (const BodyId id : {run.a, run.b})
            step.company[id] = static_cast<std::uint8_t>(std::min(step.company[id] + 1, 2));
    }
}

void aim_rims(const Simulation& simulation, StepData& step, Range runs) {
    for (std::size_t n = runs.begin; n < runs.end; ++n) {
        const ContactList::Run run = step.contacts.nth_run(n);
        std::fill(step.rises.data() + run.begin, step.rises.data() + run.end, 0.0);
        std::fill(step.rim_slips.data() + run.begin, step.rim_slips.data() + run.end,
                  Vec4(Vec4::Zero()));
        for (const bool is_a : {true, false}) aim_rim(simulation, step, n, is_a);
    }
}

}  // namespace tesserae
