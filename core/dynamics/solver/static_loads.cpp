// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/static_loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/solver/motion_roots.hpp"

namespace tesserae {
namespace {

/// Of a body's motion, in units of the root of its mass and inertia: half of its square is a
/// kinetic energy. Four numbers of its velocity, then its turning.
using Part = BlockCholesky::Part;

/// Runs of contacts above which bodies are not even counted: each of them in some corner.
constexpr std::size_t kMostRuns = 8 * BlockCholesky::kMostRows;

/// One direction of a contact point.
struct Along {
    Vec4 axis;
    Part a, b;           ///< what a unit impulse does to the bodies
    double speed;        ///< before any impulse of the load [m/s]
    double warm_start;   ///< the last step's impulse [N s]
    double impulse = 0;  ///< [N s]
};

struct Point {
    std::size_t contact;         ///< its place in the list
    std::size_t a, b;            ///< the bodies' places
    std::array<Along, 4> along;  ///< the normal and three tangents
    bool touches;
    std::size_t held;  ///< along how many of them: none, the normal or all
    double friction;
    double stiffness;  ///< of what holds it [kg]
};

/// What warm start's impulses give a body.
struct Impulse {
    Vec4 straight = Vec4::Zero();  ///< [N s]
    Bivector turning;              ///< [N m s]
};

/// Where the points of a run act. In coloured islands all are as high along the normal as the
/// deepest (see GeneralRow): loads that hold still where they are would not there.
class Places {
  public:
    Places(const StepData& step, const ContactList::Run& run, bool coloured)
        : contacts_(step.contacts), normal_(step.contacts.normal(run.begin)), level_(coloured) {
        std::size_t deepest = run.begin;
        for (std::size_t i = run.begin + 1; i < run.end; ++i)
            if (contacts_.separation(i) < contacts_.separation(deepest)) deepest = i;
        height_ = normal_.dot(contacts_.point(deepest));
    }
    Vec4 of(std::size_t contact) const {
        const Vec4 point = contacts_.point(contact);
        return level_ ? Vec4(point + (height_ - normal_.dot(point)) * normal_) : point;
    }

  private:
    const ContactList& contacts_;
    Vec4 normal_;
    bool level_;
    double height_;
};

/// The load of one island.
class StaticLoad {
  public:
    void begin(const Simulation& simulation, StepData& step, std::size_t island) {
        simulation_ = &simulation, step_ = &step;
        runs_ = step.islands.runs_in(island);
        island_ = island, coloured_ = step.islands.is_coloured(island);
    }
    /// @return whether there are few enough, and none whose rolling friction resists
    bool list_bodies();
    /// @return whether they touch so that solve() takes little work
    bool couple();
    /// Takes the memory of a solve, whether there is one or not: a thread that has seen an island
    /// once then takes no more.
    void reserve();
    /// Whether they move, but so slowly that nothing bounces.
    bool creeps();
    void list_points();
    void solve();
    /// Whether it takes more energy than the warm start, whose impulses it then replaces.
    bool is_better() const;
    void keep() const;

  private:
    ContactList::Run run(std::uint32_t n) const { return step_->contacts.nth_run(n); }
    /// Of all that contacts do not move: the one after the others.
    std::size_t place_of(BodyId id) const;
    void add_point(std::size_t contact, const Vec4& at);
    void hold();
    void make_matrix();
    bool let_go();
    bool take_back();
    void change(Point& point, Along& along, double impulse);
    static double speed(const Point& point, const Along& along, std::span<const Part> motion) {
        return along.speed + along.a.dot(motion[point.a]) + along.b.dot(motion[point.b]);
    }

    const Simulation* simulation_ = nullptr;
    StepData* step_ = nullptr;
    std::span<const std::uint32_t> runs_;
    std::size_t island_ = 0;
    bool coloured_ = false;
    std::vector<BodyId> bodies_;
    std::vector<Impulse> given_;
    std::vector<MotionRoots> roots_;
    std::vector<Point> points_;
    std::vector<Part> motion_, warm_motion_, next_;
    BlockCholesky matrix_;
};

std::size_t StaticLoad::place_of(BodyId id) const {
    if (!simulation_->type_of(id).movable) return bodies_.size();
    const auto place = std::lower_bound(bodies_.begin(), bodies_.end(), id);
    return static_cast<std::size_t>(place - bodies_.begin());
}

bool StaticLoad::list_bodies() {
    bodies_.clear();
    if (runs_.size() > kMostRuns) return false;
    for (const std::uint32_t n : runs_)
        for (const BodyId id : {run(n).a, run(n).b}) {
            const TypeProperties& type = simulation_->type_of(id);
            if (type.rolling_friction > 0) return false;
            if (type.movable) bodies_.push_back(id);
        }
    std::sort(bodies_.begin(), bodies_.end());
    bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
    return bodies_.size() <= BlockCholesky::kMostRows;
}

bool StaticLoad::couple() {
    matrix_.begin(bodies_.size());
    for (const std::uint32_t n : runs_) {
        const std::size_t a = place_of(run(n).a), b = place_of(run(n).b);
        if (std::max(a, b) < bodies_.size()) matrix_.couple(a, b);
    }
    return matrix_.arrange() <= kStaticWork * bodies_.size();
}

void StaticLoad::reserve() {
    const std::size_t bodies = bodies_.size() + 1;
    roots_.reserve(bodies);
    motion_.reserve(bodies), warm_motion_.reserve(bodies), next_.reserve(bodies);
    points_.reserve(step_->islands.contacts[island_]);
}

bool StaticLoad::creeps() {
    const Vec4 kick = step_->h * simulation_->settings.gravity;
    // Squared, at the first point of each run: what tips over an edge is held there all the way.
    double fastest = 0;
    given_.assign(bodies_.size() + 1, {});
    for (const std::uint32_t n : runs_) {
        const auto [begin, end, a, b] = run(n);
        const Places places(*step_, run(n), coloured_);
        const Vec4 at = places.of(begin);
        const double kicks =
            simulation_->type_of(b).gravity_scale - simulation_->type_of(a).gravity_scale;
        const Vec4 v = relative_velocity(*step_, a, at - step_->position[a], b,
                                         at - step_->position[b], simulation_->needs.turning);
        fastest = std::max(fastest, (v - kicks * kick).squaredNorm());
        Impulse &of_a = given_[place_of(a)], &of_b = given_[place_of(b)];
        for (std::size_t i = begin; i < end; ++i) {
            const ContactImpulse& last = step_->impulses[i];
            if (last.normal == 0) continue;
            const Vec4 impulse = last.normal * step_->contacts.normal(i) + last.tangent();
            of_a.straight -= impulse, of_b.straight += impulse;
            of_a.turning += wedge(impulse, places.of(i) - step_->position[a]);
            of_b.turning += wedge(places.of(i) - step_->position[b], impulse);
        }
    }
    if (fastest > kRestitutionKicks * kRestitutionKicks * kick.squaredNorm()) return false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyId id = bodies_[i];
        const TypeProperties& type = simulation_->type_of(id);
        const Vec4 v = step_->velocity[id] + type.inverse_mass * given_[i].straight;
        const Bivector w = step_->angular_velocity[id] +
                           angular_response(*simulation_, *step_, id, given_[i].turning);
        if (v.norm() + type.arm * norm(w) > kStandsStill * kick.norm()) return true;
    }
    return false;
}

void StaticLoad::add_point(std::size_t place, const Vec4& at) {
    const Contact contact = step_->contacts[place];
    const Vec4& normal = contact.normal;
    Point& point = points_.emplace_back();
    point.contact = place;
    point.a = place_of(contact.a), point.b = place_of(contact.b);
    point.friction = friction_of(*simulation_, contact.a, contact.b);
    const Vec4 r_a = at - step_->position[contact.a], r_b = at - step_->position[contact.b];
    const Vec4 v =
        relative_velocity(*step_, contact.a, r_a, contact.b, r_b, simulation_->needs.turning);
    const Vec4 slip = v + slip_by_turning(*simulation_, *step_, contact, Cause::kLoad);
    const ContactImpulse& last = step_->impulses[place];
    const Vec4 tangent = last.tangent() - normal.dot(last.tangent()) * normal;
    const Vec4 friction = clamped_to_ball(tangent, point.friction * last.normal);

    // The reflection v - 2 (h.v) h takes the normal to the w axis, and the others to tangents.
    Vec4 h = normal;
    h[3] += sign_of(normal[3]);
    h.normalize();
    for (int i = 0; i < 4; ++i) {
        Along& along = point.along[static_cast<std::size_t>(i)];
        along.axis = i == 0 ? normal : Vec4(Vec4::Unit(i - 1) - 2 * h[i - 1] * h);
        along.a = -roots_[point.a].of(r_a, {along.axis, {}});
        along.b = roots_[point.b].of(r_b, {along.axis, {}});
        along.speed = along.axis.dot(i == 0 ? v : slip);
        along.warm_start = i == 0 ? last.normal : along.axis.dot(friction);
        warm_motion_[point.a] += along.warm_start * along.a;
        warm_motion_[point.b] += along.warm_start * along.b;
    }
    const double response = point.along[0].a.squaredNorm() + point.along[0].b.squaredNorm();
    point.stiffness = response > 0 ? kStaticStiffness / response : 0;
    point.touches = contact.separation <= resting_gap(*simulation_, contact.a, contact.b);
    point.held = point.touches ? point.friction > 0 ? 4 : 1 : 0;
}

void StaticLoad::list_points() {
    roots_.clear();
    for (const BodyId id : bodies_) roots_.emplace_back(*simulation_, *step_, id);
    roots_.emplace_back();
    motion_.assign(roots_.size(), Part::Zero());
    warm_motion_ = motion_;
    points_.clear();
    for (const std::uint32_t n : runs_) {
        const Places places(*step_, run(n), coloured_);
        for (std::size_t place = run(n).begin; place < run(n).end; ++place)
            add_point(place, places.of(place));
    }
}

void StaticLoad::change(Point& point, Along& along, double impulse) {
    along.impulse += impulse;
    motion_[point.a] += impulse * along.a;
    motion_[point.b] += impulse * along.b;
}

/// As dampers would that are so stiff that hardly anything moves.
void StaticLoad::hold() {
    for (Point& point : points_)
        for (std::size_t i = 0; i < point.held; ++i)
            change(point, point.along[i], -point.along[i].impulse);
    make_matrix();
    next_.assign(motion_.size(), Part::Zero());
    for (const Point& point : points_)
        for (std::size_t i = 0; i < point.held; ++i) {
            const Along& along = point.along[i];
            const double pull = -point.stiffness * speed(point, along, motion_);
            next_[point.a] += pull * along.a;
            next_[point.b] += pull * along.b;
        }
    matrix_.solve(std::span(next_).first(bodies_.size()));
    for (std::size_t i = 0; i < next_.size(); ++i) next_[i] += motion_[i];
    for (Point& point : points_)
        for (std::size_t i = 0; i < point.held; ++i)
            change(point, point.along[i], -point.stiffness * speed(point, point.along[i], next_));
}

void StaticLoad::make_matrix() {
    matrix_.clear();
    for (const Point& point : points_) {
        const double root = std::sqrt(point.stiffness);
        for (std::size_t i = 0; i < point.held; ++i) {
            const Part a = root * point.along[i].a, b = root * point.along[i].b;
            if (std::max(point.a, point.b) < bodies_.size())
                matrix_.add(point.a, a, point.b, b);
            else if (point.a < bodies_.size())
                matrix_.add(point.a, a);
            else
                matrix_.add(point.b, b);
        }
    }
    matrix_.factorize();
}

/// What contacts and friction do not bear.
/// @return whether that is anything
bool StaticLoad::let_go() {
    bool any = false;
    for (Point& point : points_) {
        auto& [normal, x, y, z] = point.along;
        if (normal.impulse < 0) {
            for (Along& along : point.along) change(point, along, -along.impulse);
            point.held = 0;
            any = true;
        }
        const double most = point.friction * normal.impulse;
        const double friction = Vec4(x.impulse, y.impulse, z.impulse, 0).norm();
        if (friction <= most) continue;
        for (Along* along : {&x, &y, &z})
            change(point, *along, (most / friction - 1) * along->impulse);
        any |= point.held == 4;
        point.held = 1;
    }
    return any;
}

/// Points that were let go and that now move into what they touch.
/// @return whether there are any
bool StaticLoad::take_back() {
    const double still = kStandsStill * step_->h * simulation_->settings.gravity.norm();
    bool any = false;
    for (Point& point : points_) {
        const bool into = speed(point, point.along[0], motion_) < -still;
        if (point.held > 0 || !point.touches || !into) continue;
        point.held = 1;
        any = true;
    }
    return any;
}

void StaticLoad::solve() {
    for (int round = 0; round < kStaticRounds; ++round) {
        hold();
        if (!let_go() && !take_back()) return;
    }
}

bool StaticLoad::is_better() const {
    double energy = 0;  // what is given more
    for (const Point& point : points_)
        for (const Along& along : point.along)
            energy += (along.impulse - along.warm_start) *
                      (speed(point, along, warm_motion_) + speed(point, along, motion_));
    return energy < 0;
}

void StaticLoad::keep() const {
    for (const Point& point : points_) {
        const auto& [normal, x, y, z] = point.along;
        step_->impulses[point.contact] = contact_impulse(
            normal.impulse, x.impulse * x.axis + y.impulse * y.axis + z.impulse * z.axis);
    }
}

}  // namespace

void hold_still(const Simulation& simulation, StepData& step, std::size_t island) {
    if (simulation.settings.gravity.isZero(0)) return;
    if (!step.islands.held[island]) return;
    if (!step.islands.constraints_in(island).empty()) return;
    thread_local StaticLoad load;
    load.begin(simulation, step, island);
    if (!load.list_bodies() || !load.couple()) return;
    load.reserve();
    if (!load.creeps()) return;
    load.list_points();
    load.solve();
    if (load.is_better()) load.keep();
}

}  // namespace tesserae
