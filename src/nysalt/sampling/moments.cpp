// SPDX-License-Identifier: BSL-1.0
#include "moments.hpp"

#include <stdexcept>

#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

Eigen::VectorXd deviations_of(const std::vector<moments>& of_chains, const shard& mine, std::int64_t chains,
                              Eigen::Index size) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  const auto count = static_cast<double>(chains);
  std::vector<Eigen::VectorXd> means;
  for (const auto& one : of_chains) means.push_back(one.mean);
  const Eigen::VectorXd mean = mine.sum(means, zero) / count;
  std::vector<Eigen::VectorXd> squares;
  for (const auto& one : of_chains)
    squares.push_back(one.squares / one.count + (one.mean - mean).cwiseAbs2());
  const Eigen::VectorXd variance = mine.sum(squares, zero) / count;
  Eigen::Index still = 0;
  if (!(variance.minCoeff(&still) > 0.0)) {
    throw std::runtime_error(
        sentence("hmc: coordinate {} must vary in the burn-in to have a mass of its own; take a smaller "
                 "step, a longer burn-in, or no diagonal_masses",
                 still + 1));
  }
  return variance.cwiseSqrt();
}

}  // namespace nysalt::detail
