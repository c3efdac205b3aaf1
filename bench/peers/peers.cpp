// SPDX-License-Identifier: Apache-2.0
// tesserae in four dimensions beside Bullet and ODE in three: time of a whole step, for a contact
// point and iteration, beside the overlap that it leaves. See README.md.
//   peers SCENE COUNT [all]   sphere_pile or box_wall of so many bodies; all: not only tesserae and
//                             Bullet's defaults, but ODE and two friction directions in Bullet

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/step/settings.hpp"

namespace tesserae::bench {
namespace {

constexpr std::array<int, 2> kIterations = {10, 30};
const int kDefaultIterations = PhysicsSettings{}.iterations;
constexpr int kRepeats = 9, kStepsOfRepeat = 4;

struct Peer {
    const char* name;
    MakePeer make;
    int dimension;
    std::array<int, 2> iterations = kIterations;  ///< twice the same: run once
};
constexpr std::size_t kBullet = 1;  ///< its place among them
std::vector<Peer> make_peers(bool all) {
    std::vector<Peer> peers = {{"tesserae", make_tesserae, 4},
                               {kBulletName, make_bullet, 3},
                               {"tesserae_default",
                                make_tesserae_at_defaults,
                                4,
                                {kDefaultIterations, kDefaultIterations}}};
    if (!all) return peers;
    peers.push_back({"bullet_2_directions", make_bullet_2_directions, 3});
    peers.push_back({"ode", make_ode, 3});
    return peers;
}

/// Memory that is now in use [bytes].
double bytes_in_use() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

struct Quartiles {
    double median, distance;
};
Quartiles quartiles_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {values[n / 2], values[3 * n / 4] - values[n / 4]};
}

/// One engine with one number of iterations, settled.
class Run {
  public:
    Run(const Peer& peer, PeerScene scene, int iterations)
        : name_(peer.name), scene_(std::move(scene)), iterations_(iterations) {
        const double before = bytes_in_use();
        engine_ = peer.make(scene_, iterations);
        for (int i = 0; i < scene_.settling_steps; ++i) engine_->step();
        bytes_ = bytes_in_use() - before;
        start_ = engine_->positions();
    }

    void measure() {
        double time = 0;
        for (int i = 0; i < kStepsOfRepeat; ++i) {
            const double before = thread_time();
            engine_->step();
            time += thread_time() - before;
            penetration_ = std::max(penetration_, engine_->penetration());
        }
        const PeerContacts found = engine_->contacts();
        points_ += found.points / kRepeats;
        touching_ += found.touching / kRepeats;
        times_.push_back(time / kStepsOfRepeat);
        if (!scene_.kinds[0].radius) return;
        checked_ = std::max(checked_, deepest_sphere_overlap(scene_, engine_->positions()));
    }

    double time() const { return quartiles_of(times_).median; }
    double ns_per_point() const { return 1e9 * time() / points_ / iterations_; }
    double ns_per_touching() const { return 1e9 * time() / touching_ / iterations_; }
    double slope(const Run& fewer) const {
        return 1e9 * (time() / points_ - fewer.time() / fewer.points_) /
               (iterations_ - fewer.iterations_);
    }

    /// @param fewer  the same engine with fewer iterations, or null
    void print(const Run& bullet, const Run* fewer, const Run* fewer_of_bullet) const {
        const auto bodies = static_cast<double>(scene_.size());
        const Quartiles all = quartiles_of(times_);
        fmt::print("{},{},{},{},{:.3f},{:.3f},{:.3f},{:.1f},{:.1f},{:.1f},", scene_.name,
                   scene_.size(), name_, iterations_, points_ / bodies, touching_ / bodies,
                   1e3 * all.median, 100 * all.distance / all.median, ns_per_point(),
                   ns_per_touching());
        fmt::print("{:.3f},{:.3f},", ns_per_point() / bullet.ns_per_point(),
                   ns_per_touching() / bullet.ns_per_touching());
        if (fewer)
            fmt::print("{:.1f},{:.3f},", slope(*fewer),
                       slope(*fewer) / bullet.slope(*fewer_of_bullet));
        else
            fmt::print(",,");
        fmt::print("{:.3f},{},{:.2f},{:.0f}", 1e3 * penetration_,
                   checked_ > 0 ? fmt::format("{:.3f}", 1e3 * checked_) : "", 1e3 * mean_speed(),
                   bytes_ / bodies);
        print_stages();
        std::fflush(stdout);
    }

  private:
    /// By how far the bodies have moved since they had settled [m/s].
    double mean_speed() const {
        const std::vector<Vec4> now = engine_->positions();
        double sum = 0;
        for (std::size_t i = 0; i < now.size(); ++i) sum += (now[i] - start_[i]).norm();
        return sum / static_cast<double>(now.size()) / (kRepeats * kStepsOfRepeat * kPeerStep);
    }

    void print_stages() const {
        if (!name_.starts_with("tesserae")) {
            fmt::print(",,,,,,\n");
            return;
        }
        const StageTimes t = stage_times(*engine_);
        const double sum =
            t.find_pairs + t.find_contacts + t.build_islands + t.make_rows + t.iterate + t.others;
        for (double part :
             {t.find_pairs, t.find_contacts, t.build_islands, t.make_rows, t.iterate, t.others})
            fmt::print(",{:.1f}", 100 * part / sum);
        fmt::print("\n");
    }

    std::string name_;
    PeerScene scene_;
    int iterations_;
    std::unique_ptr<PeerEngine> engine_;
    std::vector<Vec4> start_;
    std::vector<double> times_;  ///< of a step, of every repeat [s]
    double points_ = 0, touching_ = 0, penetration_ = 0, checked_ = 0, bytes_ = 0;
};

void compare(const std::vector<Peer>& peers, PeerScene (*make)(int dimension, int count),
             int count) {
    std::vector<std::array<std::unique_ptr<Run>, 2>> runs(peers.size());
    for (std::size_t i = 0; i < peers.size(); ++i)
        for (std::size_t k = 0; k < kIterations.size(); ++k) {
            const int iterations = peers[i].iterations[k];
            if (k > 0 && iterations == peers[i].iterations[0]) continue;
            runs[i][k] =
                std::make_unique<Run>(peers[i], make(peers[i].dimension, count), iterations);
        }
    for (int repeat = 0; repeat < kRepeats; ++repeat)
        for (auto& of_engine : runs)
            for (auto& run : of_engine)
                if (run) run->measure();
    const auto& bullet = runs[kBullet];
    for (const auto& run : runs) {
        run[0]->print(*bullet[0], nullptr, nullptr);
        if (run[1]) run[1]->print(*bullet[1], run[0].get(), bullet[0].get());
    }
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const bool all = arguments.size() == 3 && arguments[2] == "all";
    const int count = arguments.size() > 1 ? std::atoi(argv[2]) : 0;
    if (count < 20 || arguments.size() != (all ? 3u : 2u) ||
        (arguments[0] != "sphere_pile" && arguments[0] != "box_wall")) {
        fmt::print(stderr, "usage: peers sphere_pile|box_wall COUNT [all]\n");
        return 2;
    }
    fmt::print(
        "scene,bodies,engine,iterations,points_per_body,touching_per_body,ms_per_step,"
        "spread_percent,ns_per_point_iteration,ns_per_touching_iteration,ratio_to_bullet,"
        "touching_ratio_to_bullet,slope_ns,slope_ratio_to_bullet,penetration_mm,checked_"
        "penetration_mm,mean_speed_mm_s,"
        "bytes_per_body,pairs_percent,contacts_percent,islands_percent,rows_percent,"
        "iterations_percent,others_percent\n");
    compare(make_peers(all), arguments[0] == "box_wall" ? box_wall : sphere_pile, count);
}
