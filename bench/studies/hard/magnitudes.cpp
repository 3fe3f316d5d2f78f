// SPDX-License-Identifier: BSL-1.0
// Numbers near the ends of the doubles, and systems of one coordinate and of a million.
#include <fmt/format.h>

#include <chrono>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/phi4.hpp"
#include "nysalt/systems/textbook.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

phase_point<double, 1> scaled(int exponent) {
  return {vector<double, 1>(std::ldexp(1.1, exponent)), vector<double, 1>(std::ldexp(0.7, exponent))};
}

verdict scales(extent how) {
  const harmonic_oscillator system(1.3);
  const std::int64_t steps = how == extent::quick ? 10'000 : 1'000'000;
  const double step = 0.3;
  verdict result;
  std::vector<std::string> not_exact;
  double worst_quanta = 0.0;
  const auto finish_from = [&](const method& method, const phase_point<double, 1>& start) {
    const auto stepper = make_stepper(system, method, step);
    auto run = stepper.open(start);
    stepper.advance(run, steps);
    return stepper.synchronous(run);
  };
  const auto finish = [&](const nysalt::method& method, int exponent) {
    return finish_from(method, scaled(exponent));
  };
  const auto methods = classical_words();
  int other_bits = 0;
  bool subnormal_is_right = true;
  for (const auto& method : methods) {
    const auto one = finish(method, 0);
    const auto tripled = finish_from(method, {3.0 * scaled(0).q, 3.0 * scaled(0).p});
    other_bits += tripled.q[0] != 3.0 * one.q[0] || tripled.p[0] != 3.0 * one.p[0];
    for (const int exponent : {-900, -500, 500, 900}) {
      const auto x = finish(method, exponent);
      if (x.q[0] == std::ldexp(one.q[0], exponent) && x.p[0] == std::ldexp(one.p[0], exponent)) continue;
      not_exact.push_back(fmt::format("{} at 2^{}", method.name(), exponent));
    }
    // About 1e-310 = 2^-1030 a sum or product is off by half a quantum 2^-1074, twice a letter, and the
    // motion magnifies it by 10 at most.
    const int tiny = -1030;
    const auto x = finish(method, tiny);
    const double quanta =
        std::ldexp(std::abs(x.q[0] - std::ldexp(one.q[0], tiny)), 1000) * std::ldexp(1.0, 74);
    const double allowed = static_cast<double>(steps) * static_cast<double>(method.letters().length) * 10.0;
    worst_quanta = std::max(worst_quanta, quanta / allowed);
    subnormal_is_right = subnormal_is_right && quanta <= allowed;
  }
  result.require(not_exact.empty(),
                 fmt::format("{} methods, {} steps from states of the sizes 2^-900, 2^-500, 2^500 and 2^900: "
                             "the bits of those of size "
                             "1, scaled{}",
                             methods.size(), steps,
                             not_exact.empty() ? "" : fmt::format("; but not {}", not_exact.front())));
  result.require(
      other_bits == std::ssize(methods),
      fmt::format("three times the state has other bits, in {} of {}", other_bits, methods.size()));
  result.require(
      subnormal_is_right,
      fmt::format("subnormal states, 2^-1030 = 1e-310: right to {:.2g} of what their quantum 2^-1074 allows",
                  worst_quanta));
  return result;
}

verdict overflow(extent) {
  const harmonic_oscillator system(1.0);
  const auto diverged_at = [&](double size, double step) {
    const phase_point<double, 1> start{vector<double, 1>(size), vector<double, 1>(0.0)};
    return integrate(system, verlet{}, step, start, 2'000).diverged_at;
  };
  const auto sound = diverged_at(1e150, 0.5);
  const auto unstable = diverged_at(1e150, 2.1);
  const auto of_energy = diverged_at(1e300, 0.5);
  verdict result;
  result.require(!sound, "states of 1e150, with energies of 1e300, are followed like any other");
  result.require(unstable.has_value(),
                 fmt::format("beyond the window they are reported at step {}", unstable.value_or(-1)));
  result.require(of_energy == 1, "states of 1e300 have an energy that overflows: reported at step 1");

  const fpu_chain<> chain(2, 1.0);
  const phase_point<double, Eigen::Dynamic> far{Eigen::VectorXd::Constant(4, 1e120),
                                                Eigen::VectorXd::Zero(4)};
  const auto quartic = integrate(chain, verlet{}, 0.1, far, 100).diverged_at;
  result.require(quartic == 1, "a quartic spring at 1e120, whose force overflows: reported at step 1");
  return result;
}

verdict a_million(extent how) {
  const Eigen::Index pairs = 500'000;
  const std::int64_t steps = how == extent::quick ? 20 : 400;
  const double omega = 50.0;
  const double h = 0.01;
  const fpu_chain<> by_type(pairs, omega);
  const model chain(by_type);
  verdict result;

  const auto start = fpu_law<Eigen::Dynamic>(by_type)(1, 0);

  // A step carries news over one bond: the middle moves as it does in a chain that is cut so far away that
  // the news of its ends do not arrive.
  const Eigen::Index middle = pairs / 2;
  const auto whole = integrate(chain, verlet{}, h, start, steps).finish;
  const auto equal_pairs = [&](Eigen::Index half) {
    const fpu_chain<> cut(2 * half, omega);
    const phase_point<double, Eigen::Dynamic> cut_start{start.q.segment(2 * (middle - half), 4 * half),
                                                        start.p.segment(2 * (middle - half), 4 * half)};
    const auto x = integrate(cut, verlet{}, h, cut_start, steps).finish;
    int equal = 0;
    for (Eigen::Index k = -5; k < 5; ++k) {
      equal += whole.q[2 * (middle + k)] == x.q[2 * (half + k)] &&
               whole.q[2 * (middle + k) + 1] == x.q[2 * (half + k) + 1];
    }
    return equal;
  };
  const int far = equal_pairs(steps + 5);
  result.require(far == 10, fmt::format("10^6 masses, {} steps: the ten pairs in the middle have the bits "
                                        "that they have in the middle of {}",
                                        steps, 2 * (steps + 5)));
  const int near = equal_pairs(5);
  result.require(near < 10, fmt::format("cut right beside them, {} of the ten have other bits", 10 - near));

  const auto begin = std::chrono::steady_clock::now();
  const auto story = follow(chain, verlet{}, h, start, steps, "", false, 10);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  // The stiff springs' share varies by z^2/4/(1 - z^2/4) of itself at most, and the soft ones' by less.
  const double z = h * omega;
  const double bound = 0.25 * z * z / (1.0 - 0.25 * z * z);
  result.require(
      !story.diverged_at && story.largest <= bound,
      fmt::format("all 10^6 masses in motion, {} steps: energy error {:.1e}, Verlet's bound {:.1e}", steps,
                  story.largest, bound));
  if (how == extent::full)
    result.note(fmt::format("{:.1f} ns a mass and step, looks included",
                            1e9 * seconds.count() / static_cast<double>(steps) / 1e6));

  const phi4_chain<1> fixed;
  const phi4_chain<> dynamic(1);
  const auto small =
      integrate(fixed, srkn6b{}, 0.1, {vector<double, 1>(1.0), vector<double, 1>(0.5)}, 1000).finish;
  const auto same = integrate(dynamic, srkn6b{}, 0.1,
                              {Eigen::VectorXd::Constant(1, 1.0), Eigen::VectorXd::Constant(1, 0.5)}, 1000)
                        .finish;
  result.require(small.q[0] == same.q[0] && small.p[0] == same.p[0],
                 "one degree of freedom, fixed or dynamic: the same bits after 1000 steps");
  return result;
}

}  // namespace

topic magnitudes() {
  return {
      "Tiny, huge and many numbers",
      {{"scales", "An oscillator in states from 1e-310 to 1e270.",
        "Scaled by a power of two, a trajectory has scaled bits; subnormal ones are right to their quantum.",
        "Scaled by three, bits are others.", scales},
       {"overflow", "States whose energy or force overflows.",
        "Reported as diverged at the step where it does.",
        "At 1e150 nothing overflows, and nothing is reported.", overflow},
       {"sizes", "One coordinate, and a million masses.",
        "Bits do not depend on how long the chain is, or on whether its size is known when it is compiled; "
        "the energy "
        "error keeps Verlet's bound.",
        "A chain so short that its ends are felt has other bits.", a_million}}};
}

}  // namespace nysalt::hard
