// SPDX-License-Identifier: BSL-1.0
// Lattice phi^4 in two dimensions: words learned on a small lattice, run on large ones.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "chapters.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/methods/classical.hpp"
#include "power_spectrum.hpp"

namespace nysalt::sampling_benchmark {

namespace {

constexpr double coupling = 4.316;

model lattice_of(Eigen::Index side, double lambda = coupling) {
  return bundled("phi4_lattice", {{"side", static_cast<std::int64_t>(side)}, {"coupling", lambda}});
}

/// Cold chains, and where they are after a burn-in that tunes the step: of the law.
target thermal(Eigen::Index side, std::int64_t chains, std::int64_t draws, const extent& how) {
  const model system = lattice_of(side);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(side * side);
  const normal_around<Eigen::Dynamic> cold({rest, rest}, 0.4, 1.0);
  std::vector<Eigen::VectorXd> positions(static_cast<std::size_t>(chains * draws));
  hmc(system, omelyan5v{}, cold,
      {.step = 0.1,
       .length = 0.5,
       .chains = chains,
       .burn_in = 600,
       .draws = draws,
       .acceptance = 0.9,
       .execution = {.threads = how.threads}},
      [&](const hmc_draw& draw) {
        positions[static_cast<std::size_t>(draw.chain * draws + draw.number)] = draw.q;
      });
  return {system, thermal_positions(system, std::move(positions), 1.0)};
}

/// The square of the power of each mode; its mean and variance are estimated by long chains of a word.
statistic squared_powers(const target& of, Eigen::Index side, const contender& by, std::int64_t draws,
                         const contest_options& options) {
  statistic result;
  result.value = [side](const Eigen::VectorXd& q, Eigen::VectorXd& f) {
    power_spectrum(q, side, f);
    f = f.cwiseAbs2();
  };
  constexpr std::size_t chains = 8;
  std::vector<Eigen::VectorXd> first(chains, Eigen::VectorXd::Zero(side * side));
  std::vector<Eigen::VectorXd> second = first;
  std::vector<Eigen::VectorXd> values = first;
  hmc(of.system, by.word, of.starts,
      {.step = by.step,
       .length = options.length,
       .chains = chains,
       .burn_in = 50,
       .draws = draws,
       .seed = 7,
       .execution = {.threads = options.threads}},
      [&](const hmc_draw& draw) {
        const auto m = static_cast<std::size_t>(draw.chain);
        result.value(draw.q, values[m]);
        first[m] += values[m];
        second[m] += values[m].cwiseAbs2();
      });
  for (std::size_t m = 1; m < chains; ++m) {
    first[0] += first[m];
    second[0] += second[m];
  }
  const double count = static_cast<double>(chains) * static_cast<double>(draws);
  result.mean = over_symmetries(first[0] / count, side);
  result.variance = over_symmetries(second[0] / count, side) - result.mean.cwiseAbs2();
  return result;
}

double nanoseconds_per_site(const target& of) {
  const auto start = of.starts(1, 1);
  auto p = start.p;
  double least = 1e300;
  for (int n = 0; n < 50; ++n) {
    const auto began = std::chrono::steady_clock::now();
    for (int k = 0; k < 10; ++k) of.system.own_kick(start.q, p, 1e-9);
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - began;
    least = std::min(least, passed.count() / 10.0 / static_cast<double>(p.size()));
  }
  return least;
}

/// Steps at an acceptance of 0.9 only.
void add_steps_on(Eigen::Index side, double lambda, const target& smaller, std::vector<contender> words,
                  const contest_options& options, const extent& how, page& to, table& rows) {
  const model system = lattice_of(side, lambda);
  // Copies of the smaller lattice side by side, and some trajectories by which they become one.
  const auto small_side = static_cast<Eigen::Index>(std::lround(std::sqrt(size(smaller.system))));
  std::vector<Eigen::VectorXd> tiled;
  for (std::uint64_t n = 0; n < 4; ++n) {
    const Eigen::VectorXd q = smaller.starts(3, n).q;
    Eigen::VectorXd& large = tiled.emplace_back(side * side);
    for (Eigen::Index r = 0; r < side; ++r) {
      for (Eigen::Index c = 0; c < side; ++c)
        large[r * side + c] = q[(r % small_side) * small_side + c % small_side];
    }
  }
  target of{system, thermal_positions(system, std::move(tiled), 1.0)};
  const auto word =
      std::ranges::find(words, "omelyan5v", [](const contender& one) { return one.word.name(); });
  of.starts = reached_by(of, word->word, 0.7 * word->step, 4, 60, 1, options);
  contest_options few = options;
  few.pilot = how.quick ? 4 : 16;
  table shown({"word", "step per gradient"});
  std::erase_if(words, [](const contender& one) {
    return one.word.name() == "bcss4" || one.word.name() == "chin4a_displaced";
  });
  for (auto& one : words) {
    one.step = step_with_error(of, one.word, 0.6 * one.step, energy_error_at(0.9), few);
    const double evaluations = one.word.letters().evaluations_per_step;
    say(fmt::format("side {}: {} step {:.4g}", side, one.word.name(), one.step));
    shown.add({one.word.name(), fmt::format("{:.4f}", one.step / evaluations)});
    rows.add({fmt::format("phi4_lattice, {} x {}, lambda {:g}", side, side, lambda), one.word.name(),
              fmt::format("{:g}", few.length), fmt::format("{:.5g}", one.step),
              fmt::format("{:.5g}", one.step / evaluations), "", "", "", "", "", ""});
  }
  to.table(shown);
}

}  // namespace

void add_lattice(const extent& how, page& to, table& rows) {
  const Eigen::Index side = how.quick ? 64 : 256;
  constexpr Eigen::Index fitted_side = 12;
  const double ratio = static_cast<double>(side * side) / static_cast<double>(fitted_side * fitted_side);
  say("pilot chains of the lattices");
  const small_target small{thermal(fitted_side, 16, 60, how), ratio};
  const target large = thermal(side, 8, 4, how);
  const contest_options typical{.length = 0.5, .threads = how.threads};

  std::vector<contender> words{{verlet{}, 0.016},
                               {mclachlan2{}, 0.05},
                               {bcss4{}, 0.1},
                               {omelyan5v{}, 0.23},
                               {chin4a_displaced{}, 0.13}};
  for (const auto& [drifts, guess] : {std::pair{5, 0.28}, {6, 0.36}}) {
    say(fmt::format("learning bab{}", drifts));
    const auto found = learned_bab(drifts, small, guess, typical);
    words.push_back({found.word, found.step});
  }
  for (auto& one : words) one.step = one.foretold = foretold_step(small, one.word, one.step, typical);
  if (!how.quick) {
    words[0].published = "30691 ± 186";
    words[1].published = "7410 ± 15";
  }
  say("the law of the modes");
  contender by = words.back();
  const statistic measured = squared_powers(large, side, by, how.quick ? 300 : 1000, typical);

  constexpr std::int64_t draws = 1200;
  const race found = run_race(fmt::format("phi4_lattice, {} x {}", side, side), large, words, measured,
                              &error_curve::mean, {{0.4, draws * 5 / 4}, {0.7, draws}}, how);
  to.heading("Lattice phi^4");
  to.text(fmt::format(
      "V = sum of lambda phi^4 - phi (the sum of the four neighbours), lambda = {:g}, on {} x {} sites: "
      "`phi4_lattice --mass-squared -4`. The statistic is the square of the power of each Fourier mode, its "
      "error the mean over all modes of the squared bias over the variance; means and variances are those of "
      "long chains, averaged over the symmetries of the square. Learned words were fitted on {} x {} sites "
      "by "
      "the loss `acceptance`, and steps foretold there, as the variance of H' - H is extensive.",
      coupling, side, side, fitted_side, fitted_side));
  to.text(fmt::format("Trajectories of mean length {:g}, of those tried the best for all words together:",
                      found.length));
  add_race(found, to, rows, false);
  panel shown{"", "gradients", "mean squared error over variance", true, {}};
  for (const auto& one : found.words) {
    curve line;
    line.label = one.word.name();
    line.emphasised = one.word.name().starts_with("learned");
    double next = 4.0;
    for (std::size_t n = 3; n < one.run.mean_errors.size(); ++n) {
      if (static_cast<double>(n + 1) < next) continue;
      next *= 1.2;
      line.x.push_back(static_cast<double>(n + 1) * one.run.evaluations_of_draw);
      line.y.push_back(one.run.mean_errors[n]);
    }
    shown.curves.push_back(line);
  }
  shown.levels.push_back({"low", 0.01});
  to.picture(
      {.name = "phi4_lattice", .panels = {shown}},
      fmt::format("The error of the modes on {} x {} sites against gradients of a chain, the median of "
                  "four chains.",
                  side, side));
  to.text(fmt::format("A gradient took {:.2g} ns a site, {:.2g} ms in all, on one thread.",
                      nanoseconds_per_site(large),
                      nanoseconds_per_site(large) * static_cast<double>(side * side) * 1e-6));

  how.save();
  const Eigen::Index largest = how.quick ? 128 : 1024;
  const double lambda = how.quick ? coupling : 4.266;
  to.subheading(fmt::format("{} x {} sites", largest, largest));
  to.text(fmt::format("Steps at an acceptance of 0.9 only, lambda = {:g}, the same words{}", lambda,
                      how.quick ? ":" : " (published: leapfrog .0088, McLachlan's .019):"));
  add_steps_on(largest, lambda, large, found.words, {.length = found.length, .threads = how.threads}, how, to,
               rows);
}

}  // namespace nysalt::sampling_benchmark
