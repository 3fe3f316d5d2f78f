// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 8 s at -O0, 0.9 s at -O1.
// States of Gibbs ensembles, by chains and by the modes of linear systems, have its law, are independent, and
// are a function of seed and number.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using lanes = pack<double>;
constexpr int width = lanes::lanes;
constexpr std::int64_t count = 4096;
constexpr double omega = 50.0;
const fpu_chain<3> chain(omega);
const in_bath in_the_papers_bath(chain, bath::of_sigma(0.01, 0.05));
constexpr double kT = 0.05 * 0.05 / 0.02;

/// Made once: most of the time of this test.
const gibbs<6>& papers() {
  static const gibbs ensemble(in_the_papers_bath, fpu_law<3>(chain), {.seed = seed(1)});
  return ensemble;
}

template <class S, class E>
auto states_of(const S& system, const E& ensemble, std::uint64_t which) {
  std::vector<phase_point<double, S::dimension>> result;
  for (std::int64_t first = 0; first < count; first += width) {
    const auto all = sound_starts<lanes>(system, ensemble, which, first, width);
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
double in_standard_errors(double correlation) {
  return std::abs(correlation) * std::sqrt(static_cast<double>(count));
}

}  // namespace

// I is a sum of 6 squares of normal numbers, kT/2 each: mean 3 kT, variance 3 kT^2, fourth central moment
// 3 (variance)^2 + 6 * 12 (kT/2)^4 = 2 * 9 kT^4 + ... : kurtosis 3 + 12/6 = 5, so the variance has the
// relative error sqrt(4/count).
BOOST_AUTO_TEST_CASE(the_stiff_energy_has_mean_and_variance_of_its_law) {
  const auto energy = numbers(papers_states(), [](const auto& x) { return chain.stiff_energy(x); });
  const double allowed = standard_errors(false_alarms / 2);
  BOOST_TEST(mean_off(energy, 3.0 * kT, std::sqrt(3.0) * kT) <= allowed);
  const double variance = covariance(energy, energy) / (3.0 * kT * kT);
  BOOST_TEST(std::abs(variance - 1.0) <= allowed * std::sqrt(4.0 / count));
  const auto of_law = numbers(states_of(chain, fpu_law<3>(chain), seed(7)),
                              [](const auto& x) { return chain.stiff_energy(x); });
  BOOST_TEST(mean_off(of_law, 3.0 * kT, std::sqrt(3.0) * kT) > allowed);  // where the chains begin
}

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
    BOOST_TEST(in_standard_errors(correlation(q, p)) <= standard_errors(each));
  }
}

BOOST_AUTO_TEST_CASE(trajectories_and_seeds_are_independent) {
  const auto neighbours = [](std::vector<double> x) {
    std::vector<double> next(x.begin() + 1, x.end());
    x.pop_back();
    return correlation(x, next);
  };
  const double allowed = standard_errors(false_alarms / 3);
  const auto slow = [](const auto& x) { return x.q[0] + x.q[1]; };
  const auto fast = [](const auto& x) { return x.q[1] - x.q[0]; };
  const auto other = states_of(in_the_papers_bath, papers(), seed(8));
  BOOST_TEST(in_standard_errors(neighbours(numbers(papers_states(), slow))) <= allowed);
  BOOST_TEST(in_standard_errors(neighbours(numbers(papers_states(), fast))) <= allowed);
  const auto mine = numbers(papers_states(), slow);
  BOOST_TEST(in_standard_errors(correlation(mine, numbers(other, slow))) <= allowed);
  BOOST_TEST(in_standard_errors(correlation(mine, mine)) > allowed);
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
  BOOST_TEST(report.step * chain.frequency_bands().back().high == 0.5, boost::test_tools::tolerance(1e-12));
  // Twenty times tau, of which a pilot finds sqrt(2/256) and the friction is a matter of taste.
  BOOST_TEST(report.length >= 20.0 * report.tau);
  BOOST_TEST((report.tau > 0.7 && report.tau < 3.0));
  const std::string said = papers().description();
  for (const char* words : {"gibbs(temperature=0.125", "fpu_law(omega=50)", "friction", "step"})
    BOOST_TEST(said.find(words) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(lanes_beyond_the_last_trajectory_have_the_state_of_the_first) {
  const auto filled = sound_starts<lanes>(in_the_papers_bath, papers(), seed(7), 3, 5);
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

BOOST_AUTO_TEST_CASE(modes_of_what_is_not_linear_or_has_no_temperature_are_refused) {
  const auto chain = linear_chain::between_walls(4, 1.0);
  using wrong = std::invalid_argument;
  using of_chain = gibbs_of_modes<Eigen::Dynamic>;
  BOOST_TEST(refuses<wrong>([&] { of_chain(chain, 0.0); }, {"temperature", "above 0"}));
  BOOST_TEST(refuses<wrong>([&] { of_chain(chain, -1.0); }, {"linear_chain", "temperature"}));
  BOOST_TEST(refuses<wrong>([] { gibbs_of_modes<6>(fpu_chain<3>(50.0), 1.0); }, {"exact_linear"}));
}
