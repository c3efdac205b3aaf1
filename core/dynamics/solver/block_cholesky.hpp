#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tesserae {

/// A symmetric positive definite matrix of blocks, most of which are zero, and its Cholesky
/// factors: of a few bodies that press on each other, one row of blocks a body. A row holds a
/// body's ten degrees of freedom and two more that stay alone, as twelve is three registers.
///
/// begin(), couple() and arrange() say which blocks there are, clear() makes the matrix the
/// identity, add() adds to it, factorize() and then solve(). Source: A. George and J. Liu, "The
/// evolution of the minimum degree ordering algorithm", 1989.
class BlockCholesky {
  public:
    static constexpr std::size_t kSize = 12, kMostRows = 64;
    using Block = Eigen::Matrix<double, kSize, kSize>;
    using Part = Eigen::Matrix<double, kSize, 1>;

    /// @param rows   <= kMostRows
    void begin(std::size_t rows);
    /// Of two different rows.
    void couple(std::size_t i, std::size_t j);
    /// Chooses the order of elimination.
    /// @return how many products of blocks factorize() is
    std::size_t arrange();

    void clear();
    /// Adds a a^T to the diagonal block i.
    void add(std::size_t i, const Part& a);
    /// Adds (a, b) (a, b)^T to the blocks of the rows i and j, which are coupled.
    void add(std::size_t i, const Part& a, std::size_t j, const Part& b);
    void factorize();
    /// x becomes what the matrix takes to it.
    void solve(std::span<Part> x) const;

  private:
    using Rows = std::uint64_t;  ///< a set of them

    Block& block(std::size_t row, std::size_t column) { return blocks_[place_[row][column]]; }
    const Block& block(std::size_t row, std::size_t column) const {
        return blocks_[place_[row][column]];
    }

    std::size_t rows_ = 0;
    std::array<std::uint8_t, kMostRows> order_{};  ///< rows as they are eliminated
    std::array<std::uint8_t, kMostRows> rank_{};   ///< of a row in it
    std::array<Rows, kMostRows> coupled_{};        ///< with which rows; once arranged: later ones
    std::array<std::array<std::uint16_t, kMostRows>, kMostRows> place_;  ///< [later row][earlier]
    std::vector<Block> blocks_;
};

}  // namespace tesserae
