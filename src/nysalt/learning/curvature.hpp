// SPDX-License-Identifier: BSL-1.0
// The Hessian of a loss, and the uncertainty of a minimum that follows from it.
#pragma once

#include <Eigen/Core>

#include <iterator>
#include <utility>
#include <vector>

#include "nysalt/losses/squares.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// Contributions of trajectories, or other blocks of data, to the gradient of a loss: those of this rank.
struct trajectory_scores {
  std::vector<Eigen::VectorXd> of_each;  ///< gradients, one for each block of this rank
  shard share;                           ///< distribution of the blocks over ranks

  /// All blocks are here.
  trajectory_scores(std::vector<Eigen::VectorXd> all) : of_each(std::move(all)), share(std::ssize(of_each)) {}
  /// Scores of the blocks of this rank.
  trajectory_scores(std::vector<Eigen::VectorXd> ours, const shard& whose)
      : of_each(std::move(ours)), share(whose) {}

  double blocks() const { return static_cast<double>(share.total()); }  ///< B, of all ranks
};

/// The full Hessian (not Gauss-Newton's: residuals do not vanish at the minimum) by central differences of
/// the exact gradient. Its relative error is about 1e-8: some hundred s^2 of the step, and eps/s of the
/// gradient. The step is 1e-5 of a parameter beyond 1 and else of 1; of one in other units, where
/// Gauss-Newton's curvatures change by more than 1e-3 over it, it is shorter, until they do not. Cost: two
/// passes with derivatives for each parameter, as much as one with exact second derivatives, which a black
/// box has not; two more for each step that is too long.
Eigen::MatrixXd hessian(const objective& loss, const Eigen::VectorXd& theta);

/// The contribution of each trajectory to the gradient of the loss, by its residuals and by its part in the
/// weights: those of a metric are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out
/// larger by some part counts less by that part: `deviations` are those parts, a row for each coordinate and
/// a column for each trajectory. Without this the standard errors are two to three times too small.
trajectory_scores scores_of(const loss_on_data& loss, const Eigen::VectorXd& theta,
                            const Eigen::MatrixXd& deviations);

/// Standard errors of a minimum by each parameter, and how far they may be relied on.
struct spread_of_minimum {
  /// NaN with a single block; infinite along flat directions; 0 of what is not free.
  Eigen::VectorXd standard_errors;
  /// Number of blocks that decide each: (sum_b x_b^2)^2/sum_b x_b^4 of the x_b that block b moves it by. The
  /// variance of a sum of squares is about that of the squares' sample, sum x_b^4 - (sum x_b^2)^2/B, so that
  /// a standard error has the relative error sqrt(1/deciding - 1/B)/2 [satterthwaite_1946].
  Eigen::VectorXd deciding;
};

/// A Hessian restricted to the free parameters, in its eigenvectors.
class curvature {
 public:
  /// The Hessian is by all parameters; `free` numbers those that are free.
  curvature(const Eigen::MatrixXd& hessian, std::vector<Eigen::Index> free);

  /// Directions along which the loss does not rise beyond the error of the Hessian, in all parameters.
  std::vector<Eigen::VectorXd> flat_directions() const;
  /// Largest over smallest curvature of the directions that are not flat.
  double condition() const;
  /// Whether the loss falls along no direction, but for the error of the Hessian.
  bool is_minimum() const;

  /// H^+ v, the inverse of the Hessian on what is free and not flat.
  Eigen::VectorXd solve(const Eigen::VectorXd& v) const;

  /// The mean contribution of the uncertainty of the minimum to the loss on new data: the loss L is least at
  /// theta*, and with H = L'' there and C the covariance of the minimum theta,
  ///   E L(theta) - L(theta*) = E (theta - theta*)^T H (theta - theta*)/2 = tr(H C)/2.
  /// C is that of standard_errors(), so that H C has one H^+ less: B/(B - 1) sum_b g_b^T H^+ g_b/2. Along a
  /// flat direction C has no bound, and H nothing to add: it is left out. NaN with a single block.
  double expected_excess(const trajectory_scores& scores) const;

  /// Effective number of blocks on which the curvature rests: (sum_b e_b)^2/sum_b e_b^2, with
  /// e_b = g_b^T H^+ g_b. Of B blocks with normal gradients it is B P/(P + 2), P the number of parameters.
  double deciding_blocks(const trajectory_scores& scores) const;

  /// Uncertainty of the minimum by its sandwich covariance [white_1982, theorem 3.2], clustered by block:
  /// H^+ (sum_b g_b g_b^T) H^+ B/(B - 1), where g_b is what block b adds to the gradient, by its residuals
  /// and by its part in the weights. It holds for a misspecified model, as a learned map is one.
  ///
  /// The blocks that the minimum was fitted to show too small a spread where few of them matter: theta has
  /// gone to where their g_b are small (leverage), and the rare blocks with a large one are missing from most
  /// samples. `others` are scores at the same theta, about their mean, of B' blocks that theta was not fitted
  /// to; the spread is then the mean of both, weighted by B - 1 and B' - 1. None are all of one block.
  spread_of_minimum spread(const trajectory_scores& scores, const trajectory_scores& others) const;

 private:
  std::vector<double> excesses(const trajectory_scores& scores) const;

  static constexpr double flat_below = 1e-8;  // the relative error of the Hessian

  Eigen::Index count() const { return static_cast<Eigen::Index>(free_.size()); }
  double largest() const;
  bool is_flat(Eigen::Index k) const;
  Eigen::VectorXd direction(Eigen::Index k) const;

  Eigen::Index size_;
  std::vector<Eigen::Index> free_;
  Eigen::VectorXd eigenvalues_;  // of the Hessian by what is free: they rise
  Eigen::MatrixXd eigenvectors_;
};

}  // namespace nysalt
