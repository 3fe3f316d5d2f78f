// SPDX-License-Identifier: BSL-1.0
// What a guard has against a word at a step.
#include <fmt/format.h>

#include <algorithm>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/magnification.hpp"
#include "nysalt/derivatives/stiffness_along.hpp"
#include "nysalt/derivatives/sum_resonance.hpp"
#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/learning/stability_guard.hpp"

namespace nysalt {

void stability_guard::watch_rotations(const model& system, const phase_points& states) {
  const auto part = modal_coordinates::of(system);
  watch_modes(part->frequencies(), stiffness_along<field::soft>(system, states).highest_frequency());
  const Eigen::Index n = size(system);
  if (n > most_for_all_frequencies) {
    description_ += "; pairs of modes are not examined";
    return;
  }
  // So that all pairs of modes of all states take some milliseconds.
  constexpr Eigen::Index pairs_and_states = 4000;
  const auto enough =
      static_cast<std::size_t>(std::clamp<Eigen::Index>(2 * pairs_and_states / (n * n), 1, 16));
  const auto count = states.size();
  const normal_modes modes = system.modes();
  mean_soft_ = Eigen::MatrixXd::Zero(n, n);
  std::size_t number = 0;
  force_jacobian<field::soft, model> jacobian(system, states);
  for (const auto& state : states) {
    // Evenly spread: the k-th of those that are examined is the state count * k / enough.
    const bool is_looked_at = number * enough / count != (number + 1) * enough / count;
    ++number;
    if (count > enough && !is_looked_at) continue;
    const Eigen::MatrixXd root = detail::kinetic_factor(system, state.p);
    const Eigen::MatrixXd soft = root * detail::potential_hessian(jacobian, state.q) * root;
    soft_.push_back(modes.basis.transpose() * soft * modes.basis);
    mean_soft_ += soft_.back();
  }
  mean_soft_ /= static_cast<double>(soft_.size());
}

bool stability_guard::admits(const run_time_word& word, const std::vector<double>& coefficients, double step,
                             met which) const {
  return objection(word, coefficients, step, which).empty();
}

std::string stability_guard::objection(const run_time_word& word, const std::vector<double>& coefficients,
                                       double step, met which) const {
  word.require_one_for_each_slot(coefficients);
  if (word.has_own_letters()) return {};
  if (!word.rotates()) return unstable(word, coefficients, step, which);
  const std::string of_one = magnified(word, coefficients, step);
  return of_one.empty() ? resonant(word, coefficients, step) : of_one;
}

std::vector<stability_window> stability_guard::gaps(const run_time_word& word,
                                                    const std::vector<double>& coefficients,
                                                    double step) const {
  if (word.rotates() || word.has_own_letters()) return {};
  double highest = 0.0;
  for (const auto& band : bands_) highest = std::max(highest, step * band.high);
  return gaps_below(stability_windows(conservative_part(word), conservative_part(word, coefficients)),
                    highest);
}

stability_guard::magnified_mode stability_guard::most_magnified(const run_time_word& word,
                                                                const std::vector<double>& coefficients,
                                                                double step, double enough) const {
  constexpr int samples = 64;  // a narrower gap is passed before it does harm, as soft forces change
  magnified_mode worst{0.0, 1.0};
  for (const double omega : modes_) {
    for (int i = 1; i <= samples && stiffest_soft_ > 0.0; ++i) {
      const double soft = step * stiffest_soft_ * i / samples;
      const double grown = magnification(word, coefficients, step * omega, soft * soft, steps_);
      if (!(grown <= worst.factor)) worst = {omega, grown};
      if (!(worst.factor <= enough)) return worst;
    }
  }
  return worst;
}

stability_guard::resonant_pair stability_guard::most_resonant(const run_time_word& word,
                                                              const std::vector<double>& coefficients,
                                                              double step) const {
  resonant_pair worst{0.0, 0.0, 0.0};
  const auto growth_at = [&](const Eigen::MatrixXd& soft, Eigen::Index i, Eigen::Index j) {
    const Eigen::Array2d theta(step * all_modes_[static_cast<std::size_t>(i)],
                               step * all_modes_[static_cast<std::size_t>(j)]);
    const Eigen::Matrix2d k{{soft(i, i), soft(i, j)}, {soft(j, i), soft(j, j)}};
    return growth_of_pair(word, coefficients, theta, step * step * k);
  };
  for (Eigen::Index i = 0; i < mean_soft_.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      double in_the_mean = 0.0;
      for (const auto& soft : soft_) in_the_mean += growth_at(soft, i, j);
      in_the_mean /= static_cast<double>(soft_.size());
      const double growth = static_cast<double>(steps_) * std::max(growth_at(mean_soft_, i, j), in_the_mean);
      if (growth <= worst.growth) continue;
      worst = {all_modes_[static_cast<std::size_t>(j)], all_modes_[static_cast<std::size_t>(i)], growth};
    }
  }
  return worst;
}

}  // namespace nysalt
