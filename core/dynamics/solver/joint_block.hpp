#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/solver/block_cholesky.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// All joints of an island of few bodies as one block, which is solved directly. Sweeps take a
/// joint after the other and need thousands where a light chain bears a heavy load; the block takes
/// one factor a sub-step, and two or three solutions of it a sweep.
///
/// The change of the bodies' motion is the least of 1/2 |u|^2 + 1/2 s |J u - left|^2, in the norm
/// of the kinetic energy, with stiff s; its impulses are s (left - J u). What is left after it is
/// less by a factor of about 1 + s/m, and it is repeated (method of multipliers: Nocedal and
/// Wright, "Numerical optimization", 2006, 17.3).
class JointBlock {
  public:
    /// Prepares the block for an island whose constraints are posed.
    /// @param bodies        the island's movable bodies, ascending
    /// @param constraints   numbers in step.constraints
    /// @return whether it is one to solve so: few blocks have to be eliminated, and all constraints
    ///         hold whatever it takes
    bool begin(const Simulation& simulation, const StepData& step, std::span<const BodyId> bodies,
               std::span<const std::uint32_t> constraints);

    /// Solves all rows at the bodies' present motion, and applies what their impulses change.
    /// @return the largest change of a row's velocity [m/s, rad/s]
    double sweep(const Simulation& simulation, StepData& step);

  private:
    using Part = BlockCholesky::Part;

    /// The roots of a body's inverse mass and inverse inertia: motions are in units of these.
    struct Roots {
        double mass = 0;
        BivectorMap inertia = BivectorMap::Zero();
    };
    /// One row: what its unit impulse does to both bodies.
    struct Row {
        Part a, b;
        double left = 0;  ///< aim less its velocity
    };
    /// A constraint and its rows.
    struct Joint {
        std::uint32_t constraint = 0, first = 0;
        std::size_t a = 0, b = 0;  ///< places of the bodies
        double stiffness = 0;      ///< [kg]
    };

    std::size_t place_of(const Simulation& simulation, BodyId id) const;
    bool arrange(const Simulation& simulation, const StepData& step);
    void list_rows(const Simulation& simulation, const StepData& step);
    Part motion_by(std::size_t body, const Vec4& r, const Wrench& unit) const;
    void factorize();
    void solve();

    std::span<const BodyId> bodies_;
    std::span<const std::uint32_t> constraints_;
    std::vector<Roots> roots_;  ///< of the bodies, and of all that contacts do not move
    std::vector<Joint> joints_;
    std::vector<Row> rows_;
    std::vector<Part> motion_;
    BlockCholesky matrix_;
};

}  // namespace tesserae
