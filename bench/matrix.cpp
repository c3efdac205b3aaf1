// SPDX-License-Identifier: Apache-2.0
#include "bench/matrix.hpp"

#include "bench/experiments/experiments.hpp"

namespace tesserae::bench {

std::vector<Listed> all_experiments() {
    return {
        {projectile, Kind::kFlight},         {double_rotation, Kind::kRotation},
        {free_box, Kind::kRotation},         {tennis_racket, Kind::kRotation},
        {bounces, Kind::kContact},           {head_on, Kind::kContact},
        {unequal_masses, Kind::kContact},    {chain, Kind::kContact},
        {close_chain, Kind::kContact},       {sliding_to_rolling, Kind::kContact},
        {rolling_down, Kind::kContact},      {block_sticking, Kind::kContact},
        {block_sliding, Kind::kContact},     {critical_angle, Kind::kContact},
        {friction_isotropy, Kind::kContact}, {friction_isotropy_free, Kind::kContact},
        {pendulum, Kind::kContact},          {oscillator, Kind::kContact},
        {hanging_chain, Kind::kContact},     {column_of_spheres, Kind::kContact},
        {stack_of_boxes, Kind::kContact},    {mixed_pile, Kind::kContact},
        {heap_of_capsules, Kind::kContact},  {stacked_spheres, Kind::kCrowd},
        {elastic_stack, Kind::kCrowd},       {gas, Kind::kCrowd},
    };
}

namespace {

/// Ways of spending one step. The first is the default, and the next ones differ from it in
/// `iterations`. Those with sub-steps do all of their sweeps, eight over all sub-steps, so that
/// their times at equal steps differ by little more than the sub-steps' own cost.
const std::vector<Knobs> kWays = {
    {},
    {.iterations = 5},
    {.iterations = 10},
    {.iterations = 30},
    {.iterations = 300},
    {.substeps = 2, .iterations = 4, .tolerance = 0},
    {.substeps = 4, .iterations = 2, .tolerance = 0},
    {.substeps = 8, .iterations = 1, .tolerance = 0},
};

/// Most sub-steps a second in which contacts and crowds are run.
constexpr int kMostOfContacts = 1920, kMostOfCrowds = 480;

}  // namespace

std::vector<Knobs> knobs_of(Kind kind) {
    std::vector<Knobs> list;
    for (int steps : {60, 120, 240, 480, 960}) {
        if (kind == Kind::kFlight) list.push_back({.steps_per_second = steps});
        if (kind == Kind::kRotation)
            for (RotationIntegrator integrator :
                 {RotationIntegrator::kMidpoint, RotationIntegrator::kEuler})
                list.push_back({.integrator = integrator, .steps_per_second = steps});
        if (kind != Kind::kContact && kind != Kind::kCrowd) continue;
        const int most = kind == Kind::kCrowd ? kMostOfCrowds : kMostOfContacts;
        for (Knobs knobs : kWays) {
            if (steps * knobs.substeps > most) continue;
            knobs.steps_per_second = steps;
            list.push_back(knobs);
        }
    }
    return list;
}

const char* name_of(RotationIntegrator integrator) {
    switch (integrator) {
        case RotationIntegrator::kEuler:
            return "euler";
        case RotationIntegrator::kMidpoint:
            return "midpoint";
    }
    return "unknown";
}

}  // namespace tesserae::bench
