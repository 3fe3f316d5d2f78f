// SPDX-License-Identifier: BSL-1.0

#include "nysalt/learning/reach.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

// A test whether starts are outside of the energies that were learned on, or outside by chance.

namespace nysalt {

double energies_outside::probability() const {
  const auto m = static_cast<double>(trajectories);
  const auto n = static_cast<double>(examined);
  double term = m * (m - 1.0) / ((m + n) * (m + n - 1.0));  // that none is
  double rest = 1.0;
  for (std::size_t j = 0; j < outside; ++j) {
    rest -= term;
    const auto k = static_cast<double>(j);
    term *= (n - k) / (k + 1.0) * (k + 2.0) / (m + n - k - 2.0);
  }
  return rest;
}

// The largest of M exponential energies, the widest that are allowed for, is H with E exp(-t H) = Gamma(1 +
// t) M!/ Gamma(M + 1 + t): one of n others is beyond t H with n times that probability, or less.
double energies_outside::far() const {
  if (trajectories < 2) return std::numeric_limits<double>::infinity();
  const double m = static_cast<double>(trajectories) + 1.0;
  const double n = static_cast<double>(examined);
  const auto is_likely = [&](double t) {
    return std::log(n / chance) + std::lgamma(1.0 + t) + std::lgamma(m) - std::lgamma(m + t) > 0.0;
  };
  double near = 1.0;
  double beyond = 1.0;
  while (is_likely(beyond)) beyond *= 2.0;
  for (int k = 0; k < 50; ++k) {  // to rounding
    const double middle = 0.5 * (near + beyond);
    (is_likely(middle) ? near : beyond) = middle;
  }
  return (seen.high - seen.low) * (beyond - 1.0);
}

std::string energies_outside::report() const {
  return fmt::format(
      "{} of {} starts have energies outside {:.6g} to {:.6g}, on which it was learned (they go from "
      "{:.6g} "
      "to {:.6g})",
      outside, examined, seen.low, seen.high, energies.low, energies.high);
}

// Parameters between the steps that they were learned at.

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
    throw std::invalid_argument(fmt::format("the step must be from {} to {}, the steps of learning, got {}",
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

method at_size_of(const model& system, const method& learned, const initial_states& starts,
                  const judging_options& options) {
  const auto& validity = learned.validity();
  if (!validity || describe(system) == validity->system) return learned;
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format(
        "learned:{} must run on {}, for which it was learned, got {}: {}; learn it there, or use anywhere()",
        learned.name(), validity->system, describe(system), why));
  };
  if (validity->kind.empty() || validity->kind != detail::kind_of(system))
    refuse("the systems are not of one kind");
  const judgement found =
      judge(system, starts_to_judge(system, starts), learned.anywhere(), validity->step, options);
  if (!found.holds()) refuse(found.in_words());
  return {learned.name(), learned.letters(), learned.coefficients(), learned,
          method_validity{validity->step, describe(system), detail::kind_of(system)}};
}

}  // namespace nysalt
