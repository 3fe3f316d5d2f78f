// SPDX-License-Identifier: BSL-1.0
// A search writes nothing to the standard error stream, wherever it starts: Ceres would.
#include <boost/test/unit_test.hpp>

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>

#include "../support/scratch.hpp"
#include "nysalt/learning/minimise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// What is written to the standard error stream meanwhile, by whatever library.
std::string written_by(const std::function<void()>& act) {
  const scratch folder("quiet_search");
  const std::string name = folder / "err";
  std::fflush(stderr);
  const int kept = dup(STDERR_FILENO);
  std::FILE* file = std::fopen(name.c_str(), "w");
  BOOST_REQUIRE(file != nullptr);
  dup2(fileno(file), STDERR_FILENO);
  act();
  std::fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  std::fclose(file);
  return contents(name);
}

/// r = (theta_1 - 2, theta_2^2 - 3), and beyond theta_1 = `wall` the loss overflows or the point is
/// undefined.
squares bowl(const Eigen::VectorXd& theta, double wall) {
  const double a = theta[0] < wall ? theta[0] - 2.0 : std::numeric_limits<double>::infinity();
  const double b = theta[1] * theta[1] - 3.0;
  const Eigen::Matrix2d j{{1.0, 0.0}, {0.0, 2.0 * theta[1]}};
  const Eigen::Vector2d r(a, b);
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

minimum search_from(double first, double wall, bool by_definition) {
  const objective loss = [=](const Eigen::VectorXd& theta) { return bowl(theta, wall); };
  const auto defined = [=](const Eigen::VectorXd& theta) { return !by_definition || theta[0] < wall; };
  return minimise(loss, defined, Eigen::Vector2d(first, 1.0), {0, 1}, 100);
}

/// As the search did: whatever is rejected is false.
class rejecting_cost final : public ceres::CostFunction {
 public:
  rejecting_cost() {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(1);
  }
  bool Evaluate(double const* const*, double*, double**) const override { return false; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_start_where_the_loss_is_not_finite_is_given_up_in_silence) {
  for (const bool by_definition : {false, true}) {
    minimum found{};
    BOOST_TEST(written_by([&] { found = search_from(5.0, 4.0, by_definition); }) == "");
    BOOST_TEST(!std::isfinite(found.loss));
    BOOST_TEST(!found.converged);
    BOOST_TEST(found.theta[0] == 5.0);
  }
}

BOOST_AUTO_TEST_CASE(steps_beyond_a_wall_are_rejected_in_silence) {
  for (const bool by_definition : {false, true}) {
    for (const double wall : {2.5, 1.5}) {
      minimum found{};
      BOOST_TEST(written_by([&] { found = search_from(-3.0, wall, by_definition); }) == "");
      BOOST_TEST(found.theta[0] < wall);
      BOOST_TEST(std::isfinite(found.loss));
    }
  }
}

// So that the tests above can tell.
BOOST_AUTO_TEST_CASE(ceres_is_not_silent_by_itself) {
  const std::string written = written_by([] {
    double theta = 1.0;
    ceres::Problem problem;
    problem.AddResidualBlock(new rejecting_cost, nullptr, &theta);
    ceres::Solver::Options options;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
  });
  BOOST_TEST(written.find("evaluation failed") != std::string::npos, written);
}
