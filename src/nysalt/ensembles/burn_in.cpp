// SPDX-License-Identifier: BSL-1.0

#include "burn_in.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace nysalt {

burn_in_report::discrepancy mean_over_chains(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  double mean = 0.0;
  double squares = 0.0;
  for (const double value : x) mean += value / n;
  for (const double value : x) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1.0) / n)};
}

burn_in_report::discrepancy watched_interval::potential_of_the_far() const {
  std::vector<double> sorted = way_to_begin;
  const auto middle = sorted.begin() + std::ssize(sorted) / 2;
  std::ranges::nth_element(sorted, middle);
  std::vector<double> near;
  std::vector<double> far;
  const auto& potential = mean[static_cast<std::size_t>(burn_in_report::watched::potential)];
  for (std::size_t k = 0; k < potential.size(); ++k)
    (way_to_begin[k] < *middle ? near : far).push_back(potential[k]);
  if (near.size() < 2) return {};  // all have gone as far
  const burn_in_report::discrepancy a = mean_over_chains(far);
  const burn_in_report::discrepancy b = mean_over_chains(near);
  return {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error)};
}

double watched_interval::share_without_force() const {
  const auto chains = static_cast<double>(force_square.size());
  const Eigen::Index coordinates = force_square.empty() ? 0 : force_square.front().size();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    double mean = 0.0;
    for (const auto& of_chain : force_square) mean += of_chain[i] / chains;
    if (!(mean > 0.0)) continue;
    constexpr double tail = 1e-4;  // a hundredth of the forces, as those of exp(q) fall off without an end
    const auto is_free = [&](const Eigen::VectorXd& of_chain) { return of_chain[i] <= tail * mean; };
    largest = std::max(largest, static_cast<double>(std::ranges::count_if(force_square, is_free)) / chains);
  }
  return largest;
}

bool watched_interval::is_cooling() const {
  const auto is_above = [](const burn_in_report::discrepancy& one) {
    return !(one.mean <= 0.0) && one.shows();
  };
  for (const burn_in_report::watched what :
       {burn_in_report::watched::kinetic, burn_in_report::watched::virial}) {
    const auto i = static_cast<std::size_t>(what);
    if (!counts(i)) continue;
    std::vector<double> over_bath = mean[i];
    std::vector<double> fall = begin[i];
    for (std::size_t k = 0; k < fall.size(); ++k) {
      over_bath[k] -= 1.0;
      fall[k] -= mean[i][k];
    }
    if (is_above(mean_over_chains(over_bath)) && is_above(mean_over_chains(fall))) return true;
  }
  return false;
}

double watched_interval::largest_at_begin() const {
  double largest = 0.0;
  for (const burn_in_report::watched what :
       {burn_in_report::watched::virial, burn_in_report::watched::potential}) {
    for (const double one : begin[static_cast<std::size_t>(what)]) largest = std::max(largest, std::abs(one));
  }
  return largest;
}

double watched_interval::tau() const {
  double longest = 0.0;
  for (std::size_t i = 0; i < detail::watched_numbers; ++i) {
    if (!counts(i)) continue;
    const auto n = static_cast<double>(mean[i].size());
    const burn_in_report::discrepancy all = mean_over_chains(mean[i]);
    const double variance = mean_over_chains(square[i]).mean - all.mean * all.mean;
    const double of_means = all.standard_error * all.standard_error * n;
    if (variance > 0.0) longest = std::max(longest, duration * of_means / variance);
  }
  return longest;
}

void detail::require_burn_in(const burn_in_options& options) {
  const auto sound = [](const char* what, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(fmt::format(
        "gibbs: the {} of the burn-in must be finite and positive, or 0 to be found, got {}", what, value));
  };
  sound("friction", options.friction);
  sound("step", options.step);
  sound("length", options.length);
  if (options.pilots >= 16 && options.pilots <= 100'000 && options.most_steps >= 1) return;
  throw std::invalid_argument(
      fmt::format("gibbs: pilots must be 16 to 100000 and most_steps >= 1, got {} and {}", options.pilots,
                  options.most_steps));
}

void detail::refuse_escape(const watched_interval& later, const model& system) {
  const auto& virials = later.square[static_cast<std::size_t>(burn_in_report::watched::virial)];
  if (std::ranges::all_of(virials, [](double one) { return one == 0.0; })) {
    throw std::runtime_error(fmt::format(
        "gibbs: the motion of {} must be confined, got chains that have all left and meet no force",
        describe(system)));
  }
  // Half-way between the 1/2 of a half-line and the 0 of what repeats itself.
  if (const double free = later.share_without_force(); free > 0.25) {
    throw std::runtime_error(fmt::format(
        "gibbs: the motion of {} must be confined, or its potential the same wherever it goes, got {:.0f} % "
        "of the chains that have left and meet no force along a coordinate",
        describe(system), 100.0 * free));
  }
  const burn_in_report::discrepancy potential = later.potential_of_the_far();
  if (!potential.shows()) return;
  throw std::runtime_error(fmt::format(
      "gibbs: the motion of {} must be confined, or its potential the same wherever it goes, got chains that "
      "leave: the "
      "potential energy of the half that went farther is larger by {:.3g} +- {:.3g} kT for each coordinate",
      describe(system), potential.mean, potential.standard_error));
}

void detail::refuse_discrepancy(const burn_in_report::discrepancy& found, std::size_t i, const char* what,
                                const burn_in_report& report) {
  if (!found.shows()) return;
  throw std::runtime_error(
      fmt::format("gibbs: after a burn-in of {:.6g} the {} must {}, got a difference of {:.3g} +- {:.3g} kT; "
                  "burn in for longer",
                  report.length, detail::watched_names[i], what, found.mean, found.standard_error));
}

}  // namespace nysalt
