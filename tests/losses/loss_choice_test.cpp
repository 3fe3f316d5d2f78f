// SPDX-License-Identifier: BSL-1.0
// A loss by its name, and the stages through which it is minimised; the coordinates and weights in which an
// error counts; and the loss gaussian_acceptance: its value, its gradient, and what is learned by it without
// data.
#include "nysalt/losses/loss_choice.hpp"

#include <boost/math/special_functions/erf.hpp>

#include "../support/draws.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/acceptance.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <class F>
objective loss_of(const F& family, const model& system, double step) {
  return loss_named("gaussian_acceptance").kind->without_data(system, nysalt::family(family), step);
}

std::vector<std::vector<int>> times(const char* loss, int shortest) {
  const loss_choice choice = loss_named(loss);
  std::vector<std::vector<int>> result;
  for (const auto& stage : choice.kind->stages(choice.steps, shortest)) result.push_back(stage.steps);
  return result;
}

using several = std::vector<std::vector<int>>;

constexpr int dynamic = Eigen::Dynamic;
using point = phase_point<double, dynamic>;

/// Two masses, 1 and 4, on three springs.
const linear_chain chain(Eigen::Matrix2d{{3.0, -1.0}, {-1.0, 2.0}}, Eigen::Vector2d(1.0, 4.0));
flow_map_data data_of_seed(std::uint64_t seed = 1) {
  return make_flow_map_data(chain, around_rest<dynamic>(0.3, 0.7, chain.size()), exact_linear(chain),
                            {.step = 0.3, .horizon = 1.5, .trajectories = 9, .seed = seed});
}
/// Row n: the residuals of the increment of pair n.
Eigen::MatrixXd increments(const metric& measure, const flow_map_data& data) {
  Eigen::MatrixXd result(measure.residuals(), static_cast<Eigen::Index>(data.pairs()));
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    measure.residual(data.finish[n].q, data.finish[n].p, data.start[n], result.col(Eigen::Index(n)).data());
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_loss_is_the_expected_energy_error) {
  const linear_chain chain = linear_chain::between_walls(5, 3.0);
  const Eigen::VectorXd modes = chain.modes().frequencies;
  const std::vector<double> frequencies(modes.begin(), modes.end());
  const auto loss = loss_of(bab<3>{}, chain, 0.4);
  const auto theta_of = [](const auto& method) {
    const auto c = method.coefficients();
    return Eigen::VectorXd(Eigen::Vector2d(c[0], c[1]));
  };
  const double expected = detail::gaussian_energy_error(nysalt::method(bcss3{}), frequencies, 0.4);
  // Sums of five terms, each right to some hundred roundings over z^2, the least 1.2.
  BOOST_TEST(loss(theta_of(bcss3{})).value == expected, tolerance(1e-12));
  BOOST_TEST(std::abs(loss(theta_of(predescu3{})).value / expected - 1.0) > 1e-2);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope) {
  const auto loss = loss_of(bab<4>{}, linear_chain::between_walls(5, 3.0), 0.5);
  const Eigen::VectorXd theta = Eigen::Vector3d(0.08, 0.2, 0.26);
  const Eigen::VectorXd gradient = loss(theta).gradient();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const central_difference difference([&](const auto& at) { return loss(at).value; }, theta, k);
    const double slope = difference(1e-5);  // the square of that, and rounding over it, are below 1e-9
    BOOST_TEST(std::abs(slope - gradient[k]) <= 1e-6 * std::abs(gradient[k]) + 1e-9);
    BOOST_TEST(std::abs(slope - 2.0 * gradient[k]) > 1e-3 * std::abs(slope));
  }
}

// Below z = h omega = 4 the word of four equal steps is stable, beyond 8 none.
BOOST_AUTO_TEST_CASE(where_a_word_is_not_stable_the_loss_is_infinite) {
  const Eigen::VectorXd equal = Eigen::Vector3d(0.125, 0.25, 0.25);
  BOOST_TEST(std::isfinite(loss_of(bab<4>{}, harmonic_oscillator(1.0), 3.9)(equal).value));
  BOOST_TEST(std::isinf(loss_of(bab<4>{}, harmonic_oscillator(1.0), 8.1)(equal).value));
}

// Bands without modes: the mean over frequencies of the band. The points of a band are 16.
BOOST_AUTO_TEST_CASE(bands_count_where_there_are_no_modes) {
  const auto bands = pendulum().frequency_bands();
  std::vector<double> frequencies;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < 16; ++k) frequencies.push_back(low + (high - low) * (k + 0.5) / 16.0);
  }
  const double mean = detail::gaussian_energy_error(method(bcss3{}), frequencies, 0.5) /
                      static_cast<double>(frequencies.size());
  const auto c = bcss3().coefficients();
  const auto loss = loss_of(bab<3>{}, pendulum(), 0.5);
  BOOST_TEST(loss(Eigen::Vector2d(c[0], c[1])).value == mean, tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(what_has_no_spectrum_or_no_plain_word_is_refused) {
  const linear_chain chain = linear_chain::between_walls(3, 3.0);
  BOOST_TEST(refuses([] { loss_of(bab<3>{}, kepler(), 0.1); }, {"must declare frequencies"}));
  BOOST_TEST(refuses([&] { loss_of(aba3_free{}, chain, 0.1); }, {"must be symmetric"}));
  BOOST_TEST(refuses([&] { loss_of(r_aba<2>{}, chain, 0.1); }, {"must be symmetric"}));
  BOOST_TEST(std::isfinite(loss_of(fd_chin{}, chain, 0.1)(Eigen::Vector2d(1.0 / 6.0, 1.0 / 24.0)).value));
}

// A spread spectrum: 40 of its frequencies stand for all of 10,000 dimensions, so that at the acceptance 0.9
// of these the 40 have a 250th of the energy error.
BOOST_AUTO_TEST_CASE(what_is_learned_takes_larger_steps_than_all_formulas) {
  constexpr double dimensions = 1e4;
  std::vector<double> frequencies;  // quantiles of a logarithmic normal law
  for (int k = 0; k < 40; ++k) {
    frequencies.push_back(
        std::exp(0.02 * std::numbers::sqrt2 * boost::math::erf_inv((k + 0.5) / 20.0 - 1.0)));
  }
  const double acceptance = detail::acceptance_at(energy_error_at(0.9) * 40.0 / dimensions);
  const auto step_of = [&](const method& method, double from = 0.0) {
    return nysalt::gaussian_step(method, frequencies, acceptance, from) /
           method.letters().evaluations_per_step;
  };
  double best = 0.0;
  for (const auto& rival :
       {nysalt::method(verlet{}), nysalt::method(mclachlan2v{}), nysalt::method(bcss3{}),
        nysalt::method(predescu3{}), nysalt::method(bcss4{}), nysalt::method(omelyan5v{})}) {
    best = std::max(best, step_of(rival));
  }
  const Eigen::VectorXd squares = Eigen::Map<const Eigen::VectorXd>(frequencies.data(), 40).cwiseAbs2();
  const linear_chain target{Eigen::MatrixXd(squares.asDiagonal())};
  const double step = 4.0 * 1.25 * best;
  const data_sets sets(target, gibbs_of_modes<Eigen::Dynamic>(target, 1.0), exact_linear(target),
                       {.step = step, .horizon = 2.0 * step, .trajectories = 8});
  const nysalt::family family{bab<4>{}};
  const auto [theta, fit, method] = sets.learned(family, target, {.loss = loss_named("gaussian_acceptance")});
  BOOST_TEST(fit.usable, fit.reason);
  BOOST_TEST(fit.loss_name == "gaussian_acceptance");
  BOOST_TEST(!fit.is_of_data);
  const double learned = step_of(method.anywhere(), step);
  BOOST_TEST(learned > 1.15 * best, learned << " and " << best);
  BOOST_TEST(learned < 1.5 * best);
}

BOOST_AUTO_TEST_CASE(names_are_understood_and_told_again) {
  for (const auto& [text, name, steps] :
       std::vector<std::tuple<const char*, std::string_view, int>>{{"state", "state", 1},
                                                                   {"trajectory", "trajectory", 1},
                                                                   {"state:5", "state", 5},
                                                                   {"energy", "energy", 1},
                                                                   {"energy:10", "energy", 10},
                                                                   {"covariance", "covariance", 1}}) {
    BOOST_TEST((loss_named(text).kind->name == name && loss_named(text).steps == steps), text);
  }
  BOOST_TEST((loss_named("trajectory") == loss_choice{}));
  BOOST_TEST((loss_named("state:5") != loss_named("state:6")));
  for (const char* name :
       {"trajectory", "state:1", "state:5", "energy:10", "acceptance", "gaussian_acceptance", "covariance"}) {
    BOOST_TEST(loss_named(name).description() == name);
  }
  // Each says what it needs.
  for (const auto& kind : losses()) {
    BOOST_TEST(loss_named(kind->name).kind == kind);
    BOOST_TEST(static_cast<bool>(kind->over_data));
    BOOST_TEST((kind->asks_data() || !kind->counts_steps));
  }
  BOOST_TEST(detail::loss_patterns(true) == "state:K, energy:K");
  BOOST_TEST(detail::loss_patterns(false) == "trajectory, acceptance, gaussian_acceptance, covariance");
}

BOOST_AUTO_TEST_CASE(what_is_no_name_is_refused) {
  for (const char* name : {"", "State", "states", "state:", "state:0", "state:05", "state:-5", "state:+5",
                           "state: 5", "state:5 ", "state:5.0", "state:five", "state:5:6",
                           "energy:99999999999", "covariance:3", "covariance:", ":5"}) {
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(refuses([&] { loss_named(name); }, {name, "state:K", "energy:K", "covariance"}));
    }
  }
}

BOOST_AUTO_TEST_CASE(stages_lead_from_a_few_steps_to_whole_trajectories) {
  const auto stages = times("trajectory", 320);
  BOOST_TEST_REQUIRE(stages.size() == 3U);
  BOOST_TEST((stages[0] == std::vector{1, 2, 4}));
  BOOST_TEST((stages[1] == std::vector{1, 4, 9, 16}));
  BOOST_TEST_REQUIRE(stages[2].size() == 16U);
  BOOST_TEST(stages[2].front() == 20);
  BOOST_TEST(stages[2].back() == 320);
  // Early stages use a few windows, and the last all.
  const auto& kind = *loss_named("trajectory").kind;
  for (const int shortest : {17, 100, 320}) {
    const auto some = kind.stages(1, shortest);
    for (std::size_t n = 0; n + 1 < some.size(); ++n) {
      BOOST_TEST(some[n].apart >= some[n].steps.back());
      BOOST_TEST(shortest / some[n].apart <= 2);
    }
    BOOST_TEST(some.back().apart == shortest);
  }
  // Short trajectories have fewer stages.
  BOOST_TEST((times("trajectory", 1) == several{{1}}));
  BOOST_TEST((times("trajectory", 3) == several{{1, 2, 3}}));
  BOOST_TEST((times("trajectory", 4) == several{{1, 2, 3, 4}}));
  BOOST_TEST(times("trajectory", 5).size() == 2U);
  BOOST_TEST(times("trajectory", 16).size() == 2U);
  BOOST_TEST(times("trajectory", 17).size() == 3U);
  // Losses after K steps use a few windows first.
  BOOST_TEST((times("state:1", 320) == several{{1}, {1}}));
  BOOST_TEST((times("energy:7", 320) == several{{7}, {7}}));
  const auto of_five = loss_named("state:5").kind->stages(5, 320);
  BOOST_TEST(of_five[0].apart == 80);
  BOOST_TEST(of_five[1].apart == 1);
}

BOOST_AUTO_TEST_CASE(each_coordinate_is_measured_in_its_mean_square_increment) {
  const auto data = data_of_seed();
  for (const auto which : {coordinates::qp, coordinates::modes, coordinates::energy}) {
    const Eigen::VectorXd mean_squares =
        increments(metric(chain, data, which), data).rowwise().squaredNorm() / double(data.pairs());
    BOOST_TEST(mean_squares.size() == 4);
    // 45 squares are added, twice.
    BOOST_TEST(std::abs(mean_squares.mean() - 1.0) <= 2 * 45 * eps);
    const double off = (mean_squares.array() - 1.0).abs().maxCoeff();
    BOOST_TEST(
        (which == coordinates::energy ? off > 1e-3 : off <= 2 * 45 * eps));  // there one weight for all
  }
}

BOOST_AUTO_TEST_CASE(the_energy_coordinates_are_the_energy_norm) {
  const auto data = data_of_seed();
  draws random;
  Eigen::Vector4d r;
  const auto ratio = [&](const metric& measure) {
    const auto a = random.state(chain, 1.0);
    const auto b = random.state(chain, 1.0);
    measure.residual(a.q, a.p, b, r.data());
    return r.squaredNorm() / energy<double>(chain, point{a.q - b.q, a.p - b.p});
  };
  const metric by_energy(chain, data, coordinates::energy);
  BOOST_TEST(std::abs(ratio(by_energy) / ratio(by_energy) - 1.0) <= 60 * eps);  // some 30 operations, twice
  const metric by_modes(chain, data, coordinates::modes);
  BOOST_TEST(std::abs(ratio(by_modes) / ratio(by_modes) - 1.0) > 1e-3);
}

BOOST_AUTO_TEST_CASE(coordinates_without_motion_are_named_and_left_out) {
  const auto dropped = [](const linear_chain& chain, const point& start, coordinates which) {
    const auto data = make_flow_map_data(chain, listed<dynamic>({start}), exact_linear(chain),
                                         {.step = 0.3, .horizon = 3.0, .trajectories = 1});
    const metric measure(chain, data, which);
    BOOST_TEST(measure.residuals() + std::ssize(measure.dropped()) == 2 * chain.size());
    return measure.dropped();
  };
  using names = std::vector<std::string>;
  const linear_chain one_held(Eigen::Matrix2d{{2.0, 0.0}, {0.0, 0.0}});
  const point one_at_rest{Eigen::Vector2d(0.3, 1.0), Eigen::Vector2d(0.2, 0.0)};
  BOOST_TEST((dropped(one_held, one_at_rest, coordinates::qp) == names{"q2", "p2"}));
  BOOST_TEST((dropped(one_held, one_at_rest, coordinates::modes) == names{"x1", "y1"}));
  // Three masses that swing in their first mode: the others move by rounding, and would weigh 1e15.
  const auto three = linear_chain::between_walls(3, 1.0);
  const point first_mode{three.modes().basis.col(0), Eigen::VectorXd::Zero(3)};
  BOOST_TEST((dropped(three, first_mode, coordinates::modes) == names{"x2", "x3", "y2", "y3"}));
  BOOST_TEST((dropped(three, first_mode, coordinates::qp) == names{}));  // there all move
}

// What a trajectory adds to the weights, found by giving it twice: Sigma is a mean over pairs.
BOOST_AUTO_TEST_CASE(weight_deviations_are_what_a_trajectory_adds_to_the_weights) {
  const auto data = data_of_seed();
  const metric measure(chain, data, coordinates::qp);
  const auto deviations = measure.weight_deviations();
  BOOST_TEST(deviations.rows() == 4);
  BOOST_TEST(deviations.cols() == 9);
  BOOST_TEST(deviations.rowwise().sum().cwiseAbs().maxCoeff() <= 45 * eps);
  auto twice = data;
  for (std::size_t n = data.first_of[3]; n < data.first_of[4]; ++n) {
    twice.start.push_back(data.start[n]);
    twice.finish.push_back(data.finish[n]);
  }
  twice.first_of.push_back(twice.pairs());
  const metric heavier(chain, twice, coordinates::qp);
  const double share = 1.0 / 9.0;
  const Eigen::MatrixXd before = increments(measure, data);
  const Eigen::MatrixXd after = increments(heavier, data);
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double ratio = before(k, 0) / after(k, 0);  // of the roots of Sigma, after over before
    const double expected = deviations(k, 3) / (1.0 + share);
    BOOST_TEST(std::abs(ratio * ratio - 1.0 - expected) <= 4 * 45 * eps);
    BOOST_TEST(std::abs(expected) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(weight_deviations_of_other_trajectories_are_those_among_each_other) {
  const auto data = data_of_seed();
  const metric measure(chain, data, coordinates::qp);
  const Eigen::MatrixXd known = measure.weight_deviations();
  BOOST_TEST((measure.weight_deviations(data) - known).cwiseAbs().maxCoeff() <= 45 * eps);
  auto wider = data;
  for (std::size_t n = 0; n < wider.pairs(); ++n) {  // increments twice as large
    wider.finish[n].q += wider.finish[n].q - wider.start[n].q;
    wider.finish[n].p += wider.finish[n].p - wider.start[n].p;
  }
  BOOST_TEST((measure.weight_deviations(wider) - known).cwiseAbs().maxCoeff() <= 4 * 45 * eps);
  const metric own(chain, wider, coordinates::qp);  // whose weights are half as large
  BOOST_TEST((own.weight_deviations() - known).cwiseAbs().maxCoeff() <= 4 * 45 * eps);
  const Eigen::MatrixXd found = measure.weight_deviations(data_of_seed(2));
  BOOST_TEST((found - known).cwiseAbs().maxCoeff() > 1e-2);
  BOOST_TEST(found.rowwise().sum().cwiseAbs().maxCoeff() <= 45 * eps);
}

BOOST_AUTO_TEST_CASE(coordinates_that_do_not_exist_are_refused) {
  const pendulum swing;
  const data_options options{.step = 0.1, .trajectories = 2};
  const auto of_swing = make_flow_map_data(swing, around_rest<1>(0.1, 0.1), fine_steps(0.01), options);
  for (const auto which : {coordinates::modes, coordinates::energy}) {
    BOOST_TEST(refuses([&] { metric(swing, of_swing, which); },
                       {to_string(which), "pendulum()", "must have modes()", "use qp"}));
  }
  const auto of_nothing = make_flow_map_data(swing, around_rest<1>(0.0, 0.0), fine_steps(0.01), options);
  BOOST_TEST(refuses([&] { metric(swing, of_nothing, coordinates::qp); }, {"must hold motion"}));
}
