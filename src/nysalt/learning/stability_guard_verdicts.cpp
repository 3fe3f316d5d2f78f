// SPDX-License-Identifier: BSL-1.0
// What a guard has against a word at a step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nysalt/derivatives/hessian_spectrum.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/strong_stability.hpp"
#include "nysalt/derivatives/sum_resonance.hpp"
#include "nysalt/derivatives/transient_growth.hpp"
#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/learning/stability_guard.hpp"

namespace nysalt {

stability_guard::stability_guard(const model& system, const phase_points& states, const run_time_word& word,
                                 std::int64_t steps, std::size_t typical)
    : stability_guard(system, states, word.rotates(), steps, typical) {
  if (is_of_oscillators(word)) return;
  const auto parts = std::make_shared<const word_on_parts>(system, states, word);
  if (parts->is_known()) {
    parts_ = parts;
    description_ = fmt::format("linearised motion of {} along {} states", word.letters(), parts->states());
  } else {
    description_ = fmt::format("trial runs only: the linearised motion of {} was not analysed, as {}",
                               word.letters(), parts->why_not());
  }
}

void stability_guard::watch_rotations(const model& system, const phase_points& states) {
  const auto part = modal_coordinates::of(system);
  watch_modes(part->frequencies(), hessian_spectrum<field::soft>(system, states).highest_frequency());
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
    const bool is_examined = number * enough / count != (number + 1) * enough / count;
    ++number;
    if (count > enough && !is_examined) continue;
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
  if (!is_of_oscillators(word)) {
    if (!parts_) return {};
    if (word.letters() != parts_->word()) {
      throw std::invalid_argument(
          sentence("stability_guard: word must be {}, for which the guard was made, got {}; make a guard for "
                   "this word",
                   parts_->word(), word.letters()));
    }
    return grown_on_parts(coefficients, step);
  }
  if (!word.rotates()) return unstable(word, coefficients, step, which);
  const std::string of_one = magnified(word, coefficients, step);
  return of_one.empty() ? resonant(word, coefficients, step) : of_one;
}

namespace {
/// What a spectrum shows, as the end of a sentence.
std::string shown_by(const symplectic_spectrum& spectrum) {
  if (!std::isfinite(spectrum.growth)) return "a step is not finite";
  if (!spectrum.is_on_circle()) {
    return fmt::format("a step multiplies a mode by exp({:.3g}), at the phase {:.4g}", spectrum.growth,
                       spectrum.first);
  }
  return fmt::format(
      "the nearest eigenvalues of opposite Krein signature, of phases {:.4g} and {:.4g}, are {:.3g} apart",
      spectrum.first, spectrum.second, spectrum.krein_distance);
}
}  // namespace

std::string stability_guard::grown_on_parts(const std::vector<double>& coefficients, double step) const {
  const auto growth = parts_->growth(coefficients, step, steps_);
  if (growth.is_refused()) {
    const std::string how_much =
        std::isfinite(growth.late) ? fmt::format("by the factor {:.3g}", 1.0 + growth.late) : "without bound";
    return fmt::format("the linearised motion gains energy {} in {} steps: {}", how_much, steps_,
                       shown_by(spectrum_of(parts_->step(coefficients, step, growth.state))));
  }
  // A perturbation that turns an eigenvalue by less than a radian in all steps may move two off the circle.
  // Two slow modes, or one and its conjugate, are of opposite signature and on either side of +1, without any
  // resonance: they are farther apart than one of them turns at least.
  if (parts_->has_mean()) {
    const auto spectrum = spectrum_of(parts_->step(coefficients, step, parts_->states()));
    const double too_near = std::min(2.0 / static_cast<double>(steps_), word_on_parts::least_turn);
    if (spectrum.krein_distance < too_near)
      return fmt::format("it is not strongly stable: {}", shown_by(spectrum));
  }
  const double moved = parts_->displacement(coefficients, step);
  if (moved > 1.0) {
    return fmt::format(
        "kicks of a part push a mode in one phase: the equilibrium moves by {:.3g} times the "
        "amplitude of the motion",
        moved);
  }
  return {};
}

std::vector<stability_window> stability_guard::gaps(const run_time_word& word,
                                                    const std::vector<double>& coefficients,
                                                    double step) const {
  if (word.rotates() || !is_of_oscillators(word)) return {};
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
      const double grown = transient_growth(word, coefficients, step * omega, soft * soft, steps_);
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
