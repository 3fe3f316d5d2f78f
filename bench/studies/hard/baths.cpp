// SPDX-License-Identifier: BSL-1.0
// No friction, huge friction, no temperature.
#include <fmt/format.h>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/textbook.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

using oscillator_in_bath = in_bath<harmonic_oscillator>;

phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

phase_point<double, 1> finish(const auto& stepper, const phase_point<double, 1>& start, std::int64_t steps) {
  auto run = stepper.open(start);
  stepper.advance(run, steps);
  return stepper.synchronous(run);
}

verdict idle(extent how) {
  const harmonic_oscillator alone(1.3);
  const std::int64_t steps = how == extent::quick ? 10'000 : 1'000'000;
  const oscillator_in_bath none(alone, bath::of_sigma(0.0, 0.0));
  const oscillator_in_bath barely(alone, bath::of_sigma(1e-12, 0.0));
  int equal = 0;
  int all = 0;
  int differs = 0;
  for (const auto& method : classical_words()) {
    const auto placed = thermostat(method, placement::symmetric);
    const auto expected = finish(make_stepper(alone, method, 0.3), at(1.0, 0.5), steps);
    const auto got = finish(make_stepper(none, placed, 0.3), at(1.0, 0.5), steps);
    const auto other = finish(make_stepper(barely, placed, 0.3), at(1.0, 0.5), steps);
    ++all;
    equal += got.q == expected.q && got.p == expected.p;
    differs += other.q != expected.q;
  }
  verdict result;
  result.require(equal == all, fmt::format("{} of {} methods: the bits of the system alone after {} steps",
                                           equal, all, steps));
  result.require(differs == all, fmt::format("a friction of 1e-12 changes them in {} of {}", differs, all));
  return result;
}

struct moments {
  double variance_p = 0.0;
  double variance_q = 0.0;
  double lag_p = 0.0;  // correlation of p with that of the step before
};

/// kT = 1, obabo: its last letter is O.
moments moments_at(double friction, double z, std::int64_t steps) {
  const oscillator_in_bath system(harmonic_oscillator(1.0), bath::of_temperature(friction / z, 1.0));
  const auto stepper = make_stepper(system, obabo{}, z, counter_noise(7));
  auto run = stepper.open(at(0.0, 0.0));
  stepper.advance(run, 100);  // forgets where it began: q does so by 1 - z^2/2 a step
  moments sums;
  double before = stepper.synchronous(run).p[0];
  stepper.advance(run, steps, 1, [&](std::int64_t, const auto& x) {
    sums.variance_p += x.p[0] * x.p[0];
    sums.variance_q += x.q[0] * x.q[0];
    sums.lag_p += x.p[0] * before;
    before = x.p[0];
  });
  const auto n = static_cast<double>(steps);
  return {sums.variance_p / n, sums.variance_q / n, sums.lag_p / sums.variance_p};
}

verdict huge_friction(extent how) {
  const std::int64_t steps = how == extent::quick ? 100'000 : 10'000'000;
  const auto n = static_cast<double>(steps);
  const double z = 1.0;
  const moments fresh = moments_at(1e3, z, steps);
  verdict result;
  // A variance of n independent normal numbers has the standard error sqrt(2/n), a correlation 1/sqrt n; four
  // of them are exceeded once in 16,000.
  const double of_variance = std::sqrt(2.0 / n);
  result.require(std::abs(fresh.variance_p - 1.0) <= 4.0 * of_variance,
                 fmt::format("gamma h = 1000: the momenta have the variance {:.5f} kT, expected 1 +- {:.5f}",
                             fresh.variance_p, of_variance));
  result.require(std::abs(fresh.lag_p) <= 4.0 / std::sqrt(n),
                 fmt::format("their correlation from step to step is {:.5f}, expected 0 +- {:.5f}",
                             fresh.lag_p, 1.0 / std::sqrt(n)));
  // With fresh momenta q <- (1 - z^2/2) q + h p: of variance kT/(omega^2 (1 - z^2/4)), and q^2 forgets itself
  // as the square of 1 - z^2/2 = 1/2 does.
  const double expected = 1.0 / (1.0 - 0.25 * z * z);
  const double left = (1.0 - 0.5 * z * z) * (1.0 - 0.5 * z * z);
  const double of_q = expected * std::sqrt(2.0 / n * (1.0 + left) / (1.0 - left));
  result.require(
      std::abs(fresh.variance_q - expected) <= 4.0 * of_q,
      fmt::format("q diffuses as Verlet with fresh momenta does: variance {:.5f}, expected {:.5f} +- {:.5f}",
                  fresh.variance_q, expected, of_q));
  const moments remembered = moments_at(1.0, z, steps);
  result.require(std::abs(remembered.lag_p) > 4.0 / std::sqrt(n),
                 fmt::format("gamma h = 1: the correlation {:.3f} is seen", remembered.lag_p));
  return result;
}

/// q'' = -omega^2 q - gamma q', exactly, for gamma < 2 omega.
phase_point<double, 1> damped(double omega, double gamma, double t) {
  const double nu = std::sqrt(omega * omega - 0.25 * gamma * gamma);
  const double c = std::cos(nu * t);
  const double s = std::sin(nu * t) / nu;
  const double e = std::exp(-0.5 * gamma * t);
  return at(e * (c + 0.5 * gamma * s), -e * omega * omega * s);
}

verdict no_temperature(extent how) {
  const double omega = 1.0;
  const double time = 8.0;
  verdict result;
  std::vector<curve> curves;
  for (const double gamma : {0.2, 1.0}) {
    const oscillator_in_bath system(harmonic_oscillator(omega), bath::of_sigma(gamma, 0.0));
    const auto exact = damped(omega, gamma, time);
    const auto order_of = [&](const method& method, std::string label) {
      curve errors{.label = fmt::format("{}, gamma = {}", label, gamma), .x = {}, .y = {}};
      const int finest = how == extent::quick ? 8 : 11;
      for (int k = 4; k <= finest; ++k) {
        const double step = time * std::pow(0.5, k);
        const auto x = finish(make_stepper(system, method, step), at(1.0, 0.0), std::llround(time / step));
        errors.x.push_back(step);
        errors.y.push_back(std::hypot(x.q[0] - exact.q[0], x.p[0] - exact.p[0]));
      }
      const double order = std::log2(errors.y[errors.y.size() - 2] / errors.y.back());
      curves.push_back(errors);
      return order;
    };
    // A method of order r errs by c h^r (1 + O(h)): with h omega < 1/30 the slope is r to a tenth.
    const double of_baoab = order_of(baoab{}, "baoab");
    const double of_fourth = order_of(thermostat(srkn6b{}, placement::symmetric), "srkn6b_symmetric");
    const double of_end = order_of(thermostat(verlet{}, placement::end), "verlet_end");
    result.require(
        std::abs(of_baoab - 2.0) < 0.1 && std::abs(of_fourth - 2.0) < 0.1,
        fmt::format(
            "gamma = {}: baoab reaches the exact damped oscillation with the order {:.2f}, srkn6b between "
            "two halves of the bath with {:.2f}",
            gamma, of_baoab, of_fourth));
    result.require(std::abs(of_end - 1.0) < 0.1,
                   fmt::format("O at the end has the order {:.2f} only", of_end));
  }
  result.show(
      {{.title = "T = 0: the damped oscillator at t = 8",
        .x_label = "step",
        .y_label = "error of the state",
        .log_log = true,
        .curves = std::move(curves)}},
      "Damping alone: the splitting between bath and motion has order 2 at most, whatever the method.");
  return result;
}

}  // namespace

topic baths() {
  return {"Baths of no and of huge friction",
          {{"no_friction", "gamma = 0 and sigma = 0, every classical method with letters O about it.",
            "The bits of the system alone.", "A friction of 1e-12 changes bits.", idle},
           {"huge_friction", "gamma h = 1000, obabo on an oscillator, z = 1.",
            "Momenta are fresh Maxwell draws: variance kT and no memory, within four standard errors; q has "
            "the variance "
            "of Verlet with fresh momenta.",
            "At gamma h = 1 the memory is seen.", huge_friction},
           {"no_temperature", "T = 0: a damped oscillator.",
            "It converges to the exact solution with the order 2 of a symmetric placement.",
            "Letters O at the end have order 1.", no_temperature}}};
}

}  // namespace nysalt::hard
