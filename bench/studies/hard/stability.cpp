// SPDX-License-Identifier: BSL-1.0
// Steps just inside and just outside stability windows.
#include <fmt/format.h>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/systems/textbook.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

/// The oscillator of frequency 1: z is the step.
const harmonic_oscillator& oscillator() {
  static const harmonic_oscillator system(1.0);
  return system;
}

phase_point<double, 1> at_one() { return {vector<double, 1>(1.0), vector<double, 1>(1.0)}; }

/// One step of a word as a matrix, letter by letter and in long double: by none of the code that is judged.
struct step_matrix {
  long double qq = 1.0L, qp = 0.0L, pq = 0.0L, pp = 1.0L;
  long double letters = 1.0L;  // product of the letters' sizes: how much they may magnify rounding

  step_matrix(const nysalt::method& method, long double z) {
    const auto& word = method.letters();
    const auto c = method.coefficients();
    for (std::size_t i = 0; i < word.length; ++i) {
      const std::size_t slot = word.first_slot(i);
      long double shear = c[slot] * z;
      if (word.letters()[i] == 'G') shear -= 2.0L * c[slot + 1] * z * z * z;
      letters *= 1.0L + std::abs(shear);
      if (word.letters()[i] == 'A') {
        qq += shear * pq;
        qp += shear * pp;
      } else {
        pq -= shear * qq;
        pp -= shear * qp;
      }
    }
  }

  long double cosine() const { return 0.5L * (qq + pp); }

  /// How much the energy can grow where |cosine| < 1. B = (M - cosine)/sine has the square -1, and
  /// M^n = cos + sin B: its norm is at most that of B, of singular values beta and 1/beta.
  double swing() const {
    const long double c = cosine();
    const long double sine_squared = 1.0L - c * c;
    const long double frobenius =
        ((qq - c) * (qq - c) + (pp - c) * (pp - c) + qp * qp + pq * pq) / sine_squared;
    return static_cast<double>(0.5L * (frobenius + std::sqrt(std::max(0.0L, frobenius * frobenius - 4.0L))));
  }

  /// The first step from (1, 1), of energy 1, after which it is off by more than 1e3.
  std::optional<std::int64_t> first_bad_step(std::int64_t steps) const {
    long double q = 1.0L;
    long double p = 1.0L;
    for (std::int64_t n = 1; n <= steps; ++n) {
      const long double before = q;
      q = qq * q + qp * p;
      p = pq * before + pp * p;
      if (std::abs(0.5L * (q * q + p * p) - 1.0L) > 1e3L) return n;
    }
    return std::nullopt;
  }
};

struct tally {
  int windows = 0;
  int left_out = 0;  // far out, where letters magnify rounding beyond all
  int inside = 0;
  int outside = 0;
  int slow = 0;  // gaps in which nothing grows within the run
  std::int64_t soonest = std::numeric_limits<std::int64_t>::max();  // divergence
  std::int64_t latest = 0;
  double largest_swing = 1.0;  // of the energy, inside
  std::vector<std::string> faults;
};

/// Energy over that of the start, at most, whatever integrate() would say.
double largest_energy(const method& method, double z, std::int64_t steps) {
  const auto stepper = make_stepper(oscillator(), method, z);
  auto run = stepper.open(at_one());
  double largest = 1.0;
  stepper.advance(run, steps, 1, [&](std::int64_t, const auto& x) {
    largest = std::max(largest, energy<double>(oscillator(), x));
  });
  return largest;
}

/// Inside: bounded by the exact swing. Each letter of n steps rounds by eps; the rest of its step magnifies
/// that by the product of the letters at most, further steps by the root of the swing, and a square doubles
/// it. Nor is it taken for divergence, where the swing stays below the criterion, a factor of 1001.
void try_inside(const method& method, double z, std::int64_t steps, tally& count) {
  const step_matrix exact(method, z);
  const double letters = static_cast<double>(method.letters().length);
  const double rounding = 2.0 * static_cast<double>(steps) * letters * 2.2e-16 *
                          static_cast<double>(exact.letters) * std::sqrt(exact.swing());
  const double largest = largest_energy(method, z, steps);
  const bool reported =
      exact.swing() < 1000.0 && integrate(oscillator(), method, z, at_one(), steps).diverged_at;
  ++count.inside;
  count.largest_swing = std::max(count.largest_swing, largest);
  if (!reported && largest <= exact.swing() * (1.0 + rounding)) return;
  count.faults.push_back(fmt::format("{} at z = {}: energy times {:.4g}, bound {:.4g}{}", method.name(), z,
                                     largest, exact.swing(), reported ? ", and reported" : ""));
}

/// Outside: diverged, at the step that the matrix says.
void try_outside(const method& method, double z, std::int64_t expected, std::int64_t steps, tally& count) {
  const auto named = integrate(oscillator(), method, z, at_one(), steps).diverged_at;
  ++count.outside;
  if (named) {
    count.soonest = std::min(count.soonest, *named);
    count.latest = std::max(count.latest, *named);
  }
  if (named == expected) return;
  count.faults.push_back(fmt::format("{} at z = {}: diverged at {}, expected {}", method.name(), z,
                                     named.value_or(-1), expected));
}

constexpr double part_outside = 1e-3;  // of the narrowest width or gap beside an end
constexpr double part_inside = 1e-2;

void try_windows(const method& method, std::int64_t steps, tally& count) {
  const auto windows = stability_windows(method);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto [low, high] = windows[i];
    double narrowest = high - low;
    if (i > 0) narrowest = std::min(narrowest, low - windows[i - 1].high);
    if (i + 1 < windows.size()) narrowest = std::min(narrowest, windows[i + 1].low - high);
    // 1e-3 of the width is some 1e-3 of trace/2: rounding must leave a hundredth of that.
    if (2.2e-16 * static_cast<double>(step_matrix(method, high).letters) > 1e-5 * narrowest) {
      ++count.left_out;
      continue;
    }
    ++count.windows;
    // As near to the end as growth is told within the run.
    const auto outside = [&](double end, double outwards) {
      for (double part = part_outside; part < 0.6; part *= 2.0) {
        const double z = end + outwards * part * narrowest;
        if (const auto expected = step_matrix(method, z).first_bad_step(steps)) {
          return try_outside(method, z, *expected, steps, count);
        }
      }
      ++count.slow;
    };
    try_inside(method, high - part_inside * narrowest, steps, count);
    outside(high, 1.0);
    if (low == 0.0) continue;
    try_inside(method, low + part_inside * narrowest, steps, count);
    outside(low, -1.0);
  }
}

verdict judge_windows(const std::vector<method>& methods, extent how) {
  const std::int64_t steps = how == extent::quick ? 10'000 : 200'000;
  tally count;
  for (const auto& method : methods) try_windows(method, steps, count);
  verdict result;
  result.require(count.faults.empty(),
                 fmt::format("{} methods, {} windows; {} steps inside an end: all bounded over {} steps, the "
                             "energy at most {:.0f} times that of the start",
                             methods.size(), count.windows, count.inside, steps, count.largest_swing));
  result.require(count.outside > 0,
                 fmt::format("{} steps outside: all diverged, at the steps {} to {} as their matrices say",
                             count.outside, count.soonest, count.latest));
  for (const auto& fault : count.faults) result.note(fault);
  if (count.slow > 0) {
    result.note(fmt::format("{} sides of gaps are so narrow that nothing grows a thousandfold within the run",
                            count.slow));
  }
  if (count.left_out > 0) {
    result.note(fmt::format(
        "{} windows far out are left out: their letters magnify rounding so much that it hides the ends",
        count.left_out));
  }
  return result;
}

panel ends_of_window(const method& method, const stability_window& window, std::int64_t steps) {
  const double width = window.high - window.low;
  std::vector<curve> curves;
  const auto add = [&](double z, const char* where, bool inside) {
    auto story = follow(oscillator(), method, z, at_one(), steps, fmt::format("{}, z = {:.4f}", where, z));
    story.shown.emphasised = inside;
    curves.push_back(std::move(story.shown));
  };
  if (window.low > 0.0) add(window.low - part_outside * width, "below it", false);
  if (window.low > 0.0) add(window.low + part_inside * width, "at its low end", true);
  add(window.high - part_inside * width, "at its high end", true);
  add(window.high + part_outside * width, "above it", false);
  return energy_panel(fmt::format("{}: {:.4f} to {:.4f}", method.name(), window.low, window.high),
                      std::move(curves));
}

verdict windows_of_classical_methods(extent how) {
  verdict result = judge_windows(classical_words(), how);
  const std::int64_t steps = how == extent::quick ? 1'000 : 100'000;
  const method two_windows = nystrom_with_two_windows();
  const auto windows = stability_windows(two_windows);
  result.show(
      {ends_of_window(verlet{}, stability_windows(verlet{}).front(), steps),
       ends_of_window(two_windows, windows.at(1), steps)},
      "The ends of the only window of Verlet, and of the second one of the two-stage word (1/2, 0.4): "
      "1 % of the width inside (solid) the energy swings by a fixed factor for ever, 0.1 % outside it "
      "grows until the run is stopped.",
      1200);
  return result;
}

verdict windows_of_learned_words(extent how) { return judge_windows(learned_words(), how); }

}  // namespace

topic stability() {
  return {
      "Steps at the ends of stability windows",
      {{"windows_of_classical_methods",
        "An oscillator, at steps 1 % inside and 0.1 % outside both ends of each stability window of every "
        "classical method.",
        "Inside, the energy stays below its exact swing; outside, the run is reported as diverged at the "
        "very "
        "step that the matrix of the word, multiplied out in long double, says.",
        "Each step outside, where it is ten times nearer to the end than those inside; farther out only in "
        "gaps so narrow "
        "that nothing would grow within the run.",
        windows_of_classical_methods},
       {"windows_of_learned_words",
        "The same for words of families, most with several windows, among them learned ones.",
        "As above, in every window.", "Each step outside.", windows_of_learned_words}}};
}

}  // namespace nysalt::hard
