// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 6 s at -O0, 0.6 s at -O1.
// In a bath data are of a noise, and held-out data of another; and on the damped oscillator the learner finds
// the optimum of docs/theory-langevin-optimum.md. That a member has no loss on its own data, with their noise
// and no other: losses/after_steps_test.cpp.
#include "../support/draws.hpp"
#include "../support/langevin.hpp"
#include "../support/learned.hpp"
#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using galaxy = in_bath<henon_heiles>;
const family bathed_stages = two_stages_in(placement::symmetric);
using parameters = detail::parameters_of<nystrom>;

constexpr double h = 0.5;
const galaxy warm(henon_heiles(), bath::of_sigma(0.7, 0.1));
const auto starts = around_rest<2>(0.1, 0.2);

fit fit_to(const data_sets& sets, const galaxy& system = warm) {
  return sets.learned(bathed_stages, system, {.planned_steps = 1000});
}

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

/// Two stages with b1 = 1/2, learned with noise from the invariant law, at z = 1 and gamma = omega/10.
fit_summary::fitted_parameter learned_beta1(placement where) {
  const double g = 0.1;
  const damped_oscillator x{omega, g * omega, std::sqrt(2.0 * g * omega)};
  constexpr std::int64_t paths = 20000;
  const auto system = bathed_system(x);
  const double step = 1.0 / omega;
  const auto data = make_flow_map_data(
      system, at_random(x, paths), exact_paths(x),
      {.step = step, .horizon = step, .trajectories = paths, .seed = seed(1), .noise_parts = 2});
  const auto fit = learn(two_stages_in(where), system, data, data,
                         {.coordinates = coordinates::energy,
                          .start = Eigen::Vector2d(0.5, 0.4),
                          .random_starts = 0,
                          .fixed = {0.5, std::nullopt},
                          .planned_steps = 100});
  return fit.summary.parameters[1];
}

}  // namespace

BOOST_AUTO_TEST_CASE(held_out_data_are_new_if_starts_or_noise_are_and_both_are_of_the_bath) {
  const listed<2> same({starts(1, 0), starts(1, 1), starts(1, 2)});
  const auto with = [&](std::uint64_t seed, int parts) {
    return made_by_steps(warm, same, member(bathed_stages, {0.45, 0.38}),
                         {.step = h, .trajectories = 3, .seed = seed, .parts = parts});
  };
  const auto is_new = [&](const auto& held_out) {
    return fit_to({with(1, 2), held_out}).summary.held_out_is_new;
  };
  BOOST_TEST(is_new(with(2, 2)));
  BOOST_TEST(!is_new(with(1, 2)));
  BOOST_TEST(!is_new(with(1, 4)));  // the data do not show it

  const data_sets sets(with(1, 2), with(2, 2));
  const galaxy warmer(henon_heiles(), bath::of_sigma(0.7, 0.2));
  BOOST_TEST(refuses([&] { fit_to(sets, warmer); }, {"sigma=0.1", "sigma=0.2"}));
  auto without = sets;
  for (auto* data : {&without.held_out, &without.data}) {
    data->noise.clear();
    data->noise_parts = 0;
    BOOST_TEST(refuses([&] { fit_to(without); }, {"got 0", "noise_parts = 2"}));
  }
}

// By the same calculation as the tables: of the matrix .360024, .400501, .400515.
BOOST_AUTO_TEST_CASE(with_the_noise_of_the_data) {
  const auto check = [](const fit_summary::fitted_parameter& found, double expected, double of_matrix) {
    BOOST_TEST_MESSAGE("beta1 = " << found.value << " +- " << found.standard_error << ", expected "
                                  << expected);
    BOOST_TEST(found.standard_error < 1e-3);
    const double allowed = standard_errors(false_alarms / 3) * found.standard_error;
    BOOST_TEST(std::abs(found.value - expected) <= allowed);
    if (of_matrix != expected) BOOST_TEST(std::abs(found.value - of_matrix) > allowed);
  };
  check(learned_beta1(placement::end), .360024, .360024);
  check(learned_beta1(placement::symmetric), .391594, .400501);
  check(learned_beta1(placement::middle), .400744, .400744);
}
