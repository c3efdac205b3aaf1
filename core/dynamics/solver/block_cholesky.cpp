// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/block_cholesky.hpp"

#include <Eigen/Cholesky>
#include <bit>
#include <limits>

namespace tesserae {
namespace {

constexpr std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i; }

/// Calls visit(i) for the members of a set, ascending.
template <class Visit>
void for_each_in(std::uint64_t set, const Visit& visit) {
    for (; set != 0; set &= set - 1) visit(static_cast<std::size_t>(std::countr_zero(set)));
}

}  // namespace

void BlockCholesky::begin(std::size_t rows) {
    rows_ = rows;
    coupled_.fill(0);
}

void BlockCholesky::couple(std::size_t i, std::size_t j) {
    coupled_[i] |= bit(j);
    coupled_[j] |= bit(i);
}

std::size_t BlockCholesky::arrange() {
    std::size_t products = 0;
    std::uint16_t count = 0;
    Rows left = rows_ == kMostRows ? ~Rows{0} : bit(rows_) - 1;
    for (std::size_t n = 0; n < rows_; ++n) {
        std::size_t row = 0;
        int least = std::numeric_limits<int>::max();
        for_each_in(left, [&](std::size_t i) {
            if (std::popcount(coupled_[i]) < least) least = std::popcount(coupled_[row = i]);
        });
        order_[n] = static_cast<std::uint8_t>(row);
        rank_[row] = static_cast<std::uint8_t>(n);
        left &= ~bit(row);
        const auto degree = static_cast<std::size_t>(least);
        products += degree * (degree + 3) / 2;
        place_[row][row] = count++;
        for_each_in(coupled_[row], [&](std::size_t i) {
            place_[i][row] = count++;
            coupled_[i] = (coupled_[i] | coupled_[row]) & ~(bit(row) | bit(i));
        });
    }
    blocks_.resize(count);
    return products;
}

void BlockCholesky::clear() {
    for (Block& block : blocks_) block.setZero();
    for (std::size_t i = 0; i < rows_; ++i) block(i, i).setIdentity();
}

void BlockCholesky::add(std::size_t i, const Part& a) {
    block(i, i).noalias() += a * a.transpose();
}

void BlockCholesky::add(std::size_t i, const Part& a, std::size_t j, const Part& b) {
    add(i, a);
    add(j, b);
    if (rank_[i] > rank_[j])
        block(i, j).noalias() += a * b.transpose();
    else
        block(j, i).noalias() += b * a.transpose();
}

void BlockCholesky::factorize() {
    for (std::size_t n = 0; n < rows_; ++n) {
        const std::size_t row = order_[n];
        Block& diagonal = block(row, row);
        Eigen::LLT<Eigen::Ref<Block>> in_place(diagonal);
        for_each_in(coupled_[row], [&](std::size_t i) {
            in_place.matrixU().solveInPlace<Eigen::OnTheRight>(block(i, row));
        });
        for_each_in(coupled_[row], [&](std::size_t i) {
            for_each_in(coupled_[row], [&](std::size_t j) {
                if (rank_[i] >= rank_[j])
                    block(i, j).noalias() -= block(i, row).lazyProduct(block(j, row).transpose());
            });
        });
    }
}

void BlockCholesky::solve(std::span<Part> x) const {
    for (std::size_t n = 0; n < rows_; ++n) {
        const std::size_t row = order_[n];
        block(row, row).triangularView<Eigen::Lower>().solveInPlace(x[row]);
        for_each_in(coupled_[row],
                    [&](std::size_t i) { x[i].noalias() -= block(i, row).lazyProduct(x[row]); });
    }
    for (std::size_t n = rows_; n-- > 0;) {
        const std::size_t row = order_[n];
        for_each_in(coupled_[row], [&](std::size_t i) {
            x[row].noalias() -= block(i, row).transpose().lazyProduct(x[i]);
        });
        block(row, row).transpose().triangularView<Eigen::Upper>().solveInPlace(x[row]);
    }
}

}  // namespace tesserae
