// SPDX-License-Identifier: Apache-2.0
#include <ode/ode.h>

#include <algorithm>

#include "bench/peers/engine.hpp"

namespace tesserae::bench {
namespace {

/// ODE's library is set up as long as one of its worlds is.
class OdeLibrary {
  public:
    OdeLibrary() {
        if (users_++ == 0) dInitODE2(0);
    }
    ~OdeLibrary() {
        if (--users_ == 0) dCloseODE();
    }
    OdeLibrary(const OdeLibrary&) = delete;
    OdeLibrary& operator=(const OdeLibrary&) = delete;

  private:
    static inline int users_ = 0;
};

/// dWorldQuickStep() with ODE's defaults.
class InOde : public PeerEngine {
  public:
    InOde(const PeerScene& scene, int iterations) {
        dWorldSetGravity(world_, 0, -kPeerGravity, 0);
        dWorldSetQuickStepNumIterations(world_, iterations);
        for (std::size_t i = 0; i < scene.size(); ++i)
            add_body(scene.kinds[scene.kind[i]], scene.position[i]);
        for (const Wall& wall : scene.walls) {
            const Vec4 normal = wall.side * Vec4::Unit(wall.axis);
            dCreatePlane(space_, normal.x(), normal.y(), normal.z(), wall.offset);
        }
    }
    ~InOde() override {
        dJointGroupDestroy(joints_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }
    InOde(const InOde&) = delete;
    InOde& operator=(const InOde&) = delete;

    void step() override {
        dJointGroupEmpty(joints_);
        points_ = penetration_ = 0;
        dSpaceCollide(space_, this, [](void* self, dGeomID a, dGeomID b) {
            static_cast<InOde*>(self)->collide(a, b);
        });
        dWorldQuickStep(world_, kPeerStep);
    }
    PeerContacts contacts() override { return {points_, points_}; }
    double penetration() const override { return penetration_; }
    std::vector<Vec4> positions() const override {
        std::vector<Vec4> positions;
        for (const dBodyID body : bodies_) {
            const dReal* x = dBodyGetPosition(body);
            positions.push_back({x[0], x[1], x[2], 0});
        }
        return positions;
    }
    void set_velocity(std::size_t body, const Vec4& velocity) override {
        dBodySetLinearVel(bodies_[body], velocity.x(), velocity.y(), velocity.z());
    }

  private:
    void add_body(const PeerKind& kind, const Vec4& position) {
        const Vec4& sides = kind.sides;
        const dBodyID body = dBodyCreate(world_);
        dMass mass;
        if (kind.radius > 0)
            dMassSetSphereTotal(&mass, kind.mass, kind.radius);
        else
            dMassSetBoxTotal(&mass, kind.mass, sides.x(), sides.y(), sides.z());
        dBodySetMass(body, &mass);
        dBodySetPosition(body, position.x(), position.y(), position.z());
        const dGeomID shape = kind.radius > 0 ? dCreateSphere(space_, kind.radius)
                                              : dCreateBox(space_, sides.x(), sides.y(), sides.z());
        dGeomSetBody(shape, body);
        bodies_.push_back(body);
    }

    void collide(dGeomID a, dGeomID b) {
        constexpr int kMost = 8;
        dContact contacts[kMost];
        const int count = dCollide(a, b, kMost, &contacts[0].geom, sizeof(dContact));
        for (int i = 0; i < count; ++i) {
            contacts[i].surface = {};
            contacts[i].surface.mode = dContactApprox1;
            contacts[i].surface.mu = kPeerFriction;
            dJointAttach(dJointCreateContact(world_, joints_, &contacts[i]), dGeomGetBody(a),
                         dGeomGetBody(b));
            penetration_ = std::max(penetration_, contacts[i].geom.depth);
        }
        points_ += count;
    }

    OdeLibrary library_;
    dWorldID world_ = dWorldCreate();
    dSpaceID space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
    dJointGroupID joints_ = dJointGroupCreate(0);
    std::vector<dBodyID> bodies_;
    double points_ = 0, penetration_ = 0;  ///< of the last step
};

}  // namespace

std::unique_ptr<PeerEngine> make_ode(const PeerScene& scene, int iterations) {
    return std::make_unique<InOde>(scene, iterations);
}

}  // namespace tesserae::bench
