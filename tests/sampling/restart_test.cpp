// SPDX-License-Identifier: BSL-1.0
// Chains that are cut and go on from a kept state draw the same bits, and ranks change none.
#include <boost/test/unit_test.hpp>

#include <cstring>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const phi4_chain<> wells(5);
const Eigen::VectorXd no_shift = Eigen::VectorXd::Zero(5);
const normal_around<Eigen::Dynamic> around_wells({no_shift, no_shift}, 0.5, 1.0);

struct course {
  std::vector<double> draws;  // coordinate 1, chain after chain; 0 where it was not drawn here
  std::vector<hmc_state> kept;
  hmc_result result;
};

course run_from(hmc_options options, const hmc_state* from = nullptr) {
  course all;
  all.draws.resize(static_cast<std::size_t>(options.chains * options.draws));
  options.from = from;
  options.keep = [&](const hmc_state& state) { all.kept.push_back(state); };
  all.result = hmc(wells, tabulated(bcss3{}), around_wells, options, [&](const hmc_draw& draw) {
    all.draws[static_cast<std::size_t>(draw.chain * options.draws + draw.number)] = draw.q[0];
  });
  return all;
}

/// Whether what was drawn after the state is the same, and the result.
bool goes_on_as(const course& whole, const course& rest, const hmc_options& options, const hmc_state& state) {
  const auto first = std::max<std::int64_t>(0, state.trajectories - options.burn_in);
  for (std::int64_t m = 0; m < options.chains; ++m) {
    for (std::int64_t n = first; n < options.draws; ++n) {
      const auto at = static_cast<std::size_t>(m * options.draws + n);
      if (whole.draws[at] != rest.draws[at]) return false;
    }
  }
  return whole.result.step == rest.result.step &&
         whole.result.acceptance.mean == rest.result.acceptance.mean &&
         whole.result.square_of_energy_error.mean == rest.result.square_of_energy_error.mean &&
         whole.result.diverged == rest.result.diverged &&
         whole.result.evaluations_of_draw == rest.result.evaluations_of_draw &&
         whole.result.evaluations_of_burn_in == rest.result.evaluations_of_burn_in &&
         whole.result.deviations == rest.result.deviations;
}

/// To the bit: a trajectory that diverged while the step was tuned leaves what is not a number.
bool same_numbers(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

const hmc_options tuned{.step = 0.3,
                        .length = 1.0,
                        .chains = 37,
                        .burn_in = 120,
                        .draws = 40,
                        .acceptance = 0.9,
                        .keep_every = 20};

}  // namespace

BOOST_AUTO_TEST_CASE(cut_and_resumed_they_draw_the_same_bits) {
  hmc_options with_masses = tuned;
  with_masses.diagonal_masses = true;
  for (const hmc_options& options : {tuned, with_masses}) {
    const course whole = run_from(options);
    BOOST_TEST_REQUIRE(whole.kept.size() == 8U);  // 160 trajectories
    for (const auto& state : whole.kept) {
      hmc_options others = options;
      others.threads = 2;
      BOOST_TEST(goes_on_as(whole, run_from(others, &state), options, state), state.trajectories);
    }
    // What is looked at can tell: another seed goes on otherwise.
    hmc_options another = options;
    another.seed = 2;
    BOOST_TEST(!goes_on_as(whole, run_from(another, &whole.kept[4]), options, whole.kept[4]));
    // How often states are kept changes nothing.
    hmc_options never = options;
    never.keep_every = 0;
    BOOST_TEST((run_from(never).draws == whole.draws));
  }
}

BOOST_AUTO_TEST_CASE(ranks_change_no_bit_and_go_on_from_what_another_number_kept) {
  hmc_options options = tuned;
  options.diagonal_masses = true;
  const course alone_all = run_from(options);
  for (const int size : {2, 3}) {
    std::vector<course> found(static_cast<std::size_t>(size));
    std::vector<course> resumed(found.size());
    run_ranks(size, [&](const communicator& ranks) {
      hmc_options on_ranks = options;
      on_ranks.ranks = &ranks;
      const auto r = static_cast<std::size_t>(ranks.rank());
      found[r] = run_from(on_ranks);
      resumed[r] = run_from(on_ranks, &alone_all.kept[3]);
    });
    std::vector<double> together_drawn(alone_all.draws.size());
    std::vector<double> drawn_after(together_drawn);
    for (std::size_t r = 0; r < found.size(); ++r) {
      for (std::size_t i = 0; i < together_drawn.size(); ++i) {
        together_drawn[i] += found[r].draws[i];  // that of one rank and zeros
        drawn_after[i] += resumed[r].draws[i];
      }
      BOOST_TEST(found[r].result.acceptance.mean == alone_all.result.acceptance.mean);
      BOOST_TEST(resumed[r].result.acceptance.mean == alone_all.result.acceptance.mean);
      BOOST_TEST_REQUIRE(found[r].kept.size() == alone_all.kept.size());
      for (std::size_t k = 0; k < found[r].kept.size(); ++k)
        BOOST_TEST(same_numbers(found[r].kept[k].numbers, alone_all.kept[k].numbers));
    }
    BOOST_TEST((together_drawn == alone_all.draws));
    BOOST_TEST((drawn_after == alone_all.draws));  // kept in the burn-in
  }
}

BOOST_AUTO_TEST_CASE(a_state_of_other_options_is_refused) {
  const course whole = run_from(tuned);
  const auto refused = [&](const hmc_options& options, const hmc_state& state) {
    BOOST_CHECK_EXCEPTION(run_from(options, &state), std::invalid_argument, [](const auto& problem) {
      return std::string(problem.what()).find("the state to go on from") != std::string::npos;
    });
  };
  hmc_options options = tuned;
  options.chains = 36;
  refused(options, whole.kept[2]);
  options = tuned;
  options.diagonal_masses = true;
  refused(options, whole.kept[2]);
  options = tuned;
  options.draws = 10;
  refused(options, whole.kept.back());
  BOOST_CHECK_NO_THROW(run_from(tuned, &whole.kept.back()));
}
