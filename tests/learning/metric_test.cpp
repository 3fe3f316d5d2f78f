// SPDX-License-Identifier: BSL-1.0
// The coordinates and weights in which an error counts.
#include "nysalt/losses/metric.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int dynamic = Eigen::Dynamic;
using point = phase_point<double, dynamic>;

/// Two masses, 1 and 4, on three springs.
linear_chain two_weights_on_springs() {
  return linear_chain(Eigen::Matrix2d{{3.0, -1.0}, {-1.0, 2.0}}, Eigen::Vector2d(1.0, 4.0));
}
flow_map_data data_of(const linear_chain& chain) {
  return make_flow_map_data(chain, around_rest<dynamic>(0.3, 0.7, chain.size()), exact_linear(chain),
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
}  // namespace

BOOST_AUTO_TEST_CASE(each_coordinate_is_measured_in_its_mean_square_increment) {
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
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
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
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

BOOST_AUTO_TEST_CASE(weight_deviations_of_other_trajectories_are_those_among_each_other) {
  const auto chain = two_weights_on_springs();
  const auto data = data_of(chain);
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
  const auto others =
      make_flow_map_data(chain, around_rest<dynamic>(0.3, 0.7, chain.size()), exact_linear(chain),
                         {.step = 0.3, .horizon = 1.5, .trajectories = 9, .seed = 2});
  const Eigen::MatrixXd found = measure.weight_deviations(others);
  BOOST_TEST((found - known).cwiseAbs().maxCoeff() > 1e-2);
  BOOST_TEST(found.rowwise().sum().cwiseAbs().maxCoeff() <= 45 * eps);
}

BOOST_AUTO_TEST_CASE(coordinates_that_do_not_exist_are_refused) {
  using wrong = std::invalid_argument;
  const pendulum swing;
  const data_options options{.step = 0.1, .trajectories = 2};
  const auto of_swing = make_flow_map_data(swing, around_rest<1>(0.1, 0.1), fine_steps<>(0.01), options);
  for (const auto which : {coordinates::modes, coordinates::energy}) {
    BOOST_TEST(refuses<wrong>([&] { metric(swing, of_swing, which); },
                              {to_string(which), "pendulum()", "must have modes()", "use qp"}));
  }
  const auto of_nothing = make_flow_map_data(swing, around_rest<1>(0.0, 0.0), fine_steps<>(0.01), options);
  BOOST_TEST(refuses<wrong>([&] { metric(swing, of_nothing, coordinates::qp); }, {"must hold motion"}));
}
