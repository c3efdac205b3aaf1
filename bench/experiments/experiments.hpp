// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/experiments/experiment.hpp"

/// The experiments. Each names its exact result where it is defined and derives it there.
namespace tesserae::bench {

// spheres.cpp
Experiment projectile(const Knobs& knobs);
Experiment bounces(const Knobs& knobs);
Experiment sliding_to_rolling(const Knobs& knobs);
Experiment rolling_down(const Knobs& knobs);
Experiment column_of_spheres(const Knobs& knobs);

// collisions.cpp
Experiment head_on(const Knobs& knobs);
Experiment chain(const Knobs& knobs);
Experiment close_chain(const Knobs& knobs);
Experiment unequal_masses(const Knobs& knobs);

// rotation.cpp
Experiment double_rotation(const Knobs& knobs);
Experiment free_box(const Knobs& knobs);
Experiment tennis_racket(const Knobs& knobs);

// blocks.cpp
Experiment block_sticking(const Knobs& knobs);
Experiment block_sliding(const Knobs& knobs);
Experiment critical_angle(const Knobs& knobs);
Experiment friction_isotropy(const Knobs& knobs);
Experiment friction_isotropy_free(const Knobs& knobs);

// joints.cpp
Experiment pendulum(const Knobs& knobs);
Experiment oscillator(const Knobs& knobs);
Experiment hanging_chain(const Knobs& knobs);

// heaps.cpp
Experiment stacked_spheres(const Knobs& knobs);
Experiment elastic_stack(const Knobs& knobs);
Experiment heap_of_capsules(const Knobs& knobs);

// gas.cpp
Experiment gas(const Knobs& knobs);

// converged.cpp
Experiment stack_of_boxes(const Knobs& knobs);
Experiment mixed_pile(const Knobs& knobs);

}  // namespace tesserae::bench
