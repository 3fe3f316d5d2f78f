// SPDX-License-Identifier: BSL-1.0
// Burn-in of chains: length, friction and step with which they forget their starts.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "burn_in_pilot.hpp"
#include "highest_frequency.hpp"
#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "slowest_mode.hpp"
#include "step_of_motion.hpp"

namespace nysalt {

namespace detail {

/// Throws std::invalid_argument if an option is out of range.
void require_burn_in(const burn_in_options& options);
/// Throws std::runtime_error where the potential of chains that have gone far is another than that of the
/// others, or no chain met a force.
void refuse_escape(const watched_interval& later, const model& system);
/// Throws std::runtime_error where a discrepancy of number i shows; `what` says what it is.
void refuse_discrepancy(const discrepancy& found, std::size_t i, const char* what,
                        const burn_in_report& report);

}  // namespace detail

/// The search for a burn-in.
template <class T>
class burn_in_search {
 public:
  /// Of chains that start at states of `from`, of a system that comes without its bath; refers to both.
  /// Throws std::invalid_argument if an option is out of range.
  burn_in_search(const model& base, double temperature, const initial_states& from,
                 const burn_in_options& options)
      : base_(&base), temperature_(temperature), from_(&from), options_(options) {
    detail::require_burn_in(options);
    slowest_ = slowest_mode(base);
  }

  /// Throws std::runtime_error where a chain diverges, nothing becomes stationary, or a check fails.
  burn_in_report find() {
    const auto began = std::chrono::steady_clock::now();
    burn_in_report report;
    report.step =
        options_.step > 0.0 ? options_.step : step_of_motion(*base_, *from_, temperature_, 0.5, "gibbs");
    while (!settle(report)) {
      report.step *= 0.5;
      ++report.halvings;
    }
    const double length = options_.length > 0.0 ? options_.length : times_of_tau() * report.tau;
    report.steps = std::max<std::int64_t>(1, std::llround(std::ceil(length / report.step)));
    report.length = static_cast<double>(report.steps) * report.step;
    check(report);
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return report;
  }

 private:
  static constexpr int most_biased = 6;  // halvings because of a bias

  /// Over tau energies fall to a part 1/e^2 of what the starts had above those of the bath: the starts of a
  /// bath that is 10^4 times colder and more take longer.
  double times_of_tau() const {
    constexpr double most = std::numeric_limits<double>::max();
    return std::max(20.0, 10.0 + std::log(std::clamp(hottest_, 1.0, most)));
  }

  burn_in_pilot<T> pilot(double friction, double step, int count) {
    // Far from the numbers of chains that anybody uses, and from those of other pilots.
    const std::int64_t noise = (std::int64_t{1} << 47) + (pilots_++ << 24);
    return {*base_, *from_, temperature_, friction, step, options_, count, noise, slowest_};
  }

  /// Chains that are watched for 32 times what they remember, after as long a time unwatched; nothing where
  /// that would take longer than `most`.
  std::optional<watched_interval> stationary(double friction, double step, int count, double most) {
    constexpr std::int64_t observations = 256;
    auto chains = pilot(friction, step, count);
    hottest_ = std::max(hottest_, chains.watch(observations, observations).largest_at_begin());
    for (std::int64_t every = 1; 2 * every * observations <= options_.most_steps; every *= 2) {
      const auto interval = chains.watch(2 * every * observations, every);
      if (interval.duration >= 32.0 * interval.tau() && !interval.is_cooling()) return interval;
      if (interval.duration > 32.0 * most) return std::nullopt;
    }
    throw std::runtime_error(
        sentence("gibbs: {} must become stationary within {} steps of {} with the friction {}; give another "
                 "friction or more steps",
                 describe(*base_), options_.most_steps, in_digits(step, 6), in_digits(friction, 6)));
  }

  /// The friction with the least tau, of omega/4, omega/16, ... with the highest frequency omega: strong
  /// friction makes slow motion creep, weak friction leaves energies what they were.
  double best_friction(double step) {
    const double omega = highest_frequency(*base_).value_or(0.5 / step);
    double best = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0 / 256}) {
      const auto interval = stationary(part * omega, step, std::min(64, options_.pilots), least);
      if (!interval || interval->tau() >= least) continue;
      best = part * omega;
      least = interval->tau();
    }
    return best;
  }

  /// Whether the step shows no bias against half of it. A step at which chains diverge is too large as well.
  bool settle(burn_in_report& report) {
    constexpr double forever = std::numeric_limits<double>::infinity();
    try {
      report.friction = options_.friction > 0.0 ? options_.friction : best_friction(report.step);
      const auto coarse = *stationary(report.friction, report.step, options_.pilots, forever);
      const auto fine = *stationary(report.friction, 0.5 * report.step, options_.pilots, forever);
      report.tau = std::max(coarse.tau(), fine.tau());
      report.confined = coarse.confined() && fine.confined();
      bool sound = true;
      for (std::size_t i = 0; i < watched_numbers; ++i) {
        const discrepancy a = mean_over_chains(coarse.mean[i]);
        const discrepancy b = mean_over_chains(fine.mean[i]);
        report.bias[i] = {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error)};
        if (i == static_cast<std::size_t>(watched::potential))
          report.bias[i].mean +=
              (coarse.zero - fine.zero) / (temperature_ * static_cast<double>(size(*base_)));
        // The momenta of the chains are not used.
        if (i != static_cast<std::size_t>(watched::kinetic) && counts(report, i))
          sound = sound && !report.bias[i].shows();
      }
      if (sound) return true;
    } catch (const chain_diverged& one) {
      // Starts may be much colder than the bath, and their frequency much too low: then chains diverge at
      // once, and halving costs little. A motion that is not confined takes its time, however small the step.
      constexpr std::int64_t at_once = 10'000;
      constexpr int most_halvings = 60;
      if (one.step > at_once || report.halvings == most_halvings) throw;
      return false;
    }
    if (biased_++ < most_biased) return false;
    throw std::runtime_error(
        sentence("gibbs: the step must have no bias that shows, got {}; give a smaller one",
                 in_digits(report.step, 6)));
  }

  static bool counts(const burn_in_report& report, std::size_t i) {
    return i != static_cast<std::size_t>(watched::virial) || report.confined;
  }

  /// Fresh pilots at the end of the burn-in against equipartition, and against themselves later.
  void check(burn_in_report& report) {
    auto chains = pilot(report.friction, report.step, options_.pilots);
    chains.watch(report.steps, report.steps);
    const auto later = chains.watch(2 * report.steps, std::max<std::int64_t>(1, report.steps / 256));
    for (std::size_t i = 0; i < watched_numbers; ++i) {
      std::vector<double> difference = later.begin[i];
      for (std::size_t k = 0; k < difference.size(); ++k) difference[k] -= later.mean[i][k];
      report.to_forget[i] = mean_over_chains(difference);
      if (i < static_cast<std::size_t>(watched::potential)) {
        report.excess[i] = mean_over_chains(later.begin[i]);
        report.excess[i].mean -= 1.0;
      }
      if (!counts(report, i)) continue;
      detail::refuse_discrepancy(report.excess[i], i, "be that of equipartition", report);
      detail::refuse_discrepancy(report.to_forget[i], i, "not change afterwards", report);
    }
    if (!report.confined) detail::refuse_escape(later, *base_);
  }

  const model* base_;
  double temperature_;
  const initial_states* from_;
  burn_in_options options_;
  Eigen::VectorXd slowest_;
  std::int64_t pilots_ = 0;
  int biased_ = 0;        // steps that showed a bias
  double hottest_ = 0.0;  // kT for each coordinate: the highest energy at a start
};

}  // namespace nysalt
