// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/experiments/experiments.hpp"

// An ideal gas but for the spheres' size, in a closed box.
namespace tesserae::bench {
namespace {

constexpr std::size_t kWalls = 8;  ///< bodies 0 to 7
constexpr std::size_t kCount = 500;
constexpr double kBall = 0.1;      ///< radius of the spheres [m]; their mass is 1 kg
constexpr double kInside = 1.8;    ///< side of the cube in which centres move [m]
constexpr double kSpeed = 3;       ///< of every sphere at the start [m/s]
constexpr double kWarmUp = 1.5;    ///< some six free times between collisions [s]
constexpr double kDuration = 9.5;  ///< [s]

/// 500 places of a lattice of 5^4, drawn at random, and equal speeds in random directions: far from
/// Maxwell's distribution, which the collisions have to make.
Bodies gas_in_box() {
    Bodies bodies;
    const double wall = 0.5 * kInside + kBall;
    add_walls(bodies, {0, 1, 2, 3}, wall, 0, 1);
    bodies.types.push_back(sphere_type(kBall, 1, 0, 1));
    std::mt19937_64 engine(11);
    std::vector<int> places(5 * 5 * 5 * 5);
    std::iota(places.begin(), places.end(), 0);
    std::shuffle(places.begin(), places.end(), engine);
    std::normal_distribution<> normal;
    for (std::size_t i = 0; i < kCount; ++i) {
        const int p = places[i];
        const Vec4 x{p % 5 - 2.0, p / 5 % 5 - 2.0, p / 25 % 5 - 2.0, p / 125 - 2.0};
        const Vec4 u{normal(engine), normal(engine), normal(engine), normal(engine)};
        add(bodies, static_cast<std::uint32_t>(kWalls), 0.22 * kInside * x,
            kSpeed * u.normalized());
    }
    return bodies;
}

/// P V/(N kT) of the gas in a cube of side a. With d = 2 R the distance at which two centres meet,
/// Z_2 = the integral over both centres of 1 where they are apart = a^8 (1 - X), where
///   a^8 X = integral over the 4-ball |s| < d of the product of (a - |s_i|)
/// since the centres are a separation s apart in that part of the cube's square. With the moments
/// of the ball, 1: pi^2 d^4/2, |s1|: 8 pi d^5/15, |s1 s2|: pi d^6/6, |s1 s2 s3|: 16 d^7/105,
/// |s1 s2 s3 s4|: d^8/24, and the 4, 6, 4 and 1 choices of axes,
///   X = (pi^2 d^4/2 - 32 pi d^5/(15 a) + pi d^6/a^2 - 64 d^7/(105 a^3) + d^8/(24 a^4))/a^4.
/// ln Z_N = 4 N ln a - N (N - 1)/2 X + ..., and P/kT = d(ln Z_N)/dV = (dX/da and so on)/(4 a^3).
/// In a large cube this is the virial series' 1 + B2 N/V, B2 = pi^2 d^4/4; the rest of X is what
/// the walls change. The next term, B3 = (4/3 - 3 sqrt(3)/(2 pi)) B2^2 in four dimensions (M. Luban
/// and A. Baram, 1982), is taken without the walls' part; the one after it is below 0.1 %.
double exact_compressibility() {
    const double a = kInside, d = 2 * kBall, n = static_cast<double>(kCount);
    const double moments[5] = {pi * pi * std::pow(d, 4) / 2, 32 * pi * std::pow(d, 5) / 15,
                               pi * std::pow(d, 6), 64 * std::pow(d, 7) / 105, std::pow(d, 8) / 24};
    double slope = 0;  // a dX/da
    for (int k = 0; k < 5; ++k)
        slope += (k % 2 ? 1 : -1) * (4 + k) * moments[k] / std::pow(a, 4 + k);
    const double filled = pi * pi * std::pow(d, 4) / 4 * n / std::pow(a, 4);  // B2 N/V
    const double third = 4.0 / 3 - 3 * std::sqrt(3.0) / (2 * pi);
    return 1 - (n - 1) / 8 * slope + third * filled * filled;
}

/// sqrt(n) times the largest distance between the samples' distribution and an exact one. For
/// independent samples of it the mean is 0.87 and one in twenty is above 1.36.
template <class Distribution>
double kolmogorov_smirnov(std::vector<double> samples, const Distribution& below) {
    std::sort(samples.begin(), samples.end());
    const double n = static_cast<double>(samples.size());
    double most = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double p = below(samples[i]), rank = static_cast<double>(i);
        most = std::max({most, p - rank / n, (rank + 1) / n - p});
    }
    return std::sqrt(n) * most;
}

/// The impulse of the walls on the spheres [N s]: what an impact of which a wall is part changes of
/// a sphere's momentum along the wall's normal. Of another sphere that hits it in the same step the
/// mean is nothing.
class WallImpulse : public StageObserver {
  public:
    void begin(Stage stage, std::size_t, const Simulation& simulation,
               const StepData& step) override {
        if (stage != Stage::kSolveImpacts) return;
        simulation_ = &simulation, step_ = &step, before_ = step.velocity;
    }
    void end(Stage stage) override {
        if (stage != Stage::kSolveImpacts) return;
        for (std::size_t i = 0; i < step_->contacts.size(); ++i) {
            const Contact c = step_->contacts[i];
            if (c.a >= kWalls || !step_->hit[i]) continue;
            const Vec4 change = step_->velocity[c.b] - before_[c.b];
            sum += simulation_->type_of(c.b).mass * c.normal.dot(change);
        }
    }
    double sum = 0;

  private:
    const Simulation* simulation_ = nullptr;
    const StepData* step_ = nullptr;
    std::vector<Vec4> before_;
};

/// What is read off the gas after the warm-up.
struct Samples {
    static constexpr double kSpacing = 0.5;  ///< of the velocities' samples [s]: two collisions

    double next = kWarmUp;
    std::vector<double> components, speeds;  ///< [m/s]

    void see(double time, const Trial& trial) {
        if (time < next) return;
        next += kSpacing;
        for (std::size_t i = kWalls; i < kWalls + kCount; ++i) {
            const Vec4& v = trial.bodies().velocity[i];
            speeds.push_back(v.norm());
            components.insert(components.end(), v.begin(), v.end());
        }
    }
};

}  // namespace

/// e = 1 keeps the energy. kT = m <v^2>/4, from 2 kT for four degrees of freedom, by the kinetic
/// energy that the gas has (the mean of start and end). The pressure is the impulse on the eight
/// walls by their time and content 8 a^3, where a is the cube of the centres: the gas in it is the
/// one whose V = a^4. Some 20000 hits, each of a mean square of 4/pi times the squared mean, leave
/// a statistical error of sqrt(4/pi/20000) = 0.8 % in the pressure.
Experiment gas(const Knobs& knobs) {
    const auto settings = settings_of(kDuration, knobs, Vec4::Zero());
    const Bodies bodies = gas_in_box();
    return {
        "gas", bodies, settings,
        [=](Trial& trial) -> std::vector<Error> {
            Samples samples;
            WallImpulse walls;
            trial.run([&](double time, const StepReport&) {
                if (time > kWarmUp) trial.observe(&walls);
                samples.see(time, trial);
            });
            trial.observe(nullptr);
            const double start = energy(bodies, Vec4::Zero());
            const double end = energy(trial.bodies(), Vec4::Zero());
            const double kT = 0.5 * (start + end) / (2 * kCount);
            const double pressure = walls.sum / ((kDuration - kWarmUp) * 8 * std::pow(kInside, 3));
            const double compressibility = pressure * std::pow(kInside, 4) / (kCount * kT);
            const double gauss = kolmogorov_smirnov(samples.components, [&](double v) {
                return 0.5 * std::erfc(-v / std::sqrt(2 * kT));
            });
            // The integral of v^3 exp(-v^2/2kT), whose weight v^3 is the 3-sphere's content.
            const double maxwell = kolmogorov_smirnov(samples.speeds, [&](double v) {
                const double u = v * v / (2 * kT);
                return 1 - (1 + u) * std::exp(-u);
            });
            return {
                {"energy", "relative", std::abs(end / start - 1)},
                {"components against Gauss", "sqrt(n) D; 0.87 expected", gauss},
                {"speeds against Maxwell", "sqrt(n) D; 0.87 expected", maxwell},
                {"pressure", "relative", std::abs(compressibility / exact_compressibility() - 1)}};
        },
        true};
}

}  // namespace tesserae::bench
