// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/fingerprint.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Bayesian logistic regression [gelman_and_others_2013, section 16.1]: rows r with predictors x_r and a
/// label y_r of 0 or 1, P(y_r = 1) = 1/(1 + exp(-x_r . q)), and the prior N(0, variance) for each
/// coefficient:
///   V(q) = sum over r of log(1 + exp(-s_r x_r . q)) + |q|^2/(2 variance),  s_r = 2 y_r - 1,
/// so that exp(-V) is the posterior of the coefficients, of unit mass each. An intercept is a predictor of
/// ones. A force costs two passes over the predictors and one exponential a row.
class logistic_regression {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  /// Predictors (a row for each observation, a column for each coefficient), labels and the prior's variance.
  /// Throws std::invalid_argument unless there is a row and a column, every predictor is finite, every label
  /// is 0 or 1, and the variance is positive and finite.
  logistic_regression(const Eigen::MatrixXd& predictors, const Eigen::VectorXd& labels, double variance)
      : precision_(1.0 / variance) {
    if (predictors.size() == 0 || labels.size() != predictors.rows() || !predictors.allFinite()) {
      throw std::invalid_argument(sentence(
          "logistic_regression: predictors must be finite and a row for each label, got {} rows of {} "
          "predictors and {} labels",
          predictors.rows(), predictors.cols(), labels.size()));
    }
    if (!std::ranges::all_of(labels, [](double y) { return y == 0.0 || y == 1.0; })) {
      throw std::invalid_argument("logistic_regression: labels must be 0 or 1");
    }
    if (!(variance > 0.0) || !std::isfinite(variance)) {
      throw std::invalid_argument(
          sentence("logistic_regression: the variance must be positive and finite, got {}", variance));
    }
    signed_ = predictors.transpose() * (2.0 * labels.array() - 1.0).matrix().asDiagonal();
    detail::fingerprint sum;
    sum.add_all(signed_.reshaped());
    sum.add_all(labels);
    // V'' is the sum of x_r x_r^T s (1 - s) <= x_r x_r^T/4, and the prior's.
    fastest_ = std::sqrt(0.25 * bound_of_eigenvalues(predictors) + precision_);
    description_ = sentence("logistic_regression(rows={}, coefficients={}, variance={}, fingerprint={})",
                            predictors.rows(), predictors.cols(), variance, sum.text());
  }

  Eigen::Index size() const { return signed_.rows(); }
  Eigen::Index rows() const { return signed_.cols(); }  ///< observations

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    using std::exp;
    using std::log;
    T sum(0.0);
    for (Eigen::Index i = 0; i < size(); ++i) sum += q[i] * q[i] * (0.5 * precision_);
    for (Eigen::Index r = 0; r < rows(); ++r) {
      const T margin = margin_of(r, q);
      // log(1 + exp(-m)) = max(-m, 0) + log(1 + exp(-|m|)): the exponential is at most one, and what log
      // makes of a small one is off by a rounding of 1, as the sum is.
      const T least = select(margin < T(0.0), margin, T(0.0));
      sum += log(exp(least + least - margin) + 1.0) - least;
    }
    return sum;
  }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    using std::exp;
    for (Eigen::Index i = 0; i < size(); ++i) f[i] = q[i] * -precision_;
    for (Eigen::Index r = 0; r < rows(); ++r) {
      const T margin = margin_of(r, q);
      // 1/(1 + exp(m)) = e/(1 + e) with e = exp(-m) for m > 0, and 1/(1 + e) with e = exp(m) else.
      const T least = select(margin < T(0.0), margin, T(0.0));
      const T small = exp(least + least - margin);
      const T weight = select(margin < T(0.0), T(1.0), small) / (small + 1.0);
      const double* const row = signed_.data() + r * size();
      for (Eigen::Index i = 0; i < size(); ++i) f[i] += weight * row[i];
    }
  }

  /// Frequency band from the frequency of the prior to the upper bound of the curvature.
  std::vector<frequency_band> frequency_bands() const { return {{std::sqrt(precision_), fastest_}}; }
  /// Two passes over the predictors, and an exponential a row, which costs as much as some twenty
  /// coordinates.
  double force_cost() const {
    return static_cast<double>(rows()) * (2.0 * static_cast<double>(size()) + 20.0);
  }
  /// Made once: it takes all the data.
  std::string description() const { return description_; }

 private:
  /// s_r x_r . q
  template <class T>
  T margin_of(Eigen::Index r, const vector<T, dimension>& q) const {
    const double* const row = signed_.data() + r * size();
    T sum(0.0);
    for (Eigen::Index i = 0; i < size(); ++i) sum += q[i] * row[i];
    return sum;
  }

  /// Upper bound of the largest eigenvalue of X^T X, which X X^T has, too: the largest sum of a row's
  /// magnitudes in the smaller of the two.
  static double bound_of_eigenvalues(const Eigen::MatrixXd& x) {
    const Eigen::MatrixXd products =
        x.cols() <= x.rows() ? Eigen::MatrixXd(x.transpose() * x) : Eigen::MatrixXd(x * x.transpose());
    return products.cwiseAbs().rowwise().sum().maxCoeff();
  }

  Eigen::MatrixXd signed_;  // column r is s_r x_r
  double precision_;        // of the prior
  double fastest_ = 0.0;
  std::string description_;
};

}  // namespace nysalt
