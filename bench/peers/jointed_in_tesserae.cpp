// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "bench/bodies.hpp"
#include "bench/peers/jointed.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

class JointedInTesserae : public JointedEngine {
  public:
    JointedInTesserae(const JointedScene& scene, int iterations) {
        settings_.steps_per_second = 1 / kJointedStep;
        settings_.iterations = iterations;
        settings_.gravity = {0, -kJointedGravity, 0, 0};
        Bodies bodies;
        for (std::size_t i = 0; i < scene.mass.size(); ++i) {
            BodyType type = sphere_type(scene.radius, std::max(scene.mass[i], 1.0));
            type.fixed_position = type.fixed_rotation = scene.mass[i] == 0;
            const auto same = std::find(bodies.types.begin(), bodies.types.end(), type);
            const auto number = static_cast<std::uint32_t>(same - bodies.types.begin());
            if (same == bodies.types.end()) bodies.types.push_back(type);
            add(bodies, number, scene.position[i]);
        }
        std::vector<Joint> joints;
        for (const JointedScene::Link& link : scene.links) {
            Joint joint;
            joint.a = static_cast<BodyId>(link.a), joint.b = static_cast<BodyId>(link.b);
            joint.kind = PointJoint{link.anchor - scene.position[link.a],
                                    link.anchor - scene.position[link.b]};
            joints.push_back(joint);
        }
        world_.emplace(make_simulation(std::move(bodies), settings_, std::move(joints)));
    }

    void step() override {
        threads_.run([&] { world_->step(kJointedStep); });
    }
    double largest_error() const override {
        const Bodies& bodies = world_->bodies();
        double largest = 0;
        for (const Joint& joint : world_->joints().all) {
            const auto& at = std::get<PointJoint>(joint.kind);
            const Vec4 a = bodies.position[joint.a] + rotate(bodies.rotor[joint.a], at.on_a);
            const Vec4 b = bodies.position[joint.b] + rotate(bodies.rotor[joint.b], at.on_b);
            largest = std::max(largest, (a - b).norm());
        }
        return largest;
    }
    double energy() const override { return kinetic_energy(world_->bodies()) + potential_energy(); }
    double potential_energy() const override {
        return tesserae::potential_energy(world_->bodies(), settings_.gravity);
    }

  private:
    PhysicsSettings settings_;
    parallel::Threads threads_{1};  ///< outlives the world's graph
    std::optional<parallel::ParallelStepper> world_;
};

}  // namespace

std::unique_ptr<JointedEngine> jointed_in_tesserae(const JointedScene& scene, int iterations) {
    return std::make_unique<JointedInTesserae>(scene, iterations);
}

}  // namespace tesserae::bench
