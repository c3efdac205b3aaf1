// SPDX-License-Identifier: Apache-2.0
#include <btBulletDynamicsCommon.h>

#include <algorithm>

#include "bench/peers/jointed.hpp"

namespace tesserae::bench {
namespace {

btVector3 vector_of(const Vec4& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()),
            static_cast<btScalar>(v.z())};
}

/// Bullet's defaults, but no split of the step and nobody falls asleep.
class JointedInBullet : public JointedEngine {
  public:
    JointedInBullet(const JointedScene& scene, int iterations)
        : shape_(static_cast<btScalar>(scene.radius)) {
        world_.setGravity(btVector3(0, static_cast<btScalar>(-kJointedGravity), 0));
        world_.getSolverInfo().m_numIterations = iterations;
        for (std::size_t i = 0; i < scene.mass.size(); ++i)
            add_body(scene.mass[i], scene.position[i]);
        for (const JointedScene::Link& link : scene.links) {
            joints_.push_back(std::make_unique<btPoint2PointConstraint>(
                *bodies_[link.a], *bodies_[link.b], vector_of(link.anchor - scene.position[link.a]),
                vector_of(link.anchor - scene.position[link.b])));
            world_.addConstraint(joints_.back().get(), true);
        }
    }
    ~JointedInBullet() override {
        for (const auto& joint : joints_) world_.removeConstraint(joint.get());
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    JointedInBullet(const JointedInBullet&) = delete;
    JointedInBullet& operator=(const JointedInBullet&) = delete;

    void step() override { world_.stepSimulation(static_cast<btScalar>(kJointedStep), 0); }

    double largest_error() const override {
        double largest = 0;
        for (const auto& joint : joints_) {
            const btVector3 a = joint->getRigidBodyA().getWorldTransform() * joint->getPivotInA();
            const btVector3 b = joint->getRigidBodyB().getWorldTransform() * joint->getPivotInB();
            largest = std::max(largest, static_cast<double>((a - b).length()));
        }
        return largest;
    }
    double energy() const override {
        double sum = potential_energy();
        for (const auto& body : bodies_) {
            if (body->getInvMass() == 0) continue;
            const btVector3 turning =
                body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity();
            sum += 0.5 * static_cast<double>(body->getLinearVelocity().length2()) /
                       static_cast<double>(body->getInvMass()) +
                   0.5 * static_cast<double>(turning.dot(body->getAngularVelocity()));
        }
        return sum;
    }
    double potential_energy() const override {
        double sum = 0;
        for (const auto& body : bodies_)
            if (body->getInvMass() > 0)
                sum += kJointedGravity * static_cast<double>(body->getCenterOfMassPosition().y()) /
                       static_cast<double>(body->getInvMass());
        return sum;
    }

  private:
    void add_body(double mass, const Vec4& position) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape_.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, &shape_,
                                                      inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(vector_of(position));
        info.m_friction = 0;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
    btSphereShape shape_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
};

}  // namespace

std::unique_ptr<JointedEngine> jointed_in_bullet(const JointedScene& scene, int iterations) {
    return std::make_unique<JointedInBullet>(scene, iterations);
}

}  // namespace tesserae::bench
