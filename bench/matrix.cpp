#include "bench/matrix.hpp"

#include "bench/experiments/experiments.hpp"

namespace tesserae::bench {

std::vector<Listed> all_experiments() {
    return {
        {projectile, Kind::kFlight},
        {double_rotation, Kind::kRotation},
        {free_box, Kind::kRotation},
        {tennis_racket, Kind::kRotation},
        {bounces, Kind::kContact},
        {head_on, Kind::kContact},
        {unequal_masses, Kind::kContact},
        {chain, Kind::kContact},
        {close_chain, Kind::kContact},
        {sliding_to_rolling, Kind::kContact},
        {rolling_down, Kind::kContact},
        {block_sticking, Kind::kContact},
        {block_sliding, Kind::kContact},
        {critical_angle, Kind::kContact},
        {friction_isotropy, Kind::kContact},
        {friction_isotropy_free, Kind::kContact},
        {column_of_spheres, Kind::kContact},
        {stack_of_boxes, Kind::kContact},
        {mixed_pile, Kind::kContact},
        {heap_of_capsules, Kind::kContact},
        {stacked_spheres, Kind::kCrowd},
        {elastic_stack, Kind::kCrowd},
        {gas, Kind::kCrowd},
    };
}

std::vector<Knobs> knobs_of(Kind kind) {
    constexpr int kSteps[] = {60, 120, 240, 480, 960};
    constexpr int kIterations[] = {5, 10, 20};
    std::vector<Knobs> list;
    for (int steps : kSteps) {
        Knobs knobs{.steps_per_second = steps};
        switch (kind) {
            case Kind::kFlight:
                list.push_back(knobs);
                break;
            case Kind::kRotation:
                for (Integrator integrator : {Integrator::kEuler, Integrator::kMidpoint}) {
                    knobs.integrator = integrator;
                    list.push_back(knobs);
                }
                break;
            case Kind::kCrowd:
                if (steps > 480) break;
                [[fallthrough]];
            case Kind::kContact:
                for (int iterations : kIterations) {
                    knobs.iterations = iterations;
                    list.push_back(knobs);
                }
                break;
        }
    }
    return list;
}

const char* name_of(Integrator integrator) {
    switch (integrator) {
        case Integrator::kEuler:
            return "euler";
        case Integrator::kMidpoint:
            return "midpoint";
    }
    return "unknown";
}

}  // namespace tesserae::bench
