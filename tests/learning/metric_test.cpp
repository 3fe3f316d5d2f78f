// SPDX-License-Identifier: BSL-1.0
// The coordinates and weights in which an error counts, and that what is learned depends on them.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int dynamic = Eigen::Dynamic;
using point = phase_point<double, dynamic>;

/// Two masses, 1 and 4, on three springs.
linear_chain two_weights_on_springs() {
  Eigen::Matrix2d stiffness;
  stiffness << 3.0, -1.0, -1.0, 2.0;
  return linear_chain(stiffness, Eigen::Vector2d(1.0, 4.0));
}
flow_map_data data_of(const linear_chain& chain) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.size());
  const normal_around<dynamic> starts({zero, zero}, 0.3, 0.7);
  return make_flow_map_data(chain, starts, exact_linear(chain),
                            {.step = 0.3, .horizon = 1.5, .trajectories = 9});
}
/// Row n: the residuals of the increment of pair n.
Eigen::MatrixXd increments(const metric& measure, const flow_map_data& data) {
  Eigen::MatrixXd result(measure.residuals(), static_cast<Eigen::Index>(data.pairs()));
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    measure.residual(data.finish[n].q, data.finish[n].p, data.start[n], result.col(Eigen::Index(n)).data());
  }
  return result;
}
double quadratic_energy(const linear_chain& chain, const point& a, const point& b) {
  return energy<double>(chain, point{a.q - b.q, a.p - b.p});
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_coordinate_is_measured_in_its_mean_square_increment) {
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
  for (const auto which : {coordinates::qp, coordinates::modes}) {
    const metric measure(chain, data, which);
    const Eigen::VectorXd mean_squares =
        increments(measure, data).rowwise().squaredNorm() / double(data.pairs());
    BOOST_TEST(mean_squares.size() == 4);
    // 45 squares are added, twice.
    BOOST_TEST((mean_squares.array() - 1.0).abs().maxCoeff() <= 2 * 45 * eps);
  }
  const metric by_energy(chain, data, coordinates::energy);
  const Eigen::VectorXd mean_squares =
      increments(by_energy, data).rowwise().squaredNorm() / double(data.pairs());
  BOOST_TEST((mean_squares.array() - 1.0).abs().maxCoeff() > 1e-3);  // one weight for all
  BOOST_TEST(std::abs(mean_squares.mean() - 1.0) <= 2 * 45 * eps);
}

BOOST_AUTO_TEST_CASE(the_energy_coordinates_are_the_energy_norm) {
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
  const metric by_energy(chain, data, coordinates::energy);
  const metric by_modes(chain, data, coordinates::modes);
  draws random;
  Eigen::Vector4d r;
  const auto ratio = [&](const metric& measure) {
    const auto a = random.state(chain, 1.0);
    const auto b = random.state(chain, 1.0);
    measure.residual(a.q, a.p, b, r.data());
    return r.squaredNorm() / quadratic_energy(chain, a, b);
  };
  const double constant = ratio(by_energy);
  const double other = ratio(by_modes);
  BOOST_TEST_CONTEXT("seed " << draws::seed) {
    BOOST_TEST(std::abs(ratio(by_energy) / constant - 1.0) <= 60 * eps);  // some 30 operations, twice
    BOOST_TEST(std::abs(ratio(by_modes) / other - 1.0) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(coordinates_without_motion_are_named_and_left_out) {
  Eigen::Matrix2d stiffness;
  stiffness << 2.0, 0.0, 0.0, 0.0;
  const linear_chain chain(stiffness);  // the second mass is free, and at rest
  const listed<dynamic> starts({{Eigen::Vector2d(0.3, 1.0), Eigen::Vector2d(0.2, 0.0)}});
  const auto data = make_flow_map_data(chain, starts, exact_linear(chain), {.step = 0.3, .trajectories = 1});
  const metric measure(chain, data, coordinates::qp);
  BOOST_TEST(measure.residuals() == 2);
  BOOST_TEST(measure.dropped() == (std::vector<std::string>{"q2", "p2"}), boost::test_tools::per_element());
  const metric by_modes(chain, data, coordinates::modes);
  BOOST_TEST(by_modes.dropped() == (std::vector<std::string>{"x1", "y1"}), boost::test_tools::per_element());
  BOOST_TEST(
      metric(two_weights_on_springs(), data_of(two_weights_on_springs()), coordinates::qp).dropped().empty());
}

// What a trajectory adds to the weights, found by giving it twice: Sigma is a mean over pairs.
BOOST_AUTO_TEST_CASE(weight_deviations_are_what_a_trajectory_adds_to_the_weights) {
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
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

BOOST_AUTO_TEST_CASE(coordinates_that_do_not_exist_are_refused) {
  using wrong = std::invalid_argument;
  const pendulum swing;
  const normal_around<1> swings({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.1, 0.1);
  const auto of_swing =
      make_flow_map_data(swing, swings, fine_steps<>(0.01), {.step = 0.1, .trajectories = 2});
  for (const auto which : {coordinates::modes, coordinates::energy}) {
    BOOST_TEST(refuses<wrong>([&] { metric(swing, of_swing, which); },
                              {to_string(which), "pendulum()", "must have modes()", "use qp"}));
  }
  const listed<1> at_rest({{vector<double, 1>(0.0), vector<double, 1>(0.0)}});
  const auto of_nothing =
      make_flow_map_data(swing, at_rest, fine_steps<>(0.01), {.step = 0.1, .trajectories = 1});
  BOOST_TEST(refuses<wrong>([&] { metric(swing, of_nothing, coordinates::qp); }, {"must hold motion"}));
}

BOOST_AUTO_TEST_CASE(motion_below_rounding_is_none) {
  // Three masses that swing in their first mode: the others move by rounding, and would weigh 1e15.
  const auto three = linear_chain::between_walls(3, 1.0);
  const normal_modes modes = three.modes();
  const listed<dynamic> starts({{modes.basis.col(0), Eigen::VectorXd::Zero(3)}});
  const auto data = make_flow_map_data(three, starts, exact_linear(three),
                                       {.step = 0.3, .horizon = 3.0, .trajectories = 1});
  const metric measure(three, data, coordinates::modes);
  BOOST_TEST(measure.residuals() == 2);
  BOOST_TEST(measure.dropped() == (std::vector<std::string>{"x2", "x3", "y2", "y3"}),
             boost::test_tools::per_element());
  BOOST_TEST(metric(three, data, coordinates::qp).residuals() == 6);  // there all move
}

// In the modes of the FPU chain the stiff ones decide, and the optimum is nearly that of a linear oscillator
// in the energy norm at z = 1, b1 = 1/2 and beta1 = .400581831; in q and p it is another.
BOOST_AUTO_TEST_CASE(in_the_modes_the_optimum_is_closer_to_the_linear_one) {
  const fpu_chain<3> chain(50.0);
  const auto data_of = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps<>(1e-3),
                              {.step = 0.02, .horizon = 1.0, .seed = seed});
  };
  const auto data = data_of(1);
  const auto held_out = data_of(2);
  const auto fitted = [&](coordinates which) {
    const fit found = learn(run_time_family(nystrom()), chain, data, held_out,
                            {.coordinates = which, .loss = loss_named("state:1")});
    BOOST_TEST(found.summary.coordinates == to_string(which));
    return (found.theta - Eigen::Vector2d(0.5, .400581831)).norm();
  };
  // Far enough apart that the errors of both fits, below 1e-3, cannot have done it.
  BOOST_TEST(fitted(coordinates::modes) + 3e-3 < fitted(coordinates::qp));
}
