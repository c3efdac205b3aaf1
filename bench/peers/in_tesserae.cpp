// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <optional>

#include "bench/bodies.hpp"
#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/step/stage_copy.hpp"
#include "parallel/parallel_stepper.hpp"
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
        add(bodies, static_cast<std::uint32_t>(scene.kind[i]), scene.position[i], Vec4::Zero(), {},
            scene.rotor);
    for (const Wall& wall : scene.walls)
        add(bodies, plane_type(wall.side * Vec4::Unit(wall.axis), wall.offset, kPeerFriction, 0),
            Vec4::Zero());
    return bodies;
}

PhysicsSettings settings_of(int iterations, double tolerance) {
    PhysicsSettings settings;
    settings.steps_per_second = 1 / kPeerStep;
    settings.iterations = iterations;
    settings.tolerance = tolerance;
    return settings;
}

class InTesserae : public PeerEngine {
  public:
    InTesserae(const PeerScene& scene, const PhysicsSettings& settings)
        : count_(scene.size()), settings_(settings) {
        world_.emplace(bodies_of(scene), settings_);
    }

    void step() override {
        threads_.run([&] { report_ = world_->step(1 / settings_.steps_per_second); });
    }
    PeerContacts contacts() override {
        StageCopy found(Stage::kBuildIslands);
        threads_.run([&] { next_step(settings_.iterations, found); });
        return {static_cast<double>(found.step.contacts.size()),
                static_cast<double>(report_.contacts)};
    }
    double penetration() const override { return report_.penetration; }
    std::vector<Vec4> positions() const override {
        const std::vector<Vec4>& all = world_->bodies().position;
        return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count_)};
    }

    void set_velocity(std::size_t body, const Vec4& velocity) override {
        Bodies bodies = world_->bodies();
        bodies.velocity[body] = velocity;
        StepMemory memory = world_->memory();
        world_.emplace(std::move(bodies), settings_);
        world_->memory() = std::move(memory);
    }

    /// Of the next step, with a search for pairs, which a step of the world makes now and then
    /// only.
    StageTimes stages() {
        StageClock clock, without_iterations;
        threads_.run([&] {
            next_step(settings_.iterations, clock);
            next_step(0, without_iterations);
        });
        const auto& of = clock.seconds;
        StageTimes times;
        times.find_pairs = of.at(Stage::kFindPairs);
        times.find_contacts = of.at(Stage::kFindContacts);
        times.build_islands = of.at(Stage::kBuildIslands);
        times.make_rows = without_iterations.seconds.at(Stage::kSolveIslands);
        times.iterate = of.at(Stage::kSolveIslands) - times.make_rows;
        for (const Stage other :
             {Stage::kAdvanceFirstHalf, Stage::kSolveImpacts, Stage::kIntegrateVelocities,
              Stage::kAdvanceSecondHalf, Stage::kApplyCorrections, Stage::kFinishStep})
            times.others += of.at(other);
        return times;
    }

  private:
    /// Adds up the processor time of each stage [s].
    struct StageClock : StageObserver {
        void begin(Stage, std::size_t, const Simulation&, const StepData&) override {
            begin_ = thread_time();
        }
        void end(Stage stage) override { seconds[stage] += thread_time() - begin_; }

        std::map<Stage, double> seconds;

      private:
        double begin_ = 0;
    };

    /// The second of two steps that go on from the present state with so many iterations: the first
    /// grows the arrays.
    void next_step(int iterations, StageObserver& observer) const {
        PhysicsSettings settings = settings_;
        settings.iterations = iterations;
        parallel::ParallelStepper world(world_->bodies(), settings);
        world.memory() = world_->memory();
        world.step(1 / settings.steps_per_second);
        world.forget_hints();
        world.observe(&observer);
        world.step(1 / settings.steps_per_second);
    }

    std::size_t count_;
    PhysicsSettings settings_;
    parallel::Threads threads_{1};  ///< outlives the world's graph
    std::optional<parallel::ParallelStepper> world_;
    StepReport report_;
};

}  // namespace

std::unique_ptr<PeerEngine> make_tesserae_with(const PeerScene& scene, PhysicsSettings settings) {
    settings.gravity = {0, -kPeerGravity, 0, 0};
    return std::make_unique<InTesserae>(scene, settings);
}

std::unique_ptr<PeerEngine> make_tesserae(const PeerScene& scene, int iterations) {
    return make_tesserae_with(scene, settings_of(iterations, 0));
}

std::unique_ptr<PeerEngine> make_tesserae_at_defaults(const PeerScene& scene, int iterations) {
    return make_tesserae_with(scene, settings_of(iterations, PhysicsSettings{}.tolerance));
}

StageTimes stage_times(PeerEngine& tesserae) {
    return dynamic_cast<InTesserae&>(tesserae).stages();
}

}  // namespace tesserae::bench
