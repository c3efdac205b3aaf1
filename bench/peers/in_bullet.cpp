// SPDX-License-Identifier: Apache-2.0
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

#include "bench/peers/engine.hpp"

namespace tesserae::bench {
namespace {

btVector3 vector_of(const Vec4& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()),
            static_cast<btScalar>(v.z())};
}

btMatrix3x3 matrix_of(const Mat4& m) {
    const auto number = [&](int i, int j) { return static_cast<btScalar>(m(i, j)); };
    return {number(0, 0), number(0, 1), number(0, 2), number(1, 0), number(1, 1),
            number(1, 2), number(2, 0), number(2, 1), number(2, 2)};
}

/// Bullet's defaults, but no split of the step and nobody falls asleep.
class InBullet : public PeerEngine {
  public:
    InBullet(const PeerScene& scene, int iterations, bool two_directions) {
        world_.setGravity(btVector3(0, static_cast<btScalar>(-kPeerGravity), 0));
        btContactSolverInfo& solver = world_.getSolverInfo();
        solver.m_numIterations = iterations;
        if (two_directions) solver.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;

        for (const PeerKind& kind : scene.kinds)
            if (kind.radius > 0)
                shapes_.push_back(
                    std::make_unique<btSphereShape>(static_cast<btScalar>(kind.radius)));
            else
                shapes_.push_back(std::make_unique<btBoxShape>(vector_of(0.5 * kind.sides)));
        for (std::size_t i = 0; i < scene.size(); ++i)
            add_body(scene.kinds[scene.kind[i]].mass, *shapes_[scene.kind[i]], scene.position[i],
                     scene.rotor);
        moving_ = bodies_.size();
        for (const Wall& wall : scene.walls) add_wall(wall, scene.half_width);
    }
    ~InBullet() override {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    InBullet(const InBullet&) = delete;
    InBullet& operator=(const InBullet&) = delete;

    void step() override { world_.stepSimulation(static_cast<btScalar>(kPeerStep), 0); }

    PeerContacts contacts() override {
        PeerContacts found;
        for_each_point([&](const btManifoldPoint& point) {
            found.points += 1;
            found.touching += point.getDistance() <= 0 || point.m_appliedImpulse > 0;
        });
        return found;
    }
    double penetration() const override {
        double deepest = 0;
        for_each_point([&](const btManifoldPoint& point) {
            deepest = std::max(deepest, -static_cast<double>(point.getDistance()));
        });
        return deepest;
    }
    std::vector<Vec4> positions() const override {
        std::vector<Vec4> positions;
        for (std::size_t i = 0; i < moving_; ++i) {
            const btVector3& x = bodies_[i]->getWorldTransform().getOrigin();
            positions.push_back({static_cast<double>(x.x()), static_cast<double>(x.y()),
                                 static_cast<double>(x.z()), 0});
        }
        return positions;
    }
    void set_velocity(std::size_t body, const Vec4& velocity) override {
        bodies_[body]->setLinearVelocity(vector_of(velocity));
    }

  private:
    template <class Visit>
    void for_each_point(const Visit& visit) const {
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
            for (int k = 0; k < manifold.getNumContacts(); ++k) visit(manifold.getContactPoint(k));
        }
    }

    void add_body(double mass, btCollisionShape& shape, const Vec4& position,
                  const Rotor& rotor = {}) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, &shape,
                                                      inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(vector_of(position));
        info.m_startWorldTransform.setBasis(matrix_of(to_matrix(rotor)));
        // Bullet multiplies the two coefficients.
        info.m_friction = static_cast<btScalar>(std::sqrt(kPeerFriction));
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
    }

    /// A thick box: the bounds of Bullet's plane hold every body, so that each would be tested
    /// against each plane in every step.
    void add_wall(const Wall& wall, double half_width) {
        constexpr double kHalfThickness = 5, kRoom = 20;
        Vec4 half = Vec4::Constant(half_width + kRoom), centre = Vec4::Zero();
        half[wall.axis] = kHalfThickness;
        centre[wall.axis] = wall.side * (wall.offset - kHalfThickness);
        shapes_.push_back(std::make_unique<btBoxShape>(vector_of(half)));
        add_body(0, *shapes_.back(), centre);
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::size_t moving_ = 0;
};

}  // namespace

const char* const kBulletName = sizeof(btScalar) == 8 ? "bullet_double" : "bullet_float";

std::unique_ptr<PeerEngine> make_bullet(const PeerScene& scene, int iterations) {
    return std::make_unique<InBullet>(scene, iterations, false);
}

std::unique_ptr<PeerEngine> make_bullet_2_directions(const PeerScene& scene, int iterations) {
    return std::make_unique<InBullet>(scene, iterations, true);
}

}  // namespace tesserae::bench
