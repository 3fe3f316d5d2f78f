// SPDX-License-Identifier: BSL-1.0
// What is learned on the damped oscillator is the optimum of docs/theory-langevin-optimum.md.
#include <boost/test/unit_test.hpp>

#include "../support/exact_paths.hpp"
#include "../support/langevin_methods.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/learner.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double omega = 3.0;

struct invariant_law {
  damped_oscillator x;
  phase_point<double, 1> operator()(std::uint64_t seed, std::uint64_t n) const {
    vector<double, 2> z;
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, z);
    return point(z[0] * std::sqrt(x.invariant()(0, 0)), z[1] * std::sqrt(x.invariant()(1, 1)));
  }
  std::string description() const { return "invariant_law()"; }
};

template <placement P>
auto learn_beta1(const damped_oscillator& x, double z, const auto& ensemble, std::int64_t trajectories) {
  using family = thermostatted_family<nystrom, P>;
  const auto system = system_of(x);
  const double step = z / omega;
  const auto data_of = [&](std::uint64_t seed) {
    return make_flow_map_data(system, ensemble, exact_paths(x),
                              {.step = step,
                               .horizon = step,
                               .trajectories = trajectories,
                               .seed = seed,
                               .noise_parts = x.sigma > 0.0 ? 2 : 0});
  };
  const auto data = data_of(1);
  return learn(family{}, system, data, data,
               {.coordinates = coordinates::energy, .fixed = {0.5, std::nullopt}})
      .summary.parameters[1];
}

/// Without noise, from the two unit states: the matrix alone.
template <placement P>
double of_the_matrix(double g, double z) {
  const listed<1> unit_states({point(1.0 / omega, 0.0), point(0.0, 1.0)});
  return learn_beta1<P>({omega, g * omega, 0.0}, z, unit_states, 2).value;
}
/// With noise, from the invariant law.
template <placement P>
fitted_parameter of_paths(double g, double z) {
  const damped_oscillator x{omega, g * omega, std::sqrt(2.0 * g * omega)};
  return learn_beta1<P>(x, z, invariant_law{x}, 40000);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_matrix_alone) {
  // The table has six digits.
  BOOST_TEST(std::abs(of_the_matrix<placement::end>(.1, 1.0) - .360024) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix<placement::symmetric>(.1, 1.0) - .400501) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix<placement::middle>(.1, 1.0) - .400515) <= 1e-6);
  BOOST_TEST(std::abs(of_the_matrix<placement::end>(.01, 0.5) - .394247) <= 1e-6);
}

// By the same calculation as the tables: of the matrix .360024, .400501, .400515.
BOOST_AUTO_TEST_CASE(with_the_noise_of_the_data) {
  const auto check = [](const fitted_parameter& found, double expected, double of_matrix) {
    BOOST_TEST_MESSAGE("beta1 = " << found.value << " +- " << found.standard_error << ", expected "
                                  << expected);
    BOOST_TEST(found.standard_error < 1e-3);
    BOOST_TEST(std::abs(found.value - expected) <= 4.0 * found.standard_error);
    if (of_matrix != expected) BOOST_TEST(std::abs(found.value - of_matrix) > 6.0 * found.standard_error);
  };
  check(of_paths<placement::end>(.1, 1.0), .360024, .360024);
  check(of_paths<placement::symmetric>(.1, 1.0), .391594, .400501);
  check(of_paths<placement::middle>(.1, 1.0), .400744, .400744);
}
