// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 75 s at -O0, 3 s at -O1.
// States of Gibbs ensembles, by chains and by the modes of linear systems, have its law, are independent, and
// are a function of seed and number. What pilots find, and what they do not let pass; states of one
// trajectory have the law if it was burned in, and more if not.
#include "nysalt/ensembles/gibbs.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using failure = std::runtime_error;
using lanes = pack<double>;
constexpr int width = lanes::lanes;
constexpr std::int64_t count = 4096;
constexpr double omega = 50.0;
const fpu_chain<3> chain(omega);
const fpu_law<3> law(chain);
const in_bath in_the_papers_bath(chain, bath::of_sigma(0.01, 0.05));
constexpr double kT = 0.05 * 0.05 / 0.02;

/// Made once: most of the time of this test.
const gibbs<6>& papers() {
  static const gibbs ensemble(in_the_papers_bath, law, {.seed = seed(1)});
  return ensemble;
}

template <class S, class E>
auto states_of(const S& system, const E& ensemble, std::uint64_t which) {
  std::vector<phase_point<double, S::dimension>> result;
  for (std::int64_t first = 0; first < count; first += width) {
    const auto all = detail::sound_starts<lanes>(system, ensemble, which, first, width);
    for (int k = 0; k < width; ++k) result.push_back(lane(all, k));
  }
  return result;
}
const auto& papers_states() {
  static const auto states = states_of(in_the_papers_bath, papers(), seed(7));
  return states;
}

std::vector<double> numbers(const auto& states, const auto& of) {
  std::vector<double> result;
  for (const auto& x : states) result.push_back(of(x));
  return result;
}
/// Against a normal law of mean 0.
double off(std::vector<double> x, double deviation) {
  for (double& value : x) value /= deviation;
  return kolmogorov_smirnov(x);
}

using vector_1 = vector<double, 1>;
using vector_2 = vector<double, 2>;
const normal_around<1> around_0({vector_1(0.0), vector_1(0.0)}, 1.0, 1.0);
const normal_around<1> far_off({vector_1(20.0), vector_1(0.0)}, 1.0, 1.0);
const normal_around<2> near_0({vector_2::Zero(), vector_2::Zero()}, 0.1, 0.1);
const harmonic_oscillator oscillator(3.0);

/// V = q^4/4: <V> = kT/4 for every temperature. A linear force would leave BAOAB no bias in q.
struct quartic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * q[0] * q[0] * 0.25;
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * q[0] * q[0] * -1.0;
  }
};
struct cusp {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::abs;
    return abs(q[0]);
  }
};
struct half_line {  // it leaves towards -x, and the potential of all chains is nearly 0: no mean shows that
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::abs;
    return (abs(q[0]) + q[0]) * q[0] + q[1] * q[1];
  }
};
struct no_force {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return 0.0 * q[0];
  }
};

template <class S>
in_bath<S> at(double temperature, const S& system) {
  return {system, bath::of_temperature(0.01, temperature)};
}

/// How far the mean potential of 1600 states is from what it must be, in standard errors.
double potential_off(const auto& system, const auto& ensemble, std::uint64_t which, double expected) {
  std::vector<double> potentials;
  for (std::uint64_t n = 0; n < 1600; ++n) potentials.push_back(system.potential(ensemble(which, n).q));
  return mean_off(potentials, expected, std::sqrt(covariance(potentials, potentials)));
}

const in_bath in_a_bath(chain, bath::of_temperature(0.1, kT));

std::vector<double> stiff_energies(const auto& ensemble) {
  std::vector<double> result;
  for (std::uint64_t n = 0; n < 10'000; ++n) result.push_back(chain.stiff_energy(ensemble(seed(5), n)));
  return result;
}

}  // namespace

// The soft springs shift the variance of a stiff mode by 12 u^2/omega^2 < 0.1 %: far below 1/sqrt(count).
BOOST_AUTO_TEST_CASE(stiff_modes_and_momenta_are_normal) {
  const Eigen::MatrixXd basis = chain.modes().basis;
  const double sd = std::sqrt(kT);
  constexpr double each = false_alarms / 15;  // nine distributions, six correlations
  const double allowed = kolmogorov_smirnov_limit(each);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto q = numbers(papers_states(), [&](const auto& x) { return basis.col(k).dot(x.q); });
    const auto p = numbers(papers_states(), [&](const auto& x) { return x.p[k]; });
    BOOST_TEST(off(p, sd) <= allowed);
    BOOST_TEST(off(p, 1.5 * sd) > allowed);  // moves F by .1, that is 6 in these units
    if (k >= 3) {
      BOOST_TEST(off(q, sd / omega) <= allowed);
      BOOST_TEST(off(q, 1.5 * sd / omega) > allowed);
    }
    BOOST_TEST(correlation_off(q, p) <= standard_errors(each));
  }
}

// Two masses between walls: <p_i^2> = m_i kT and <q q^T> = kT K^{-1}, whatever the masses.
BOOST_AUTO_TEST_CASE(masses_change_the_law_of_momenta_alone) {
  const Eigen::Matrix2d stiffness{{2.0, -1.0}, {-1.0, 2.0}};
  const linear_chain masses(stiffness, Eigen::Vector2d(1.0, 9.0));
  const in_bath system(masses, bath::of_temperature(0.0, 0.3));  // friction is ours
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2);
  const gibbs ensemble(system, normal_around<Eigen::Dynamic>({zero, zero}, 1.0, 0.0),
                       {.friction = 0.8, .seed = seed(1)});
  const auto states = states_of(system, ensemble, seed(1));
  const double allowed = kolmogorov_smirnov_limit(false_alarms / 5);
  for (int i = 0; i < 2; ++i) {
    const auto q = numbers(states, [&](const auto& x) { return x.q[i]; });
    const auto p = numbers(states, [&](const auto& x) { return x.p[i]; });
    BOOST_TEST(off(q, std::sqrt(0.3 * 2.0 / 3.0)) <= allowed);  // (K^{-1})_ii = 2/3
    BOOST_TEST(off(p, std::sqrt(0.3 * (i == 0 ? 1.0 : 9.0))) <= allowed);
    BOOST_TEST(off(p, std::sqrt(0.3 * (i == 0 ? 9.0 : 1.0))) > allowed);  // of the other mass
  }
  const auto difference = numbers(states, [](const auto& x) { return x.q[1] - x.q[0]; });
  BOOST_TEST(off(difference, std::sqrt(0.3 * 2.0 / 3.0)) <= allowed);  // 2/3 + 2/3 - 2/3
}

BOOST_AUTO_TEST_CASE(it_says_what_it_is) {
  const auto& report = papers().report();
  BOOST_TEST(report.halvings == 0);
  BOOST_TEST(report.confined);
  BOOST_TEST(report.step * chain.frequency_bands().back().high == 0.5, tolerance(1e-12));
  // Twenty times tau, of which a pilot finds sqrt(2/256) and the friction is a matter of taste.
  BOOST_TEST(report.length >= 20.0 * report.tau);
  BOOST_TEST((report.tau > 0.7 && report.tau < 3.0));
  const std::string said = papers().description();
  for (const char* words : {"gibbs(temperature=0.125", "fpu_law(omega=50)", "friction", "step"})
    BOOST_TEST(said.find(words) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(lanes_beyond_the_last_trajectory_have_the_state_of_the_first) {
  const auto filled = detail::sound_starts<lanes>(in_the_papers_bath, papers(), seed(7), 3, 5);
  for (int k = 1; k < 5; ++k) BOOST_TEST(!same_bits(lane(filled, k), lane(filled, 0)));
  for (int k = 5; k < width; ++k) BOOST_TEST(same_bits(lane(filled, k), lane(filled, 0)));
  BOOST_TEST(same_bits(lane(filled, 0), papers_states()[3]));
  BOOST_TEST(!same_bits(lane(filled, 0), papers()(seed(8), 3)));
}

// x = U^T M^{1/2} q and y = U^T M^{-1/2} p: <w^2 x^2> = <y^2> = kT for each mode.
BOOST_AUTO_TEST_CASE(every_mode_of_a_linear_chain_has_the_temperature) {
  constexpr Eigen::Index size = 100;
  constexpr int states = 4000;
  const Eigen::VectorXd masses = Eigen::VectorXd::LinSpaced(size, 1.0, 9.0);
  Eigen::MatrixXd stiffness = 2.0 * Eigen::MatrixXd::Identity(size, size);
  for (const Eigen::Index side : {-1, 1}) stiffness.diagonal(side).setConstant(-1.0);
  const linear_chain chain(stiffness, masses);
  const normal_modes modes = chain.modes();
  const gibbs_of_modes<Eigen::Dynamic> law(chain, 0.7);
  Eigen::ArrayXd of_x = Eigen::ArrayXd::Zero(size);
  Eigen::ArrayXd of_y = of_x;
  Eigen::ArrayXd without_masses = of_x;
  for (std::uint64_t n = 0; n < states; ++n) {
    const auto start = law(seed(3), n);
    const Eigen::VectorXd x = modes.basis.transpose() * start.q.cwiseProduct(masses.cwiseSqrt());
    const Eigen::VectorXd y = modes.basis.transpose() * start.p.cwiseQuotient(masses.cwiseSqrt());
    of_x += x.cwiseProduct(modes.frequencies).array().square() / (0.7 * states);
    of_y += y.array().square() / (0.7 * states);
    without_masses += (modes.basis.transpose() * start.p).array().square() / (0.7 * states);
  }
  const double error = standard_errors(false_alarms / 200) * std::sqrt(2.0 / states);  // of a normal variance
  BOOST_TEST((of_x - 1.0).abs().maxCoeff() < error);
  BOOST_TEST((of_y - 1.0).abs().maxCoeff() < error);
  BOOST_TEST((of_x - 1.3).abs().minCoeff() > error);  // no mode has another temperature
  BOOST_TEST((without_masses - 1.0).abs().maxCoeff() > error);
}

// With friction 2 omega, x" = -2 omega x' - omega^2 x + noise: rho_q(t) = (1 + omega t) e^{-omega t}, and
// rho of q^2 is its square: tau = 2 int (1 + s)^2 e^{-2 s} ds/omega = 2.5/omega. For p, (1 - s) in place of
// (1 + s): 0.5/omega. A pilot knows tau to sqrt(2/1024) = 4.4 %, and its finite time adds 1/32.
BOOST_AUTO_TEST_CASE(tau_of_a_damped_oscillator_is_that_of_theory) {
  const gibbs ensemble(at(0.7, oscillator), around_0, {.friction = 6.0, .pilots = 1024, .seed = seed(1)});
  BOOST_TEST(std::abs(ensemble.report().tau * 3.0 / 2.5 - 1.0) <=
             standard_errors(false_alarms) * 0.044 + 1.0 / 32.0);
  BOOST_TEST(ensemble.report().length >= 20.0 * ensemble.report().tau);
}

BOOST_AUTO_TEST_CASE(the_friction_is_one_that_forgets) {
  const gibbs ensemble(at(0.7, oscillator), around_0);
  const gibbs slow(at(0.7, oscillator), around_0, {.friction = 0.01 * 3.0});
  BOOST_TEST(ensemble.report().tau < 0.1 * slow.report().tau);
}

BOOST_AUTO_TEST_CASE(a_burn_in_that_is_too_short_is_refused) {
  for (const double length : {0.1, 1.0}) {
    const burn_in_options options{.friction = 6.0, .length = length};
    BOOST_TEST(refuses<failure>([&] { gibbs(at(0.7, oscillator), far_off, options); },
                                {"gibbs", "after a burn-in of", "burn in for longer"}));
  }
  const gibbs enough(at(0.7, oscillator), far_off, {.friction = 6.0, .length = 10.0});
  BOOST_TEST(enough.report().length >= 10.0);
  BOOST_TEST(enough.report().length < 10.2);
}

// Starts of energies about 5 in baths up to 10^300 times colder, in units of kT.
BOOST_AUTO_TEST_CASE(a_bath_may_be_much_colder_than_the_starts) {
  for (const double cold : {1e-4, 1e-30, 1e-300}) {
    const gibbs ensemble(at(cold, oscillator), around_0, {.pilots = 64, .seed = seed(1)});
    std::vector<double> potentials;
    for (std::uint64_t n = 0; n < 200; ++n)
      potentials.push_back(oscillator.potential(ensemble(seed(3), n).q) / cold);
    const double off = mean_off(potentials, 0.5, std::sqrt(covariance(potentials, potentials)));
    BOOST_TEST(off <= standard_errors(false_alarms), "kT = " << cold << ": off by " << off);
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const burn_in_report::discrepancy overflowed :
       {burn_in_report::discrepancy{1.0, infinity}, burn_in_report::discrepancy{std::nan(""), 1.0}})
    BOOST_TEST(overflowed.shows());
}

// Most thermal frequency sqrt(3 q^2) is about 2: a step of 1 is too large, and 1/4 shows no bias.
BOOST_AUTO_TEST_CASE(a_step_with_a_bias_is_halved) {
  const gibbs coarse(at(1.0, quartic{}), around_0, {.friction = 1.0, .step = 1.0});
  const gibbs fine(at(1.0, quartic{}), around_0, {.friction = 1.0, .step = 0.125});
  BOOST_TEST(coarse.report().halvings >= 1);
  BOOST_TEST(coarse.report().step <= 0.5);
  BOOST_TEST(fine.report().halvings == 0);
  for (const auto* found : {&coarse.report(), &fine.report()}) {
    BOOST_TEST(!found->of(found->bias, burn_in_report::watched::potential).shows());
    BOOST_TEST(!found->of(found->excess, burn_in_report::watched::virial).shows());
  }
  BOOST_TEST(potential_off(quartic{}, coarse, seed(3), 0.25) <= standard_errors(false_alarms));
}

BOOST_AUTO_TEST_CASE(where_the_motion_is_free_the_virial_does_not_count) {
  BOOST_TEST(!gibbs(at(4.0, pendulum{}), around_0).report().confined);  // it turns over
  BOOST_TEST(gibbs(at(0.1, pendulum{}), around_0).report().confined);
}

BOOST_AUTO_TEST_CASE(a_force_without_a_potential_will_do) {
  const gibbs ensemble(at(0.1, black_box{}), around_0, {.friction = 1.0, .step = 0.5, .pilots = 64});
  BOOST_TEST(ensemble.report().tau > 0.0);
  BOOST_TEST(ensemble.report().of(ensemble.report().bias, burn_in_report::watched::potential).mean == 0.0);
}

BOOST_AUTO_TEST_CASE(what_never_has_the_law_is_refused) {
  const auto free = at(0.1, henon_heiles{});
  const auto bound = [](double temperature, const burn_in_options& options) {
    return [=] { gibbs(at(temperature, oscillator), around_0, options); };
  };
  BOOST_TEST(gibbs(at(1.0, oscillator), around_0, {.friction = 1.0, .step = 200.0}).report().step * 3.0 <
             2.0);
  BOOST_TEST(refuses<failure>(bound(0.7, {.friction = 1e-4, .most_steps = 4096}),
                              {"gibbs", "must become stationary", "4096 steps"}));
  BOOST_TEST(refuses<failure>([&] { gibbs(free, near_0); }, {"gibbs", "pilot chain", "diverged at time",
                                                             "must be confined", "henon_heiles()"}));
  BOOST_TEST(refuses<failure>([] { gibbs(at(1.0, half_line{}), near_0); }, {"must be confined", "left and"}));
  BOOST_TEST(
      refuses<failure>([&] { one_long_trajectory(free, near_0); }, {"diverged at time", "henon_heiles()"}));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const burn_in_options& options, said words,
                          const bath& heat_bath = bath::of_temperature(0.01, 1.0)) {
    return refuses([&] { gibbs(in_bath(oscillator, heat_bath), around_0, options); }, words);
  };
  BOOST_TEST(refused({}, {"gibbs", "must have a temperature"}, bath::of_sigma(0.0, 0.1)));
  BOOST_TEST(refused({}, {"gibbs", "must have a temperature"}, bath::of_sigma(0.0, 0.0)));
  BOOST_TEST(refused({}, {"gibbs", "temperature must be > 0", "rests"}, bath::of_sigma(0.1, 0.0)));
  BOOST_TEST(refused({.friction = -1.0}, {"friction", "positive"}));
  BOOST_TEST(refused({.step = -1.0}, {"step", "positive"}));
  BOOST_TEST(refused({.length = std::nan("")}, {"length", "positive"}));
  BOOST_TEST(refused({.pilots = 3}, {"pilots must be 16 to", "got 3"}));
  BOOST_TEST(refused({.execution = {.threads = 0}}, {"thread"}));
  BOOST_TEST(
      refuses([] { gibbs(at(1.0, no_force{}), around_0); }, {"gibbs", "frequencies or forces", "a step"}));
  const auto springs = linear_chain::between_walls(4, 1.0);
  using of_chain = gibbs_of_modes<Eigen::Dynamic>;
  BOOST_TEST(refuses([&] { of_chain(springs, 0.0); }, {"temperature", "above 0"}));
  BOOST_TEST(refuses([&] { of_chain(springs, -1.0); }, {"linear_chain", "temperature"}));
  BOOST_TEST(refuses([] { gibbs_of_modes<6>(fpu_chain<3>(50.0), 1.0); }, {"exact_linear"}));
  const std::vector<long_trajectory_options> unsound{
      {.length = -1.0},        {.length = 10.0, .burn_in = 10.0},
      {.burn_in = -1.0},       {.step = -0.1},
      {.step = 1e-9},          {.most_states = 0},
      {.most_states = 100'001}};
  for (const auto& options : unsound) {
    BOOST_TEST(
        refuses([&] { one_long_trajectory(in_a_bath, law, options); }, {"one_long_trajectory", "must hold"}));
  }
  BOOST_TEST(
      refuses([] { one_long_trajectory(in_a_bath, law, {.length = 0.1, .burn_in = 0.09, .step = 0.04}); },
              {"must leave a state"}));
}

// Its frequency sqrt(3 q^2) at the starts, of at most some 10^-5, would let steps be 10^5 times too large.
BOOST_AUTO_TEST_CASE(starts_may_be_much_colder_than_the_bath) {
  const gibbs ensemble(at(1.0, quartic{}), normal_around<1>({vector_1(0.0), vector_1(0.0)}, 1e-6, 1e-6));
  BOOST_TEST(ensemble.report().halvings > 10);
  BOOST_TEST(potential_off(quartic{}, ensemble, seed(3), 0.25) <= standard_errors(false_alarms));
}

// exp(-|q|/kT): nothing oscillates, and <|q|> = kT.
BOOST_AUTO_TEST_CASE(a_force_without_a_frequency_has_a_step) {
  const gibbs ensemble(at(2.0, cusp{}), around_0);
  BOOST_TEST(potential_off(cusp{}, ensemble, seed(4), 2.0) <= standard_errors(false_alarms));
}

// I forgets in 1/gamma = 10: tau = 20, and of T = 20000 there are 1000 independent samples, of which 10000
// are taken with replacement: as many as 909. Its mean is 3 kT, its variance 3 kT^2 = 0.047 with the relative
// error sqrt(4/909) (kurtosis 5), where momenta have 1 - z^2/4 of their variance, z = omega h = .5, by
// BAOAB's step. A start with I_0 = 40 adds about (I_0 - 3 kT)^2 (10/2)/T = 0.39, eight times that.
BOOST_AUTO_TEST_CASE(without_a_burn_in_the_way_down_stays_in_the_sample) {
  constexpr double of_momenta = 1.0 - 0.25 * 0.5 * 0.5;
  constexpr double expected = 3.0 * kT * 0.5 * (1.0 + of_momenta);
  constexpr double variance = 3.0 * kT * kT * 0.5 * (1.0 + of_momenta * of_momenta);
  constexpr double independent = 909.0;
  const double allowed = standard_errors(false_alarms / 2);
  const double error = std::sqrt(4.0 / independent);
  const vector<double, 6> momenta = chain.modes().basis.col(3) * std::sqrt(80.0);
  const normal_around<6> hot({vector<double, 6>::Zero(), momenta}, 0.0, 0.0);
  const auto seen = [&](double burn_in) {
    return stiff_energies(one_long_trajectory(
        in_a_bath, hot, {.length = 20'000.0 + burn_in, .burn_in = burn_in, .step = 0.01, .seed = seed(1)}));
  };
  const auto raw = seen(0.0);
  const auto burned = seen(200.0);
  BOOST_TEST(covariance(raw, raw) > variance * (1.0 + allowed * error));
  BOOST_TEST(std::abs(covariance(burned, burned) / variance - 1.0) <= allowed * error);
  BOOST_TEST(mean_off(burned, expected, std::sqrt(variance)) * std::sqrt(independent / 10'000.0) <= allowed);
}

BOOST_AUTO_TEST_CASE(a_start_is_a_function_of_seed_and_number_and_one_of_few_states) {
  const in_bath system(harmonic_oscillator(1.0), bath::of_temperature(0.5, 1.0));
  const long_trajectory_options options{
      .length = 1000.0, .burn_in = 20.0, .step = 0.5, .most_states = 100, .seed = seed(1)};
  const one_long_trajectory ensemble(system, around_0, options);
  const one_long_trajectory again(system, around_0, options);
  BOOST_TEST(ensemble.states() > 50U);
  BOOST_TEST(ensemble.states() <= 100U);
  std::vector<double> seen;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    BOOST_TEST(same_bits(ensemble(seed(1), n), again(seed(1), n)));
    seen.push_back(ensemble(seed(1), n).q[0]);
  }
  BOOST_TEST(ensemble(1, 3).q != ensemble(2, 3).q);
  const std::vector<double> front(seen.begin(), seen.end() - 1);
  const std::vector<double> back(seen.begin() + 1, seen.end());
  BOOST_TEST(correlation_off(front, back) <= standard_errors(false_alarms));
  std::sort(seen.begin(), seen.end());
  const auto different = std::unique(seen.begin(), seen.end()) - seen.begin();
  // of 100 states each is missed by 2000 picks with a probability of e^{-20}
  BOOST_TEST(different == static_cast<std::ptrdiff_t>(ensemble.states()));
  BOOST_TEST(ensemble.description().find("one_long_trajectory(length=1000, burn_in=20, step=0.5, seed=" +
                                         std::to_string(seed(1))) == 0U);
}
