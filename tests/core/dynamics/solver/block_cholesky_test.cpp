// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <utility>
#include <vector>

namespace tesserae {
namespace {

using Part = BlockCholesky::Part;
constexpr auto kSize = static_cast<Eigen::Index>(BlockCholesky::kSize);

/// A sparse matrix of blocks and the same in one piece.
class Both {
  public:
    Both(std::size_t rows, const std::vector<std::pair<std::size_t, std::size_t>>& pairs)
        : rows_(rows), dense_(Eigen::MatrixXd::Identity(size(), size())) {
        sparse_.begin(rows);
        for (const auto& [i, j] : pairs) sparse_.couple(i, j);
        products_ = sparse_.arrange();
        sparse_.clear();
    }
    void add(std::size_t i, const Part& a) {
        sparse_.add(i, a);
        Eigen::VectorXd all = Eigen::VectorXd::Zero(size());
        all.segment<kSize>(place(i)) = a;
        dense_ += all * all.transpose();
    }
    void add(std::size_t i, const Part& a, std::size_t j, const Part& b) {
        sparse_.add(i, a, j, b);
        Eigen::VectorXd all = Eigen::VectorXd::Zero(size());
        all.segment<kSize>(place(i)) = a, all.segment<kSize>(place(j)) = b;
        dense_ += all * all.transpose();
    }
    std::size_t products() const { return products_; }

    /// How far apart both solutions are, as a part of them.
    double difference(const std::vector<Part>& right) {
        Eigen::VectorXd all(size()), solved(size());
        for (std::size_t i = 0; i < rows_; ++i) all.segment<kSize>(place(i)) = right[i];
        std::vector<Part> x = right;
        sparse_.factorize();
        sparse_.solve(x);
        for (std::size_t i = 0; i < rows_; ++i) solved.segment<kSize>(place(i)) = x[i];
        const Eigen::VectorXd expected = dense_.ldlt().solve(all);
        return (solved - expected).norm() / expected.norm();
    }

  private:
    Eigen::Index size() const { return kSize * static_cast<Eigen::Index>(rows_); }
    static Eigen::Index place(std::size_t i) { return kSize * static_cast<Eigen::Index>(i); }

    std::size_t rows_, products_ = 0;
    BlockCholesky sparse_;
    Eigen::MatrixXd dense_;
};

TEST(BlockCholesky, SolvesAsAnotherFactorizationOfTheWholeMatrix) {
    std::mt19937_64 engine(1);
    std::normal_distribution<> normal;
    const auto random = [&] { return Part(Part::NullaryExpr([&] { return normal(engine); })); };
    for (int round = 0; round < 60; ++round) {
        const std::size_t rows = round < 40 ? 1 + engine() % 12 : 1 + engine() % 32;
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (std::size_t n = engine() % (3 * rows); n > 0; --n)
            if (const std::size_t i = engine() % rows, j = engine() % rows; i != j)
                pairs.emplace_back(i, j);
        Both both(rows, pairs);
        for (std::size_t i = 0; i < rows; ++i) both.add(i, 10 * random());
        for (const auto& [i, j] : pairs)
            for (int n = 0; n < 10; ++n) both.add(i, 3 * random(), j, 3 * random());
        std::vector<Part> right(rows);
        for (Part& part : right) part = random();
        EXPECT_LT(both.difference(right), 1e-10) << round;
    }
}

TEST(BlockCholesky, HoldsAsManyRowsAsItSays) {
    std::vector<std::pair<std::size_t, std::size_t>> chain;
    for (std::size_t i = 1; i < BlockCholesky::kMostRows; ++i)
        chain.emplace_back(i * 37 % BlockCholesky::kMostRows,
                           (i - 1) * 37 % BlockCholesky::kMostRows);
    Both both(BlockCholesky::kMostRows, chain);
    for (const auto& [i, j] : chain) both.add(i, Part::Ones(), j, -Part::Ones());
    EXPECT_LT(both.difference(std::vector<Part>(BlockCholesky::kMostRows, Part::LinSpaced(1, 2))),
              1e-12);
}

TEST(BlockCholesky, EliminatesWhatIsAlongATreeFromItsLeaves) {
    // Two products a row and none of the last: nothing is filled, however the rows are numbered.
    EXPECT_EQ(Both(4, {{2, 0}, {0, 3}, {3, 1}}).products(), 6u);
    EXPECT_EQ(Both(6, {{3, 0}, {3, 1}, {3, 2}, {3, 4}, {3, 5}}).products(), 10u);
    EXPECT_EQ(Both(3, {{0, 1}, {1, 2}, {2, 0}}).products(), 5u + 2u);
    EXPECT_EQ(Both(5, {}).products(), 0u);
}

}  // namespace
}  // namespace tesserae
