// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tesserae {

/// A sparse symmetric positive definite matrix of blocks and its Cholesky factors: one row of
/// blocks for each of a few bodies that press on each other. A row holds a body's ten degrees of
/// freedom and two unused ones, as twelve numbers fill three registers.
///
/// begin(), couple() and arrange() say which blocks there are; clear() makes the matrix the
/// identity; add() adds to it; then come factorize() and solve(). Source: A. George and J. Liu,
/// "The evolution of the minimum degree ordering algorithm", 1989.
class BlockCholesky {
  public:
    static constexpr std::size_t kSize = 12, kMostRows = 64;
    using Block = Eigen::Matrix<double, kSize, kSize>;
    using Part = Eigen::Matrix<double, kSize, 1>;

    /// Starts a matrix without couplings.
    /// @param rows   <= kMostRows
    void begin(std::size_t rows);
    /// Says that the matrix has a block in the different rows i and j.
    void couple(std::size_t i, std::size_t j);
    /// Chooses the order of elimination.
    /// @return the number of products of blocks that factorize() takes
    std::size_t arrange();

    void clear();
    /// Adds a a^T to the diagonal block i.
    void add(std::size_t i, const Part& a);
    /// Adds (a, b) (a, b)^T to the blocks of the rows i and j, which are coupled.
    void add(std::size_t i, const Part& a, std::size_t j, const Part& b);
    void factorize();
    /// Solves A y = x and writes y to x.
    void solve(std::span<Part> x) const;

  private:
    using Rows = std::uint64_t;  ///< a set of rows, one bit each

    Block& block(std::size_t row, std::size_t column) { return blocks_[place_[row][column]]; }
    const Block& block(std::size_t row, std::size_t column) const {
        return blocks_[place_[row][column]];
    }

    std::size_t rows_ = 0;
    std::array<std::uint8_t, kMostRows> order_{};  ///< the rows in their order of elimination
    std::array<std::uint8_t, kMostRows> rank_{};   ///< each row's place in that order
    std::array<Rows, kMostRows> coupled_{};  ///< the rows that each row has blocks with; after
                                             ///< arrange() only the later ones
    std::array<std::array<std::uint16_t, kMostRows>, kMostRows> place_;  ///< [later row][earlier]
    std::vector<Block> blocks_;
};

}  // namespace tesserae
