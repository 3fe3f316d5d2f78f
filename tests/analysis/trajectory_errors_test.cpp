// SPDX-License-Identifier: BSL-1.0
// Many methods against one reference, along many trajectories.
#include "nysalt/analysis/trajectory_errors.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "../support/in_lanes.hpp"
#include "../support/ranks_as_threads.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/trial_run.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, 6>;
using pair = member<nystrom>;
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
const fine_steps<> reference(5e-4);
const auto stiff_energy = [](const state& x) { return chain.stiff_energy(x); };
const auto path = path_measure(chain, stiff_energy);

/// Two of one type: two half Verlets, and nearly McLachlan.
const std::array<pair, 2> pairs{pair({.5, .375}), pair({.5, .4034})};

/// Where one trajectory is read after the other.
const in_lanes<fpu_chain<3>, 1> singly(chain);

/// No reference: it throws when it is asked.
struct no_reference {
  void advance(const fpu_chain<3>&, state&, double) const { throw std::logic_error("it was asked"); }
  no_reference finer() const { throw std::logic_error("it was asked"); }
  std::string description() const { throw std::logic_error("it was asked"); }
};

/// Not finite after the given number of steps, all trajectories together; its finer self lasts.
struct breaking {
  std::int64_t steps_that_last;
  std::shared_ptr<std::int64_t> taken = std::make_shared<std::int64_t>(0);  // by all copies
  template <class S>
  void advance(const S& system, state& x, double t) const {
    reference.advance(system, x, t);
    if ((*taken)++ >= steps_that_last) x.p[2] = NAN;
  }
  breaking finer() const { return {1000, std::make_shared<std::int64_t>(0)}; }
  std::string description() const { return "one that breaks"; }
};

/// The reference, but trajectories of which q_1 is near a given number are lost when they get there in time.
struct losing {
  double q1;
  template <class S, class T>
  void advance(const S& system, phase_point<T, 6>& x, double t) const {
    reference.advance(system, x, t);
    for (int k = 0; k < lanes_in<T>; ++k) {
      if (lane(x.q[0], k) < q1) set_lane(x.p[2], k, NAN);
    }
  }
  losing finer() const { return {-1e9}; }
  std::string description() const { return "one that loses"; }
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(const estimate& a, const estimate& b) {
  return same_bits(a.mean, b.mean) && same_bits(a.standard_error, b.standard_error);
}
bool same_bits(const trajectory_errors_result& a, const trajectory_errors_result& b) {
  bool same = same_bits(a.reference_error.value(), b.reference_error.value()) &&
              same_bits(a.null_model.value(), b.null_model.value()) &&
              same_bits(a.predictable_until.value(), b.predictable_until.value());
  const auto numbers = [](double x, double y) { return same_bits(x, y); };
  const auto lost = [](const diverged_trajectory& x, const diverged_trajectory& y) {
    return x.trajectory == y.trajectory && x.step == y.step;
  };
  for (std::size_t k = 0; k < a.methods.size(); ++k) {
    const method_error& x = a.methods[k];
    const method_error& y = b.methods[k];
    same = same && same_bits(x.error, y.error) && std::ranges::equal(x.of_each, y.of_each, numbers) &&
           std::ranges::equal(x.diverged_at, y.diverged_at, lost);
  }
  return same;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_method_has_no_error_against_itself) {
  const trajectory_options options{.step = .01, .steps = 20, .trajectories = 5};
  const auto of = [&](const auto& method) {
    return trajectory_errors(chain, fine_steps<verlet>(.01), law, method, path, options);
  };
  // Stepping without merging differs by rounding, some 20 of them a step, which 20 steps magnify little.
  const auto own = of(verlet());
  BOOST_TEST(own.methods[0].error.mean <= 20 * 20 * eps * 10.0);
  BOOST_TEST(of(verlet_2x()).methods[0].error.mean > 1e-3);
  // What "finer" means here: two Verlets for one, as the method that was just judged.
  BOOST_TEST(own.reference == "verlet with step 0.01");
  BOOST_TEST(own.reference_error.value().mean == of(verlet_2x()).methods[0].error.mean,
             boost::test_tools::tolerance(.1));  // relative to either of two paths that differ by 3 %
}

/// The formulas once more, over paths that are kept; means over time by all samples alike, or up to a horizon
/// in the midst of the last step.
BOOST_AUTO_TEST_CASE(streaming_gives_what_the_formula_says) {
  constexpr std::int64_t trajectories = 3;
  constexpr std::int64_t steps = 70;  // more than integrate goes without looking
  for (const std::optional<double> horizon : {std::optional<double>(), std::optional(.6936)}) {
    const double last = horizon.value_or(.7) / .01 - (steps - 1);  // of the last step, linear in between
    const double all = horizon ? steps - 1 + last : steps;
    const auto weight = [&](int n) {
      if (!horizon) return n == 0 ? 0.0 : 1.0;
      if (n == steps) return last * last / 2.0;
      return n == steps - 1 ? 0.5 + last - last * last / 2.0 : n == 0 ? 0.5 : 1.0;
    };
    double mean = 0.0;
    double mean_relative = 0.0;
    double size = 0.0;
    double exchanged = 0.0;
    double whole = 0.0;
    for (std::uint64_t m = 0; m < trajectories; ++m) {
      auto x = law(7, m);
      auto y = x;
      double squares = 0.0;
      double relative_squares = 0.0;
      for (int n = 0; n <= steps; ++n) {
        if (n > 0) {
          reference.advance(chain, x, .01);
          make_stepper(chain, verlet(), .01).step(y);
        }
        const double share = weight(n) / all;
        const double difference = stiff_energy(y) - stiff_energy(x);
        squares += difference * difference * share;
        relative_squares += std::pow(difference / stiff_energy(x), 2) * share;
        size += stiff_energy(x) * stiff_energy(x) * share / trajectories;
        whole += stiff_energy(x) * share;
        for (Eigen::Index j = 0; j < 3; ++j) {
          exchanged += std::abs(chain.stiff_energy(y, j) - chain.stiff_energy(x, j)) * share;
        }
      }
      mean += std::sqrt(squares) / trajectories;
      mean_relative += std::sqrt(relative_squares) / trajectories;
    }
    trajectory_options options{.step = .01, .steps = steps, .trajectories = trajectories, .seed = 7};
    options.horizon = horizon;
    const auto error = [&](const auto& measure) {
      return trajectory_errors(chain, reference, law, verlet(), measure, options).methods[0].error.mean;
    };
    // Merging rounds otherwise, 1e-16 a step, and errors of 1e-2 are differences of numbers near 2.
    const auto near = boost::test_tools::tolerance(1e-10);
    BOOST_TEST(error(path) == mean / std::sqrt(size), near);
    BOOST_TEST(error(relative_measure(chain, stiff_energy)) == mean_relative, near);
    BOOST_TEST(error(exchange_measure(chain)) == exchanged / whole, near);
  }
}

// Where o_ref is 2 + q_1 with q_1 near 0, and 2 + q_1 of a chain that is far to the left: on each it keeps
// its sign, on both together it does not; and sin(50 t) changes it on the way.
BOOST_AUTO_TEST_CASE(a_relative_error_needs_an_observable_of_one_sign) {
  state left = law(1, 1);
  left.q.array() -= 10.0;  // the whole chain, whose energy does not mind but for the walls' springs
  const auto judge = [&](const std::vector<state>& starts, const auto& observable) {
    trajectory_errors(chain, reference, listed<6>(starts), verlet(), relative_measure(chain, observable),
                      {.step = .001, .steps = 20, .trajectories = std::ssize(starts)});
  };
  const auto far = [](const state& x) { return 5.0 + x.q[2]; };
  BOOST_CHECK_NO_THROW(judge({law(1, 0)}, far));
  BOOST_CHECK_NO_THROW(judge({left}, far));
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        judge({law(1, 0), left}, far);
      },
      {"relative error", "change its sign", "path error"}));
  const auto elongation = [](const state& x) { return x.q[1] - x.q[0]; };
  trajectory_options longer{.step = .002, .steps = 100, .trajectories = 1};
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        trajectory_errors(chain, reference, law, verlet(), relative_measure(chain, elongation), longer);
      },
      {"relative error", "change its sign"}));
  BOOST_CHECK_NO_THROW(
      trajectory_errors(chain, reference, law, verlet(), path_measure(chain, elongation), longer));
}

BOOST_AUTO_TEST_CASE(errors_of_second_order_fall_by_four_with_the_step) {
  const auto error = [](const auto& measure, double step) {
    const auto steps = static_cast<std::int64_t>(.5 / step + .5);
    const trajectory_options options{.step = step, .steps = steps, .trajectories = 20};
    const auto result = trajectory_errors(chain, reference, law, verlet(), measure, options);
    if (result.reference_error)
      BOOST_TEST(result.reference_error->mean < 1e-5 * result.methods[0].error.mean);
    return result.methods[0].error.mean;
  };
  const auto ratio = [&](const auto& measure) { return error(measure, .005) / error(measure, .0025); };
  // The next term is z^2 = 1/16 of the first, so that the ratio is off by 6 % or so.
  const auto near = boost::test_tools::tolerance(.08);
  BOOST_TEST(ratio(path) == 4.0, near);
  BOOST_TEST(ratio(state_measure(chain)) == 4.0, near);
  BOOST_TEST(ratio(exchange_measure(chain)) == 4.0, near);
  BOOST_TEST(ratio(energy_measure(chain)) == 4.0, near);
}

BOOST_AUTO_TEST_CASE(methods_beside_each_other_do_not_notice) {
  const trajectory_options options{.step = .02, .steps = 25, .trajectories = 20};
  const auto both = trajectory_errors(chain, reference, law, pairs, path, options);
  const auto span = trajectory_errors(chain, reference, law, std::span<const pair>(pairs), path, options);
  BOOST_REQUIRE(both.methods.size() == 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto alone = trajectory_errors(chain, reference, law, pairs[k], path, options);
    BOOST_TEST(same_bits(both.methods[k].error, alone.methods[0].error));
    BOOST_TEST(same_bits(both.methods[k].error, span.methods[k].error));
  }
  BOOST_TEST(both.methods[0].error.mean > 3.0 * both.methods[1].error.mean);
  BOOST_TEST(both.reference == reference.description());
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_no_bit) {
  // At z = 2.5 some of these diverge.
  for (const double step : {.02, .05}) {
    const auto run = [&](int threads) {
      const trajectory_options options{.step = step, .steps = 20, .trajectories = 50, .threads = threads};
      return trajectory_errors(chain, reference, law, std::array<verlet, 1>(), state_measure(chain), options);
    };
    const auto one = run(1);
    for (const int threads : {2, 5}) {
      const auto several = run(threads);
      BOOST_TEST(same_bits(several.methods[0].error, one.methods[0].error));
      BOOST_TEST(same_bits(several.reference_error.value(), one.reference_error.value()));
      BOOST_TEST(several.methods[0].diverged == one.methods[0].diverged);
      BOOST_TEST(several.methods[0].diverged_at.size() == one.methods[0].diverged_at.size());
    }
    BOOST_TEST((one.methods[0].diverged > 0) == (step == .05));
  }
}

// Some diverge; of four leaves five ranks have none or one.
BOOST_AUTO_TEST_CASE(the_number_of_ranks_changes_no_bit) {
  std::vector<std::int64_t> told;
  const auto run = [&](const communicator& ranks, int threads, std::uint64_t seed) {
    trajectory_options options{
        .step = .05, .steps = 20, .trajectories = 50, .seed = seed, .threads = threads, .ranks = &ranks};
    options.null_model = true;
    options.perturbation = 1e-6;
    options.progress = [&told, &ranks](std::int64_t done) {
      if (!ranks.is_first()) throw std::logic_error("not the first rank told it");
      told.push_back(done);
    };
    return trajectory_errors(chain, reference, law, std::array<verlet, 1>(), state_measure(chain), options);
  };
  const auto expected = run(one_rank, 1, 1);
  BOOST_TEST(expected.methods[0].diverged > 0);
  BOOST_TEST(!same_bits(run(one_rank, 1, 2), expected));
  for (const int size : {1, 2, 3, 5}) {
    for (const int threads : {1, 2}) {
      told.clear();
      std::vector<trajectory_errors_result> found(static_cast<std::size_t>(size));
      run_ranks(size, [&](const communicator& ranks) {
        found[static_cast<std::size_t>(ranks.rank())] = run(ranks, threads, 1);
      });
      for (const auto& result : found) BOOST_TEST(same_bits(result, expected));
      BOOST_REQUIRE(!told.empty());
      BOOST_TEST(told.back() == 50);
    }
  }
}

// Some diverge, at steps of their own; 37 trajectories fill no number of lanes.
BOOST_AUTO_TEST_CASE(the_number_of_lanes_changes_no_bit) {
  for (const double step : {.02, .05}) {
    const auto run = [&](const auto& system, const auto& measure) {
      const trajectory_options options{.step = step, .steps = 130, .trajectories = 37, .threads = 2};
      return trajectory_errors(system, reference, law, verlet(), measure(system), options);
    };
    const auto by_state = [](const auto& system) { return state_measure(system); };
    const auto by_path = [](const auto& system) { return path_measure(system, stiff_energy); };
    const auto by_energy = [](const auto& system) { return energy_measure(system); };
    const auto by_exchange = [](const auto& system) { return exchange_measure(system); };
    const auto agree = [&](const auto& measure) {
      const auto one = run(singly, measure);
      const auto same = [&](const auto& other) {
        const auto& found = other.methods[0];
        const auto& expected = one.methods[0];
        BOOST_TEST(same_bits(found.error, expected.error));
        BOOST_REQUIRE(found.diverged == expected.diverged);
        for (std::size_t i = 0; i < expected.diverged_at.size(); ++i) {
          BOOST_TEST(found.diverged_at[i].trajectory == expected.diverged_at[i].trajectory);
          BOOST_TEST(found.diverged_at[i].step == expected.diverged_at[i].step);
        }
        if (one.reference_error) BOOST_TEST(same_bits(*other.reference_error, *one.reference_error));
      };
      same(run(chain, measure));
      BOOST_TEST((one.methods[0].diverged > 0) == (step == .05));
    };
    agree(by_state);
    agree(by_path);
    agree(by_energy);
    agree(by_exchange);
  }
}

// At z = 2.5 Verlet is unstable and magnifies stiff motion by 4 in a step; in 8 steps a chain that hardly
// moves does not get there.
BOOST_AUTO_TEST_CASE(diverged_trajectories_are_told_and_left_out) {
  constexpr std::int64_t steps = 8;
  const state at_rest{vector<double, 6>::Constant(1e-3), vector<double, 6>::Constant(1e-3)};
  const auto measure = relative_measure(chain, [](const state& x) { return 20.0 + x.q[0]; });
  const auto of = [&](const std::vector<state>& starts) {
    const trajectory_options options{.step = .05, .steps = steps, .trajectories = std::ssize(starts)};
    return trajectory_errors(chain, reference, listed<6>(starts), verlet(), measure, options).methods[0];
  };
  const auto all = of({law(1, 0), at_rest, law(1, 1)});
  const auto alone = of({at_rest});
  BOOST_TEST(all.diverged == 2);
  BOOST_REQUIRE(all.diverged_at.size() == 2U);
  BOOST_TEST(all.diverged_at[0].trajectory == 0);
  BOOST_TEST(all.diverged_at[1].trajectory == 2);
  for (const auto& [trajectory, step] : all.diverged_at) {
    const auto start = law(1, trajectory == 0 ? 0U : 1U);
    BOOST_TEST(step == integrate(chain, verlet(), .05, start, steps).diverged_at.value());
  }
  BOOST_TEST(alone.diverged == 0);
  BOOST_TEST(same_bits(all.error.mean, alone.error.mean));
  BOOST_TEST(std::isnan(all.error.standard_error));
  const auto none_left = of({law(1, 0)});
  BOOST_TEST(none_left.diverged == 1);
  BOOST_TEST(std::isnan(none_left.error.mean));
  BOOST_TEST(none_left.evaluations_per_time * .05 * steps == 9.0, boost::test_tools::tolerance(8 * eps));
}

// The observable has no value at the method's fifth step, where the state itself is sound.
BOOST_AUTO_TEST_CASE(an_error_without_a_value_counts_as_diverged) {
  std::int64_t looks = 0;
  const auto measure = path_measure(singly, [&](const state&) {
    ++looks;  // 1 at the start, 10 along the reference and 10 along the finer one, then the method's
    return looks > 21 + 4 ? NAN : 1.0;
  });
  const trajectory_options options{.step = .02, .steps = 10, .trajectories = 1};
  const auto result = trajectory_errors(singly, reference, law, verlet(), measure, options).methods[0];
  BOOST_TEST(result.diverged == 1);
  BOOST_TEST(result.diverged_at.at(0).step == 5);
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_for_one_whole_trajectory) {
  const trajectory_options options{.step = .01, .steps = 20, .trajectories = 3};
  const auto evaluations = [&](const auto& method) {
    const auto result = trajectory_errors(chain, reference, law, method, path, options);
    return result.methods[0].evaluations_per_time * .2;
  };
  const auto near = boost::test_tools::tolerance(8 * eps);
  BOOST_TEST(evaluations(verlet()) == 21.0, near);  // one for each step, and one to begin
  BOOST_TEST(evaluations(verlet_2x()) == 41.0, near);
  BOOST_TEST(evaluations(mclachlan2()) == 40.0, near);  // none to begin with a drift
  BOOST_TEST(evaluations(srkn6b()) == 121.0, near);
}

BOOST_AUTO_TEST_CASE(the_energy_error_asks_for_no_reference) {
  const trajectory_options options{.step = .01, .steps = 20, .trajectories = 3};
  const auto result = trajectory_errors(chain, no_reference(), law, verlet(), energy_measure(chain), options);
  BOOST_TEST(result.methods[0].error.mean > 0.0);
  BOOST_TEST(!result.reference_error.has_value());
  BOOST_TEST(result.reference.empty());
  BOOST_CHECK_THROW(trajectory_errors(chain, no_reference(), law, verlet(), path, options), std::logic_error);
}

BOOST_AUTO_TEST_CASE(progress_counts_trajectories_in_turn) {
  for (const int threads : {1, 3}) {
    std::vector<std::int64_t> told;
    const trajectory_options options{
        .step = .01, .steps = 2, .trajectories = 40, .threads = threads, .progress = [&](std::int64_t done) {
          told.push_back(done);
        }};
    trajectory_errors(chain, reference, law, verlet(), energy_measure(chain), options);
    BOOST_REQUIRE(!told.empty());
    BOOST_TEST(told.back() == 40);
    for (std::size_t i = 1; i < told.size(); ++i) BOOST_TEST(told[i - 1] < told[i]);
  }
}

BOOST_AUTO_TEST_CASE(a_reference_that_breaks_is_told_of) {
  const trajectory_options options{.step = .01, .steps = 5, .trajectories = 30};
  const auto judge = [&](std::int64_t lasts) {
    trajectory_errors(singly, breaking{lasts}, law, verlet(), path_measure(singly, stiff_energy), options);
  };
  BOOST_CHECK_NO_THROW(judge(30 * 5));
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { judge(3); }, {"trajectory 0 ", "one that breaks", "must be finite", "at step 4"}));
  BOOST_TEST(
      refuses<std::runtime_error>([&] { judge(5 + 2); }, {"trajectory 1 ", "must be finite", "at step 3"}));
  const auto log_of_q = path_measure(chain, [](const state& x) { return std::log(x.q[0] - 10.0); });
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { trajectory_errors(chain, reference, law, verlet(), log_of_q, options); },
      {"trajectory 0 ", "path error", "step 1"}));
}

// Two are lost, the later one earlier; it is the first of them that is named, whichever trajectories are
// stepped beside it.
BOOST_AUTO_TEST_CASE(the_first_trajectory_that_is_lost_is_named_by_any_number_of_lanes) {
  const trajectory_options options{.step = .01, .steps = 60, .trajectories = 30};
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < 30; ++m) starts.push_back(law(1, m));
  starts[5].p[0] = -4.0;  // down from .7
  starts[11].p[0] = -8.0;
  const auto named = [&](const auto& system) {
    try {
      trajectory_errors(system, losing{.4}, listed<6>(starts), verlet(), state_measure(system), options);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto alone = named(singly);
  BOOST_TEST_CONTEXT(alone) { BOOST_TEST(alone.find("trajectory 5 ") == 0U); }
  BOOST_TEST(named(chain) == alone);
}

// Trajectories 20 and 31 have an energy of 0, and the earlier one is seen late.
BOOST_AUTO_TEST_CASE(the_first_trajectory_in_trouble_is_named_by_any_number_of_threads) {
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < 40; ++m) starts.push_back(law(1, m));
  starts[31].p[2] = INFINITY;
  starts[20].q[0] = NAN;
  for (const int threads : {1, 2, 5}) {
    const trajectory_options options{.step = .01, .steps = 5, .trajectories = 40, .threads = threads};
    BOOST_TEST(refuses<std::invalid_argument>(
        [&] { trajectory_errors(chain, reference, listed<6>(starts), verlet(), path, options); },
        {"start 20 ", "must be finite"}));
  }
}

// On the second rank of two and of three one is seen at once and one late, on the last one another.
BOOST_AUTO_TEST_CASE(all_ranks_name_the_first_trajectory_in_trouble) {
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < 60; ++m) starts.push_back(law(1, m));
  for (const std::size_t m : {58U, 40U, 33U}) starts[m].q[0] = NAN;
  const auto said = [&](const communicator& ranks) {
    try {
      trajectory_errors(chain, reference, listed<6>(starts), verlet(), path,
                        {.step = .01, .steps = 5, .trajectories = 60, .ranks = &ranks});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string expected = said(one_rank);
  BOOST_TEST_CONTEXT(expected) { BOOST_TEST(expected.find("start 33 ") != std::string::npos); }
  for (const int size : {2, 3, 5}) {
    std::vector<std::string> found(static_cast<std::size_t>(size));
    run_ranks(size, [&](const communicator& ranks) {
      found[static_cast<std::size_t>(ranks.rank())] = said(ranks);
    });
    for (const auto& message : found) BOOST_TEST(message == expected);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto judge = [](const trajectory_options& options, const auto& measure) {
    trajectory_errors(chain, reference, law, verlet(), measure, options);
  };
  const auto refused = [&](const trajectory_options& options, auto... words) {
    return refuses<std::invalid_argument>([&] { judge(options, path); }, {words...});
  };
  BOOST_CHECK_NO_THROW(judge({.step = .01, .steps = 1, .trajectories = 1}, path));
  BOOST_TEST(refused({.step = .01, .steps = 0, .trajectories = 1}, "0 steps", "at least 1"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 0}, "0 trajectories"));
  BOOST_TEST(refused({.step = 0.0, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = NAN, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .threads = 0}, "thread"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .threads = 1'000'000}, "fit into memory", "threads"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 2'000'000'000}, "fit into memory"));
  BOOST_TEST(refused({.step = .0103, .steps = 1}, "a multiple"));  // of the fine step
  const auto nothing = path_measure(chain, [](const state&) { return 0.0; });
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge({.step = .01, .steps = 1}, nothing); },
                                            {"path error", "must not be 0"}));
  const std::vector<state> at_rest{{vector<double, 6>::Zero(), vector<double, 6>::Zero()}};
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        trajectory_errors(chain, reference, listed<6>(at_rest), verlet(), energy_measure(chain),
                          {.step = .01, .steps = 1, .trajectories = 1});
      },
      {"energy error", "must not be 0"}));
}

BOOST_AUTO_TEST_CASE(a_tuned_method_keeps_its_step_and_system) {
  const tuned_method<nystrom> tuned(pairs[1], .02, chain.description());
  const auto judge = [&](double step) {
    return trajectory_errors(chain, reference, law, tuned, path, {.step = step, .steps = 5})
        .methods[0]
        .diverged;
  };
  BOOST_TEST(judge(.02) == 0);
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge(.01); }, {"must run at the step 0.02", "got 0.01"}));
}

BOOST_AUTO_TEST_CASE(a_measure_of_a_system_of_another_size_is_refused) {
  const trajectory_options options{.step = .01, .steps = 2, .trajectories = 2};
  for (const auto& measure :
       {state_measure(henon_heiles()), energy_measure(henon_heiles()),
        path_measure(henon_heiles(), [](const phase_point<double, 2>& x) { return x.q[0]; })}) {
    BOOST_TEST(refuses<std::invalid_argument>(
        [&] { trajectory_errors(chain, reference, law, verlet(), measure, options); },
        {measure.name, "of systems of 6 degrees of freedom", "got 2"}));
  }
}

namespace {

/// A black box that keeps scratch: two threads in one copy of it is one too many.
struct one_thread_at_a_time {
  static constexpr int dimension = 1;
  static constexpr int lanes = 1;
  mutable std::atomic<bool> is_busy = false;
  one_thread_at_a_time() = default;
  one_thread_at_a_time(const one_thread_at_a_time&) {}
  one_thread_at_a_time& operator=(const one_thread_at_a_time&) { return *this; }

  void force(const vector<double, 1>& q, vector<double, 1>& f) const {
    if (is_busy.exchange(true)) throw std::logic_error("two threads at a time");
    std::this_thread::yield();
    f = -q;
    is_busy = false;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(threads_have_copies_of_a_black_box) {
  const one_thread_at_a_time box;
  const normal_around<1> starts({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.0, 1.0);
  const auto first = [](const auto& x) { return x.q[0]; };
  const auto judge = [&](int threads) {
    const trajectory_options options{.step = .1, .steps = 5, .trajectories = 40, .threads = threads};
    return trajectory_errors(box, fine_steps<>(.05), starts, verlet(), path_measure(box, first), options);
  };
  BOOST_TEST(judge(2).methods[0].error.mean == judge(1).methods[0].error.mean);

  const auto try_out = [&](int threads) {
    const auto some = typical_and_energetic_starts(box, starts, 1, 0, 40);
    return trial_run(box, tabulated(verlet()), .1, some, {.steps = 10, .threads = threads}).report();
  };
  BOOST_TEST(try_out(2) == try_out(1));
  const auto warm_up = [&](int threads) {
    const in_bath warm(box, bath::of_temperature(1.0, 0.5));
    const burn_in_options options{
        .friction = 1.0, .step = 0.5, .length = 10.0, .pilots = 16, .threads = threads};
    return gibbs(warm, starts, options).report().tau;
  };
  BOOST_TEST(warm_up(2) == warm_up(1));
}
