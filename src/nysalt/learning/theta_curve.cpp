// SPDX-License-Identifier: BSL-1.0
// Parameters between the steps that they were learned at.
#include "nysalt/learning/theta_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "nysalt/detail/sentence.hpp"

namespace nysalt {

namespace {
constexpr double same_step = 1e-9;  // relative
}  // namespace

theta_curve::theta_curve(std::vector<double> steps, std::vector<Eigen::VectorXd> thetas)
    : steps_(std::move(steps)), thetas_(std::move(thetas)) {
  bool sound = !steps_.empty() && steps_.size() == thetas_.size();
  for (std::size_t k = 0; sound && k < steps_.size(); ++k) {
    sound = std::isfinite(steps_[k]) &&
            (k == 0 ? steps_[k] > 0.0 : steps_[k - 1] * (1.0 + 2.0 * same_step) < steps_[k]) &&
            thetas_[k].allFinite() && thetas_[k].size() == thetas_[0].size();
  }
  if (sound) return;
  throw std::invalid_argument(
      "a curve of parameters must have rising steps, and as many finite parameters at each");
}

bool theta_curve::covers(double step) const {
  return steps_.front() * (1.0 - same_step) <= step && step <= steps_.back() * (1.0 + same_step);
}

bool theta_curve::has(double step) const {
  return std::any_of(steps_.begin(), steps_.end(),
                     [&](double s) { return std::abs(step - s) <= same_step * s; });
}

Eigen::VectorXd theta_curve::at(double step) const {
  if (!covers(step)) {
    throw std::invalid_argument(sentence("the step must be from {} to {}, the steps of learning, got {}",
                                         steps_.front(), steps_.back(), step));
  }
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (std::abs(step - steps_[k]) <= same_step * steps_[k]) return thetas_[k];
  }
  const auto after =
      static_cast<std::size_t>(std::upper_bound(steps_.begin(), steps_.end(), step) - steps_.begin());
  const std::size_t count = std::min<std::size_t>(4, steps_.size());
  const std::size_t first = std::min(after < 2 ? 0 : after - 2, steps_.size() - count);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(thetas_[0].size());
  for (std::size_t k = first; k < first + count; ++k) {  // Lagrange's form
    double weight = 1.0;
    for (std::size_t j = first; j < first + count; ++j) {
      if (j != k) weight *= (step - steps_[j]) / (steps_[k] - steps_[j]);
    }
    result += weight * thetas_[k];
  }
  return result;
}

}  // namespace nysalt
