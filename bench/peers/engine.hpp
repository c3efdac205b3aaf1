// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bench/peers/scene.hpp"
#include "core/dynamics/step/settings.hpp"

namespace tesserae::bench {

/// Contact points.
struct PeerContacts {
    double points = 0;    ///< that the solver is given, those of bodies a little apart included
    double touching = 0;  ///< of these, those that overlap or carry an impulse
};

/// A scene in one engine, on one thread, with nothing asleep.
class PeerEngine {
  public:
    virtual ~PeerEngine() = default;
    /// By kPeerStep, unless it was made with settings that say otherwise.
    virtual void step() = 0;
    virtual PeerContacts contacts() = 0;
    /// Deepest overlap that the engine found in the last step [m], >= 0.
    virtual double penetration() const = 0;
    virtual std::vector<Vec4> positions() const = 0;
    virtual void set_velocity(std::size_t body, const Vec4& velocity) = 0;  ///< [m/s]
};

using MakePeer = std::unique_ptr<PeerEngine> (*)(const PeerScene&, int iterations);

/// That many sweeps, all of them.
std::unique_ptr<PeerEngine> make_tesserae(const PeerScene& scene, int iterations);
/// That many at most, until the default tolerance is reached.
std::unique_ptr<PeerEngine> make_tesserae_at_defaults(const PeerScene& scene, int iterations);
/// With settings of its own, of which gravity alone is replaced.
std::unique_ptr<PeerEngine> make_tesserae_with(const PeerScene& scene, PhysicsSettings settings);
/// In the precision of the Bullet that the program is linked with.
extern const char* const kBulletName;
/// One friction direction at a point, that of the slip (Bullet's default).
std::unique_ptr<PeerEngine> make_bullet(const PeerScene& scene, int iterations);
/// Two friction directions at a point, as ODE and (three) tesserae.
std::unique_ptr<PeerEngine> make_bullet_2_directions(const PeerScene& scene, int iterations);
std::unique_ptr<PeerEngine> make_ode(const PeerScene& scene, int iterations);

/// Parts of one step's processor time in tesserae [s].
struct StageTimes {
    double find_pairs = 0;  ///< with the bounds
    double find_contacts = 0;
    double build_islands = 0;
    double make_rows = 0;  ///< solve_islands without its iterations
    double iterate = 0;    ///< its iterations
    double others = 0;     ///< motion, the warm start, the end of the step
};
StageTimes stage_times(PeerEngine& tesserae);

}  // namespace tesserae::bench
