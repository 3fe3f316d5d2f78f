// SPDX-License-Identifier: BSL-1.0
// The paper's table 1, for its own settings: what is learned for the FPU chain from data of three
// second-order generators with a step of 1e-6 [li_lu_tao_ye_2023, section 5.2]. The generators are members of
// the family themselves, and still all of them lead to the same parameters.
#include <boost/test/unit_test.hpp>

#include <map>

#include "../../src/reproduction/thinned.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/fpu_chain.hpp"

using namespace nysalt;
using program::paper::thinned;

namespace {

using chain = fpu_chain<3>;
using pairs = flow_map_data;
using parameters = parameters_of<nystrom>;

struct row {
  std::size_t factor;  // of the step .001
  parameters expected;
  double seed_scatter;
};
// The rows are rounded to 1e-4, and ours scatter by 2e-4 at .01, twice that at two deviations; less at .001.
const std::vector<row> table_1{
    {1, {.5001, .4052}, 5e-4}, {5, {.5024, .4062}, 5e-4}, {10, {.5070, .4078}, 7.5e-4}};
const std::vector<parameters> generators{{2.0 / 3.0, 1.0 / 3.0}, {1.0 / 3.0, 1.0 / 3.0}, {0.5, 0.5}};

}  // namespace

BOOST_AUTO_TEST_CASE(the_table_is_reproduced_whatever_generates_the_data) {
  const chain system(50.0);
  const fpu_law<3> law(system);
  std::map<std::pair<std::size_t, std::uint64_t>, parameters> first;  // by factor and seed
  for (const auto& generator : generators) {
    const fine_steps reference(1e-6, member<nystrom>(generator));
    constexpr double horizon = 0.5;
    std::vector<pairs> by_seed;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      by_seed.push_back(
          make_flow_map_data(system, law, reference, {.step = 1e-3, .horizon = horizon, .seed = seed}));
    }
    for (const auto& [factor, expected, seed_scatter] : table_1) {
      for (std::size_t s = 0; s < by_seed.size(); ++s) {
        const auto data = thinned(by_seed[s], factor, horizon);
        const auto held_out = thinned(by_seed[(s + 1) % by_seed.size()], factor, horizon);
        const auto fit = learn(nystrom{}, system, data, held_out, {.loss = loss_named("state:1")});
        const auto found = fit.method.parameters();
        BOOST_TEST_CONTEXT(fit.summary.full() << "generator " << generator[0]) {
          BOOST_TEST(fit.summary.usable);
          for (const auto& other : table_1) {  // and of no other row
            BOOST_TEST((other.factor == factor || std::abs(found[0] - other.expected[0]) > seed_scatter));
          }
          const auto& reported = first.try_emplace({factor, data.seed}, found).first->second;
          for (std::size_t k = 0; k < 2; ++k) {
            BOOST_TEST(std::abs(found[k] - expected[k]) <= seed_scatter);
            // A generator of order 2 errs by (1e-6/step)^2 <= 1e-6 of a Verlet step of that size.
            BOOST_TEST(std::abs(found[k] - reported[k]) <= 1e-5);
          }
        }
      }
    }
  }
  BOOST_TEST(first.size() == 9);
}
