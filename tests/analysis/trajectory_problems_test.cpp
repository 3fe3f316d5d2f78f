// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.0 s at -O0, 0.1 s at -O1.
// What goes wrong along trajectories is reported with its trajectory and step, and what cannot be compared is
// refused.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/along_path.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using failure = std::runtime_error;
using state = phase_point<double, Eigen::Dynamic>;

const model of_chain{fpu_chain<3>(50.0)};
const fpu_law<Eigen::Dynamic> law{fpu_chain<>(3, 50.0)};
/// Where one trajectory is read after the other.
const model singly{in_lanes<fpu_chain<3>, 1>(fpu_chain<3>(50.0))};
const tabulated by_verlet{verlet()};
const fine_steps<> fine(5e-4);
const auto first_coordinate = [](const state& x) { return x.q[0]; };
const auto by_state = state_measure(of_chain);

template <class R>
detail::reference_value value_of(const R& reference) {
  return detail::reference_value(detail::reference_of(of_chain, reference));
}
const detail::reference_value reference = value_of(fine);

/// The reference until a number of steps, all trajectories together, or until q_1 is below a bound.
struct breaking {
  std::int64_t steps_that_last;
  double bound = -1e9;
  std::shared_ptr<std::int64_t> taken = std::make_shared<std::int64_t>(0);  // by all copies

  template <class T>
  void advance(const model& system, phase_point<T, Eigen::Dynamic>& x, double t, const path_place& at,
               std::span<vector<T, Eigen::Dynamic>> xi) const {
    reference.advance(system, x, t, at, xi);
    const bool ends = (*taken)++ >= steps_that_last;
    for (int k = 0; k < lanes_in<T>; ++k) {
      if (ends || lane(x.q[0], k) < bound) set_lane(x.p[2], k, NAN);
    }
  }
  breaking finer() const { return {1'000'000}; }
  std::string description() const { return "one that breaks"; }
};

trajectory_errors_result judged(const initial_states& starts, const error_measure& measure,
                                const trajectory_options& options, const auto& against = reference,
                                const model& system = of_chain) {
  return trajectory_errors(system, against, starts, by_verlet, measure, options);
}
trajectory_errors_result judged(const initial_states& starts, const error_measure& measure,
                                const trajectory_options& options) {
  return judged(starts, measure, options, reference);
}

std::vector<state> starts_of_law(std::uint64_t count) {
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < count; ++m) starts.push_back(law(1, m));
  return starts;
}
listed<Eigen::Dynamic> these(const std::vector<state>& starts) { return listed<Eigen::Dynamic>(starts); }

/// What is said of a failure, or "nothing".
std::string said(const auto& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

const model warm = model(harmonic_oscillator(2.0)).in(bath::of_sigma(0.5, 0.4));
const normal_around<Eigen::Dynamic> around_zero({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}, 0.5,
                                                1.0);
const tabulated by_baoab{baoab()};
const tabulated by_halves{thermostat<placement::symmetric>(mclachlan2())};
const tabulated by_thirds("thirds", run_time_word("OABOBAO"),
                          std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});

auto judged_in_bath(const std::vector<tabulated>& methods, const trajectory_options& options,
                    const auto& against) {
  return trajectory_errors(warm, value_of(against), around_zero, std::span<const tabulated>(methods),
                           state_measure(warm), options);
}

}  // namespace

// At z = 2.5 Verlet is unstable and magnifies stiff motion by 4 in a step; in 8 steps a chain that hardly
// moves does not get there.
BOOST_AUTO_TEST_CASE(diverged_trajectories_are_told_and_left_out) {
  constexpr std::int64_t steps = 8;
  const state at_rest{Eigen::VectorXd::Constant(6, 1e-3), Eigen::VectorXd::Constant(6, 1e-3)};
  const auto measure = relative_measure(of_chain, [](const state& x) { return 20.0 + x.q[0]; });
  const auto of = [&](const std::vector<state>& starts) {
    return judged(these(starts), measure, {.step = .05, .steps = steps, .trajectories = std::ssize(starts)})
        .methods[0];
  };
  const auto all = of({law(1, 0), at_rest, law(1, 1)});
  const auto alone = of({at_rest});
  BOOST_TEST(all.diverged == 2);
  BOOST_REQUIRE(all.diverged_at.size() == 2U);
  BOOST_TEST(all.diverged_at[0].trajectory == 0);
  BOOST_TEST(all.diverged_at[1].trajectory == 2);
  for (const auto& [trajectory, step] : all.diverged_at) {
    const auto start = law(1, trajectory == 0 ? 0U : 1U);
    BOOST_TEST(step == integrate(of_chain, by_verlet, .05, start, steps).diverged_at.value());
  }
  BOOST_TEST(alone.diverged == 0);
  BOOST_TEST(all.error.mean == alone.error.mean);
  BOOST_TEST(std::isnan(all.error.standard_error));
  const auto none_left = of({law(1, 0)});
  BOOST_TEST(none_left.diverged == 1);
  BOOST_TEST(std::isnan(none_left.error.mean));
  BOOST_TEST(none_left.evaluations_per_time * .05 * steps == 9.0, boost::test_tools::tolerance(8 * eps));
}

BOOST_AUTO_TEST_CASE(in_a_bath_a_method_that_diverges_is_told_with_its_step) {
  const trajectory_options options{.step = 1.2, .steps = 200, .trajectories = 3, .seed = 3};
  const auto paths = value_of(fine_paths(0.02));
  for (const auto& method : {by_baoab, by_thirds}) {
    const auto found = judged_in_bath({method, by_halves}, options, fine_paths(0.02));
    BOOST_TEST(found.methods[0].diverged == 3);
    BOOST_TEST(found.methods[1].diverged == 0);
    for (const auto& [m, step] : found.methods[0].diverged_at) {
      const auto trajectory = static_cast<std::uint64_t>(m);
      recorded_path<double, Eigen::Dynamic> path(0.2, 0.5, trajectory);
      auto x = around_zero(3, trajectory);
      for (std::int64_t n = 0; n < 200; ++n) {
        std::vector<Eigen::VectorXd> xi(6, Eigen::VectorXd(1));
        paths.advance(warm, x, 1.2, path_place{3, trajectory, n}, std::span(xi));
        for (const auto& one : xi) path.add(one);
      }
      const auto intervals = intervals_of_noise(word_of(method), method.coefficients());
      const along_path<double, Eigen::Dynamic> noise(path, intervals, 1.2);
      const auto stepper = make_stepper(warm, method, 1.2, noise);
      const auto alone = integrate(
          stepper, around_zero(3, trajectory), 200, [](auto&&...) {}, 200, trajectory);
      BOOST_TEST(step == alone.diverged_at.value());
    }
  }
}

// The observable has no value at the method's fifth step, where the state itself is sound.
BOOST_AUTO_TEST_CASE(an_error_without_a_value_counts_as_diverged) {
  std::int64_t looks = 0;
  const auto measure = path_measure(singly, [&](const state&) {
    ++looks;  // 1 at the start, 10 along the reference and 10 along the finer one, then the method's
    return looks > 21 + 4 ? NAN : 1.0;
  });
  const auto result =
      judged(law, measure, {.step = .02, .steps = 10, .trajectories = 1}, reference, singly).methods[0];
  BOOST_TEST(result.diverged == 1);
  BOOST_TEST(result.diverged_at.at(0).step == 5);
}

BOOST_AUTO_TEST_CASE(a_reference_that_breaks_is_told_of) {
  const trajectory_options options{.step = .01, .steps = 5, .trajectories = 30};
  const auto judge = [&](std::int64_t lasts) {
    judged(law, path_measure(singly, first_coordinate), options, breaking{lasts}, singly);
  };
  BOOST_CHECK_NO_THROW(judge(30 * 5));
  BOOST_TEST(refuses<failure>([&] { judge(3); },
                              {"trajectory 0 ", "one that breaks", "must be finite", "at step 4"}));
  BOOST_TEST(refuses<failure>([&] { judge(5 + 2); }, {"trajectory 1 ", "must be finite", "at step 3"}));
  const auto no_number = path_measure(of_chain, [](const state& x) { return std::log(x.q[0] - 10.0); });
  BOOST_TEST(
      refuses<failure>([&] { judged(law, no_number, options); }, {"trajectory 0 ", "path error", "step 1"}));
  // Of several measures that one is named.
  const std::vector two{by_state, no_number};
  BOOST_TEST(refuses<failure>(
      [&] { trajectory_errors(of_chain, reference, law, by_verlet, std::span(two), options); },
      {"trajectory 0 ", "path error", "step 1"}));
}

// Two are lost, the later one earlier; it is the first of them that is named, whichever trajectories are
// stepped beside it.
BOOST_AUTO_TEST_CASE(the_first_trajectory_that_is_lost_is_named_by_any_number_of_lanes) {
  const trajectory_options options{.step = .01, .steps = 60, .trajectories = 30};
  auto starts = starts_of_law(30);
  starts[5].p[0] = -4.0;  // down from .7
  starts[11].p[0] = -8.0;
  const auto named = [&](const model& system) {
    return said([&] { judged(these(starts), by_state, options, breaking{1'000'000, .4}, system); });
  };
  BOOST_TEST(named(singly).starts_with("trajectory 5 "), named(singly));
  BOOST_TEST(named(of_chain) == named(singly));
}

// On the second rank of two and of three one is seen at once and one late, on the last one another.
BOOST_AUTO_TEST_CASE(all_threads_and_ranks_name_the_first_trajectory_in_trouble) {
  auto starts = starts_of_law(60);
  for (const std::size_t m : {58U, 40U, 33U}) starts[m].q[0] = NAN;
  const auto named = [&](const communicator& ranks, int threads) {
    return said([&] {
      judged(these(starts), by_state,
             {.step = .01, .steps = 5, .trajectories = 60, .threads = threads, .ranks = &ranks});
    });
  };
  const std::string expected = named(one_rank, 1);
  BOOST_TEST(expected.find("start 33 ") != std::string::npos, expected);
  for (const int threads : {2, 5}) BOOST_TEST(named(one_rank, threads) == expected);
  for (const int size : {2, 3, 5}) {
    std::vector<std::string> found(static_cast<std::size_t>(size));
    run_ranks(size, [&](const communicator& ranks) {
      found[static_cast<std::size_t>(ranks.rank())] = named(ranks, 1);
    });
    for (const auto& message : found) BOOST_TEST(message == expected);
  }
}

// Where o_ref is 5 + q_3 with q_3 near 0, and that of a chain that is far to the left: on each it keeps its
// sign, on both together it does not; and the elongation, sin(50 t), changes it on the way.
BOOST_AUTO_TEST_CASE(a_relative_error_needs_an_observable_of_one_sign) {
  state left = law(1, 1);
  left.q.array() -= 10.0;  // the whole chain, whose energy does not mind but for the walls' springs
  const auto judge = [&](const std::vector<state>& starts) {
    const auto far = [](const state& x) { return 5.0 + x.q[2]; };
    judged(these(starts), relative_measure(of_chain, far),
           {.step = .001, .steps = 20, .trajectories = std::ssize(starts)});
  };
  BOOST_CHECK_NO_THROW(judge({law(1, 0)}));
  BOOST_CHECK_NO_THROW(judge({left}));
  const std::vector both{law(1, 0), left};
  BOOST_TEST(refuses<wrong>([&] { judge(both); }, {"relative error", "change its sign", "path error"}));
  const auto elongation = [](const state& x) { return x.q[1] - x.q[0]; };
  const trajectory_options longer{.step = .002, .steps = 100, .trajectories = 1};
  BOOST_TEST(refuses<wrong>([&] { judged(law, relative_measure(of_chain, elongation), longer); },
                            {"relative error", "change its sign"}));
  BOOST_CHECK_NO_THROW(judged(law, path_measure(of_chain, elongation), longer));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_compared_is_refused) {
  const auto refused = [&](const trajectory_options& options, auto... words) {
    return refuses<wrong>([&] { judged(law, by_state, options); }, {words...});
  };
  const trajectory_options one{.step = .01, .steps = 1, .trajectories = 1};
  BOOST_CHECK_NO_THROW(judged(law, by_state, one));
  BOOST_TEST(refused({.step = .01, .steps = 0, .trajectories = 1}, "0 steps", "at least 1"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 0}, "0 trajectories"));
  BOOST_TEST(refused({.step = 0.0, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = NAN, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .threads = 0}, "thread"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .threads = 1'000'000}, "fit into memory", "threads"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 2'000'000'000}, "fit into memory"));
  BOOST_TEST(refused({.step = .0103, .steps = 1}, "a multiple"));  // of the fine step
  for (const double perturbation : {0.0, -1.0, static_cast<double>(INFINITY), std::nan("")}) {
    BOOST_TEST(refused({.step = .01, .steps = 1, .perturbation = perturbation}, "perturbation"));
  }
  const auto nothing = path_measure(of_chain, [](const state&) { return 0.0; });
  BOOST_TEST(refuses<wrong>([&] { judged(law, nothing, one); }, {"path error", "must not be 0"}));
  const auto at_rest = these({{Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)}});
  BOOST_TEST(refuses<wrong>([&] { judged(at_rest, energy_measure(of_chain), one); },
                            {"energy error", "must not be 0"}));

  const model galaxy{henon_heiles()};
  for (const auto& measure :
       {state_measure(galaxy), energy_measure(galaxy), path_measure(galaxy, first_coordinate)}) {
    BOOST_TEST(refuses<wrong>([&] { judged(law, measure, one); },
                              {measure.name, "of systems of 6 degrees of freedom", "got 2"}));
  }
  const tuned_method<nystrom> tuned(member<nystrom>({.5, .4034}), .02, of_chain.description());
  const auto at_step = [&](double step) {
    return trajectory_errors(of_chain, fine, law, tuned, by_state, {.step = step, .steps = 5});
  };
  BOOST_TEST(at_step(.02).methods[0].diverged == 0);
  BOOST_TEST(refuses<wrong>([&] { at_step(.01); }, {"must run at the step 0.02", "got 0.01"}));
}

// 1e9 numbers are the most. Of 1 method and 2 references, intervals of 64 samples in all lanes hold 6e8 with
// one measure of this width, and 1.2e9 with two.
BOOST_AUTO_TEST_CASE(several_measures_must_fit_into_memory) {
  error_measure wide = by_state;
  wide.width = 600'000'000 / (3 * 64 * default_lanes);
  const std::vector two{wide, wide};
  const trajectory_options options{.step = .02, .steps = 5, .trajectories = 1};
  const auto judge = [&](std::span<const error_measure> measures) {
    trajectory_errors(of_chain, reference, law, by_verlet, measures, options);
  };
  BOOST_CHECK_NO_THROW(require_room(options, 1, wide.width));
  BOOST_TEST(
      refuses<wrong>([&] { judge(two); }, {std::to_string(2 * wide.width) + " numbers", "fit into memory"}));
  const trajectory_options many{.step = .02, .steps = 5, .trajectories = 40'000'000};
  BOOST_CHECK_NO_THROW(require_room(many, 1, 1, 2));
  BOOST_TEST(refuses<wrong>([&] { require_room(many, 1, 1, 3); }, {"fit into memory"}));
  BOOST_TEST(refuses<wrong>([&] { judge({}); }, {"measures must be one or more"}));
}

BOOST_AUTO_TEST_CASE(in_a_bath_methods_must_share_the_noise) {
  const trajectory_options options{.step = 0.12, .steps = 20, .trajectories = 5};
  const auto refused = [&](const std::vector<tabulated>& methods, double step,
                           std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { judged_in_bath(methods, options, fine_paths(step)); }, words);
  };
  const std::vector all{by_baoab, by_halves, by_thirds};
  BOOST_TEST(refused(all, 0.06, {"0.12 in the 6 equal parts", "fine step 0.06"}));
  BOOST_TEST(refused({by_thirds}, 0.03, {"0.12 in the 3 equal parts", "fine step 0.03"}));
  BOOST_TEST(!refused({by_baoab, by_halves}, 0.06, {}));
  BOOST_TEST(refused({by_baoab, by_verlet}, 0.06, {"must have a letter O, got BAB"}));
  BOOST_TEST(refused({by_verlet}, 0.06, {"must have a letter O, got BAB"}));
  const tabulated half("half", run_time_word("ABOBA"), {0.5, 0.5, 0.5, 0.5, 0.5}, {});
  BOOST_TEST(refused({half}, 0.06, {"ABOBA must cover one step", "got 0.5"}));
  const tabulated back("back", run_time_word("OABOBAO"), {1.0, 0.5, 0.5, -1.0, 0.5, 0.5, 1.0}, {});
  BOOST_TEST(refused({back}, 0.06, {"forward in time"}));
  BOOST_TEST(refuses<wrong>([&] { judged_in_bath(all, options, fine_steps<>(0.06)); },
                            {"srkn11b", "must have noise to share", "fine_paths"}));
}
