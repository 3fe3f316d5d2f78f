// SPDX-License-Identifier: BSL-1.0
// How far a fit reaches: energies outside the energies of its data, another size of the system, other steps.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <ranges>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

// A test whether starts are beyond the energies that a method was learned on, or outside by chance.

namespace nysalt {

/// Number of n initial states with energies outside the range of M trajectories, the farthest by `farthest`.
///
/// A few always have. If all are of one distribution, their n + M energies are in any order equally likely,
/// and the number outside is beta-binomial [n; 2, M - 1], 2 n/(M + 1) in the mean. How far the largest of n
/// passes the largest of M depends on the distribution; where that falls exponentially, as Gibbs
/// distributions do, or faster, it is farther than t - 1 times the width of the range with a probability
/// below n Gamma(1 + t) M!/ Gamma(M + 1 + t). Chance is left aside if it would do this once in a thousand
/// times.
struct energies_outside {
  static constexpr double chance = 1e-3;  ///< a probability below which chance is left aside

  energy_range seen;             ///< the energies of the data
  std::size_t trajectories = 0;  ///< M, of the data
  std::size_t examined = 0;      ///< n, starts
  std::size_t outside = 0;       ///< number of energies outside the range
  double farthest = 0.0;         ///< distance of the farthest energy from the range, an energy
  energy_range energies{};       ///< the energies of these starts

  /// Whether there are too many, or one is too far.
  bool is_serious() const { return outside > 0 && (probability() < chance || farthest > far()); }

  /// The probability that this number of n, or more, are outside by chance.
  double probability() const;

  /// The distance that none of n starts is beyond the range, but by a chance of one in a thousand. Infinite
  /// from one trajectory, which has no range.
  double far() const;

  /// A sentence with the numbers.
  std::string report() const;
};

/// Counts initial states by energy; one that is not finite is outside. Gentle motion is followed well: what
/// is below the range by less than a twentieth of its width counts as inside.
inline energies_outside count_outside(const energy_range& seen, std::size_t trajectories,
                                      const std::ranges::range auto& energies) {
  energies_outside result{.seen = seen, .trajectories = trajectories};
  const double gentle = seen.low - 0.05 * (seen.high - seen.low);
  for (const double energy : energies) {
    ++result.examined;
    result.energies.include(energy);
    if (seen.contains(energy) || (gentle <= energy && energy < seen.low)) continue;
    ++result.outside;
    result.farthest = std::max(result.farthest, seen.distance(energy));
  }
  return result;
}

// A method that was learned at one size of a system, tried at another.

/// A method that was learned for one size of a kind of system, as a method for this size, if it holds there
/// by judge(). Throws std::invalid_argument if the systems are not of one kind, see kind_of(), or the method
/// does not hold. Cost: one judge(); none where the method was learned for this very system.
method at_size_of(const model& system, const method& learned, const initial_states& starts,
                  const judging_options& options = {});

// Parameters that were learned at several steps, and between them.

/// theta(step) through learned points: at a point what was learned there, between two of them the polynomial
/// through two on either side, and nothing beyond the first and the last.
class theta_curve {
 public:
  /// Through one theta for each step. Throws std::invalid_argument unless there is a theta for each step, all
  /// as long and finite, and the steps are positive and rise.
  theta_curve(std::vector<double> steps, std::vector<Eigen::VectorXd> thetas);

  const std::vector<double>& steps() const { return steps_; }             ///< step of each point, rising
  const std::vector<Eigen::VectorXd>& thetas() const { return thetas_; }  ///< learned theta at each step

  /// Whether a step lies between the first and the last, to 1e-9 relative, as steps are typed in decimals.
  bool covers(double step) const;

  /// Whether a step is one of the points, and not between.
  bool has(double step) const;

  /// theta at a step. Throws std::invalid_argument where it does not cover the step.
  Eigen::VectorXd at(double step) const;

 private:
  std::vector<double> steps_;
  std::vector<Eigen::VectorXd> thetas_;
};

}  // namespace nysalt
