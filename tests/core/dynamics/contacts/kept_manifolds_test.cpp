// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/kept_manifolds.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/contacts/edge_judge.hpp"
#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// The narrow phase of one pair at rest, from sub-step to sub-step.
class PairAtRest {
  public:
    PairAtRest(const BodyType& a, const BodyType& b) {
        Bodies bodies;
        add(bodies, a);
        add(bodies, b);
        simulation_ = make_simulation(bodies, without_gravity());
        begin_step(simulation_, step_, 1.0 / 240);
        step_.velocity.assign(2, Vec4::Zero());
        step_.rotor.resize(2);
        step_.angular_velocity.assign(2, Bivector{});
        step_.pairs = {{0, 1}};
    }
    void put(BodyId id, const Vec4& position, const Rotor& rotor) {
        step_.position[id] = position, step_.rotor[id] = rotor;
    }
    std::vector<Contact> find_kept() {
        std::vector<Contact> list;
        Schedule serial;
        begin_kept(step_, 1, step_.last_kept, spare_);
        clearances_.begin(simulation_, step_, serial);
        find_kept_contacts(simulation_, step_, {0, 1}, step_.last_kept, step_.kept, spare_,
                           clearances_, list);
        clearances_.end(step_, serial);
        step_.last_kept = step_.kept;
        return list;
    }
    std::vector<Contact> find_anew() {
        std::vector<Contact> list;
        find_contacts(simulation_, step_, {0, 1}, list);
        return list;
    }
    /// Whether the pair may be an internal edge, seen from a (bit 0) and from b (bit 1).
    unsigned internal_edges_of(const std::vector<Contact>& list) {
        step_.contacts = ContactList(list);
        const auto end = static_cast<std::uint32_t>(list.size());
        return (may_be_internal_edge(simulation_, step_, {1, 0, 0, end}) ? 1u : 0u) |
               (may_be_internal_edge(simulation_, step_, {0, 1, 0, end}) ? 2u : 0u);
    }
    /// How far b may be moved against a [m].
    double most() const {
        const auto& types = simulation_.types;
        return kKeptMotion / kSlop * std::min(types[0].slop, types[1].slop);
    }
    double radius() const { return simulation_.types[1].radius; }
    const KeptManifold& manifold() const { return *step_.kept.at(0).at(0); }

  private:
    Simulation simulation_;
    StepData step_;
    SpareManifolds spare_;
    Clearances clearances_;
};

double deepest(const std::vector<Contact>& contacts) {
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& c : contacts) least = std::min(least, c.separation);
    return least;
}

Rotor small_rotor(std::mt19937_64& random, double angle) {
    std::normal_distribution<> part;
    const Bivector plane{part(random), part(random), part(random),
                         part(random), part(random), part(random)};
    return exp(-0.5 * angle / norm(plane) * plane);
}

/// Two bodies face to face, moved against each other by up to what is kept and anywhere together.
TEST(KeptContacts, AreThoseOfANewSearch) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<> part(-0.3, 0.3);
    const std::vector<BodyType> types = {box_type({1, 0.8, 0.6, 1.2}), box_type({2, 1, 1.5, 0.5}),
                                         regular_type(RegularPolychoron::k24Cell, 0.7),
                                         regular_type(RegularPolychoron::k8Cell, 0.8)};
    int kept = 0, no_internal_edge = 0;
    double worst = 0, worst_turned = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const BodyType &a = types[random() % 4], &b = types[random() % 4];
        PairAtRest pair(a, b);
        const double gap = pair.most() * part(random);
        const Vec4 offset{part(random), 0, part(random), part(random)};
        const Vec4 up = Vec4::UnitY();
        const double height = std::visit(
            [&](const auto& s, const auto& t) {
                return half_extent_along(s, up) + half_extent_along(t, up);
            },
            a.shape, b.shape);
        const bool turns = trial % 2 == 1;
        const Rotor turned = turns ? small_rotor(random, 1e-4) : Rotor{};
        pair.put(0, Vec4::Zero(), Rotor{});
        pair.put(1, offset + (height + gap) * up, turned);
        const std::vector<Contact> first = pair.find_kept();
        if (first.empty() || pair.manifold().count == 0) continue;  // vertex or edge below
        ++kept;

        const Rotor together = small_rotor(random, 2);
        const Vec4 far = random_vector(random, 5);
        const double angle = turns ? 0.4 * pair.most() / pair.radius() : 0;
        const Rotor own = turns ? small_rotor(random, angle) : Rotor{};
        const Vec4 moved = 0.4 * pair.most() * random_vector(random, 1).normalized();
        pair.put(0, far, together);
        pair.put(1, far + rotate(together, offset + (height + gap) * up + moved),
                 together * own * turned);
        const KeptManifold before = pair.manifold();
        const std::vector<Contact> now = pair.find_kept(), anew = pair.find_anew();
        EXPECT_EQ(pair.manifold().offset, before.offset);  // not found again
        ASSERT_FALSE(now.empty());
        ASSERT_FALSE(anew.empty());
        // What is known of internal edges beforehand is what the points say.
        std::vector<Contact> unknown = now;
        for (Contact& contact : unknown) contact.no_internal_edge = 0;
        EXPECT_EQ(pair.internal_edges_of(now), pair.internal_edges_of(unknown)) << trial;
        if (now[0].no_internal_edge != 0 && now.size() == now[0].no_internal_edge_points)
            ++no_internal_edge;
        const double difference = std::abs(deepest(now) - deepest(anew));
        EXPECT_LT((now[0].normal - anew[0].normal).norm(), 2 * (1e-4 + angle) + 1e-12) << trial;
        if (!turns) worst = std::max(worst, difference);
        // Seen along the face of the one or of the other, which are as good.
        if (turns)
            worst_turned = std::max(worst_turned, difference / ((1e-4 + angle) * pair.radius()));
    }
    EXPECT_GT(kept, 1000);
    EXPECT_GT(no_internal_edge, 500);
    EXPECT_LT(worst, 2e-11);  // separations of 1.5e-4 m, in float
    EXPECT_LT(worst_turned, 1);
}

/// Together anywhere: the same points as before, to rounding.
TEST(KeptContacts, GoAlongWithBothBodies) {
    std::mt19937_64 random(6);
    for (int trial = 0; trial < 1000; ++trial) {
        PairAtRest pair(box_type({1, 0.8, 0.6, 1.2}), box_type({0.7, 0.8, 0.6, 1}));
        const Vec4 offset{0.1, 0.799, 0.05, -0.2};
        pair.put(0, Vec4::Zero(), Rotor{});
        pair.put(1, offset, Rotor{});
        const std::vector<Contact> first = pair.find_kept();
        ASSERT_EQ(first.size(), 8u);
        const Rotor together = small_rotor(random, 3);
        const Vec4 far = random_vector(random, 100);
        pair.put(0, far, together);
        pair.put(1, far + rotate(together, offset), together);
        const std::vector<Contact> now = pair.find_kept();
        ASSERT_EQ(now.size(), 8u);
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_EQ(now[i].feature, first[i].feature);
            EXPECT_NEAR(now[i].separation, first[i].separation, 1e-13);
            EXPECT_LT((now[i].normal - rotate(together, first[i].normal)).norm(), 1e-14);
            EXPECT_LT((now[i].point - far - rotate(together, first[i].point)).norm(), 1e-12);
        }
    }
}

TEST(KeptContacts, AreFoundAnewOnceBodiesHaveMoved) {
    PairAtRest pair(box_type(Vec4::Ones()), box_type(Vec4::Ones()));
    pair.put(0, Vec4::Zero(), Rotor{});
    pair.put(1, {0, 0.999, 0, 0}, Rotor{});
    pair.find_kept();
    for (const double times : {0.9, 1.1}) {
        const Vec4 there{times * pair.most(), 0.999, 0, 0};
        pair.put(1, there, Rotor{});
        pair.find_kept();
        EXPECT_EQ(pair.manifold().offset == there, times > 1);
    }
    const Rotor turned = exp(Bivector{0, 0, 0, 0, 0, -0.6 * pair.most() / pair.radius()});
    pair.put(1, {1.1 * pair.most(), 0.999, 0, 0}, turned);
    pair.find_kept();
    EXPECT_TRUE(pair.manifold().rotor == turned);
}

/// Rows of boxes, each row moved by half a box.
Bodies wall(int rows, int columns) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    BodyType box = box_type({1, 0.5, 0.5, 0.5}, 125);
    box.friction = 0.5;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const Vec4 place{1.05 * column + (row % 2 == 0 ? 0 : 0.25), 0.5 * (row + 0.5), 0, 0};
            if (row + column == 0)
                add(bodies, box, place);
            else
                add(bodies, 1u, place);
        }
    return bodies;
}

/// A file has only where manifolds were found: all else is found again, to the same bits.
TEST(KeptContacts, FollowFromWhereTheyWereFound) {
    for (const int substeps : {1, 2}) {
        PhysicsSettings settings;
        settings.substeps = substeps;
        Stepper world(wall(5, 4), settings);
        run(world, 40);
        std::size_t points = 0;
        for (const KeptManifolds& list : world.memory().kept)
            for (const auto& manifold : list) points += manifold->count;
        EXPECT_GT(points, 200u);

        Stepper again(world.bodies(), settings);
        again.memory() = world.memory();
        again.memory().kept.clear();
        again.memory().kept.resize(3);  // lists may be shared out in any way
        for (const KeptManifolds& list : world.memory().kept)
            for (const auto& manifold : list) {
                KeptManifold m = *manifold;
                m.keeps = KeptManifold::Keeps::kUnknown;
                m.points.fill({}), m.count = 7;
                again.memory().kept[m.a < 8 ? 0 : 2].push_back(std::make_shared<KeptManifold>(m));
            }
        run(world, 40);
        run(again, 40);
        EXPECT_TRUE(same_bits(world.bodies(), again.bodies()));
        EXPECT_TRUE(same_values(world.memory(), again.memory()));

        Stepper without(world.bodies(), settings);
        without.memory() = world.memory();
        without.memory().kept.clear();
        run(world, 40);
        run(without, 40);
        EXPECT_FALSE(same_bits(world.bodies(), without.bodies()));  // so it is state
    }
}

/// Ranges of pairs find what was kept, however it is shared out: here in lists of 0 to 5, of 10^3
/// pairs and more ranges than one.
TEST(KeptContacts, AreFoundInManyLists) {
    Stepper world(wall(25, 24), {});
    run(world, 5);
    Stepper again(world.bodies(), {});
    again.memory() = world.memory();
    again.memory().kept.clear();
    std::size_t lists = 0, manifolds = 0;
    for (const KeptManifolds& list : world.memory().kept)
        for (const auto& manifold : list) {
            if (manifolds++ == lists) {
                again.memory().kept.resize(again.memory().kept.size() + 1 + lists % 3);
                lists += 1 + lists % 5;
            }
            again.memory().kept.back().push_back(manifold);
        }
    EXPECT_GT(manifolds, 1000u);
    EXPECT_GT(again.memory().kept.size(), 300u);
    run(world, 20);
    run(again, 20);
    EXPECT_TRUE(same_bits(world.bodies(), again.bodies()));
    EXPECT_TRUE(same_values(world.memory(), again.memory()));
}

/// Two that fall together, one above the other, may be stopped one after the other: points are
/// found that close by the upper one's own speed.
TEST(Margins, AreThoseOfWhatMayBeStopped) {
    const double half = 0.5, slop = kSlop * half, deepest = 2 * kDeepest * half;
    for (const BodyType& type : {sphere_type(half), box_type(Vec4::Constant(2 * half))})
        for (const double speed : {0.0, 1.0, 12.0, 1e4})
            for (const double part : {0.98, 1.02}) {
                const double reach = slop + std::min(speed / 240, deepest);
                Bodies bodies;
                for (const double y : {0.0, 2 * half + part * reach})
                    add(bodies, type, {0, y, 0, 0}, {0, -speed, 0, 0});
                const StepData step = solved(bodies, without_gravity(), 1.0 / 240, 1);
                EXPECT_EQ(step.contacts.empty(), part > 1) << speed;
                EXPECT_LT((step.velocity[1] + speed * Vec4::UnitY()).norm(), 1e-12);
            }
}

/// Twenty rows high, half a metre thick: it swayed by 10 mm/s for many seconds.
TEST(Wall, ComesToRestAtTheDefaults) {
    Stepper world(wall(20, 10), PhysicsSettings{});
    StepReport report;
    for (int i = 0; i < 480; ++i) report = world.step(1.0 / 240);
    double sum = 0;
    for (const Vec4& velocity : world.bodies().velocity) sum += velocity.norm();
    EXPECT_LT(sum / 200, 2e-3);
    EXPECT_LT(report.penetration, 1e-3);
    EXPECT_LT((world.bodies().position.back() - wall(20, 10).position.back()).norm(), 0.01);
}

}  // namespace
}  // namespace tesserae
