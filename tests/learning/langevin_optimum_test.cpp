// SPDX-License-Identifier: BSL-1.0
// What is learned on the damped oscillator is the optimum of docs/theory-langevin-optimum.md.
#include <boost/test/unit_test.hpp>

#include "../support/exact_paths.hpp"
#include "../support/langevin_methods.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/learn.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double omega = 3.0;

/// States of the invariant law.
listed<1> at_random(const damped_oscillator& x, std::uint64_t states) {
  std::vector<phase_point<double, 1>> all;
  vector<double, 2> z;
  for (std::uint64_t n = 0; n < states; ++n) {
    standard_normals(seed(1), {.trajectory = n, .purpose = noise_purpose::initial_state}, z);
    all.push_back(point(z[0] * std::sqrt(x.invariant()(0, 0)), z[1] * std::sqrt(x.invariant()(1, 1))));
  }
  return listed<1>(all);
}

/// Two stages with b1 = 1/2, and O at a placement that is told when running.
struct symmetric_stages {
  using word = run_time_word;
  static constexpr std::string_view name = "symmetric_stages";
  static constexpr int parameters = 1;
  static constexpr std::array<std::string_view, 1> parameter_names{"beta1"};
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<parameter_range, 1> ranges() { return {{{0.0, 0.5, true}}}; }
  static std::array<double, 1> start() { return {0.4}; }

  placement where = placement::end;
  run_time_word letters() const { return thermostatted(run_time_word(nystrom::word{}), where); }
  template <Scalar C>
  std::vector<C> coefficients(const std::array<C, 1>& beta1) const {
    const auto plain = nystrom::coefficients<C>({C(0.5), beta1[0]});
    return thermostatted_coefficients(run_time_word(nystrom::word{}), where,
                                      std::vector<C>(plain.begin(), plain.end()));
  }
};

fitted_parameter learn_beta1(placement where, const damped_oscillator& x, double z, const listed<1>& starts,
                             std::int64_t trajectories) {
  const auto system = bathed_system(x);
  const double step = z / omega;
  const auto data = make_flow_map_data(system, starts, exact_paths(x),
                                       {.step = step,
                                        .horizon = step,
                                        .trajectories = trajectories,
                                        .seed = seed(1),
                                        .noise_parts = x.sigma > 0.0 ? 2 : 0});
  const auto fit = learn(symmetric_stages{where}, system, data, data, {.coordinates = coordinates::energy});
  return fit.summary.parameters[0];
}

/// Without noise, from the two unit states: the matrix alone.
double of_the_matrix(placement where, double g, double z) {
  const listed<1> unit_states({point(1.0 / omega, 0.0), point(0.0, 1.0)});
  return learn_beta1(where, {omega, g * omega, 0.0}, z, unit_states, 2).value;
}
/// With noise, from the invariant law.
fitted_parameter of_paths(placement where, double g, double z) {
  const damped_oscillator x{omega, g * omega, std::sqrt(2.0 * g * omega)};
  constexpr std::int64_t paths = 40000;
  return learn_beta1(where, x, z, at_random(x, paths), paths);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_matrix_alone) {
  // The table has six digits.
  BOOST_TEST(std::abs(of_the_matrix(placement::end, .1, 1.0) - .360024) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix(placement::symmetric, .1, 1.0) - .400501) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix(placement::middle, .1, 1.0) - .400515) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix(placement::end, .01, 0.5) - .394247) <= 1e-6);
}

// By the same calculation as the tables: of the matrix .360024, .400501, .400515.
BOOST_AUTO_TEST_CASE(with_the_noise_of_the_data) {
  const auto check = [](const fitted_parameter& found, double expected, double of_matrix) {
    BOOST_TEST_MESSAGE("beta1 = " << found.value << " +- " << found.standard_error << ", expected "
                                  << expected);
    BOOST_TEST(found.standard_error < 1e-3);
    const double allowed = standard_errors(false_alarms / 3) * found.standard_error;
    BOOST_TEST(std::abs(found.value - expected) <= allowed);
    if (of_matrix != expected) BOOST_TEST(std::abs(found.value - of_matrix) > allowed);
  };
  check(of_paths(placement::end, .1, 1.0), .360024, .360024);
  check(of_paths(placement::symmetric, .1, 1.0), .391594, .400501);
  check(of_paths(placement::middle, .1, 1.0), .400744, .400744);
}
