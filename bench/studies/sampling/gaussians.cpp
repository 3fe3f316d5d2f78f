// SPDX-License-Identifier: BSL-1.0
// Normal distributions: equal frequencies, and a spread that estimated masses leave.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "chapters.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/gaussian.hpp"

namespace nysalt::sampling_benchmark {

namespace {

/// The Gibbs law of independent oscillators at kT = 1.
struct gibbs_of_oscillators {
  Eigen::VectorXd frequencies;

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    Eigen::VectorXd normals(2 * frequencies.size());
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    return {normals.head(frequencies.size()).cwiseQuotient(frequencies), normals.tail(frequencies.size())};
  }
  std::string description() const { return "gibbs_of_oscillators"; }
};

target target_of(const Eigen::VectorXd& frequencies) {
  return {gaussian(frequencies), gibbs_of_oscillators{frequencies}};
}

/// q_i^2, with the mean 1/omega^2 and the variance 2/omega^4.
statistic squares(const Eigen::VectorXd& frequencies) {
  const Eigen::VectorXd variances = frequencies.cwiseAbs2().cwiseInverse();
  return {[](const Eigen::VectorXd& q, Eigen::VectorXd& f) { f = q.cwiseAbs2(); }, variances,
          2.0 * variances.cwiseAbs2()};
}

/// Frequencies in the unit of time of masses that a burn-in estimates: what is left of a spectrum.
Eigen::VectorXd after_masses(Eigen::Index size, double condition, const extent& how) {
  Eigen::VectorXd frequencies(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
    frequencies[i] = std::pow(condition, 0.5 * (u - 0.5));
  }
  const target of = target_of(frequencies);
  const auto found = hmc(of.system, mclachlan2{}, of.starts,
                         {.step = 0.5,
                          .length = 1.5,
                          .burn_in = 1000,
                          .draws = 1,
                          .acceptance = 0.9,
                          .diagonal_masses = true,
                          .execution = {.threads = how.threads}},
                         [](const hmc_draw&) {});
  return frequencies.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(found.deviations.data(), size));
}

double deviation_of_logarithm(const Eigen::VectorXd& x) {
  const Eigen::ArrayXd logarithms = x.array().log();
  return std::sqrt((logarithms - logarithms.mean()).square().mean());
}

/// As many frequencies as a fit needs, evenly among the sorted ones.
Eigen::VectorXd few_of(Eigen::VectorXd frequencies, Eigen::Index size) {
  std::ranges::sort(frequencies);
  Eigen::VectorXd result(size);
  for (Eigen::Index i = 0; i < size; ++i)
    result[i] = frequencies[(2 * i + 1) * frequencies.size() / (2 * size)];
  return result;
}

Eigen::VectorXd log_normal(Eigen::Index size, double deviation) {
  Eigen::VectorXd frequencies(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
    frequencies[i] = std::exp(deviation * std::sqrt(2.0) * boost::math::erf_inv(2.0 * u - 1.0));
  }
  return frequencies;
}

std::vector<contender> classical_words() {
  return {{verlet{}, 0.14}, {mclachlan2{}, 0.9}, {bcss3{}, 1.0}, {bcss4{}, 3.0}, {omelyan5v{}, 2.0}};
}

/// Steps at an acceptance of 0.9 only, of words that were learned for each spread.
void add_spreads(const extent& how, page& to, table& rows) {
  const Eigen::Index size = how.quick ? 4096 : 65'536;
  constexpr Eigen::Index fitted_on = 64;
  const contest_options options{.length = 1.5, .pilot = 16, .threads = how.threads};
  std::vector<std::string> columns{"word"};
  std::vector<std::vector<std::string>> cells;
  for (const double deviation : {0.1, 0.3}) {
    columns.push_back(fmt::format("deviation {:g}", deviation));
    const target of = target_of(log_normal(size, deviation));
    const small_target small{target_of(log_normal(fitted_on, deviation)),
                             static_cast<double>(size) / static_cast<double>(fitted_on)};
    auto words = classical_words();
    for (const auto& [drifts, guess] : {std::pair{2, 0.9}, {3, 1.9}, {4, 3.0}}) {
      const auto found = learned_bab(drifts, small, guess, options);
      words.push_back({found.word, found.step});
    }
    for (std::size_t k = 0; k < words.size(); ++k) {
      auto& one = words[k];
      one.step = step_with_error(of, one.word, one.step, energy_error_at(0.9), options);
      const double evaluations = one.word.letters().evaluations_per_step;
      if (cells.size() <= k) cells.push_back({one.word.name()});
      cells[k].push_back(fmt::format("{:.3f}", one.step / evaluations));
      say(fmt::format("spread {:g}: {} step {:.4g}", deviation, one.word.name(), one.step));
      rows.add({fmt::format("gaussian, deviation {:g}, d = {}", deviation, size), one.word.name(),
                fmt::format("{:g}", options.length), fmt::format("{:.5g}", one.step),
                fmt::format("{:.5g}", one.step / evaluations), "", "", "", "", "", ""});
    }
  }
  to.subheading(fmt::format("Spread frequencies, {} dimensions", size));
  to.text(
      "Step per gradient at an acceptance of 0.9 where log omega is normal with the deviation of the column; "
      "words are learned for each:");
  table shown(columns);
  for (const auto& row : cells) shown.add(row);
  to.table(shown);
}

/// The words of the main case at equal frequencies; of many dimensions a part of them.
void add_equal(Eigen::Index size, const race& main, const extent& how, page& to, table& rows) {
  const Eigen::VectorXd equal = Eigen::VectorXd::Ones(size);
  auto racing = main.words;
  for (auto& one : racing) one.foretold = 0.0;
  racing[0].published = size == 10'000 ? "7.02e4" : "";
  racing[1].published = size == 100'000 ? "1.86e4" : size == 10'000 ? "8686" : "";
  racing[4].published = size == 100'000 ? "1.47e4" : size == 10'000 ? "1.49e4" : "";
  to.subheading(fmt::format("Equal frequencies, {} dimensions", size));
  to.text(
      "The same words at steps of their own for this target. Where all frequencies are equal a word can be "
      "made exact at one step, so that this case flatters; the first one is what happens.");
  if (size == 100'000) {
    to.text("A part of the words; for leapfrog 2.45e5 is published.");
    racing = {racing[1], racing[4], racing[5]};
  }
  const std::int64_t draws = how.quick ? 4000 : size == 100'000 ? 6000 : 8000;
  const race found = run_race(fmt::format("gaussian, equal frequencies, d = {}", size), target_of(equal),
                              racing, squares(equal), &error_curve::largest, {{main.length, draws}}, how);
  add_race(found, to, rows, true);
}

}  // namespace

void add_gaussians(const extent& how, page& to, table& rows) {
  const Eigen::Index size = how.quick ? 1000 : 10'000;
  say("estimating masses");
  const Eigen::VectorXd spread = after_masses(size, 100.0, how);
  constexpr Eigen::Index fitted_on = 64;
  const small_target small{target_of(few_of(spread, fitted_on)),
                           static_cast<double>(size) / static_cast<double>(fitted_on)};
  const contest_options typical{.length = 1.2, .threads = how.threads};
  say("learning bab2");
  const auto found = learned_bab(2, small, 1.3, typical);
  auto words = classical_words();
  if (!how.quick) {
    words[0].published = "4.2e4";
    words[1].published = "7552";
  }
  words.push_back({found.word, found.step, foretold_step(small, found.word, found.step, typical)});

  const std::int64_t draws = how.quick ? 4000 : 8000;
  const std::vector<tried_length> lengths{{0.7, draws}, {1.0, draws}};
  to.heading("Normal distributions");
  to.text(fmt::format(
      "Independent oscillators. Low is an error below 0.01 of the mean of q_i^2: its squared bias over the "
      "variance 2/omega_i^4, the largest over all coordinates (which is what the published counts are of) or "
      "the mean over them."));
  to.subheading(fmt::format("Condition number 100 after masses, {} dimensions", size));
  to.text(fmt::format(
      "Variances are log-uniform over two decades; masses are those that `--diagonal-masses` finds in a "
      "burn-in "
      "of 1000 trajectories of four chains, which leaves frequencies around 1 with the deviation {:.3f} of "
      "their logarithm. The word of two drifts was fitted on {} of them by the loss `acceptance`. Words of "
      "more "
      "drifts reach larger steps per gradient (the last table), but their step is then longer than a "
      "trajectory "
      "should be: a quarter of the period of most frequencies here is 1.57, and where the step at an "
      "acceptance "
      "of 0.9 is longer than the mean length, chains take steps of that length and accept more. "
      "Lengths and the family of this race were chosen after looking at earlier runs.",
      deviation_of_logarithm(spread), fitted_on));
  const race main = run_race(fmt::format("gaussian, condition 100 after masses, d = {}", size),
                             target_of(spread), words, squares(spread), &error_curve::largest, lengths, how);
  to.text(fmt::format("Trajectories of mean length {:g}, of those tried the best for all words together:",
                      main.length));
  add_race(main, to, rows, true);

  how.save();
  add_equal(size, main, how, to, rows);
  how.save();
  add_spreads(how, to, rows);
  how.save();
  add_equal(how.quick ? 10'000 : 100'000, main, how, to, rows);
}

}  // namespace nysalt::sampling_benchmark
