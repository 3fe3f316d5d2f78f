// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.7 s at -O0, 0.7 s at -O1.
// Errors of methods along many trajectories, against one reference: with a bath and without one, by one
// measure and by several.
#include "nysalt/analysis/trajectory_errors.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <bit>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/along_path.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;
using noise = std::vector<Eigen::VectorXd>;
using errors = trajectory_errors_result;

/// What methods are compared on: a system with its starts, a reference, methods, and an error measure.
struct setting {
  std::string name;
  model system;
  initial_states starts;
  detail::reference_value reference;
  std::vector<tabulated> methods;
  std::vector<error_measure> measures;
  double step;

  trajectory_options options(std::int64_t steps, std::int64_t trajectories) const {
    return {.step = step, .steps = steps, .trajectories = trajectories, .threads = 2};
  }
  errors judged(const std::vector<tabulated>& some, const error_measure& measure,
                const trajectory_options& how) const {
    return trajectory_errors(system, reference, starts, std::span<const tabulated>(some), measure, how);
  }
};

const fpu_chain<3> chain(50.0);
const fpu_chain<> same_chain(3, 50.0);
const fpu_law<3> law(chain);
const auto stiff_energy = [](const state& x) { return same_chain.stiff_energy(x); };
const model of_chain(chain);

/// Two half Verlets, and nearly McLachlan.
const std::array<member<nystrom>, 2> pairs{member<nystrom>({.5, .375}), member<nystrom>({.5, .4034})};

const tabulated by_verlet{verlet()};
const tabulated by_baoab{baoab()};
const tabulated by_end{thermostat<placement::end>(mclachlan2())};
const tabulated by_halves{thermostat<placement::symmetric>(mclachlan2())};
const tabulated by_thirds("thirds", run_time_word("OABOBAO"),
                          std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});

template <class R>
detail::reference_value value_of(const R& reference) {
  return detail::reference_value(detail::reference_of(of_chain, reference));
}

const setting on_the_chain{"chain",
                           of_chain,
                           law,
                           value_of(fine_steps<>(5e-4)),
                           {tabulated(pairs[0]), tabulated(pairs[1])},
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
setting in_the_bath(const detail::reference_value& reference, double step, const model& system = warm) {
  return {"bath",
          system,
          around_zero,
          reference,
          {by_baoab, by_end, by_halves, by_thirds},
          {energy_measure(system), state_measure(system)},
          step};
}
/// Six of its steps are one step, in halves and in thirds.
const setting warmed = in_the_bath(value_of(fine_paths(0.02)), 0.12);
const std::vector<const setting*> settings{&on_the_chain, &warmed};

double error_of(const setting& on, const tabulated& method, const trajectory_options& options) {
  return on.judged({method}, on.measures[1], options).methods[0].error.mean;
}

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

/// A reference that gives another noise than that of its path, or counts how often it is asked.
struct strange {
  detail::reference_value of;
  std::int64_t* asked = nullptr;

  template <class T>
  void advance(const model& system, phase_point<T, Eigen::Dynamic>& x, double t, const path_place& at,
               std::span<vector<T, Eigen::Dynamic>> xi) const {
    of.advance(system, x, t, at, xi);
    if (asked != nullptr) {
      ++*asked;
      return;
    }
    auto y = x;
    of.advance(system, y, t, {at.seed + 1, at.trajectory, at.step}, xi);
  }
  strange finer() const { return {of.finer(), asked}; }
  std::string description() const { return "strange"; }
};

/// Of one trajectory at a time along paths that are kept whole.
double error_by_hand(const tabulated& method, const trajectory_options& options, std::size_t parts) {
  double squares = 0.0;
  for (std::int64_t m = 0; m < options.trajectories; ++m) {
    const auto trajectory = static_cast<std::uint64_t>(m);
    recorded_path<double, Eigen::Dynamic> path(options.step / double(parts), friction, trajectory);
    auto x = around_zero(options.seed, trajectory);
    auto y = x;
    std::vector<state> expected;
    for (std::int64_t n = 0; n < options.steps; ++n) {
      noise xi(parts, Eigen::VectorXd(1));
      warmed.reference.advance(warm, x, options.step, path_place{options.seed, trajectory, n}, std::span(xi));
      for (const auto& one : xi) path.add(one);
      expected.push_back(x);
    }
    const along_path<double, Eigen::Dynamic> along(
        path, intervals_of_noise(word_of(method), method.coefficients()), options.step);
    const auto stepper = make_stepper(warm, method, options.step, along);
    for (std::int64_t n = 0; n < options.steps; ++n) {
      stepper.step(y, trajectory, n);
      const state& wanted = expected[static_cast<std::size_t>(n)];
      squares += std::pow(2.0 * (y.q[0] - wanted.q[0]), 2) + std::pow(y.p[0] - wanted.p[0], 2);
    }
  }
  return std::sqrt(squares / static_cast<double>(options.trajectories * options.steps));
}

}  // namespace

// A reference of the method's own steps is stepped without merging, which rounds otherwise: some 20 roundings
// of numbers below 10 in each of up to 100 steps, which magnify little.
BOOST_AUTO_TEST_CASE(a_method_has_no_error_against_itself) {
  const double rounding = 100 * 20 * eps * 10.0;
  const auto at_own_step = [](const setting& like, const auto& reference, double step) {
    setting own = like;
    own.reference = value_of(reference);
    own.step = step;
    return own;
  };
  const auto coarse = at_own_step(on_the_chain, fine_steps<verlet>(.01), .01);
  BOOST_TEST(error_of(coarse, by_verlet, coarse.options(20, 5)) <= rounding);
  BOOST_TEST(error_of(coarse, tabulated(verlet_2x()), coarse.options(20, 5)) > 1e-3);
  const auto baoabs = at_own_step(warmed, fine_paths(0.1), 0.1);
  const auto ends = at_own_step(warmed, fine_paths(0.1, thermostat<placement::end>(mclachlan2())), 0.1);
  BOOST_TEST(error_of(baoabs, by_baoab, baoabs.options(100, 20)) <= rounding);
  BOOST_TEST(error_of(ends, by_end, ends.options(100, 20)) <= rounding);
  BOOST_TEST(error_of(baoabs, by_end, ends.options(100, 20)) > 1e-3);
  BOOST_TEST(error_of(at_own_step(warmed, fine_paths(0.05), 0.1), by_baoab, baoabs.options(100, 20)) > 1e-3);

  // What "finer" means: two Verlets for one, as the method that was just judged.
  const auto own = coarse.judged({by_verlet}, coarse.measures[3], coarse.options(20, 5));
  const auto twice = coarse.judged({tabulated(verlet_2x())}, coarse.measures[3], coarse.options(20, 5));
  BOOST_TEST(own.reference == "verlet with step 0.01");
  BOOST_TEST(own.reference_error.value().mean == twice.methods[0].error.mean,
             boost::test_tools::tolerance(.1));  // relative to either of two paths that differ by 3 %
}

// Where noise is weak the steps of BAOAB are of order two: the error that a reference tells, 4/3 of its
// difference from half the step, is that against a 64th of the step but for (omega h)^2 = 4 %, here of its
// fourth part at most.
BOOST_AUTO_TEST_CASE(a_reference_in_a_bath_tells_its_own_error) {
  const model quiet = in_bath_of(1e-6);
  const auto against = [&](double fine) {
    const setting on = in_the_bath(value_of(fine_paths(fine)), 0.1, quiet);
    return on.judged({by_baoab}, on.measures[1], on.options(50, 16));
  };
  const double told = against(0.1).reference_error->mean;
  const double known = against(0.1 / 64.0).methods[0].error.mean;
  const auto near = boost::test_tools::tolerance(0.01);
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
    for (std::uint64_t m = 0; m < trajectories; ++m) {
      state x = on_the_chain.starts(7, m);
      state y = x;
      double squares = 0.0;
      double relative_squares = 0.0;
      for (int n = 0; n <= steps; ++n) {
        if (n > 0) {
          on_the_chain.reference.advance(of_chain, x, .01, {}, {});
          make_stepper(of_chain, by_verlet, .01).step(y);
        }
        const double share = weight(n) / all;
        const double difference = stiff_energy(y) - stiff_energy(x);
        squares += difference * difference * share;
        relative_squares += std::pow(difference / stiff_energy(x), 2) * share;
        size += stiff_energy(x) * stiff_energy(x) * share / trajectories;
        whole += stiff_energy(x) * share;
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
    const auto near = boost::test_tools::tolerance(1e-10);
    BOOST_TEST(error(on_the_chain.measures[3]) == mean / std::sqrt(size), near);
    BOOST_TEST(error(relative_measure(of_chain, stiff_energy)) == mean_relative, near);
    BOOST_TEST(error(on_the_chain.measures[2]) == exchanged / whole, near);
  }
}

// 150 steps are three intervals, of which the path is kept one at a time.
BOOST_AUTO_TEST_CASE(streaming_along_noise_gives_what_the_formula_says) {
  trajectory_options options{.step = 0.12, .steps = 150, .trajectories = 11, .seed = 7};
  const auto found = warmed.judged(warmed.methods, warmed.measures[1], options);
  const auto near = boost::test_tools::tolerance(1e-10);  // errors of 1e-2 of numbers near 1, 150 steps
  const std::array<std::size_t, 4> parts{1, 1, 2, 3};
  for (std::size_t n = 0; n < parts.size(); ++n) {
    BOOST_TEST(found.methods[n].error.mean == error_by_hand(warmed.methods[n], options, parts[n]), near);
  }
  options.seed = 8;
  BOOST_TEST(found.methods[2].error.mean != error_by_hand(by_halves, options, 2), near);
}

BOOST_AUTO_TEST_CASE(errors_of_second_order_fall_by_four_with_the_step) {
  const auto error = [](const error_measure& measure, double step) {
    const auto steps = static_cast<std::int64_t>(.5 / step + .5);
    const trajectory_options options{.step = step, .steps = steps, .trajectories = 20};
    const auto result = trajectory_errors(chain, fine_steps<>(5e-4), law, verlet(), measure, options);
    if (result.reference_error)
      BOOST_TEST(result.reference_error->mean < 1e-5 * result.methods[0].error.mean);
    return result.methods[0].error.mean;
  };
  // The next term is z^2 = 1/16 of the first, so that the ratio is off by 6 % or so.
  for (const error_measure& measure : on_the_chain.measures) {
    BOOST_TEST(error(measure, .005) / error(measure, .0025) == 4.0, boost::test_tools::tolerance(.08));
  }
}

// Methods that share a path in a bath have noise in common parts, whose sums round otherwise.
BOOST_AUTO_TEST_CASE(beside_others_a_method_has_the_error_that_it_has_alone) {
  for (const setting* on : settings) {
    const auto options = on->options(70, 20);
    const auto table = on->judged(on->methods, on->measures[1], options);
    for (std::size_t n = 0; n < on->methods.size(); ++n) {
      const double alone = error_of(*on, on->methods[n], options);
      const auto near = boost::test_tools::tolerance(on == &warmed ? 1e-10 : 0.0);
      BOOST_TEST(table.methods[n].error.mean == alone, near);
      BOOST_TEST(table.methods[(n + 1) % on->methods.size()].error.mean != alone,
                 boost::test_tools::tolerance(1e-3));
    }
    BOOST_TEST(table.reference == on->reference.description());
  }
  // An array, and a span of it, of methods by their type.
  const auto options = on_the_chain.options(25, 20);
  const auto& measure = on_the_chain.measures[3];
  const auto both = trajectory_errors(chain, fine_steps<>(5e-4), law, pairs, measure, options);
  const auto of_span = trajectory_errors(chain, fine_steps<>(5e-4), law,
                                         std::span<const member<nystrom>>(pairs), measure, options);
  const auto as_data = on_the_chain.judged(on_the_chain.methods, measure, options);
  BOOST_TEST((bits_of(both) == bits_of(as_data) && bits_of(of_span) == bits_of(as_data)));
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
            trajectory_errors(on->system, on->reference, on->starts, std::span<const tabulated>(on->methods),
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
  const model singly{in_lanes<fpu_chain<3>, 1>(chain)};
  const auto asked = [&](const std::vector<std::size_t>& chosen, std::optional<double> perturbation) {
    std::int64_t count = 0;
    std::vector<error_measure> measures;
    for (const std::size_t i : chosen) measures.push_back(on_the_chain.measures[i]);
    const trajectory_options options{
        .step = .02, .steps = 5, .trajectories = 20, .null_model = true, .perturbation = perturbation};
    const auto found = trajectory_errors(singly, strange{on_the_chain.reference, &count}, on_the_chain.starts,
                                         std::span<const tabulated>(on_the_chain.methods),
                                         std::span<const error_measure>(measures), options);
    BOOST_TEST(found[0].methods[0].error.mean > 0.0);
    BOOST_TEST(found[0].reference_error.has_value() == measures[0].needs_reference);
    BOOST_TEST(found[0].reference.empty() != measures[0].needs_reference);
    return count;
  };
  BOOST_TEST(asked({1}, {}) == 5 * (20 + 16));
  BOOST_TEST(asked({1, 0, 2}, {}) == 5 * (20 + 16));
  BOOST_TEST(asked({1, 0, 2}, 1e-6) == 5 * (20 + 2 * 16));
  BOOST_TEST(asked({0, 0}, 1e-6) == 0);
}

BOOST_AUTO_TEST_CASE(methods_share_the_noise_of_the_reference) {
  const auto along = [](const auto& reference, std::size_t measure) {
    const setting& on = warmed;
    return trajectory_errors(warm, reference, around_zero, std::span<const tabulated>(on.methods),
                             on.measures[measure], {.step = 0.1, .steps = 20, .trajectories = 200});
  };
  const auto fine = value_of(fine_paths(0.1 / 60.0));
  const auto together = along(fine, 1);
  const auto apart = along(strange{fine}, 1);
  // A method's own error: w sigma h/2 = .04 where q learns of the noise at the end of a step, less elsewhere.
  // Other noise: kT = sigma^2/(2 gamma) = .16, and e^2 = 4 (q - q')^2 + (p - p')^2 goes to 4 kT; with
  // 1 - exp(-gamma t) at t = 2, averaged over time, .6 or so is left.
  for (std::size_t n = 0; n < warmed.methods.size(); ++n) {
    BOOST_TEST(together.methods[n].error.mean < 0.06);
    BOOST_TEST(apart.methods[n].error.mean > 0.3);
    BOOST_TEST(apart.methods[n].error.mean < 0.8);
  }
  BOOST_TEST(together.reference_error->mean < 0.05 * together.methods[0].error.mean);
  BOOST_TEST(together.reference.starts_with("baoab with step"));
  // The energy error needs the noise alone.
  const auto energies = along(fine, 0);
  BOOST_TEST(!energies.reference_error.has_value());
  BOOST_TEST(energies.reference.empty());
  for (const auto& method : energies.methods) BOOST_TEST(method.error.mean > 0.0);
  BOOST_TEST(along(strange{fine}, 0).methods[0].error.mean != energies.methods[0].error.mean);
}

// Parts of .12 in thirds would not be multiples of .06.
BOOST_AUTO_TEST_CASE(without_sigma_there_is_no_noise_and_no_part) {
  for (const double damping : {0.0, friction}) {
    const setting quiet = in_the_bath(value_of(fine_paths(0.06)), 0.12, in_bath_of(0.0, damping));
    const auto found = quiet.judged(quiet.methods, quiet.measures[1], quiet.options(20, 5));
    for (const auto& method : found.methods) BOOST_TEST(method.error.mean < 0.05);
    BOOST_TEST(found.methods[0].error.mean > found.reference_error->mean);
  }
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_for_one_whole_trajectory) {
  const std::vector<tabulated> methods{by_verlet, tabulated(verlet_2x()), tabulated(mclachlan2()),
                                       tabulated(srkn6b())};
  const auto result =
      on_the_chain.judged(methods, on_the_chain.measures[0], {.step = .01, .steps = 20, .trajectories = 3});
  // Verlet: one for each step, and one to begin; McLachlan: none to begin with a drift.
  const std::array<double, 4> expected{21.0, 41.0, 40.0, 121.0};
  for (std::size_t n = 0; n < methods.size(); ++n) {
    BOOST_TEST(result.methods[n].evaluations_per_time * .2 == expected[n],
               boost::test_tools::tolerance(8 * eps));
  }
}

BOOST_AUTO_TEST_CASE(progress_counts_trajectories_in_turn) {
  for (const int ranks : {1, 3}) {
    for (const int threads : {1, 3}) {
      std::vector<std::int64_t> told;
      run_ranks(ranks, [&](const communicator& all) {
        auto options = on_the_chain.options(2, 40);
        options.threads = threads;
        options.ranks = &all;
        options.progress = [&](std::int64_t done) {
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
