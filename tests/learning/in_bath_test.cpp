// SPDX-License-Identifier: BSL-1.0
// In a bath the learner finds the member that made the data, from their noise, and no other way.
#include <boost/test/unit_test.hpp>

#include <Eigen/Core>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/one_step.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/steps_in_bath.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using galaxy = in_bath<henon_heiles>;
using family = thermostatted_family<nystrom, placement::symmetric>;
using parameters = parameters_of<nystrom>;

constexpr double h = 0.5;
const galaxy warm(henon_heiles(), bath::of_sigma(0.7, 0.1));
const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);

struct data_sets {
  flow_map_data data, held_out;
};
data_sets made_by(const auto& method, const galaxy& system = warm) {
  const auto make = [&](std::uint64_t seed) {
    return made_by_steps(system, starts, method, {.step = h, .steps = 5, .seed = seed});
  };
  return {make(1), make(2)};
}
data_sets followed(const auto& reference, std::uint64_t seed = 1) {
  const auto make = [&](std::uint64_t data_seed) {
    return make_flow_map_data(
        warm, starts, reference,
        {.step = h, .horizon = 2.5, .trajectories = 30, .seed = data_seed, .noise_parts = 2});
  };
  return {make(seed), make(seed + 1)};
}
learned<family> fit_to(const data_sets& sets, const galaxy& system = warm,
                       const learn_options<family>& options = {}) {
  return learn(family{}, system, sets.data, sets.held_out, options);
}
double distance_of(const parameters& a, const parameters& b) {
  return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
}

/// How far theta can be off where the minimum is zero but for rounding: residuals of some 40 roundings, in
/// units of increments of .1 or more, over the least singular value of the Jacobian.
double recovery_error(const data_sets& sets, const parameters& theta, const galaxy& system = warm) {
  const metric measure(system, sets.data, coordinates::qp);
  const one_step<family> loss(system, sets.data, measure);
  const symmetric_eigen of_loss(hessian(loss, theta));
  return std::sqrt(4.0) * 40.0 * eps / 0.1 / std::sqrt(0.5 * of_loss.values[0]);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_member_that_made_the_data_is_recovered) {
  draws random;
  for (int n = 0; n < 4; ++n) {
    const parameters theta{random.uniform(0.35, 0.6), random.uniform(0.25, 0.5)};
    auto sets = made_by(member<family>(theta));
    const auto fit = fit_to(sets);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1] << "\n"
                               << fit.summary.full()) {
      const double allowed = recovery_error(sets, theta);
      BOOST_TEST_MESSAGE("error " << distance_of(fit.method.parameters(), theta) << " of " << allowed);
      BOOST_TEST(distance_of(fit.method.parameters(), theta) <= allowed);
      BOOST_TEST(fit.summary.family == "nystrom_symmetric");
      // With the noise of the next pairs nothing is to be recovered.
      const vector_list noise = sets.data.noise;
      for (std::size_t n = 0; n < noise.size(); ++n) sets.data.noise[n] = noise[(n + 2) % noise.size()];
      BOOST_TEST(distance_of(fit_to(sets).method.parameters(), theta) > 1e3 * allowed);
    }
  }
}

BOOST_AUTO_TEST_CASE(recovery_needs_no_sigma) {
  for (const double friction : {0.0, 0.7}) {
    const galaxy quiet(henon_heiles(), bath::of_sigma(friction, 0.0));
    const parameters theta{0.45, 0.38};
    auto sets = made_by(member<family>(theta), quiet);
    for (auto* data : {&sets.data, &sets.held_out}) {
      data->noise_parts = 0;
      data->noise.clear();
    }
    const double allowed = recovery_error(sets, theta, quiet);
    BOOST_TEST(distance_of(fit_to(sets, quiet).method.parameters(), theta) <= allowed);
  }
}

BOOST_AUTO_TEST_CASE(whatever_makes_the_paths_the_same_is_learned) {
  const auto by_baoab = fit_to(followed(fine_paths(2.5e-3)));
  const auto by_aboba = fit_to(followed(fine_paths(2.5e-3, aboba())));
  const auto by_finer = fit_to(followed(fine_paths(2.5e-3).finer()));
  const auto by_other_seed = fit_to(followed(fine_paths(2.5e-3), 3));
  const auto off = [&](const auto& fit) {
    return distance_of(fit.method.parameters(), by_baoab.method.parameters());
  };
  BOOST_TEST_CONTEXT(by_baoab.summary.full()) {
    // The generators' errors, sigma h/sqrt(12) = 7e-5 at time 1, are a hundred times below those of a step,
    // and of either sign; other paths move theta by its standard errors.
    double error = 0.0;
    for (const auto& parameter : by_baoab.summary.parameters)
      error = std::max(error, parameter.standard_error);
    BOOST_TEST(off(by_aboba) <= 0.05 * error);
    BOOST_TEST(off(by_finer) <= 0.05 * error);
    BOOST_TEST(off(by_other_seed) > 0.05 * error);
    BOOST_TEST(off(by_other_seed) <= 4.0 * std::sqrt(2.0) * error);
    BOOST_TEST(by_baoab.summary.reference_checked);
    BOOST_TEST(by_baoab.summary.reference_error < 0.05 * by_baoab.summary.one_step_error);
    BOOST_TEST(by_baoab.summary.reference == "baoab with step 0.0025");
  }
}

BOOST_AUTO_TEST_CASE(held_out_data_are_new_if_starts_or_noise_are) {
  const listed<2> same({starts(1, 0), starts(1, 1), starts(1, 2)});
  const auto with = [&](std::uint64_t seed, int parts) {
    return made_by_steps(warm, same, member<family>({0.45, 0.38}),
                         {.step = h, .trajectories = 3, .seed = seed, .parts = parts});
  };
  const auto is_new = [&](const auto& held_out) {
    return fit_to({with(1, 2), held_out}).summary.held_out_is_new;
  };
  BOOST_TEST(is_new(with(2, 2)));
  BOOST_TEST(!is_new(with(1, 2)));
  BOOST_TEST(!is_new(with(1, 4)));  // the data do not show it
}

BOOST_AUTO_TEST_CASE(threads_change_no_bit) {
  const auto sets = followed(fine_paths(0.025));
  const auto one = fit_to(sets);
  const auto two = fit_to(sets, warm, {.threads = 2});
  BOOST_TEST((one.method.parameters() == two.method.parameters()));
  BOOST_TEST(one.summary.loss == two.summary.loss);
  BOOST_TEST(one.summary.held_out_loss == two.summary.held_out_loss);
}

BOOST_AUTO_TEST_CASE(data_that_do_not_fit_the_bath_are_refused) {
  const auto sets = followed(fine_paths(0.025));
  const galaxy warmer(henon_heiles(), bath::of_sigma(0.7, 0.2));
  BOOST_TEST(refuses<wrong>([&] { fit_to(sets, warmer); }, {"sigma=0.1", "sigma=0.2"}));
  auto without = sets;
  without.held_out.noise.clear();
  without.held_out.noise_parts = 0;
  BOOST_TEST(refuses<wrong>([&] { fit_to(without); }, {"in 0 parts", "noise_parts = 2"}));
  without.data.noise.clear();
  without.data.noise_parts = 0;
  BOOST_TEST(refuses<wrong>([&] { fit_to(without); }, {"in 0 parts", "noise_parts = 2"}));
}
