// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 57 s at -O0, 11 s at -O1.
// The errors that a fit reports are the scatter of fits to other data [li_lu_tao_ye_2023, theorem 3.1], and
// those that take the weights for given are too small. How they fall with the number of trajectories:
// verification/enough_data_test. In tier 1: the formula, in learning/minima_test.
#include <boost/test/unit_test.hpp>

#include <boost/math/distributions/chi_squared.hpp>

#include "../../../src/nysalt/learning/problem.hpp"
#include "../../support/learned.hpp"
#include "nysalt/analysis/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::size_t repetitions = 40;
constexpr double step = 0.02;
const fpu_chain<3> chain(50.0);

flow_map_data data_of(std::int64_t trajectories, std::uint64_t seed) {
  return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps(1e-3),
                            {.step = step, .horizon = 0.2, .trajectories = trajectories, .seed = seed});
}

/// Errors that take the weights for given: the paper's theorem, but not its estimator.
Eigen::VectorXd errors_without_weights(const flow_map_data& data, const Eigen::VectorXd& theta) {
  const metric measure(chain, data, coordinates::qp);
  const after_steps<> loss(family(nystrom()), chain, data, state_error(measure));
  const std::vector<Eigen::VectorXd> none;
  return curvature(hessian(detail::objective_of(loss), theta), {0, 1})
      .spread(trajectory_gradients(loss, theta), none)
      .standard_errors;
}

/// The errors of a fit of data as few as one likes, of which the summary says only that they are not known.
Eigen::VectorXd errors_of(const flow_map_data& data, const flow_map_data& held_out,
                          const Eigen::VectorXd& theta) {
  const learning_problem problem(family(nystrom{}), chain, data, held_out, {.loss = loss_named("state:1")});
  const curvature bend(hessian(problem.loss, theta), {0, 1});
  return bend.spread(problem.scores(theta), problem.held_out_scores(theta)).standard_errors;
}

/// Fits to data of different seeds.
struct repeated_fits {
  std::array<std::vector<double>, 2> value, reported_square, naive_square;

  repeated_fits(std::int64_t trajectories, std::uint64_t first_seed) {
    for (std::size_t n = 0; n < repetitions; ++n) {
      const auto data = data_of(trajectories, first_seed + n);
      const auto held_out = data_of(trajectories, 100'000 + first_seed + n);
      const auto fit = learn(nystrom{}, chain, data, held_out, {.loss = loss_named("state:1")});
      const auto naive = errors_without_weights(data, fit.theta);
      const auto errors = errors_of(data, held_out, fit.theta);
      for (std::size_t k = 0; k < 2; ++k) {
        const auto& p = fit.summary.parameters[k];
        const double error = errors[static_cast<Eigen::Index>(k)];
        if (fit.summary.errors_withheld.empty())
          BOOST_TEST(p.standard_error == error, boost::test_tools::tolerance(1e-6));
        value[k].push_back(p.value);
        reported_square[k].push_back(error * error);
        naive_square[k].push_back(std::pow(naive[static_cast<Eigen::Index>(k)], 2));
      }
    }
  }
  double scatter(std::size_t k) const {  // standard deviation of one value
    return mean_and_error(value[k]).standard_error * std::sqrt(static_cast<double>(repetitions));
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_scatter_over_seeds_is_the_reported_error) {
  const repeated_fits fits(100, 1000);
  // The sum of squares over its expectation is chi-squared with 39 degrees of freedom. The reported variance
  // is an estimate from 100 trajectories, 15 % off at most in the mean over 40 seeds.
  const boost::math::chi_squared law(repetitions - 1);
  const double low = 0.85 * quantile(law, 1e-3);
  const double high = 1.15 * quantile(law, 1.0 - 1e-3);
  for (std::size_t k = 0; k < 2; ++k) {
    const double squares = (repetitions - 1) * std::pow(fits.scatter(k), 2);
    const double statistic = squares / mean_and_error(fits.reported_square[k]).mean;
    const double naive = squares / mean_and_error(fits.naive_square[k]).mean;
    BOOST_TEST_MESSAGE(nystrom::parameter_names[k] << ": " << statistic << " in " << low << ".." << high
                                                   << "; with weights taken for given " << naive);
    BOOST_TEST(statistic > low);
    BOOST_TEST(statistic < high);
    BOOST_TEST(naive > high);  // those errors are too small
  }
}
