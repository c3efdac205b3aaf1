// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/experiments.hpp"

// Motions without an exact result, against a run of many more steps and iterations, over a time too
// short for chaos.
namespace tesserae::bench {
namespace {

constexpr int kFineSteps = 7680;  ///< 32 times the usual 240 a second
constexpr int kFineIterations = 60;

/// Root mean square distance of the bounded bodies' centres [m].
double distance(const Bodies& a, const Bodies& b) {
    double sum = 0, count = 0;
    for (BodyId id = 0; id < a.size(); ++id) {
        if (!is_bounded(a.type_of(id).shape)) continue;
        sum += (a.position[id] - b.position[id]).squaredNorm();
        ++count;
    }
    return std::sqrt(sum / count);
}

Bodies end_of(const Bodies& bodies, const Knobs& knobs, double duration) {
    Trial trial(bodies, settings_of(duration, knobs, kDown));
    trial.run();
    return trial.bodies();
}

/// The converged run, made once per experiment, and how far it can be trusted: the larger change
/// by half its steps and half its iterations, and by four sub-steps a step.
struct Converged {
    Bodies end;
    double doubt;  ///< [m]
};

Converged converge(const Bodies& bodies, double duration) {
    const Knobs fine{.iterations = kFineIterations, .tolerance = 0, .steps_per_second = kFineSteps};
    Knobs half = fine, other = fine;
    half.iterations /= 2;
    half.steps_per_second /= 2;
    other.substeps = 4;
    const Bodies end = end_of(bodies, fine, duration);
    return {end, std::max(distance(end, end_of(bodies, half, duration)),
                          distance(end, end_of(bodies, other, duration)))};
}

Experiment against(const char* name, const Bodies& bodies, double duration,
                   const Converged& reference, const Knobs& knobs) {
    return {name, bodies, settings_of(duration, knobs, kDown),
            [&reference](Trial& trial) -> std::vector<Error> {
                trial.run();
                return {
                    {"position", "m (root mean square)", distance(trial.bodies(), reference.end)},
                    {"doubt about the converged run", "m (root mean square)", reference.doubt}};
            }};
}

}  // namespace

/// Five boxes of different sizes, each 3 cm above the one below, moved sideways on it and
/// given a push: they land, slide on each other and come to rest.
Experiment stack_of_boxes(const Knobs& knobs) {
    constexpr double kDuration = 0.8;
    static const Bodies bodies = [] {
        Bodies b = floor_of(0.5, 0);
        std::mt19937_64 engine(7);
        std::uniform_real_distribution<> part(-1, 1);
        double top = 0;
        for (int i = 0; i < 5; ++i) {
            const double side = 1.2 - 0.1 * i;
            const Vec4 size{side, 0.3 + 0.05 * i, side, side};
            const Vec4 aside{0.08 * part(engine), 0, 0.08 * part(engine), 0.08 * part(engine)};
            const Vec4 push{0.5 * part(engine), 0, 0.5 * part(engine), 0.5 * part(engine)};
            add(b, box_type(size, 2, 0.5), aside + Vec4(0, top + 0.5 * size[1] + 0.03, 0, 0), push);
            top += size[1] + 0.03;
        }
        return b;
    }();
    static const Converged reference = converge(bodies, kDuration);
    return against("stack_of_boxes", bodies, kDuration, reference, knobs);
}

/// Spheres and boxes in turn, in layers of eight, above a floor between walls.
Experiment mixed_pile(const Knobs& knobs) {
    constexpr double kDuration = 0.4;
    static const Bodies bodies = [] {
        Bodies b = floor_of(0.5, 0);
        add_walls(b, {0, 2, 3}, 1.2, 0.5);
        std::mt19937_64 engine(9);
        std::uniform_real_distribution<> part(-1, 1);
        for (int i = 0; i < 40; ++i) {
            const Vec4 place{i % 2 - 0.5, 0.5 + 0.9 * (i / 8), i / 2 % 2 - 0.5, i / 4 % 2 - 0.5};
            Vec4 x{1.1 * place[0], place[1], 1.1 * place[2], 1.1 * place[3]};
            for (int k = 0; k < 4; ++k) x[k] += 0.03 * part(engine);
            if (i % 3 == 0) {
                const double side = 0.4 + 0.1 * part(engine);
                add(b, box_type({side, 0.4, 0.5, side}, 60, 0.5), x);
                b.rotor.back() = exp(Bivector{0.3 * part(engine), 0.2, 0.3 * part(engine), -0.2});
            } else {
                add(b, sphere_type(0.3 + 0.02 * part(engine), 40, 0.5, 0), x);
            }
        }
        return b;
    }();
    static const Converged reference = converge(bodies, kDuration);
    return against("mixed_pile", bodies, kDuration, reference, knobs);
}

}  // namespace tesserae::bench
