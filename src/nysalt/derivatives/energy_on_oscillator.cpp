// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/energy_on_oscillator.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt {

namespace {

/// A and B + C of a step; or their derivatives by a coefficient.
struct turn_of_step {
  double half_trace;
  double defect;
};

turn_of_step turn(const run_time_word& word, const std::vector<double>& coefficients, double z) {
  const auto times_square = [x = z * z](double q) { return x * q; };
  double qq = 1.0, pq = 0.0, qp = 0.0, pp = 1.0;  // p in units of q/h
  step_on_oscillator(word, coefficients, 0.0, times_square, qq, pq);
  step_on_oscillator(word, coefficients, 0.0, times_square, qp, pp);
  return {0.5 * (qq + pp), qp * z + pq / z};
}

void require_plain(const run_time_word& word) {
  if (!word.rotates() && !word.is_processed() && word.stochastic_letters == 0) return;
  throw std::invalid_argument(sentence(
      "energy_error_on_oscillator: the word must have no rotation, no letter O and no processor, got {}",
      word.letters()));
}

}  // namespace

namespace detail {

/// The matrix of a word is affine in each coefficient, so that a difference over a step of 1 is the
/// derivative.
energy_defect energy_defect_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                                          double z) {
  require_plain(word);
  word.require_one_for_each_slot(coefficients);
  const auto [half_trace, defect] = turn(word, coefficients, z);
  energy_defect result{std::numeric_limits<double>::infinity(),
                       Eigen::VectorXd::Zero(std::ssize(coefficients))};
  const double rotation = (1.0 - half_trace) * (1.0 + half_trace);
  if (!(rotation > 0.0)) return result;
  const double factor = 1.0 / (std::numbers::sqrt2 * std::sqrt(rotation));
  result.value = factor * defect;
  auto changed = coefficients;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    changed[i] += 1.0;
    const auto other = turn(word, changed, z);
    changed[i] = coefficients[i];
    result.slopes[static_cast<Eigen::Index>(i)] =
        factor * (other.defect - defect + defect * half_trace * (other.half_trace - half_trace) / rotation);
  }
  return result;
}

}  // namespace detail

double energy_error_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                                  double z) {
  require_plain(word);
  word.require_one_for_each_slot(coefficients);
  const auto [half_trace, defect] = turn(word, coefficients, z);
  const double rotation = (1.0 - half_trace) * (1.0 + half_trace);
  if (!(rotation > 0.0)) return std::numeric_limits<double>::infinity();
  return 0.5 * defect * defect / rotation;
}

}  // namespace nysalt
