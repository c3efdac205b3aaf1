// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

#include "bench/box_motions.hpp"

namespace tesserae::bench {

/// A motion in Bullet's world of sequential impulses, set up so that its error is one of the step's
/// size alone.
class BoxInBullet {
  public:
    explicit BoxInBullet(const BoxMotion& motion)
        : plane_({-std::sin(motion.slope), std::cos(motion.slope), 0}, 0),
          shape_(vector_of(0.5 * motion.sides)),
          floor_(0, nullptr, &plane_),
          box_(start_of(motion)) {
        set_up_solver();
        world_.setGravity({0, -kBoxGravity, 0});
        // Bullet multiplies the two coefficients.
        floor_.setFriction(1);
        box_.setFriction(motion.friction);
        box_.setDamping(0, 0);
        box_.setActivationState(DISABLE_DEACTIVATION);
        box_.setFlags(BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
        box_.setLinearVelocity(vector_of(motion.velocity));
        box_.setAngularVelocity(vector_of(motion.angular_velocity));
        if (motion.has_floor) world_.addRigidBody(&floor_);
        world_.addRigidBody(&box_);
    }
    ~BoxInBullet() {
        world_.removeRigidBody(&box_);
        if (floor_.isInWorld()) world_.removeRigidBody(&floor_);
    }
    BoxInBullet(const BoxInBullet&) = delete;
    BoxInBullet& operator=(const BoxInBullet&) = delete;

    /// One step of exactly this length [s].
    void step(double h) { world_.stepSimulation(h, 0); }

    BoxPlace place() const {
        const btTransform& at = box_.getWorldTransform();
        BoxPlace place;
        for (int i = 0; i < 3; ++i) {
            place.position[i] = at.getOrigin()[i];
            for (int j = 0; j < 3; ++j) place.rotation(i, j) = at.getBasis()[i][j];
        }
        return place;
    }

  private:
    static btVector3 vector_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

    btRigidBody::btRigidBodyConstructionInfo start_of(const BoxMotion& motion) {
        btVector3 inertia;
        shape_.calculateLocalInertia(kBoxMass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(kBoxMass, nullptr, &shape_, inertia);
        const Matrix3d& R = motion.rotation;
        const btMatrix3x3 rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0),
                                   R(2, 1), R(2, 2));
        info.m_startWorldTransform = btTransform(rotation, vector_of(motion.position));
        return info;
    }

    /// The default has one friction direction at a point, that of the slip: Coulomb's law while it
    /// slides, which two directions, a pyramid, are not. Margins need no care: a box's margin is
    /// inside it, and box against plane does without.
    void set_up_solver() {
        btContactSolverInfo& solver = world_.getSolverInfo();
        solver.m_numIterations = kBoxIterations;
        // A start from the last step's normal impulses, but not from its friction, breaks the
        // mirror symmetry of a landing: the box turns by 0.01 rad at any step size.
        solver.m_solverMode &= ~SOLVER_USE_WARMSTARTING;
        // Overlap is removed without leaving momentum, however shallow it is.
        solver.m_splitImpulsePenetrationThreshold = 0;
        solver.m_erp2 = 0.1;
        // Every step looks for all corners (more than the four points that are kept): else it finds
        // one a step, and a corner that has slid 6 mm loses contact for a step.
        configuration_.setPlaneConvexMultipointIterations(8, 5);
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
    btStaticPlaneShape plane_;
    btBoxShape shape_;
    btRigidBody floor_, box_;
};

inline BoxPath path_in_bullet(const BoxMotion& motion, int steps_per_second) {
    BoxInBullet box(motion);
    BoxPath path;
    for (int sample = 0; sample < kBoxSamples; ++sample) {
        for (int i = 0; i < steps_of_sample(steps_per_second); ++i)
            box.step(1.0 / steps_per_second);
        path.push_back(box.place());
    }
    return path;
}

}  // namespace tesserae::bench
