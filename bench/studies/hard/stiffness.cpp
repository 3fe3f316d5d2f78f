// SPDX-License-Identifier: BSL-1.0
// Stiff chains: resonant steps, stiffness beyond measure, and soft springs as strong as the stiff ones.
#include <fmt/format.h>

#include <numbers>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/methods/classical.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

using chain = fpu_chain<3>;

/// Largest |I - I_0|/I_0 of the stiff energy, an adiabatic invariant.
double exchanged(const chain& system, const method& method, double step, const phase_point<double, 6>& start,
                 double time) {
  const double initial = system.stiff_energy(start);
  double largest = 0.0;
  const auto look = [&](std::int64_t, double, const auto& x) {
    largest = std::max(largest, std::abs(system.stiff_energy(x) / initial - 1.0));
  };
  const auto done = integrate(system, method, step, start, std::llround(time / step), look);
  return done.diverged_at ? std::numeric_limits<double>::infinity() : largest;
}

/// How much one stiff mode is magnified at most, if soft springs add k to its stiffness.
double largest_magnification(const method& method, double theta, double h, std::int64_t steps) {
  double largest = 1.0;
  for (const double k : {1.0, 3.0, 10.0, 30.0}) {
    largest = std::max(
        largest, detail::transient_growth(method.letters(), method.coefficients(), theta, h * h * k, steps));
  }
  return largest;
}

verdict resonance(extent how) {
  const double omega = 50.0;
  const chain system(omega);
  const double time = how == extent::quick ? 100.0 : 1000.0;
  verdict result;
  std::vector<panel> panels;
  for (int k = 1; k <= 3; ++k) {
    const double h = k * std::numbers::pi / omega;
    const std::int64_t steps = std::llround(time / h);
    const auto start = fpu_law<3>(system)(1, 0);
    const auto learned = learned_r_aba4_at_resonance(k);
    auto resonant = follow(system, impulse{}, h, start, steps, "impulse");
    auto beside = follow(system, impulse{}, h * (1.0 + 0.15 / k), start, steps, "impulse, 0.15 pi beside");
    auto word = follow(system, learned, h, start, steps, "learned r_aba4", true);
    const double of_word = largest_magnification(learned, k * std::numbers::pi, h, steps);
    const double of_impulse = largest_magnification(impulse{}, k * std::numbers::pi, h, steps);
    result.require(
        word.finite && !word.diverged_at && word.largest <= 0.1 * resonant.largest && of_word <= 1.1,
        fmt::format("h omega = {} pi, learned r_aba4: energy error {:.1e} and {:.1e} in the halves of a time "
                    "of {:.0f}; a "
                    "stiff mode is magnified by {:.2f}",
                    k, word.early, word.late, time, of_word));
    result.require(
        resonant.largest > 1.0 && of_impulse > 10.0,
        fmt::format(
            "impulse: energy error {:.1e}, a stiff mode is magnified by {:.0f}; 0.15 pi beside {:.1e}",
            resonant.largest, of_impulse, beside.largest));
    panels.push_back(
        energy_panel(fmt::format("h omega = {} pi", k),
                     {std::move(resonant.shown), std::move(beside.shown), std::move(word.shown)}));
  }
  result.show(std::move(panels), "The FPU chain of omega = 50 at resonant steps.", 1500);
  return result;
}

/// Plain words at h omega = k pi: what the windows say of the stiff band.
verdict plain_words_at_resonance(extent how) {
  const double omega = 50.0;
  const chain system(omega);
  const double time = how == extent::quick ? 50.0 : 1000.0;
  const auto band = system.frequency_bands().back();
  verdict result;
  auto all = classical_words();
  for (const auto& learned : learned_words()) all.push_back(learned);
  for (int k = 1; k <= 3; ++k) {
    const double h = k * std::numbers::pi / omega;
    const auto start = fpu_law<3>(system)(1, 0);
    int stable = 0;
    int unstable = 0;
    int open = 0;
    std::string faults;
    for (const auto& method : all) {
      const auto windows = stability_windows(method);
      const bool all_in = is_stable(windows, h * band.low, h * band.high);
      const bool none_in = std::none_of(windows.begin(), windows.end(), [&](const auto& window) {
        return window.low <= h * band.high && h * band.low <= window.high;
      });
      const auto done = integrate(system, method, h, start, std::llround(time / h));
      stable += all_in;
      unstable += none_in;
      open += !all_in && !none_in;
      const bool wrong = (all_in && done.diverged_at) || (none_in && !done.diverged_at);
      if (wrong) faults += fmt::format(" {}", method.name());
    }
    result.require(faults.empty(),
                   fmt::format("h omega = {} pi: {} methods whose windows hold the stiff band are bounded "
                               "for a time of {:.0f}, {} whose "
                               "windows do not meet it diverge{}; of {} the windows hold a part{}",
                               k, stable, time, unstable, unstable > 0 ? "" : " (none)", open, faults));
  }
  return result;
}

verdict very_stiff(extent how) {
  verdict result;
  const double h = 0.02;
  const double time = how == extent::quick ? 2'000.0 : 10'000.0;
  std::vector<panel> panels;
  for (const double omega : {1e3, 1e4}) {
    const chain system(omega);
    const auto start = fpu_law<3>(system)(1, 0);
    const double of_exact = exchanged(system, srkn11b{}, 0.4 / omega, start, 2e3 / omega);
    const double of_impulse = exchanged(system, impulse{}, h, start, time);
    auto rotated = follow(system, impulse{}, h, start, std::llround(time / h), "impulse, h = 0.02", true);
    result.require(rotated.has_no_trend(),
                   fmt::format("omega = {:g}: impulse at h omega = {:g} has the energy error {:.1e}; the "
                               "stiff energy varies by {:.1e}, "
                               "by {:.1e} in truth",
                               omega, h * omega, rotated.largest, of_impulse, of_exact));

    // Verlet conserves a quantity whose stiff part is (1 - z^2/4) times as stiff: H varies by z^2/4/(1 -
    // z^2/4).
    const double z = 0.1;
    const double bound = 0.25 * z * z / (1.0 - 0.25 * z * z);
    auto plain = follow(system, verlet{}, z / omega, start,
                        std::llround((how == extent::quick ? 2e3 : 2e5) / z), "verlet, h omega = 0.1");
    result.require(
        !plain.diverged_at && plain.largest <= bound,
        fmt::format("Verlet at h omega = 0.1: energy error {:.1e}, bound {:.1e}", plain.largest, bound));
    const auto at_once = integrate(system, verlet{}, h, start, 100).diverged_at;
    result.require(at_once == first_bad_step(system, verlet{}, h, start, 100) && at_once.has_value(),
                   fmt::format("Verlet at 0.02 diverges at step {}", at_once.value_or(-1)));
    panels.push_back(
        energy_panel(fmt::format("omega = {:g}", omega), {std::move(rotated.shown), std::move(plain.shown)}));
  }
  result.show(std::move(panels), "Steps of the impulse method are not bound to the stiff frequency.", 1200);
  return result;
}

verdict strong_soft_springs(extent how) {
  const double omega = 50.0;
  const chain system(omega);
  const auto start = fpu_law<3>::soft_dominated(system)(1, 0);
  const double energy_of_soft = omega * omega;
  const double time = how == extent::quick ? 20.0 : 1000.0;
  const auto ordinary = system.frequency_bands().back().high;
  const auto fastest = system.frequency_bands(energy_of_soft).back().high;
  verdict result;
  std::vector<curve> curves;
  const double per_evaluation = 0.5 / fastest;
  std::string errors;
  auto all = side_by_side(learned_fg4_for_fpu());
  all.push_back({"impulse", impulse{}});
  all.push_back({"learned r_aba4", learned_r_aba4_at_resonance(1), true});
  bool bounded = true;
  for (const auto& one : all) {
    auto story = follow(system, one, per_evaluation, start, time);
    errors += fmt::format("{}{} {:.1e}", errors.empty() ? "" : ", ", one.label, story.largest);
    if (story.diverged_at) errors += fmt::format(" (diverged at step {})", *story.diverged_at);
    if (one.label == "verlet" || one.label == "mclachlan2") bounded = bounded && story.has_no_trend();
    curves.push_back(std::move(story.shown));
  }
  result.require(bounded, fmt::format("at {:.4f} per evaluation, z = 1/2 of the band of this energy: {}",
                                      per_evaluation, errors));
  const double trap = 1.9 / ordinary;
  const auto trapped = follow(system, verlet{}, trap, start, std::llround(time / trap), "");
  result.require(
      trapped.diverged_at.has_value() &&
          trapped.diverged_at == first_bad_step(system, verlet{}, trap, start, std::llround(time / trap)),
      fmt::format("Verlet at z = 1.9 by the band of ordinary starts, {:.2f} by that of this energy: {}",
                  trap * fastest,
                  trapped.diverged_at ? fmt::format("diverged at step {}", *trapped.diverged_at)
                                      : fmt::format("energy error {:.1e}", trapped.largest)));
  result.show({energy_panel("FPU, soft energy of omega^2", std::move(curves))},
              "Soft springs that hold as much as stiff ones, methods at equal cost.", 1000);
  return result;
}

}  // namespace

topic stiffness() {
  return {
      "Stiff chains",
      {{"resonance",
        "The FPU chain of omega = 50 at steps h omega = pi, 2 pi, 3 pi, with its stiff part rotated exactly.",
        "Of words learned there no stiff mode is magnified by more than 1.1, and the energy error is a tenth "
        "of that of the impulse "
        "method at most.",
        "The impulse method, whose trace is 2 or -2 there whatever the soft force.", resonance},
       {"plain_words_at_resonance", "The same steps without rotations.",
        "A method whose stability windows hold the stiff band stays bounded.",
        "One whose windows do not meet it diverges.", plain_words_at_resonance},
       {"very_stiff", "omega = 1000 and 10,000.",
        "The impulse method at h = 0.02 has no trend; Verlet at h omega = 0.1 keeps within z^2/4/(1 - "
        "z^2/4).",
        "Verlet at h = 0.02 diverges at once, at its step.", very_stiff},
       {"strong_soft_springs", "Soft energy of omega^2: the soft springs are as stiff as the stiff ones.",
        "At z = 1/2 of the band of this energy the energy errors of Verlet's and McLachlan's methods have no "
        "trend.",
        "A step that suits ordinary starts.", strong_soft_springs}}};
}

}  // namespace nysalt::hard
