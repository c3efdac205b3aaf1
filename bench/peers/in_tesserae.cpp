#include <utility>

#include "bench/bodies.hpp"
#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/islands.hpp"
#include "core/dynamics/motion.hpp"
#include "core/dynamics/pairs.hpp"
#include "core/dynamics/solver.hpp"
#include "core/dynamics/step.hpp"
#include "parallel/kept_pairs.hpp"
#include "parallel/parallel_world.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

Bodies bodies_of(const PeerScene& scene) {
    Bodies bodies;
    for (const PeerKind& kind : scene.kinds) {
        BodyType type = sphere_type(kind.radius, kind.mass, kPeerFriction, 0);
        if (!(kind.radius > 0)) type.shape = Hyperbox{kind.sides};
        bodies.types.push_back(type);
    }
    for (std::size_t i = 0; i < scene.size(); ++i)
        add(bodies, static_cast<std::uint32_t>(scene.kind[i]), scene.position[i]);
    for (const Wall& wall : scene.walls)
        add(bodies, plane_type(wall.side * Vec4::Unit(wall.axis), wall.offset, kPeerFriction, 0),
            Vec4::Zero());
    return bodies;
}

PhysicsSettings settings_of(int iterations) {
    PhysicsSettings settings;
    settings.gravity = {0, -kPeerGravity, 0, 0};
    settings.steps_per_second = 1 / kPeerStep;
    settings.iterations = iterations;
    return settings;
}

class InTesserae : public PeerEngine {
  public:
    InTesserae(const PeerScene& scene, int iterations)
        : count_(scene.size()),
          settings_(settings_of(iterations)),
          world_(bodies_of(scene), settings_) {}

    void step() override {
        threads_.run([&] { report_ = world_.step(kPeerStep); });
    }
    PeerContacts contacts() override {
        Simulation simulation = present();
        StepData step;
        parallel::KeptPairs kept_pairs;
        threads_.run([&] { begin(simulation, step, kept_pairs); });
        return {static_cast<double>(step.contacts.size()), static_cast<double>(report_.contacts)};
    }
    double penetration() const override { return report_.penetration; }
    std::vector<Vec4> positions() const override {
        const std::vector<Vec4>& all = world_.bodies().position;
        return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count_)};
    }

    /// The next step again with core's own functions, timed.
    StageTimes stages() {
        StageTimes times;
        threads_.run([&] {
            Simulation simulation = present();
            StepData step;
            parallel::KeptPairs kept_pairs;
            IslandBuilder builder;
            // The first time grows the arrays.
            for (int i = 0; i < 2; ++i) times = time_step(simulation, step, kept_pairs, builder);
        });
        return times;
    }

  private:
    Simulation present() const {
        Simulation simulation = make_simulation(world_.bodies(), settings_);
        simulation.memory = world_.memory();
        return simulation;
    }

    static StageTimes begin(Simulation& simulation, StepData& step,
                            parallel::KeptPairs& kept_pairs) {
        StageTimes times;
        const Range all{0, simulation.bodies.size()};
        const double start = thread_time();
        begin_step(simulation, step, kPeerStep);
        advance_first_half(simulation, step, all);
        const double moved = thread_time();
        update_bounds(simulation, step, all);
        kept_pairs.forget();  // with a search, which a step of the world makes now and then only
        kept_pairs.find_pairs(simulation, step);
        const double paired = thread_time();
        step.contacts.clear();
        find_contacts(simulation, step, {0, step.pairs.size()}, step.contacts);
        times.find_contacts = thread_time() - paired;
        times.find_pairs = paired - moved;
        times.others = moved - start;
        return times;
    }

    static StageTimes time_step(Simulation& simulation, StepData& step,
                                parallel::KeptPairs& kept_pairs, IslandBuilder& builder) {
        StageTimes times = begin(simulation, step, kept_pairs);
        const Range all{0, simulation.bodies.size()};
        const double start = thread_time();
        begin_contacts(step);
        recall_impulses(simulation, step, {0, step.contacts.size()});
        integrate_velocities(simulation, step, all);
        const double integrated = thread_time();
        builder.build(simulation, step);
        const double built = thread_time();
        times.others += integrated - start;
        times.build_islands = built - integrated;

        // Without iterations first, and then what the iterations add.
        const auto velocity = step.velocity;
        const auto angular_velocity = step.angular_velocity;
        const auto solve = [&](int iterations) {
            step.velocity = velocity;
            step.angular_velocity = angular_velocity;
            std::swap(simulation.settings.iterations, iterations);
            const double before = thread_time();
            for (std::size_t i = 0; i < step.islands.size(); ++i) solve_island(simulation, step, i);
            std::swap(simulation.settings.iterations, iterations);
            return thread_time() - before;
        };
        step.residual.resize(step.islands.size());
        times.make_rows = solve(0);
        times.iterate = solve(simulation.settings.iterations) - times.make_rows;

        const double solved = thread_time();
        advance_second_half(simulation, step, all);
        for (std::size_t i = 0; i < step.islands.size(); ++i) relax_island(simulation, step, i);
        step.pushing.clear();
        list_pushing(step, {0, step.impulses.size()}, step.pushing);
        end_substep(simulation, step);
        times.others += thread_time() - solved;
        return times;
    }

    std::size_t count_;
    PhysicsSettings settings_;
    parallel::Threads threads_{1};  ///< outlives the world's graph
    parallel::ParallelWorld world_;
    StepReport report_;
};

}  // namespace

std::unique_ptr<PeerEngine> make_tesserae(const PeerScene& scene, int iterations) {
    return std::make_unique<InTesserae>(scene, iterations);
}

StageTimes stage_times(PeerEngine& tesserae) {
    return dynamic_cast<InTesserae&>(tesserae).stages();
}

}  // namespace tesserae::bench
