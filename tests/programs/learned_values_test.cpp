// SPDX-License-Identifier: BSL-1.0
// What the program learns is what the library learns, bit for bit, and what is known.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>

#include "../../src/comparison/seeds.hpp"
#include "../support/document.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;
using program::role;
using program::seed_for;

namespace {

const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
const fine_steps<> reference(.02 / 200);
constexpr std::uint64_t seed = 5;  // the user's

learned<nystrom> fitted(coordinates how) {
  const auto pairs = [&](role which) {
    return make_flow_map_data(
        chain, law, reference,
        {.step = .02, .horizon = .4, .trajectories = 15, .seed = seed_for(which, seed)});
  };
  learn_options<nystrom> options;
  options.coordinates = how;
  options.seed = seed_for(role::training, seed);
  return learn(nystrom{}, chain, pairs(role::training), pairs(role::held_out), options);
}

}  // namespace

BOOST_AUTO_TEST_CASE(learn_gives_the_fit_of_the_library) {
  for (const auto how : {coordinates::qp, coordinates::modes}) {
    const auto fit = fitted(how).summary;
    const auto printed = document(
        "learn --family nystrom --seed 5 --step 0.02 --trajectories 15 --horizon 0.4 --coordinates " +
        std::string(to_string(how)));
    for (const auto& parameter : fit.parameters) {
      BOOST_TEST(printed["parameters"][parameter.name] == parameter.value);
      BOOST_TEST(printed["standard_errors"][parameter.name] == parameter.standard_error);
    }
    BOOST_TEST(printed["loss"] == fit.loss);
    BOOST_TEST(printed["held_out_loss"] == fit.held_out_loss);
    BOOST_TEST(printed["held_out_loss"] != printed["loss"]);
    BOOST_TEST(printed["samples"] == fit.samples);
    BOOST_TEST(printed["learning_evaluations"] == fit.learning_evaluations);
    BOOST_TEST(printed["reference_error"] == fit.reference_error);
    BOOST_TEST(printed["iterations"] == fit.iterations);
  }
}

BOOST_AUTO_TEST_CASE(compare_learns_as_learn_does) {
  const auto all = document(
      "compare --seed 5 --methods learned:nystrom --steps 0.02 --trajectories 2 --learn-trajectories 15 "
      "--learn-horizon 0.4 --metric state");
  const auto fit = fitted(coordinates::energy);
  BOOST_TEST(all["fits"][0]["parameters"]["b1"] == fit.summary.parameters[0].value);
  BOOST_TEST(all["fits"][0]["held_out_loss"] == fit.summary.held_out_loss);
}

// On a linear oscillator the optimum in the energy norm depends on z alone, if all phases are seen alike.
// They are where a trajectory of N steps takes N z = 355 or 710, and 355/113 is pi to 1e-7: what is left of
// sum exp(2 i n z) is 2 |N z - k pi| = 1e-4 of one term, in some 1000.
BOOST_AUTO_TEST_CASE(linear_optima_are_the_known_ones) {
  struct optimum {
    const char* z;
    double beta1;
  };
  for (const auto& [z, beta1] : {optimum{"0.5", 0.402727}, {"1", 0.400582}, {"2", 0.390164}}) {
    const auto fit = document(
        std::string("learn --loss state:1 --random-starts 0 --family nystrom --system oscillator --omega "
                    "1 --horizon 710 --trajectories "
                    "4 --coordinates energy --step ") +
        z);
    // Six digits are known, and the data leave an error of the size that is said above.
    BOOST_TEST(std::abs(fit["parameters"]["beta1"].get<double>() - beta1) < 1e-6, "z = " << z);
    BOOST_TEST(std::abs(fit["parameters"]["b1"].get<double>() - 0.5) < 1e-6, "z = " << z);
  }
}
