// SPDX-License-Identifier: BSL-1.0
// Linear stability of a word at a step, on the frequencies that a system has.

#include "nysalt/learning/stability_guard.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/stepping/served_letters.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

namespace {

constexpr double margin = detail::stability_guard::widened;
constexpr double rarely = 0.1;  // of the states

/// Threefold is much: a stable motion whose energy swings by nine. On the FPU chain at h omega = j pi
/// impulses come to 33 by t = 100, and words learned there to 1.0003.
constexpr double too_much = 3.0;

/// What a tenth of all states exceed, of values that some of them have; 0 if fewer have one.
double exceeded_often(std::vector<double> values, std::size_t states) {
  const auto rank = static_cast<std::size_t>(rarely * static_cast<double>(states));
  if (values.size() <= rank) return 0.0;
  std::ranges::sort(values, std::greater{});
  return values[rank];
}

/// Ranges of frequencies that lie apart, as those of stiff bonds and of what they hold do: with nothing
/// between them over a quarter of their distance from 0 and over a tenth of the highest. The first begins at
/// 0. The k-th lowest frequency is continuous along the motion, and passes through all between the least and
/// the largest that is met. One range where not all frequencies are known, or of few states.
std::vector<frequency_band> clusters(const detail::frequencies_along& along) {
  constexpr double quarter = 0.25;
  constexpr double tenth = 0.1;
  constexpr int enough = 64;
  const double highest = along.highest().frequency;
  std::vector<frequency_band> of_number;
  int known = 0;
  for (const auto& one : along.of_state) {
    if (one.empty()) continue;
    ++known;
    if (of_number.empty()) of_number.assign(one.size(), {highest, 0.0});
    for (std::size_t k = 0; k < one.size(); ++k) {
      of_number[k] = {std::min(of_number[k].low, one[k]), std::max(of_number[k].high, one[k])};
    }
  }
  if (!along.are_complete || known < enough) return {{0.0, highest}};
  std::vector<frequency_band> result{{0.0, 0.0}};
  for (const auto& [low, high] : of_number) {
    const bool is_first = result.back().high == 0.0;
    const double distance = low - result.back().high;
    if (!is_first && distance > std::max(quarter * result.back().high, tenth * highest)) {
      result.push_back({low, high});
    }
    result.back().high = std::max(result.back().high, high);
  }
  return result;
}

std::string in_words(const std::vector<frequency_band>& bands) {
  std::vector<std::string> each;
  for (const auto& [low, high] : bands) each.push_back(fmt::format("{:.4g}..{:.4g}", low, high));
  return fmt::format("{}", fmt::join(each, " "));
}

}  // namespace

detail::stability_guard::stability_guard(const model& system, const phase_points& states, bool rotations,
                                         std::int64_t steps, std::size_t typical)
    : steps_(steps) {
  if (system.facts().has_bands) declare(system.frequency_bands());
  scan_along(detail::frequencies_of_states(system, states), states.size(), std::min(typical, states.size()),
             has_quadratic_kinetic(system));
  const bool has_soft_derivative = system.facts().serves<double>(soft_gradient_kick::letter);
  if (has_soft_derivative && rotations && states.size() > 0) watch_rotations(system, states);
}

void detail::stability_guard::declare(const std::vector<frequency_band>& bands) {
  for (const auto& band : bands) bands_.push_back({band.low * (1.0 - margin), band.high * (1.0 + margin)});
}

void detail::stability_guard::scan_along(const detail::frequencies_along& along, std::size_t count,
                                         std::size_t typical, bool has_quadratic_kinetic) {
  const bool are_declared = !bands_.empty();
  highest_along_ = along.highest().frequency;
  state_of_highest_ = along.highest().state;
  often_ = bands_;
  if (are_declared) {
    description_ = "declared bands";
    for (const auto& band : bands_) description_ += fmt::format(" [{:g}, {:g}]", band.low, band.high);
    extend(along, typical);
  } else if (highest_along_ > 0.0) {
    estimate(along, typical);
    description_ = fmt::format("estimated {} along {} states", nysalt::in_words(bands_), count);
    if (nysalt::in_words(often_) != nysalt::in_words(bands_))
      description_ += fmt::format(", {} in nine tenths of them", nysalt::in_words(often_));
  } else if (has_quadratic_kinetic && count == 0) {
    throw std::invalid_argument(
        "stability_guard: frequency_bands() must be declared, or states given to estimate them from, got "
        "neither");
  } else if (along.of_state.empty()) {
    description_ = "no linear criterion: no bands are declared, and K''(p) is not known";
  } else {
    description_ = fmt::format("no linear criterion: nothing oscillates along {} states", count);
  }
}

void detail::stability_guard::estimate(const detail::frequencies_along& along, std::size_t typical) {
  const std::vector<frequency_band> met = clusters(along);
  for (std::size_t k = 0; k < met.size(); ++k) {
    const auto& [low, high] = met[k];
    std::vector<double> highest;
    std::vector<double> below_high;  // how far the lowest is
    for (std::size_t state = 0; state < typical; ++state) {
      const auto& all = along.of_state[state];
      const auto first = std::ranges::lower_bound(all, low);
      const auto last = std::ranges::upper_bound(all, high);
      if (first == last) continue;
      highest.push_back(*std::prev(last));
      below_high.push_back(high - *first);
    }
    bands_.push_back({low * (1.0 - margin), high * (1.0 + margin)});
    const double often = exceeded_often(highest, typical);
    if (often == 0.0 && k > 0) continue;
    // Of a range that few more than a tenth of the states meet the two may come in another order.
    const double lowest = k == 0 ? 0.0 : high - exceeded_often(below_high, typical);
    often_.push_back({std::min(lowest, often) * (1.0 - margin), std::max(lowest, often) * (1.0 + margin)});
  }
}

namespace {

enum where : std::size_t { above, below };
using of_states = std::vector<double>;  // of the states that have one

/// How far frequencies lie outside of bands.
struct beyond_bands {
  std::vector<std::array<of_states, 2>> of_band;  // the farthest above and below each band that is nearest
  of_states under_all;                            // the highest of those below all bands
};

/// By the frequencies of the first states.
beyond_bands beyond(const std::vector<frequency_band>& declared, const detail::frequencies_along& along,
                    std::size_t states) {
  const auto distance = [](const frequency_band& band, double omega) {
    return omega > band.high ? omega - band.high : band.low - omega;
  };
  const double lowest = std::ranges::min(declared, {}, &frequency_band::low).low;
  beyond_bands result{std::vector<std::array<of_states, 2>>(declared.size()), {}};
  for (std::size_t state = 0; state < std::min(states, along.of_state.size()); ++state) {
    std::vector<std::array<double, 2>> farthest(declared.size(), {0.0, 0.0});
    double under = 0.0;
    for (const double omega : along.of_state[state]) {
      if (omega == 0.0) continue;
      if (omega < lowest) {
        under = std::max(under, omega);
        continue;
      }
      const auto nearest = static_cast<std::size_t>(
          std::ranges::min_element(declared, {}, [&](const auto& band) { return distance(band, omega); }) -
          declared.begin());
      auto& far = farthest[nearest][omega > declared[nearest].high ? above : below];
      far = std::max(far, distance(declared[nearest], omega));  // below zero within a band
    }
    for (std::size_t k = 0; k < declared.size(); ++k) {
      for (const where side : {above, below}) {
        if (farthest[k][side] > 0.0) result.of_band[k][side].push_back(farthest[k][side]);
      }
    }
    if (under > 0.0) result.under_all.push_back(under);
  }
  return result;
}

}  // namespace

void detail::stability_guard::extend(const detail::frequencies_along& along, std::size_t typical) {
  const std::vector<frequency_band> declared = bands_;
  const beyond_bands all = beyond(declared, along, along.of_state.size());
  const beyond_bands of_typical = beyond(declared, along, typical);
  const std::size_t states = along.of_state.size();
  for (std::size_t k = 0; k < declared.size(); ++k) {
    const auto& [over, down] = all.of_band[k];
    const auto largest = [](const of_states& values) {
      return values.empty() ? 0.0 : std::ranges::max(values);
    };
    const auto widen = [&](frequency_band& band, double up, double low) {
      if (up > 0.0) band.high = (declared[k].high + up) * (1.0 + margin);
      if (low > 0.0) band.low = (declared[k].low - low) * (1.0 - margin);
    };
    widen(bands_[k], largest(over), largest(down));
    widen(often_[k], exceeded_often(of_typical.of_band[k][above], typical),
          exceeded_often(of_typical.of_band[k][below], typical));
    if (!over.empty() || !down.empty()) {
      description_ += fmt::format(
          "; along {} of {} states frequencies lie outside of band {}: [{:.4g}, "
          "{:.4g}]",
          std::max(over.size(), down.size()), states, k + 1, bands_[k].low, bands_[k].high);
    }
  }
  // A band from zero is a bound: how much of it is met often is known where all frequencies of the states
  // are, and of a single band where the highest are.
  const bool are_known = along.are_complete || declared.size() == 1;
  for (std::size_t k = 0; k < declared.size() && are_known; ++k) {
    if (declared[k].low > 0.0 || often_[k].high > declared[k].high) continue;
    of_states inside;
    for (std::size_t state = 0; state < typical; ++state) {
      double highest = 0.0;
      for (const double omega : along.of_state[state]) {
        if (omega <= declared[k].high) highest = std::max(highest, omega);
      }
      if (highest > 0.0) inside.push_back(highest);
    }
    const double often = exceeded_often(inside, typical) * (1.0 + margin);
    if (often > 0.0) often_[k].high = std::min(often_[k].high, often);
  }
  if (all.under_all.empty()) return;
  bands_.push_back({0.0, std::ranges::max(all.under_all) * (1.0 + margin)});
  description_ += fmt::format("; along {} of {} states there are frequencies in 0..{:.4g}",
                              all.under_all.size(), states, bands_.back().high);
  const double often = exceeded_often(of_typical.under_all, typical);
  if (often > 0.0) often_.push_back({0.0, often * (1.0 + margin)});
}

void detail::stability_guard::add_mode(double omega) {
  const auto is_near = [&](double other) { return std::abs(omega - other) <= 1e-9 * other; };
  if (std::none_of(modes_.begin(), modes_.end(), is_near)) modes_.push_back(omega);
}

void detail::stability_guard::watch_modes(const std::vector<double>& frequencies, double highest) {
  all_modes_ = frequencies;
  for (const double omega : all_modes_) add_mode(omega);
  stiffest_soft_ = highest * (1.0 + margin);
  description_ +=
      fmt::format("; {} modes under soft forces of frequencies up to {:.4g}", modes_.size(), stiffest_soft_);
}

std::string detail::stability_guard::unstable(const nysalt::word& word,
                                              const std::vector<double>& coefficients, double step,
                                              met which) const {
  // trace/2 = cosh(rate): over the steps the growth is less than e where the excess is below this.
  const double excess = 0.5 / (static_cast<double>(steps_) * static_cast<double>(steps_));
  for (const auto& band : frequencies(which)) {
    const double low = step * band.low;
    const double high = step * band.high;
    const auto trace = detail::half_trace(word, coefficients, 0.0, low * low, high * high);
    if (const auto x = detail::where_larger(trace, 1.0 + excess)) {
      return fmt::format(
          "it is not linearly stable at z = {:.4g}, on the frequencies {:.4g} to {:.4g} of the system",
          std::sqrt(*x), band.low, band.high);
    }
  }
  return {};
}

std::string detail::stability_guard::magnified(const nysalt::word& word,
                                               const std::vector<double>& coefficients, double step) const {
  const auto worst = most_magnified(word, coefficients, step, too_much);
  if (worst.factor <= too_much) return {};
  return fmt::format(
      "in {} steps it magnifies the mode of frequency {:.4g}, z = {:.4g}, {} under soft forces", steps_,
      worst.frequency, step * worst.frequency,
      std::isfinite(worst.factor) ? fmt::format("{:.3g}-fold", worst.factor) : "without bound");
}

std::string detail::stability_guard::resonant(const nysalt::word& word,
                                              const std::vector<double>& coefficients, double step) const {
  const auto worst = most_resonant(word, coefficients, step);
  if (!(worst.growth > std::log(too_much))) return {};
  const double turns = step * (worst.first + worst.second) / (2.0 * std::numbers::pi);
  return fmt::format(
      "the modes of frequencies {:.4g} and {:.4g}, which soft forces couple, grow by the factor "
      "exp({:.3g}) "
      "in {} steps: h (omega_1 + omega_2) = {:.4g} 2 pi is near a resonance",
      worst.first, worst.second, worst.growth, steps_, turns);
}

// What a guard has against a word at a step.

detail::stability_guard::stability_guard(const model& system, const phase_points& states,
                                         const nysalt::word& word, std::int64_t steps, std::size_t typical)
    : detail::stability_guard(system, states, word.rotates(), steps, typical) {
  if (!word.has_own_letters()) return;
  const auto parts = std::make_shared<const detail::word_on_parts>(system, states, word);
  if (parts->is_known()) {
    parts_ = parts;
    description_ = fmt::format("linearised motion of {} along {} states", word.letters(), parts->states());
  } else {
    description_ = fmt::format("trial runs only: the linearised motion of {} was not analysed, as {}",
                               word.letters(), parts->why_not());
  }
}

void detail::stability_guard::watch_rotations(const model& system, const phase_points& states) {
  const auto part = detail::modal_coordinates::of(system);
  watch_modes(part->frequencies(), hessian_spectrum(system, states, field::soft).highest_frequency());
  const Eigen::Index n = size(system);
  if (n > detail::most_for_all_frequencies) {
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
  detail::force_jacobian jacobian(system, states, field::soft);
  for (const auto& state : states) {
    // Evenly spread: the k-th of those that are examined is the state count * k / enough.
    const bool is_examined = number * enough / count != (number + 1) * enough / count;
    ++number;
    if (count > enough && !is_examined) continue;
    const Eigen::MatrixXd root = detail::kinetic_factor(system, state.p);
    const Eigen::MatrixXd soft = root * jacobian.potential_hessian(state.q) * root;
    soft_.push_back(modes.basis.transpose() * soft * modes.basis);
    mean_soft_ += soft_.back();
  }
  mean_soft_ /= static_cast<double>(soft_.size());
}

bool detail::stability_guard::admits(const nysalt::word& word, const std::vector<double>& coefficients,
                                     double step, met which) const {
  return objection(word, coefficients, step, which).empty();
}

std::string detail::stability_guard::objection(const nysalt::word& word,
                                               const std::vector<double>& coefficients, double step,
                                               met which) const {
  word.require_one_for_each_slot(coefficients);
  if (word.has_own_letters()) {
    if (!parts_) return {};
    if (word.letters() != parts_->word()) {
      throw std::invalid_argument(fmt::format(
          "stability_guard: word must be {}, for which the guard was made, got {}; make a guard for "
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
std::string shown_by(const detail::symplectic_spectrum& spectrum) {
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

std::string detail::stability_guard::grown_on_parts(const std::vector<double>& coefficients,
                                                    double step) const {
  const auto growth = parts_->growth(coefficients, step, steps_);
  if (growth.is_refused()) {
    const std::string how_much =
        std::isfinite(growth.late) ? fmt::format("by the factor {:.3g}", 1.0 + growth.late) : "without bound";
    return fmt::format("the linearised motion gains energy {} in {} steps: {}", how_much, steps_,
                       shown_by(detail::spectrum_of(parts_->step(coefficients, step, growth.state))));
  }
  // A perturbation that turns an eigenvalue by less than a radian in all steps may move two off the circle.
  // Two slow modes, or one and its conjugate, are of opposite signature and on either side of +1, without any
  // resonance: they are farther apart than one of them turns at least.
  if (parts_->has_mean()) {
    const auto spectrum = detail::spectrum_of(parts_->step(coefficients, step, parts_->states()));
    const double too_near = std::min(2.0 / static_cast<double>(steps_), detail::word_on_parts::least_turn);
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

std::vector<stability_window> detail::stability_guard::gaps(const nysalt::word& word,
                                                            const std::vector<double>& coefficients,
                                                            double step) const {
  if (word.rotates() || word.has_own_letters()) return {};
  return detail::gaps_below(stability_windows(conservative_part(word), conservative_part(word, coefficients)),
                            step * highest_frequency(bands_));
}

detail::stability_guard::magnified_mode detail::stability_guard::most_magnified(
    const nysalt::word& word, const std::vector<double>& coefficients, double step, double enough) const {
  constexpr int samples = 64;  // a narrower gap is passed before it does harm, as soft forces change
  magnified_mode worst{0.0, 1.0};
  for (const double omega : modes_) {
    for (int i = 1; i <= samples && stiffest_soft_ > 0.0; ++i) {
      const double soft = step * stiffest_soft_ * i / samples;
      const double grown = detail::transient_growth(word, coefficients, step * omega, soft * soft, steps_);
      if (!(grown <= worst.factor)) worst = {omega, grown};
      if (!(worst.factor <= enough)) return worst;
    }
  }
  return worst;
}

detail::stability_guard::resonant_pair detail::stability_guard::most_resonant(
    const nysalt::word& word, const std::vector<double>& coefficients, double step) const {
  resonant_pair worst{0.0, 0.0, 0.0};
  const auto growth_at = [&](const Eigen::MatrixXd& soft, Eigen::Index i, Eigen::Index j) {
    const Eigen::Array2d theta(step * all_modes_[static_cast<std::size_t>(i)],
                               step * all_modes_[static_cast<std::size_t>(j)]);
    const Eigen::Matrix2d k{{soft(i, i), soft(i, j)}, {soft(j, i), soft(j, j)}};
    return detail::growth_of_pair(word, coefficients, theta, step * step * k);
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
