// SPDX-License-Identifier: BSL-1.0
// Steps back in time, very many steps, and very small ones.
#include <fmt/format.h>

#include <chrono>
#include <numbers>

#include "../../../examples/systems/compensated.hpp"
#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/textbook.hpp"
#include "words.hpp"

namespace nysalt::hard {

using namespace examples;

namespace {

const harmonic_oscillator& oscillator() {
  static const harmonic_oscillator system(1.0);
  return system;
}

phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

/// It reads the same from both ends: words of families do so to rounding.
bool is_symmetric(const method& method) {
  const auto c = method.coefficients();
  const auto& letters = method.letters().letters();
  if (!std::equal(letters.begin(), letters.end(), letters.rbegin())) return false;
  if (letters.find('G') != std::string::npos) return true;  // ours are; two slots of one letter
  return std::equal(c.begin(), c.end(), c.rbegin(),
                    [](double a, double b) { return std::abs(a - b) < 1e-14; });
}

double forth_and_back(const method& method, double step, std::int64_t steps) {
  const auto start = at(1.0, 0.3);
  const auto there = integrate(oscillator(), method, step, start, steps).finish;
  const auto back = integrate(oscillator(), method, -step, there, steps).finish;
  return std::hypot(back.q[0] - start.q[0], back.p[0] - start.p[0]);
}

verdict negative_step(extent how) {
  const double z = 0.5;
  const std::int64_t steps = how == extent::quick ? 10'000 : 1'000'000;
  int symmetric = 0;
  int others = 0;
  double worst = 0.0;
  double least = std::numeric_limits<double>::infinity();
  bool returns = true;
  auto all = classical_words();
  for (auto& learned : learned_words()) all.push_back(learned);
  for (const auto& method : all) {
    // Each letter rounds by eps of a coordinate below 2, and what follows does not magnify more than the
    // energy may swing there and the rest of a step: by 10 in all at z = 1/2.
    const double rounding =
        2.0 * static_cast<double>(steps * std::ssize(method.letters().letters())) * 2.2e-16 * 2.0 * 10.0;
    const double off = forth_and_back(method, z, steps);
    if (is_symmetric(method)) {
      ++symmetric;
      worst = std::max(worst, off);
      returns = returns && off <= rounding;
    } else {
      ++others;
      least = std::min(least, off / rounding);
    }
  }
  verdict result;
  result.require(returns,
                 fmt::format("{} symmetric methods: {} steps of 1/2 and as many of -1/2 return to {:.1e}",
                             symmetric, steps, worst));
  result.require(
      others > 0 && least > 1.0,
      fmt::format("{} others do not return: {:.0f} times what rounding allows, and more", others, least));
  return result;
}

using lanes = pack<double>;

/// Sixteen phases of the circle, or so many as there are lanes.
phase_point<lanes, 1> around_the_circle() {
  return detail::gather<lanes, 1>(lanes_in<lanes>, [](int k) {
    const double phase = 2.0 * std::numbers::pi * (k + 0.25) / lanes_in<lanes>;
    return at(std::cos(phase), std::sin(phase));
  });
}

/// What Verlet conserves but for rounding: p^2 + omega^2 q^2 (1 - h^2 omega^2/4), here of omega = 1.
long double shadow_energy(const phase_point<double, 1>& x, double h) {
  const long double q = x.q[0];
  const long double p = x.p[0];
  return p * p + q * q * (1.0L - 0.25L * static_cast<long double>(h) * h);
}

struct random_walk {
  curve rms;             // of the relative error of the shadow energy, over the lanes
  double largest = 0.0;  // |H - H_0|/H_0
  double seconds = 0.0;  // a step
};

template <class T>
random_walk walk(double h, std::int64_t steps) {
  const auto stepper = make_stepper(oscillator(), verlet{}, h);
  const auto start = around_the_circle();
  auto run = stepper.open(start.template cast<T>());
  random_walk result;
  std::chrono::duration<double> stepping{0.0};
  for (std::int64_t n = 1'000; n <= steps; n *= 10) {
    const auto begin = std::chrono::steady_clock::now();
    stepper.advance(run, n - run.step);
    stepping += std::chrono::steady_clock::now() - begin;
    const auto x = stepper.synchronous(run).template cast<lanes>();
    double squares = 0.0;
    for (int k = 0; k < lanes_in<lanes>; ++k) {
      const auto first = lane(start, k);
      const auto now = lane(x, k);
      const auto off = static_cast<double>(shadow_energy(now, h) / shadow_energy(first, h) - 1.0L);
      squares += off * off;
      const double initial = energy<double>(oscillator(), first);
      result.largest = std::max(result.largest, std::abs(energy<double>(oscillator(), now) / initial - 1.0));
    }
    result.rms.x.push_back(static_cast<double>(n));
    result.rms.y.push_back(std::sqrt(squares / lanes_in<lanes>));
  }
  result.seconds = stepping.count() / static_cast<double>(run.step);
  return result;
}

double ulp(double x) { return std::ldexp(1.0, std::ilogb(x) - 52); }

/// Rounding errors are uniform in +-ulp/2, of variance ulp^2/12, and independent; an error dq changes the
/// relative energy by 2 q dq, and dp by 2 p dp. A step of Verlet makes two sums, q + h p and p - h q. Plain
/// ones round to the ulp of q and p. Compensated ones round h p and its sum with the carry, and miss h times
/// the carry of the other.
double predicted_rms(double h, bool is_compensated, std::int64_t steps) {
  constexpr int samples = 10'000;
  double variance = 0.0;
  for (int k = 0; k < samples; ++k) {
    const double q = std::cos(2.0 * std::numbers::pi * (k + 0.5) / samples);
    const double p = std::sin(2.0 * std::numbers::pi * (k + 0.5) / samples);
    const auto of_sum = [&](double x, double rate) {
      const double product = ulp(h * rate) * ulp(h * rate);
      if (!is_compensated) return (ulp(x) * ulp(x) + product) / 12.0;
      return (2.0 * product + h * h * ulp(rate) * ulp(rate)) / 12.0;
    };
    variance += 4.0 * (q * q * of_sum(q, p) + p * p * of_sum(p, q)) / samples;
  }
  return std::sqrt(variance * static_cast<double>(steps));
}

curve predicted(double h, bool is_compensated, std::string label, const std::vector<double>& at) {
  curve result{.label = std::move(label), .x = at, .y = {}, .dashed = true};
  for (const double n : at)
    result.y.push_back(predicted_rms(h, is_compensated, static_cast<std::int64_t>(n)));
  return result;
}

verdict many_steps(extent how) {
  const double h = 0.01;
  const std::int64_t steps = how == extent::quick ? 1'000'000 : 1'000'000'000;
  auto plain = walk<lanes>(h, steps);
  auto kept = walk<compensated<lanes>>(h, steps);
  verdict result;
  // p^2 + q^2 (1 - h^2/4) is constant, so that p^2 + q^2 varies by h^2/4 of q^2, and q^2 by 1/(1 - h^2/4).
  const double bound = 0.25 * h * h / (1.0 - 0.25 * h * h) + 1e-10;
  result.require(plain.largest <= bound && kept.largest <= bound,
                 fmt::format("after {:.0e} steps of 0.01 the energy error is {:.2e} and, compensated, "
                             "{:.2e}; Verlet's own is at "
                             "most {:.2e}",
                             static_cast<double>(steps), plain.largest, kept.largest, bound));
  // The root mean square of 16 normal numbers is off by more than a factor of 2 less than once in 1000.
  const auto as_predicted = [&](const random_walk& measured, bool is_compensated, const char* what) {
    const double expected = predicted_rms(h, is_compensated, steps);
    const double ratio = measured.rms.y.back() / expected;
    result.require(ratio > 0.5 && ratio < 2.0,
                   fmt::format("rounding moves the energy by {:.1e} {}, expected {:.1e} = {:.2g} sqrt(n) eps",
                               measured.rms.y.back(), what, expected,
                               expected / std::sqrt(static_cast<double>(steps)) / 2.2e-16));
  };
  as_predicted(plain, false, "with plain sums");
  as_predicted(kept, true, "with compensated ones");
  const double gain = plain.rms.y.back() / kept.rms.y.back();
  result.require(gain > 10.0, fmt::format("compensation gains a factor of {:.0f}", gain));
  if (how == extent::full) {
    result.note(fmt::format(
        "a step of {} trajectories takes {:.2f} ns plain and {:.2f} ns compensated: {:.2f} times as long",
        lanes_in<lanes>, 1e9 * plain.seconds, 1e9 * kept.seconds, kept.seconds / plain.seconds));
  }
  plain.rms.label = "plain";
  kept.rms.label = "compensated<double>";
  kept.rms.emphasised = true;
  result.show({{.title = "Verlet on an oscillator, h omega = 0.01",
                .x_label = "steps",
                .y_label = "what rounding did to the energy, rms",
                .log_log = true,
                .curves = {plain.rms, kept.rms, predicted(h, false, "plain, predicted", plain.rms.x),
                           predicted(h, true, "compensated, predicted", plain.rms.x)}}},
              "Of the quantity that Verlet conserves exactly but for rounding, over 16 trajectories.");
  return result;
}

verdict tiny_step(extent) {
  const double h = 1e-17;
  const std::int64_t steps = 1'000'000;
  const auto stepper = make_stepper(oscillator(), verlet{}, h);
  const auto start = at(1.0, 1.0);
  auto plain = stepper.open(start);
  stepper.advance(plain, steps);
  auto kept = stepper.open(start.cast<compensated<double>>());
  stepper.advance(kept, steps);
  const double t = static_cast<double>(steps) * h;
  const double stuck = stepper.synchronous(plain).q[0];
  const double moved = stepper.synchronous(kept).cast<double>().q[0];
  verdict result;
  result.require(
      std::abs(moved - (std::cos(t) + std::sin(t))) <= 2.3e-16,
      fmt::format("10^6 steps of 1e-17: compensated, q has moved by {:.3e} as it must", moved - 1.0));
  result.require(stuck == 1.0, "with plain sums it has not moved at all");
  return result;
}

}  // namespace

topic long_runs() {
  return {
      "Back in time, very many steps, very small ones",
      {{"negative_step", "Forth, and back with the negative step.", "Symmetric methods return to rounding.",
        "Methods that are not symmetric do not return.", negative_step},
       {"many_steps", "10^9 steps of Verlet on an oscillator, plain and with compensated sums.",
        "The energy error is Verlet's own; rounding adds a random walk of the predicted size, and "
        "compensation makes it "
        "smaller by more than 10.",
        "Plain sums do not reach what compensated ones do.", many_steps},
       {"tiny_step", "Steps so small that q + h p = q.", "With compensated sums the state moves as it must.",
        "With plain ones it does not move.", tiny_step}}};
}

}  // namespace nysalt::hard
