// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 10 s at -O0, 2 s at -O1.
// The program's numbers are those of the library, bit for bit: its methods are data, those here are types,
// and numbers in JSON are printed so that they are read back whole. Nothing is tested where it was learned.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "../../src/comparison/seeds.hpp"
#include "../support/program.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/phi4.hpp"
#include "nysalt/systems/textbook.hpp"

using namespace nysalt;
using namespace nysalt::test;
using json = nlohmann::ordered_json;
using program::role;
using program::seed_for;

namespace {

using state = phase_point<double, 6>;
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
constexpr std::uint64_t seed = 5;  // the user's

/// What the library says of a method on the chain at the step 0.02, for the row that the program printed.
void must_be(const json& row, const method& method, const error_measure& measure) {
  const trajectory_options options{
      .step = .02, .steps = 25, .trajectories = 20, .seed = seed_for(role::test, seed), .horizon = .5};
  const auto expected = trajectory_errors(chain, fine_steps(.02 / 20), law, method, measure, options);
  BOOST_TEST_CONTEXT(row["method"] << " by " << measure.name) {
    BOOST_TEST(row["error"] == expected.methods[0].error.mean);
    BOOST_TEST(row["standard_error"] == expected.methods[0].error.standard_error);
    BOOST_TEST(row["evaluations_per_time"] == expected.methods[0].evaluations_per_time);
    BOOST_TEST(row["diverged"] == 0);
    if (expected.reference_error) BOOST_TEST(row["reference_error"] == expected.reference_error->mean);
    BOOST_TEST(row["reference_error"].is_null() == !expected.reference_error.has_value());
  }
}

/// By the random starts of the library's default seed, as those of the program are the same for every seed.
fit fitted(coordinates how) {
  const auto pairs = [&](role which) {
    return make_flow_map_data(
        chain, law, fine_steps(.02 / 20),
        {.step = .02, .horizon = .4, .trajectories = 15, .seed = seed_for(which, seed)});
  };
  return learn(nystrom(), chain, pairs(role::training), pairs(role::held_out), {.coordinates = how});
}

}  // namespace

BOOST_AUTO_TEST_CASE(compare_gives_the_errors_of_the_library) {
  const auto stiff_energy = [](const state& x) { return chain.stiff_energy(x); };
  const auto kinetic = [](const state& x) { return kinetic_energy<double>(chain, x.p); };
  const auto must_all_be = [](const std::string& metric, const error_measure& measure) {
    const auto all = document(
        "compare --system fpu --seed 5 --methods learned:nystrom,s_aia2,srkn6b,phase_fitted_chin4a --steps "
        "0.02 "
        "--fine-step 1e-3 "
        "--trajectories 20 "
        "--learn-trajectories 5 " +
        metric);
    const auto& theta = all["fits"][0]["parameters"];
    BOOST_REQUIRE(all["rows"].size() == 4U);
    must_be(all["rows"][0], member(nystrom(), {theta["b1"], theta["beta1"]}), measure);
    must_be(all["rows"][1], s_aia2(.02 * chain.frequency_bands().back().high), measure);
    must_be(all["rows"][2], srkn6b(), measure);
    must_be(all["rows"][3], phase_fitted(fg_chin(), chin4a(), .02 * frequency_to_fit(chain)), measure);
  };
  must_all_be("", path_measure(chain, stiff_energy));
  must_all_be("--observable kinetic_energy", path_measure(chain, kinetic));
  must_all_be("--metric relative", relative_measure(chain, stiff_energy));
  must_all_be("--metric state", state_measure(chain));
  must_all_be("--metric exchange", exchange_measure(chain));
  must_all_be("--metric energy", energy_measure(chain));
}

/// Where the second trajectory starts, and where a step of Verlet leads: energy, q1 and the last of p.
template <System S>
void must_step(const std::string& options, const S& system, const Ensemble<S> auto& starts) {
  const auto last = fmt::format("p{}", size(system));
  const auto all = document(
      "run --seed 5 --method verlet --step 0.01 --horizon 0.01 --trajectories 2 "
      "--observables energy,q1," +
      last + " --system " + options);
  const auto start = starts(seed_for(role::test, seed), 1);
  const auto must_be = [&](std::int64_t n, double t, const auto& x) {
    const json expected{1, n, t, energy<double>(system, x), x.q[0], x.p[size(system) - 1]};
    BOOST_TEST(all["rows"][static_cast<std::size_t>(2 + n)] == expected, options);
  };
  integrate(system, verlet(), .01, start, 1, must_be);
}

BOOST_AUTO_TEST_CASE(systems_start_where_the_library_says) {
  must_step("kepler", kepler(), kepler_law(.6));
  must_step("kepler --eccentricity 0.1", kepler(), kepler_law(.1));
  const lennard_jones<> in_space(3, 13);
  must_step("lennard_jones --space 3 --atoms 13 --spread 2", in_space,
            lennard_jones_law(in_space, .1 * 2. * 2.));
  const vector<double, 5> rest = vector<double, 5>::Zero();
  must_step("phi4 --masses 5 --spread 3", phi4_chain<5>(), normal_around<5>({rest, rest}, 1.5, 3.));
  must_step("fpu --spread 2", chain, fpu_law<3>(chain, 2.));
  const vector<double, 2> at_rest(0., 0.);
  must_step("henon_heiles --spread 2", henon_heiles(), normal_around<2>({at_rest, at_rest}, .2, .2));
}

/// The rows of three trajectories of a run are what the library's steps show: `sample` says it of a state.
template <class Sample>
void must_be_samples(const json& all, const auto& stepper, const auto& starts, int steps, int every,
                     const Sample& sample) {
  std::size_t at = 0;
  for (std::uint64_t m = 0; m < 3; ++m) {
    const auto watch = [&](std::int64_t n, double t, const state& x) {
      json expected{m, n, t};
      for (const double value : sample(x)) expected.push_back(value);
      BOOST_REQUIRE(at < all["rows"].size());
      BOOST_TEST(all["rows"][at++] == expected);
    };
    integrate(stepper, starts(seed_for(role::test, seed), m), steps, watch, every, m);
  }
  BOOST_TEST(at == all["rows"].size());
}

BOOST_AUTO_TEST_CASE(run_gives_the_samples_of_the_library) {
  const auto all = document(
      "run --system fpu --seed 5 --method srkn6b --step 0.03 --horizon 6 --sample-every 7 --trajectories 3 "
      "--observables stiff_energy,energy,kinetic_energy,potential_energy,q1,p6,stiff_energy_2");
  must_be_samples(all, make_stepper(chain, srkn6b(), .03), law, 200, 7, [](const state& x) {
    return std::vector<double>{chain.stiff_energy(x),
                               energy<double>(chain, x),
                               kinetic_energy<double>(chain, x.p),
                               chain.potential(x.q),
                               x.q[0],
                               x.p[5],
                               chain.stiff_energy(x, 1)};
  });
}

BOOST_AUTO_TEST_CASE(run_gives_the_samples_of_the_library_in_a_bath) {
  const in_bath system(chain, bath::of_sigma(0.01, 0.05));
  const auto all = document(
      "run --system fpu --seed 5 --method srkn6b@symmetric --step 0.03 --horizon 0.6 --sample-every 4 "
      "--trajectories 3 "
      "--observables stiff_energy,kinetic_temperature,q1,p6 --start gibbs --friction 0.01 --sigma 0.05");
  const auto stepper = make_stepper(system, thermostat(srkn6b(), placement::symmetric), .03,
                                    counter_noise(seed_for(role::test, seed)));
  must_be_samples(all, stepper, gibbs<6>(system, law), 20, 4, [](const state& x) {
    return std::vector<double>{chain.stiff_energy(x), kinetic_temperature<double>(chain, x), x.q[0], x.p[5]};
  });
}

BOOST_AUTO_TEST_CASE(run_tells_where_the_library_sees_divergence) {
  const auto all = json_of(
      nysalt::test::run("run --system fpu --method verlet --step 0.05 --horizon 1 --trajectories 5 --json"));
  BOOST_REQUIRE(all["diverged"].size() == 5U);
  for (std::uint64_t m = 0; m < 5; ++m) {
    const auto end = integrate(chain, verlet(), .05, law(seed_for(role::test, 1), m), 20);
    BOOST_TEST(all["diverged"][m]["trajectory"] == m);
    BOOST_TEST(all["diverged"][m]["step"] == end.diverged_at.value());
  }
}

BOOST_AUTO_TEST_CASE(stability_gives_the_windows_of_the_library) {
  const auto must_have = [](const std::string& arguments, const method& method) {
    const auto all = document("stability " + arguments);
    json expected = json::array();
    for (const auto& [low, high] : stability_windows(method))
      expected.push_back({{"low", low}, {"high", high}});
    const auto evaluations = method.letters().evaluations_per_step;
    BOOST_TEST(all["windows"] == expected);
    BOOST_TEST(all["limit"] == stability_limit(method));
    BOOST_TEST(all["limit_per_evaluation"] == stability_limit(method) / evaluations);
    BOOST_TEST(all["evaluations_per_step"] == evaluations);
    json coefficients = json::array();
    for (const double c : method.coefficients()) coefficients.push_back(c);
    BOOST_TEST(all["coefficients"] == coefficients);
  };
  must_have("--method srkn6b", srkn6b());
  must_have("--family nystrom --parameters 0.45,0.4", member(nystrom(), {.45, .4}));
  must_have("--method s_aia2 --system fpu --step 0.03", s_aia2(.03 * chain.frequency_bands().back().high));
}

BOOST_AUTO_TEST_CASE(acceptances_are_those_of_the_library) {
  const trajectory_options options{
      .step = 0.03, .steps = 66, .trajectories = 20, .seed = program::seed_for(program::role::test, 5)};
  for (const double temperature : {1.0, 0.2}) {
    const auto all = document(
        "compare --system fpu --methods verlet,learned:fg_chin --steps 0.03 --metric acceptance "
        "--trajectories 20 "
        "--learn-trajectories 5 " +
        std::string("--seed 5 --horizon 2") + (temperature == 1.0 ? "" : " --hmc-temperature 0.2"));
    const auto& theta = all["fits"][0]["parameters"];
    const auto is_of = [&](const auto& row, const auto& method) {
      const auto expected = acceptance(chain, nysalt::method(method), law, options, temperature);
      BOOST_TEST(row["acceptance"] == expected.probability.mean);
      BOOST_TEST(row["standard_error"] == expected.probability.standard_error);
      BOOST_TEST(row["evaluations_per_time"] == expected.evaluations_per_time);
      BOOST_TEST(row["diverged"] == 0);
      BOOST_TEST(row["error"].is_null());
      BOOST_TEST(expected.probability.mean < 1.0);
    };
    BOOST_TEST(all["hmc_temperature"] == temperature);
    is_of(all["rows"][0], verlet());
    is_of(all["rows"][1], member(fg_chin(), {theta["b"], theta["c"]}));
  }
}

BOOST_AUTO_TEST_CASE(learn_gives_the_fit_of_the_library) {
  const auto fit = fitted(coordinates::modes).summary;
  const auto printed = document(
      "learn --system fpu --family nystrom --seed 5 --step 0.02 --fine-step 1e-3 --trajectories 15 --horizon "
      "0.4 "
      "--coordinates modes")["fits"][0];
  for (const auto& parameter : fit.parameters) {
    BOOST_TEST(printed["parameters"][parameter.name] == parameter.value);
    BOOST_TEST(std::isnan(parameter.standard_error));  // fifteen trajectories do not tell
    BOOST_TEST(printed["standard_errors"][parameter.name].is_null());
  }
  BOOST_TEST(printed["standard_errors_withheld"] == fit.errors_withheld);
  BOOST_TEST(printed["loss"] == fit.loss);
  BOOST_TEST(printed["held_out_loss"] == fit.held_out_loss);
  BOOST_TEST(printed["held_out_loss"] != printed["loss"]);
  BOOST_TEST(printed["samples"] == fit.samples);
  BOOST_TEST(printed["learning_evaluations"] == fit.learning_evaluations);
  BOOST_TEST(printed["reference_error"] == fit.reference_error);
  BOOST_TEST(printed["iterations"] == fit.iterations);
}

BOOST_AUTO_TEST_CASE(compare_learns_as_learn_does) {
  const auto all = document(
      "compare --system fpu --seed 5 --methods learned:nystrom --steps 0.02 --trajectories 2 "
      "--learn-trajectories 15 "
      "--learn-horizon 0.4 --fine-step 1e-3 --metric state");
  const auto fit = fitted(coordinates::energy);
  BOOST_TEST(all["fits"][0]["parameters"]["b1"] == fit.summary.parameters[0].value);
  BOOST_TEST(all["fits"][0]["held_out_loss"] == fit.summary.held_out_loss);
}

// Along an accurate trajectory the energy stays: it tells from which start the data are.
BOOST_AUTO_TEST_CASE(no_test_starts_where_training_did) {
  const auto energy_from = [](role which) { return energy<double>(chain, law(seed_for(which, 1), 0)); };
  const auto learned =
      json_of(nysalt::test::run("learn --system fpu --family nystrom --step 0.02 --trajectories 1 --json"));
  const auto& range = learned["fits"][0]["energy_range"];
  const std::array<double, 2> training{range["low"], range["high"]};
  const auto test =
      document("run --system fpu --method verlet --step 0.02 --horizon 0.02 --observables energy");
  // Both hold exactly: the range has the start in it, and the first sample is the start.
  BOOST_TEST(training[0] <= energy_from(role::training));
  BOOST_TEST(energy_from(role::training) <= training[1]);
  BOOST_TEST(test["rows"][0][3] == energy_from(role::test));
  BOOST_TEST(training[1] - training[0] < 1e-9);
  for (const auto other : {role::held_out, role::test})
    BOOST_TEST((energy_from(other) < training[0] || energy_from(other) > training[1]));
}
