// SPDX-License-Identifier: BSL-1.0
// Error measures against their formulas, on states made by hand, and the weights of samples in means over
// time.
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using lanes = pack<double>;

const auto near = tolerance(32 * eps);  // a few dozen operations

phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

/// The same state in every lane.
template <int N>
auto numbers(const error_measure& measure, const phase_point<double, N>& x) {
  return measure.numbers_of(x.template cast<lanes>());
}

/// The error of one sample, which is the same in every lane and of one trajectory alone.
template <int N>
double error_of(const error_measure& measure, const phase_point<double, N>& seen,
                const phase_point<double, N>& expected) {
  const lanes error = measure.error(numbers(measure, seen), numbers(measure, expected));
  const double alone = measure.error(measure.numbers_of(seen), measure.numbers_of(expected));
  for (int k = 0; k < pack<double>::lanes; ++k) BOOST_TEST(lane(error, k) == alone);
  return alone;
}

bool says(const error_measure& measure, said words) {
  return std::ranges::all_of(words,
                             [&](auto word) { return measure.no_scale.find(word) != std::string::npos; });
}

/// An oscillator of frequency 1 whose energy is 2 lower.
struct lowered : harmonic_oscillator {
  lowered() : harmonic_oscillator(1.0) {}
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return harmonic_oscillator::potential(q) - 2.0;
  }
};

/// A spring that is slack where it is not stretched: with lanes = 1 its energy may branch.
struct slack_spring : harmonic_oscillator {
  static constexpr int lanes = 1;
  slack_spring() : harmonic_oscillator(1.0) {}
  Eigen::Index pairs() const { return 1; }
  template <class T>
  T stiff_energy(const phase_point<T, 1>& x, Eigen::Index) const {
    if (x.q[0] < 0.0) return T(0.0);
    return 0.5 * x.q[0] * x.q[0];
  }
};

const harmonic_oscillator oscillator(3.0);
const auto position = relative_measure(oscillator, [](const auto& x) { return x.q[0]; });
const auto path_of_position = path_measure(oscillator, [](const auto& x) { return x.q[0]; });

/// The mean of t^k over samples of a step, by weights.
double mean_of_power(const detail::sample_weights& weights, double step, std::int64_t samples, int k) {
  double sum = 0.0;
  for (std::int64_t i = 0; i <= samples; ++i) {
    sum += weights(i) * std::pow(static_cast<double>(i) * step, k);
  }
  return sum / weights.total();
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_relative_error_is_relative_to_the_observable_at_each_time) {
  BOOST_TEST(position.width == 1U);
  BOOST_TEST(position.needs_reference);
  BOOST_TEST(error_of(position, at(1.25, 7.0), at(1.0, 2.0)) == 0.0625);
  BOOST_TEST(error_of(position, at(-2.0, 0.0), at(-1.0, 0.0)) == 1.0);
  BOOST_TEST(error_of(position, at(1.0, 7.0), at(1.0, 2.0)) == 0.0);
  BOOST_TEST(lane(position.scale(numbers(position, at(0.0, 1.0))), 0) == 0.0);
  BOOST_TEST(lane(position.scale(numbers(position, at(-1.0, 0.0))), 0) != 0.0);
  BOOST_TEST(says(position, {"relative error", "must not be 0", "another observable"}));
}

// (.25, 1)^2 over the mean square of the observable: the size is that of all trajectories, where one may be
// 0.
BOOST_AUTO_TEST_CASE(the_path_error_is_relative_to_the_mean_square_of_all) {
  const auto& measure = path_of_position;
  BOOST_TEST(error_of(measure, at(1.25, 7.0), at(1.0, 2.0)) == 0.0625);
  BOOST_TEST(lane(measure.relative_to(numbers(measure, at(-2.0, 1.0))), 0) == 4.0);
  BOOST_TEST(!measure.scale);
  const std::vector<double> scores{0.25, 1.0};  // roots of means over times
  const std::vector<double> sizes{0.0, 8.0};
  BOOST_TEST(measure.unit(sizes) == 2.0, near);
  BOOST_TEST(measure.average(scores, sizes).mean == 0.625 / 2.0, near);
  BOOST_TEST(measure.of_each(scores, sizes)[1] == 0.5, near);
  // d(mean/sqrt(size)) = dx/2 - (.625/2)(ds/4)/2: what the two trajectories differ by, over two, is the
  // error.
  const double apart = (1.0 - 0.25) / 2.0 - 0.3125 * (8.0 - 0.0) / 4.0 / 2.0;
  BOOST_TEST(measure.average(scores, sizes).standard_error == std::abs(apart) / 2.0, near);
}

BOOST_AUTO_TEST_CASE(the_state_error_weighs_modes_by_frequency) {
  BOOST_TEST(error_of(state_measure(oscillator), at(1.5, 2.0), at(1.0, 1.0)) == 9.0 * 0.25 + 1.0, near);
  // On the chain x_0 = (q_2 + q_1)/sqrt 2 has frequency 0, and x_1 = (q_2 - q_1)/sqrt 2 has omega.
  const fpu_chain<1> chain(50.0);
  const auto measure = state_measure(chain);
  const phase_point<double, 2> origin{{0.0, 0.0}, {0.0, 0.0}};
  const auto error = [&](double q1, double q2, double p1, double p2) {
    return error_of(measure, {{q1, q2}, {p1, p2}}, origin);
  };
  BOOST_TEST(measure.width == 4U);
  BOOST_TEST(error(1.0, 1.0, 0.0, 0.0) == 2.0, near);  // weight 1, not 0
  BOOST_TEST(error(-1.0, 1.0, 0.0, 0.0) == 2.0 * 2500.0, near);
  BOOST_TEST(error(0.0, 0.0, -1.0, 1.0) == 2.0, near);
  BOOST_TEST(error(0.0, 0.0, 3.0, 0.0) == 9.0, near);
}

// Twice the energy is the energy norm, for any masses, in all modes that have a frequency.
BOOST_AUTO_TEST_CASE(the_state_error_of_a_linear_chain_is_twice_its_energy) {
  const Eigen::MatrixXd stiffness{{3.0, -1.0, 0.0}, {-1.0, 2.0, -1.0}, {0.0, -1.0, 5.0}};
  const linear_chain chain(stiffness, Eigen::VectorXd{{1.0, 4.0, 0.25}});
  const Eigen::VectorXd q{{0.3, -0.2, 0.7}};
  const Eigen::VectorXd p{{1.0, 0.5, -2.0}};
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
  const phase_point<double, Eigen::Dynamic> x{q, p};
  const double twice = 2.0 * energy<double>(chain, x);
  // The eigenvectors of three masses are good to some 100 eps.
  BOOST_TEST(error_of(state_measure(chain), x, {zero, zero}) == twice, tolerance(1000 * eps));
  const linear_chain other(stiffness);
  BOOST_TEST(std::abs(error_of(state_measure(other), x, {zero, zero}) - twice) > 0.1);
}

BOOST_AUTO_TEST_CASE(without_modes_the_state_error_is_mass_weighted) {
  const auto measure = state_measure(two_masses());  // masses 1 and 4
  const phase_point<double, 2> origin{{0.0, 0.0}, {0.0, 0.0}};
  BOOST_TEST(error_of(measure, {{1.0, 2.0}, {3.0, 4.0}}, origin) == 1.0 + 4.0 * 4.0 + 9.0 + 16.0 / 4.0, near);
  const phase_point<double, 1> shifted = at(0.25, -1.0);
  BOOST_TEST(error_of(state_measure(relativistic()), at(0.75, -1.0), shifted) == 0.25);  // no masses at all
  struct wrong_modes : henon_heiles {
    normal_modes modes() const { return {Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Ones(1)}; }
  };
  BOOST_CHECK_NO_THROW(state_measure(henon_heiles()));
  BOOST_TEST(refuses([] { state_measure(wrong_modes()); }, {"modes of henon_heiles", "2 x 2"}));
}

// The standard error of a root is that of the mean below it, over twice the root.
BOOST_AUTO_TEST_CASE(the_root_of_all_has_its_error_by_the_delta_method) {
  const auto measure = state_measure(oscillator);
  const std::vector<double> scores{1.0, 4.0, NAN, 7.0};
  const auto below = mean_and_error(scores);
  const auto [mean, error] = measure.average(scores);
  BOOST_TEST(mean == 2.0, near);
  BOOST_TEST(error == below.standard_error / 4.0, near);
  BOOST_TEST(measure.average(std::vector<double>{0.0, 0.0}).standard_error == 0.0);
  BOOST_TEST(std::isnan(measure.average(std::vector<double>{NAN, NAN}).mean));
  BOOST_TEST(std::isnan(measure.average(std::vector<double>{4.0}).standard_error));
}

BOOST_AUTO_TEST_CASE(the_exchange_error_is_relative_to_the_whole_stiff_energy) {
  const fpu_chain<2> chain(50.0);
  const auto measure = exchange_measure(chain);
  // I_j = (p_{2j+1} - p_{2j})^2/4 where no spring is stretched.
  const auto moving = [](double first, double second) {
    return phase_point<double, 4>{{0.0, 0.0, 0.0, 0.0}, {0.0, first, 0.0, second}};
  };
  BOOST_TEST(measure.width == 2U);
  BOOST_TEST(error_of(measure, moving(2.0, 4.0), moving(4.0, 2.0)) == 3.0 + 3.0, near);  // I agrees
  BOOST_TEST(error_of(measure, moving(-4.0, 2.0), moving(4.0, 2.0)) == 0.0);
  BOOST_TEST(measure.average(std::vector<double>{0.5, 1.0}).mean == 0.75, near);
  BOOST_TEST(measure.score(3.0, 4.0) == 0.75);
  BOOST_TEST(lane(measure.relative_to(numbers(measure, moving(4.0, 2.0))), 0) == 5.0, near);
  BOOST_TEST(measure.unit(std::vector<double>{5.0, 1.0}) == 3.0, near);
  BOOST_TEST(says(measure, {"exchange error"}));
  static_assert(HasStiffEnergies<fpu_chain<>> && !HasStiffEnergies<henon_heiles>);
  // A system of one lane is not asked for more.
  const auto slack = exchange_measure(slack_spring());
  BOOST_TEST(slack.error(slack.numbers_of(at(2.0, 0.0)), slack.numbers_of(at(-2.0, 0.0))) == 2.0);
  BOOST_TEST(slack.error(slack.numbers_of(at(-1.0, 0.0)), slack.numbers_of(at(-2.0, 0.0))) == 0.0);
}

BOOST_AUTO_TEST_CASE(the_energy_error_is_relative_to_the_energies_of_the_starts) {
  const auto measure = energy_measure(oscillator);
  BOOST_TEST(!measure.needs_reference);
  const auto error = [&](const auto& seen, const auto& start) { return error_of(measure, seen, start); };
  BOOST_TEST(error(at(0.0, 3.0), at(0.0, 2.0)) == 2.5 * 2.5, near);
  BOOST_TEST(error(at(2.0 / 3.0, 0.0), at(0.0, 2.0)) == 0.0);  // the same energy elsewhere
  BOOST_TEST(measure.average(std::vector<double>{4.0, 4.0}).mean == 2.0, near);
  BOOST_TEST(lane(measure.relative_to(numbers(measure, at(0.0, 2.0))), 0) == 4.0, near);
  BOOST_TEST(measure.unit(std::vector<double>{4.0, 4.0}) == 2.0, near);
  // A negative energy is as good: 1/2 - 2 of 1 - 2.
  const auto negative = energy_measure(lowered());
  BOOST_TEST(error_of(negative, at(0.0, 1.0), at(1.0, 1.0)) == 0.25, near);
  BOOST_TEST(lane(negative.relative_to(numbers(negative, at(1.0, 1.0))), 0) == 1.0, near);
  BOOST_TEST(says(measure, {"energy error"}));
}

// Of the same mean and standard error as the whole, to rounding: also where that is a root.
BOOST_AUTO_TEST_CASE(an_error_is_the_mean_of_its_parts) {
  const std::vector<double> scores{0.5, NAN, 2.0, 0.25, 1.0};
  const std::vector<double> sizes{1.0, 2.0, 0.5, 4.0, 3.0};
  const auto check = [&](const auto& measure, const std::vector<double>& given_sizes = {}) {
    const auto parts = measure.parts(scores, given_sizes);
    const estimate whole = measure.average(scores, given_sizes);
    BOOST_TEST(mean_and_error(parts).mean == whole.mean, near);
    BOOST_TEST(mean_and_error(parts).standard_error == whole.standard_error, near);
    BOOST_TEST(std::isnan(parts[1]));
    return parts;
  };
  BOOST_TEST(check(position)[2] == 2.0);
  check(path_of_position, sizes);
  check(energy_measure(oscillator), sizes);
  BOOST_TEST(check(energy_measure(oscillator))[2] < 1.9);  // not its root, and not itself
  BOOST_TEST(energy_measure(oscillator).parts(std::vector<double>{0.0, 0.0})[1] == 0.0);
}

// Lane 1 is lost at the third sample; lane 2 holds nothing that counts; the others go on.
BOOST_AUTO_TEST_CASE(a_sum_tells_where_which_lane_was_lost) {
  detail::errors_along<lanes> errors(position);
  auto live = detail::first_lanes<lanes>(pack<double>::lanes);
  live.set(2, false);
  const std::vector<lanes> expected{lanes(1.0)};
  const auto add = [&](std::int64_t i, double lost) {
    std::vector<lanes> seen{lanes(2.0)};
    seen[0].set(1, lost);
    seen[0].set(2, NAN);
    errors.see(i, seen, expected, live);
  };
  add(1, 2.0);
  add(2, 2.0);
  BOOST_TEST(errors.score(1) == 1.0);
  BOOST_TEST(!errors.lost_at(1));
  add(3, 1e200);
  add(4, NAN);
  BOOST_TEST(errors.lost_at(1).value() == 3);
  BOOST_TEST(std::isnan(errors.score(1)));
  BOOST_TEST(errors.score(0) == 1.0);
  BOOST_TEST(errors.score(2) == 0.0);
}

// What is linear has its exact mean for any step; t^2 errs as the header says, by n^-2/2 at most. Samples
// alike leave out the start and depend on the step: ten of t^2 are 16 % above its mean, and the last of nine
// covers less.
BOOST_AUTO_TEST_CASE(means_up_to_a_horizon_are_those_of_what_lies_between) {
  for (const double step : {0.1, 0.083, 0.0999, 0.05, 0.011}) {
    const auto samples = static_cast<std::int64_t>(std::ceil(1.0 / step - 1e-9));
    const detail::sample_weights weights(step, samples, 1.0);
    const auto near = tolerance(100 * eps);  // of that many terms at most
    BOOST_TEST(weights.total() == 1.0 / step, near);
    BOOST_TEST(mean_of_power(weights, step, samples, 0) == 1.0, near);
    BOOST_TEST(mean_of_power(weights, step, samples, 1) == 0.5, near);
    BOOST_TEST(std::abs(3.0 * mean_of_power(weights, step, samples, 2) - 1.0) <= 0.51 * step * step);
  }
  const detail::sample_weights alike(10);
  for (std::int64_t i = 0; i <= 10; ++i) BOOST_TEST(alike(i) == (i > 0 ? 1.0 : 0.0));
  BOOST_TEST(alike.total() == 10.0);
  BOOST_TEST(3.0 * mean_of_power(alike, 0.1, 10, 2) > 1.15);
  BOOST_TEST(3.0 * mean_of_power(detail::sample_weights(12), 0.08, 12, 2) < 1.07);
  // A horizon ends within the last step.
  BOOST_CHECK_NO_THROW(detail::sample_weights(0.1, 10, 0.901));
  BOOST_CHECK_NO_THROW(detail::sample_weights(0.1, 3, 0.3));  // 0.30000000000000004/0.1
  BOOST_CHECK_NO_THROW(detail::sample_weights(-0.1, 10, 1.0));
  for (const double horizon : {0.9, 1.1, 0.0, -1.0, std::nan("")}) {
    BOOST_TEST(refuses([&] { detail::sample_weights(0.1, 10, horizon); },
                       {"sample_weights: horizon must lie", "10 steps of 0.1"}));
  }
}
