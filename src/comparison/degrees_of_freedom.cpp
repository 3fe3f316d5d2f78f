// SPDX-License-Identifier: BSL-1.0
#include "degrees_of_freedom.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "nysalt/ensemble.hpp"
#include "nysalt/force.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::program {

namespace {

/// Velocities or accelerations at positions.
struct rates {
  std::vector<Eigen::VectorXd> q;
  std::vector<Eigen::VectorXd> v;
};

/// Starts with their velocities, and accelerations at starts that are displaced by chance.
rates rates_of(const initial_value_problem& problem, std::int64_t count) {
  const model& system = problem.system;
  std::mt19937_64 bits{1};
  rates found;
  auto f = detail::make_vector<double>(system);
  for (std::int64_t n = 0; n < count; ++n) {
    const auto x = sound_start(system, problem.starts, 1, n % problem.starts.size());
    if (n < problem.starts.size()) {
      found.q.push_back(x.q);
      found.v.push_back(x.p);
    }
    const double size = x.q.norm();
    const double scale = size > 0.0 ? 0.1 * size / std::sqrt(static_cast<double>(x.q.size())) : 1.0;
    auto q = x.q;
    for (double& one : q) one += scale * (2.0 * detail::uniform_by_bits(bits()) - 1.0);
    force<double>(system, q, f);
    if (!f.allFinite()) continue;
    found.q.push_back(q);
    found.v.push_back(f);
  }
  if (system.has_unit_mass()) return found;
  for (auto& v : found.v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] *= system.inverse_mass(i);
  }
  return found;
}

/// The vectors that are orthogonal to all columns, of a length of about 1 or less; as columns.
Eigen::MatrixXd orthogonal_to(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(A * A.transpose());
  const double eps = 1e-15 * static_cast<double>(A.rows());  // some roundings of the largest eigenvalue
  const double limit = eps * std::max(squares.eigenvalues().maxCoeff(), 1e-300);
  return squares.eigenvectors().leftCols((squares.eigenvalues().array() <= limit).count());
}

/// v_i q_j - v_j q_i, of all pairs.
Eigen::VectorXd turns_of(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Eigen::VectorXd all(q.size() * (q.size() - 1) / 2);
  Eigen::Index k = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) all[k++] = v[i] * q[j] - v[j] * q[i];
  }
  return all;
}

}  // namespace

Eigen::Index degrees_of_freedom(const initial_value_problem& problem) {
  const model& system = problem.system;
  const Eigen::Index n = size(system);
  constexpr Eigen::Index most = 400;
  constexpr Eigen::Index most_with_turns = 24;
  if (system.bath().acts() || n > most || !has_quadratic_kinetic(system)) return n;
  const bool has_turns = n <= most_with_turns;
  const Eigen::Index relations = has_turns ? std::max(n, n * (n - 1) / 2) : n;
  const rates along = rates_of(problem, 2 * relations);
  const auto states = static_cast<Eigen::Index>(along.q.size());
  if (states < relations) return n;
  Eigen::MatrixXd velocities(n, states);
  for (Eigen::Index k = 0; k < states; ++k)
    velocities.col(k) = along.v[static_cast<std::size_t>(k)].stableNormalized();
  const Eigen::MatrixXd sums = orthogonal_to(velocities);
  Eigen::MatrixXd conserved = sums;
  if (has_turns && n > 1) {
    Eigen::MatrixXd turns(n * (n - 1) / 2, states);
    for (Eigen::Index k = 0; k < states; ++k) {
      const auto i = static_cast<std::size_t>(k);
      turns.col(k) = turns_of(along.q[i].stableNormalized(), along.v[i].stableNormalized());
    }
    const Eigen::MatrixXd kept = orthogonal_to(turns);
    // At the last state: the derivatives of what is kept by each velocity.
    conserved.conservativeResize(n, sums.cols() + kept.cols());
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::VectorXd turn = turns_of(along.q.back(), Eigen::VectorXd::Unit(n, i));
      conserved.row(i).tail(kept.cols()) = kept.transpose() * turn;
    }
  }
  if (conserved.cols() == 0) return n;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> independent(conserved);
  independent.setThreshold(1e-6);  // relations are known to the root of the roundings above, 2e-7
  return std::max<Eigen::Index>(1, n - independent.rank());
}

}  // namespace nysalt::program
