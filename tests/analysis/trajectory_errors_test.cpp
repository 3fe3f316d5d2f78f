// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 2.7 s at -O0, 0.8 s at -O1.
// Errors of methods along many trajectories, against one reference: with a bath and without one, by one
// measure and by several. What goes wrong is reported with its trajectory and step, and what cannot be
// compared is refused.
#include <bit>

#include "../support/ranks_as_threads.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;
using noise = std::vector<Eigen::VectorXd>;
using errors = trajectory_errors_result;
using failure = std::runtime_error;

/// What methods are compared on: a system with its starts, a reference, methods, and an error measure.
struct setting {
  std::string name;
  model system;
  initial_states starts;
  nysalt::reference reference;
  std::vector<method> methods;
  std::vector<error_measure> measures;
  double step;

  trajectory_options options(std::int64_t steps, std::int64_t trajectories) const {
    return {.step = step, .steps = steps, .trajectories = trajectories, .execution = {.threads = 2}};
  }
  errors judged(const std::vector<method>& some, const error_measure& measure,
                const trajectory_options& how) const {
    return trajectory_errors(system, reference, starts, std::span<const method>(some), measure, how);
  }
};

const fpu_chain<3> chain(50.0);
const fpu_chain<> same_chain(3, 50.0);
const fpu_law<Eigen::Dynamic> law(same_chain);
const auto stiff_energy = [](const state& x) { return same_chain.stiff_energy(x); };
const model of_chain(chain);

/// Two half Verlets, and nearly McLachlan.
const std::array<method, 2> pairs{member(nystrom(), {.5, .375}), member(nystrom(), {.5, .4034})};

const method by_verlet{verlet()};
const method by_baoab{baoab()};
const method by_end{thermostat(mclachlan2(), placement::end)};
const method by_halves{thermostat(mclachlan2(), placement::symmetric)};
const method by_thirds("thirds", word("OABOBAO"),
                       std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});

const setting on_the_chain{"chain",
                           of_chain,
                           law,
                           fine_steps(5e-4),
                           {method(pairs[0]), method(pairs[1])},
                           {energy_measure(of_chain), state_measure(of_chain), exchange_measure(same_chain),
                            path_measure(of_chain, stiff_energy)},
                           0.02};

constexpr double friction = 0.5;
model in_bath_of(double sigma, double damping = friction) {
  return model(harmonic_oscillator(2.0)).in(bath::of_sigma(damping, sigma));
}
const model warm = in_bath_of(0.4);
const normal_around<Eigen::Dynamic> around_zero({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}, 0.5,
                                                1.0);
setting in_the_bath(const reference& reference, double step, const model& system = warm) {
  return {"bath",
          system,
          around_zero,
          reference,
          {by_baoab, by_end, by_halves, by_thirds},
          {energy_measure(system), state_measure(system)},
          step};
}
/// Six of its steps are one step, in halves and in thirds.
const setting warmed = in_the_bath(fine_paths(0.02), 0.12);
const std::vector<const setting*> settings{&on_the_chain, &warmed};

/// The whole result, to the bit.
std::vector<std::uint64_t> bits_of(const errors& result) {
  std::vector<double> numbers;
  const auto add = [&](const std::optional<estimate>& x) {
    numbers.insert(numbers.end(), {double(x.has_value()), x ? x->mean : 0.0, x ? x->standard_error : 0.0});
  };
  add(result.reference_error);
  add(result.null_model);
  numbers.push_back(result.predictable_until.value_or(-1.0));
  for (const method_error& one : result.methods) {
    add(one.error);
    numbers.push_back(one.evaluations_per_time);
    numbers.insert(numbers.end(), one.of_each.begin(), one.of_each.end());
    for (const auto& lost : one.diverged_at)
      numbers.insert(numbers.end(), {double(lost.trajectory), double(lost.step)});
  }
  std::vector<std::uint64_t> result_bits;
  for (const double x : numbers) result_bits.push_back(std::bit_cast<std::uint64_t>(x));
  return result_bits;
}

/// The reference on the chain, which counts how often it and the finer one are asked, and breaks after some
/// steps, all trajectories together.
struct counting {
  std::shared_ptr<std::int64_t> asked = std::make_shared<std::int64_t>(0);
  std::int64_t steps_that_last = 1'000'000;
  std::shared_ptr<std::int64_t> taken = std::make_shared<std::int64_t>(0);  // by all copies

  template <class T>
  std::int64_t advance(const model& system, phase_point<T, Eigen::Dynamic>& x, double t) const {
    ++*asked;
    const std::int64_t evaluations = on_the_chain.reference.advance(system, x, t);
    if ((*taken)++ >= steps_that_last) x.p[2] = T(NAN);
    return evaluations;
  }
  counting finer() const { return {asked}; }
  std::string description() const { return "one that breaks"; }
};

/// A trajectory of the reference in the bath, and its path kept whole, in parts of a step.
struct kept_path {
  kept_path(const trajectory_options& options, std::uint64_t trajectory, std::size_t parts)
      : path(options.step / double(parts), friction, trajectory) {
    const auto x = around_zero(options.seed, trajectory);
    const auto run = warmed.reference.open(
        warm, x,
        {.length = options.step, .at = {options.seed, trajectory}, .noise_parts = static_cast<int>(parts)});
    for (std::int64_t n = 0; n < options.steps; ++n) {
      run->advance();
      for (const auto& one : run->noise()) path.add(one);
      states.push_back(run->state());
    }
  }
  auto stepper_of(const nysalt::method& method, double step) const {
    const auto intervals = detail::intervals_of_noise(method.letters(), method.coefficients());
    return make_stepper(warm, method, step, along_path<double, Eigen::Dynamic>(path, intervals, step));
  }
  recorded_path<double, Eigen::Dynamic> path;
  std::vector<state> states;
};

double error_by_hand(const method& method, const trajectory_options& options, std::size_t parts) {
  double squares = 0.0;
  for (std::uint64_t m = 0; m < static_cast<std::uint64_t>(options.trajectories); ++m) {
    const kept_path kept(options, m, parts);
    const auto stepper = kept.stepper_of(method, options.step);
    auto y = around_zero(options.seed, m);
    for (std::int64_t n = 0; n < options.steps; ++n) {
      stepper.step(y, m, n);
      const state& wanted = kept.states[static_cast<std::size_t>(n)];
      squares += std::pow(2.0 * (y.q[0] - wanted.q[0]), 2) + std::pow(y.p[0] - wanted.p[0], 2);
    }
  }
  return std::sqrt(squares / static_cast<double>(options.trajectories * options.steps));
}

/// Where one trajectory is read after the other.
const model singly{in_lanes<fpu_chain<3>, 1>(chain)};
const auto first_coordinate = [](const state& x) { return x.q[0]; };
const error_measure by_state = state_measure(of_chain);

errors judged(const initial_states& starts, const error_measure& measure, const trajectory_options& options,
              const reference& against = on_the_chain.reference, const model& system = of_chain) {
  return trajectory_errors(system, against, starts, by_verlet, measure, options);
}
std::vector<state> starts_of_law(std::uint64_t count) {
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < count; ++m) starts.push_back(law(1, m));
  return starts;
}
listed<Eigen::Dynamic> these(const std::vector<state>& starts) { return listed<Eigen::Dynamic>(starts); }

}  // namespace

// What "finer" means: two Verlets for one.
BOOST_AUTO_TEST_CASE(a_reference_tells_its_own_error) {
  setting own = on_the_chain;
  own.reference = fine_steps(.01, verlet());
  own.step = .01;
  const auto of = [&](const method& method) {
    return own.judged({method}, own.measures[3], own.options(20, 5));
  };
  // Stepped without merging, which rounds otherwise: some 20 roundings of numbers below 10 in each of 20
  // steps.
  BOOST_TEST(of(by_verlet).methods[0].error.mean <= 20 * 20 * eps * 10.0);
  BOOST_TEST(of(by_verlet).reference == "verlet with step 0.01");
  BOOST_TEST(
      of(by_verlet).reference_error.value().mean == of(nysalt::method(verlet_2x())).methods[0].error.mean,
      tolerance(.1));  // relative to either of two paths that differ by 3 %
}

// Where noise is weak the steps of BAOAB are of order two: the error that a reference tells, 4/3 of its
// difference from half the step, is that against a 64th of the step but for (omega h)^2 = 4 %, here of its
// fourth part at most.
BOOST_AUTO_TEST_CASE(a_reference_in_a_bath_tells_its_own_error) {
  const model quiet = in_bath_of(1e-6);
  const auto against = [&](double fine) {
    const setting on = in_the_bath(fine_paths(fine), 0.1, quiet);
    return on.judged({by_baoab}, on.measures[1], on.options(50, 16));
  };
  const double told = against(0.1).reference_error->mean;
  const double known = against(0.1 / 64.0).methods[0].error.mean;
  const auto near = tolerance(0.01);
  BOOST_TEST(known > 1e-3);
  BOOST_TEST(told == known, near);
  BOOST_TEST(0.75 * told != known, near);
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
    double energies = 0.0;
    double energy_at_start = 0.0;
    for (std::uint64_t m = 0; m < trajectories; ++m) {
      state x = on_the_chain.starts(7, m);
      state y = x;
      double squares = 0.0;
      double relative_squares = 0.0;
      const double before = energy<double>(of_chain, x);
      energy_at_start += before * before / trajectories;
      for (int n = 0; n <= steps; ++n) {
        if (n > 0) {
          on_the_chain.reference.advance(of_chain, x, .01);
          make_stepper(of_chain, by_verlet, .01).step(y);
        }
        const double share = weight(n) / all;
        const double difference = stiff_energy(y) - stiff_energy(x);
        squares += difference * difference * share;
        relative_squares += std::pow(difference / stiff_energy(x), 2) * share;
        size += stiff_energy(x) * stiff_energy(x) * share / trajectories;
        whole += stiff_energy(x) * share;
        energies += std::pow(energy<double>(of_chain, y) - before, 2) * share / trajectories;
        for (Eigen::Index j = 0; j < 3; ++j) {
          exchanged += std::abs(same_chain.stiff_energy(y, j) - same_chain.stiff_energy(x, j)) * share;
        }
      }
      mean += std::sqrt(squares) / trajectories;
      mean_relative += std::sqrt(relative_squares) / trajectories;
    }
    trajectory_options options{.step = .01, .steps = steps, .trajectories = trajectories, .seed = 7};
    options.horizon = horizon;
    const auto error = [&](const error_measure& measure) {
      return on_the_chain.judged({by_verlet}, measure, options).methods[0].error.mean;
    };
    // Merging rounds otherwise, 1e-16 a step, and errors of 1e-2 are differences of numbers near 2.
    const auto near = tolerance(1e-10);
    BOOST_TEST(error(on_the_chain.measures[3]) == mean / std::sqrt(size), near);
    BOOST_TEST(error(relative_measure(of_chain, stiff_energy)) == mean_relative, near);
    BOOST_TEST(error(on_the_chain.measures[2]) == exchanged / whole, near);
    BOOST_TEST(error(on_the_chain.measures[0]) == std::sqrt(energies / energy_at_start), near);
  }
}

// 150 steps are three intervals, of which the path is kept one at a time.
BOOST_AUTO_TEST_CASE(streaming_along_noise_gives_what_the_formula_says) {
  trajectory_options options{.step = 0.12, .steps = 150, .trajectories = 11, .seed = 7};
  const auto found = warmed.judged(warmed.methods, warmed.measures[1], options);
  const auto near = tolerance(1e-10);  // errors of 1e-2 of numbers near 1, 150 steps
  const std::array<std::size_t, 4> parts{1, 1, 2, 3};
  for (std::size_t n = 0; n < parts.size(); ++n) {
    BOOST_TEST(found.methods[n].error.mean == error_by_hand(warmed.methods[n], options, parts[n]), near);
  }
  options.seed = 8;
  BOOST_TEST(found.methods[2].error.mean != error_by_hand(by_halves, options, 2), near);
}

// A container of methods, a span of it, and a list of the same methods.
BOOST_AUTO_TEST_CASE(beside_others_and_by_its_type_a_method_has_the_error_that_it_has_alone) {
  const auto options = on_the_chain.options(25, 20);
  const auto& measure = on_the_chain.measures[3];
  const auto both = trajectory_errors(chain, fine_steps(5e-4), fpu_law<3>(chain), pairs, measure, options);
  const auto of_span = trajectory_errors(chain, fine_steps(5e-4), fpu_law<3>(chain),
                                         std::span<const method>(pairs), measure, options);
  const auto as_data = on_the_chain.judged(on_the_chain.methods, measure, options);
  BOOST_TEST((bits_of(both) == bits_of(as_data) && bits_of(of_span) == bits_of(as_data)));
  for (std::size_t n = 0; n < 2; ++n) {
    const auto alone = on_the_chain.judged({on_the_chain.methods[n]}, measure, options);
    BOOST_TEST(both.methods[n].error.mean == alone.methods[0].error.mean);
  }
  BOOST_TEST(both.methods[0].error.mean > 3.0 * both.methods[1].error.mean);
}

// At a step of .1, z = 2.5 of each half, some diverge, at steps that the measures see differently.
BOOST_AUTO_TEST_CASE(each_measure_says_what_it_says_alone) {
  for (const setting* on : settings) {
    for (const double step : {on->step, on == &warmed ? 1.2 : 0.1}) {
      for (const bool more : {false, true}) {
        auto options = on->options(100, 37);
        options.step = step;
        options.null_model = more;
        if (more) options.perturbation = 1e-6;
        const auto together =
            trajectory_errors(on->system, on->reference, on->starts, std::span<const method>(on->methods),
                              std::span(on->measures), options);
        BOOST_REQUIRE(together.size() == on->measures.size());
        for (std::size_t i = 0; i < together.size(); ++i) {
          const auto alone = on->judged(on->methods, on->measures[i], options);
          BOOST_TEST((bits_of(together[i]) == bits_of(alone)));
          BOOST_TEST((bits_of(together[(i + 1) % together.size()]) != bits_of(alone)));
          BOOST_TEST(alone.null_model.has_value() == (more && on->measures[i].needs_reference));
          BOOST_TEST(alone.predictable_until.has_value() == (more && on->measures[i].needs_reference));
        }
        BOOST_TEST((together[1].methods[0].diverged > 0) == (step > on->step));
      }
    }
  }
}

// Once along each of 20 trajectories, and along 16 for the finer one; as often for perturbed starts. None is
// needed if energies alone are compared.
BOOST_AUTO_TEST_CASE(one_reference_serves_all_measures) {
  const auto asked = [&](const std::vector<std::size_t>& chosen, std::optional<double> perturbation) {
    const counting reference;
    std::vector<error_measure> measures;
    for (const std::size_t i : chosen) measures.push_back(on_the_chain.measures[i]);
    const trajectory_options options{
        .step = .02, .steps = 5, .trajectories = 20, .null_model = true, .perturbation = perturbation};
    const auto found = trajectory_errors(singly, reference, on_the_chain.starts,
                                         std::span<const method>(on_the_chain.methods),
                                         std::span<const error_measure>(measures), options);
    BOOST_TEST(found[0].reference_error.has_value() == measures[0].needs_reference);
    BOOST_TEST(found[0].reference.empty() != measures[0].needs_reference);
    return *reference.asked;
  };
  BOOST_TEST(asked({1}, {}) == 5 * (20 + 16));
  BOOST_TEST(asked({1, 0, 2}, {}) == 5 * (20 + 16));
  BOOST_TEST(asked({1, 0, 2}, 1e-6) == 5 * (20 + 2 * 16));
  BOOST_TEST(asked({0, 0}, 1e-6) == 0);
}

// Parts of .12 in thirds would not be multiples of .06.
BOOST_AUTO_TEST_CASE(without_sigma_there_is_no_noise_and_no_part) {
  for (const double damping : {0.0, friction}) {
    const setting quiet = in_the_bath(fine_paths(0.06), 0.12, in_bath_of(0.0, damping));
    const auto found = quiet.judged(quiet.methods, quiet.measures[1], quiet.options(20, 5));
    for (const auto& method : found.methods) BOOST_TEST(method.error.mean < 0.05);
    BOOST_TEST(found.methods[0].error.mean > found.reference_error->mean);
  }
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_for_one_whole_trajectory) {
  const std::vector<method> methods{by_verlet, method(verlet_2x()), method(mclachlan2()), method(srkn6b())};
  const auto result =
      on_the_chain.judged(methods, on_the_chain.measures[0], {.step = .01, .steps = 20, .trajectories = 3});
  // Verlet: one for each step, and one to begin; McLachlan: none to begin with a drift.
  const std::array<double, 4> expected{21.0, 41.0, 40.0, 121.0};
  for (std::size_t n = 0; n < methods.size(); ++n) {
    BOOST_TEST(result.methods[n].evaluations_per_time * .2 == expected[n], tolerance(8 * eps));
  }
}

BOOST_AUTO_TEST_CASE(progress_counts_trajectories_in_turn) {
  for (const int ranks : {1, 3}) {
    for (const int threads : {1, 3}) {
      std::vector<std::int64_t> told;
      run_ranks(ranks, [&](const communicator& all) {
        auto options = on_the_chain.options(2, 40);
        options.execution.threads = threads;
        options.execution.ranks = &all;
        options.execution.progress = [&](std::int64_t done) {
          if (!all.is_first()) throw std::logic_error("not the first rank told it");
          told.push_back(done);
        };
        on_the_chain.judged({by_verlet}, on_the_chain.measures[0], options);
      });
      BOOST_REQUIRE(!told.empty());
      BOOST_TEST(told.back() == 40);
      for (std::size_t i = 1; i < told.size(); ++i) BOOST_TEST(told[i - 1] < told[i]);
    }
  }
}

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
  BOOST_TEST(none_left.evaluations_per_time * .05 * steps == 9.0, tolerance(8 * eps));
}

BOOST_AUTO_TEST_CASE(a_reference_that_breaks_is_told_of) {
  const trajectory_options options{.step = .01, .steps = 5, .trajectories = 30};
  const auto judge = [&](std::int64_t lasts) {
    judged(law, path_measure(singly, first_coordinate), options, counting{.steps_that_last = lasts}, singly);
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
      [&] { trajectory_errors(of_chain, on_the_chain.reference, law, by_verlet, std::span(two), options); },
      {"trajectory 0 ", "path error", "step 1"}));
}

// On the second rank of two and of three one is seen at once and one late, on the last one another.
BOOST_AUTO_TEST_CASE(all_threads_and_ranks_name_the_first_trajectory_in_trouble) {
  auto starts = starts_of_law(60);
  for (const std::size_t m : {58U, 40U, 33U}) starts[m].q[0] = NAN;
  const auto named = [&](const communicator& ranks, int threads) {
    return refusal_of<std::exception>([&] {
      judged(
          these(starts), by_state,
          {.step = .01, .steps = 5, .trajectories = 60, .execution = {.threads = threads, .ranks = &ranks}});
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
  const auto measure = relative_measure(of_chain, [](const state& x) { return 5.0 + x.q[2]; });
  const auto judge = [&](const std::vector<state>& starts) {
    judged(these(starts), measure, {.step = .001, .steps = 20, .trajectories = std::ssize(starts)});
  };
  BOOST_CHECK_NO_THROW(judge({law(1, 0)}));
  BOOST_CHECK_NO_THROW(judge({left}));
  BOOST_TEST(refuses([&] { judge({law(1, 0), left}); }, {"relative error", "change its sign", "path error"}));
  const auto elongation = [](const state& x) { return x.q[1] - x.q[0]; };
  const trajectory_options longer{.step = .002, .steps = 100, .trajectories = 1};
  BOOST_TEST(refuses([&] { judged(law, relative_measure(of_chain, elongation), longer); },
                     {"relative error", "change its sign"}));
  BOOST_CHECK_NO_THROW(judged(law, path_measure(of_chain, elongation), longer));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_compared_is_refused) {
  const auto refused = [&](const trajectory_options& options, auto... words) {
    return refuses([&] { judged(law, by_state, options); }, {words...});
  };
  const trajectory_options one{.step = .01, .steps = 1, .trajectories = 1};
  BOOST_CHECK_NO_THROW(judged(law, by_state, one));
  BOOST_TEST(refused({.step = .01, .steps = 0, .trajectories = 1}, "0 steps", "at least 1"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 0}, "0 trajectories"));
  BOOST_TEST(refused({.step = 0.0, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = NAN, .steps = 1}, "step must be"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .execution = {.threads = 0}}, "thread"));
  BOOST_TEST(
      refused({.step = .01, .steps = 1, .execution = {.threads = 1'000'000}}, "fit into memory", "threads"));
  BOOST_TEST(refused({.step = .01, .steps = 1, .trajectories = 2'000'000'000}, "fit into memory"));
  BOOST_TEST(refused({.step = .0103, .steps = 1}, "a multiple"));  // of the fine step
  for (const double perturbation : {0.0, -1.0, static_cast<double>(INFINITY), std::nan("")}) {
    BOOST_TEST(refused({.step = .01, .steps = 1, .perturbation = perturbation}, "perturbation"));
  }
  const auto nothing = path_measure(of_chain, [](const state&) { return 0.0; });
  BOOST_TEST(refuses([&] { judged(law, nothing, one); }, {"path error", "must not be 0"}));
  const auto at_rest = these({{Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)}});
  BOOST_TEST(
      refuses([&] { judged(at_rest, energy_measure(of_chain), one); }, {"energy error", "must not be 0"}));

  const model galaxy{henon_heiles()};
  for (const auto& measure :
       {state_measure(galaxy), energy_measure(galaxy), path_measure(galaxy, first_coordinate)}) {
    BOOST_TEST(refuses([&] { judged(law, measure, one); },
                       {measure.name, "of systems of 6 degrees of freedom", "got 2"}));
  }
  const method tuned("nystrom", pairs[1].letters(), pairs[1].coefficients(), pairs[1],
                     method_validity{.02, of_chain.description()});
  const auto at_step = [&](double step) {
    return trajectory_errors(of_chain, fine_steps(5e-4), law, tuned, by_state, {.step = step, .steps = 5});
  };
  BOOST_TEST(at_step(.02).methods[0].diverged == 0);
  BOOST_TEST(refuses([&] { at_step(.01); }, {"must run at the step 0.02", "got 0.01"}));
}

// 1e9 numbers are the most. Of 1 method and 2 references, intervals of 64 samples in all lanes hold 6e8 with
// one measure of this width, and 1.2e9 with two.
BOOST_AUTO_TEST_CASE(several_measures_must_fit_into_memory) {
  error_measure wide = by_state;
  wide.width = 600'000'000 / (3 * 64 * pack<double>::lanes);
  const std::vector two{wide, wide};
  const trajectory_options options{.step = .02, .steps = 5, .trajectories = 1};
  const auto judge = [&](std::span<const error_measure> measures) {
    trajectory_errors(of_chain, on_the_chain.reference, law, by_verlet, measures, options);
  };
  BOOST_CHECK_NO_THROW(detail::require_room(options, 1, wide.width));
  BOOST_TEST(refuses([&] { judge(two); }, {std::to_string(2 * wide.width) + " numbers", "fit into memory"}));
  const trajectory_options many{.step = .02, .steps = 5, .trajectories = 40'000'000};
  BOOST_CHECK_NO_THROW(detail::require_room(many, 1, 1, 2));
  BOOST_TEST(refuses([&] { detail::require_room(many, 1, 1, 3); }, {"fit into memory"}));
  BOOST_TEST(refuses([&] { judge({}); }, {"measures must be one or more"}));
}

BOOST_AUTO_TEST_CASE(in_a_bath_methods_must_share_the_noise) {
  const auto judge = [](const std::vector<method>& methods, const reference& reference) {
    const setting on = in_the_bath(reference, 0.12);
    on.judged(methods, on.measures[1], on.options(20, 5));
  };
  const auto refused = [&](const std::vector<method>& methods, double step, said words) {
    return refuses([&] { judge(methods, fine_paths(step)); }, words);
  };
  const std::vector all{by_baoab, by_halves, by_thirds};
  BOOST_TEST(refused(all, 0.06, {"0.12 in the 6 equal parts", "fine step 0.06"}));
  BOOST_TEST(refused({by_thirds}, 0.03, {"0.12 in the 3 equal parts", "fine step 0.03"}));
  BOOST_TEST(!refused({by_baoab, by_halves}, 0.06, {}));
  BOOST_TEST(refused({by_baoab, by_verlet}, 0.06, {"must have a letter O, got BAB"}));
  BOOST_TEST(refused({by_verlet}, 0.06, {"must have a letter O, got BAB"}));
  BOOST_TEST(
      refuses([&] { judge(all, fine_steps(0.06)); }, {"srkn11b", "must have noise to share", "fine_paths"}));
}
