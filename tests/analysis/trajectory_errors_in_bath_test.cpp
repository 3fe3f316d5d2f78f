// SPDX-License-Identifier: BSL-1.0
// Methods beside a reference in a bath, on one path.
#include <boost/test/unit_test.hpp>

#include <cstring>

#include "../support/in_lanes.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/along_path.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using system_type = in_bath<harmonic_oscillator>;
using state = phase_point<double, 1>;
using numbers = vector<double, 1>;

constexpr double friction = 0.5;
const system_type warm(harmonic_oscillator(2.0), bath::of_sigma(friction, 0.4));
const normal_around<1> starts({numbers(0.0), numbers(0.0)}, 0.5, 1.0);

const tabulated by_baoab{baoab()};
const tabulated by_end{thermostat<placement::end>(mclachlan2())};
const tabulated by_halves{thermostat<placement::symmetric>(mclachlan2())};
const tabulated by_thirds("thirds", run_time_word("OABOBAO"),
                          std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});
const std::vector<tabulated> all{by_baoab, by_end, by_halves, by_thirds};

template <class S = system_type>
trajectory_errors_result judged(const std::vector<tabulated>& methods, const trajectory_options& options,
                                const auto& reference, const S& system = warm) {
  return trajectory_errors(system, reference, starts, methods, state_measure(system), options);
}
double error_of(const tabulated& method, const trajectory_options& options, const auto& reference) {
  return judged({method}, options, reference).methods[0].error.mean;
}

/// A reference that says another noise than its own.
struct untrue : fine_paths<> {
  explicit untrue(double step) : fine_paths<>(step) {}
  explicit untrue(const fine_paths<>& reference) : fine_paths<>(reference) {}
  template <class S, class T>
  void advance(const S& system, phase_point<T, 1>& x, double t, const path_place& at,
               std::span<vector<T, 1>> xi) const {
    fine_paths<>::advance(system, x, t, at, xi);
    auto y = x;
    fine_paths<>::advance(system, y, t, {at.seed + 1, at.trajectory, at.step}, xi);
  }
  untrue finer() const { return untrue(fine_paths<>::finer()); }
};

/// What trajectory_errors does, once more, of one trajectory at a time along paths that are kept whole.
double error_by_hand(const tabulated& method, const trajectory_options& options, const auto& reference,
                     std::size_t parts) {
  double squares = 0.0;
  for (std::int64_t m = 0; m < options.trajectories; ++m) {
    const auto trajectory = static_cast<std::uint64_t>(m);
    recorded_path<double, 1> path(options.step / double(parts), friction, trajectory);
    auto x = starts(options.seed, trajectory);
    auto y = x;
    std::vector<state> expected;
    for (std::int64_t n = 0; n < options.steps; ++n) {
      std::vector<numbers> xi(parts);
      reference.advance(warm, x, options.step, path_place{options.seed, trajectory, n}, std::span(xi));
      for (const auto& one : xi) path.add(one);
      expected.push_back(x);
    }
    const along_path<double, 1> noise(path, intervals_of_noise(word_of(method), method.coefficients()),
                                      options.step);
    const auto stepper = make_stepper(warm, method, options.step, noise);
    for (std::int64_t n = 0; n < options.steps; ++n) {
      stepper.step(y, trajectory, n);
      const state& wanted = expected[static_cast<std::size_t>(n)];
      squares += std::pow(2.0 * (y.q[0] - wanted.q[0]), 2) + std::pow(y.p[0] - wanted.p[0], 2);
    }
  }
  return std::sqrt(squares / static_cast<double>(options.trajectories * options.steps));
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(const trajectory_errors_result& a, const trajectory_errors_result& b) {
  bool same = same_bits(a.reference_error->mean, b.reference_error->mean);
  for (std::size_t n = 0; n < a.methods.size(); ++n) {
    const auto& x = a.methods[n];
    const auto& y = b.methods[n];
    same = same && same_bits(x.error.mean, y.error.mean) && x.diverged == y.diverged &&
           same_bits(x.error.standard_error, y.error.standard_error);
    for (std::size_t k = 0; same && k < x.diverged_at.size(); ++k) {
      same = x.diverged_at[k].trajectory == y.diverged_at[k].trajectory &&
             x.diverged_at[k].step == y.diverged_at[k].step;
    }
  }
  return same;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_method_has_no_error_against_itself) {
  const trajectory_options options{.step = 0.1, .steps = 100, .trajectories = 20};
  // It is stepped without merging, which rounds otherwise: twenty roundings of numbers of 4 in each step.
  const double rounding = 100 * 20 * eps * 4.0;
  BOOST_TEST(error_of(by_baoab, options, fine_paths(0.1)) <= rounding);
  BOOST_TEST(error_of(by_end, options, fine_paths(0.1, thermostat<placement::end>(mclachlan2()))) <=
             rounding);
  BOOST_TEST(error_of(by_baoab, options, fine_paths(0.05)) > 1e-3);
  BOOST_TEST(error_of(by_end, options, fine_paths(0.1)) > 1e-3);
}

BOOST_AUTO_TEST_CASE(the_noise_is_common) {
  const trajectory_options options{.step = 0.1, .steps = 20, .trajectories = 200};
  const auto together = judged(all, options, fine_paths(0.1 / 60.0));
  const auto apart = judged(all, options, untrue(0.1 / 60.0));
  // A method's own error: w sigma h/2 = .04 where q learns of the noise at the end of a step, less elsewhere.
  // Other noise: kT = sigma^2/(2 gamma) = .16, and e^2 = 4 (q - q')^2 + (p - p')^2 goes to 4 kT; with
  // 1 - exp(-gamma t) at t = 2, averaged over time, .6 or so is left.
  for (std::size_t n = 0; n < all.size(); ++n) {
    BOOST_TEST(together.methods[n].error.mean < 0.06);
    BOOST_TEST(apart.methods[n].error.mean > 0.3);
    BOOST_TEST(apart.methods[n].error.mean < 0.8);
  }
  BOOST_TEST(together.reference_error->mean < 0.05 * together.methods[0].error.mean);
  BOOST_TEST(together.reference.starts_with("baoab with step"));
}

// 150 steps are three intervals, of which the path is kept one at a time.
BOOST_AUTO_TEST_CASE(streaming_gives_what_the_formula_says) {
  const trajectory_options options{.step = 0.12, .steps = 150, .trajectories = 21, .seed = 7};
  const fine_paths reference(0.02);
  const auto found = judged(all, options, reference);
  const auto near = boost::test_tools::tolerance(1e-10);  // errors of 1e-2 of numbers near 1, 150 steps
  BOOST_TEST(found.methods[0].error.mean == error_by_hand(by_baoab, options, reference, 1), near);
  BOOST_TEST(found.methods[1].error.mean == error_by_hand(by_end, options, reference, 1), near);
  BOOST_TEST(found.methods[2].error.mean == error_by_hand(by_halves, options, reference, 2), near);
  BOOST_TEST(found.methods[3].error.mean == error_by_hand(by_thirds, options, reference, 3), near);
  const trajectory_options other{.step = 0.12, .steps = 150, .trajectories = 21, .seed = 8};
  BOOST_TEST(found.methods[2].error.mean != error_by_hand(by_halves, other, reference, 2), near);
}

BOOST_AUTO_TEST_CASE(in_a_table_each_method_has_the_error_that_it_has_alone) {
  const trajectory_options options{.step = 0.12, .steps = 70, .trajectories = 20};
  const fine_paths reference(0.02);  // six in a step: in halves and thirds
  const auto table = judged(all, options, reference);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const double alone = error_of(all[n], options, reference);
    BOOST_TEST(table.methods[n].error.mean == alone, boost::test_tools::tolerance(1e-10));
    BOOST_TEST(table.methods[(n + 1) % 4].error.mean != alone, boost::test_tools::tolerance(1e-3));
  }
}

BOOST_AUTO_TEST_CASE(threads_and_lanes_change_no_bit) {
  for (const double step : {0.12, 1.2}) {  // z = 2.4: beyond the stability of some
    const auto with = [&](const auto& system, int threads, std::uint64_t seed = 1) {
      const trajectory_options options{
          .step = step, .steps = 130, .trajectories = 37, .seed = seed, .threads = threads};
      return judged(all, options, fine_paths(0.02), system);
    };
    const auto one = with(in_lanes<system_type, 1>(warm), 1);
    BOOST_TEST(same_bits(with(warm, 1), one));
    BOOST_TEST(same_bits(with(warm, 2), one));
    BOOST_TEST(!same_bits(with(warm, 1, 2), one));
    BOOST_TEST((one.methods[0].diverged > 0) == (step == 1.2));
  }
}

BOOST_AUTO_TEST_CASE(a_method_that_diverges_is_told_with_its_step) {
  const trajectory_options options{.step = 1.2, .steps = 200, .trajectories = 20, .seed = 3};
  const fine_paths reference(0.02);
  for (const auto& method : {by_baoab, by_thirds}) {
    const auto found = judged({method, by_halves}, options, reference);
    BOOST_TEST(found.methods[0].diverged == 20);
    BOOST_TEST(found.methods[1].diverged == 0);
    for (const auto& [m, step] : found.methods[0].diverged_at) {
      const auto trajectory = static_cast<std::uint64_t>(m);
      recorded_path<double, 1> path(0.2, friction, trajectory);
      auto x = starts(3, trajectory);
      for (std::int64_t n = 0; n < 200; ++n) {
        std::vector<numbers> xi(6);
        reference.advance(warm, x, 1.2, path_place{3, trajectory, n}, std::span(xi));
        for (const auto& one : xi) path.add(one);
      }
      const auto intervals = intervals_of_noise(word_of(method), method.coefficients());
      const along_path<double, 1> noise(path, intervals, 1.2);
      const auto stepper = make_stepper(warm, method, 1.2, noise);
      const auto alone = integrate(
          stepper, starts(3, trajectory), 200, [](auto&&...) {}, 200, trajectory);
      BOOST_TEST(step == alone.diverged_at.value());
    }
  }
}

BOOST_AUTO_TEST_CASE(without_sigma_there_is_no_noise_and_no_part) {
  // Parts of .12 in thirds would not be multiples of .06.
  const trajectory_options options{.step = 0.12, .steps = 20, .trajectories = 5};
  for (const double bath_friction : {0.0, friction}) {
    const system_type quiet(harmonic_oscillator(2.0), bath::of_sigma(bath_friction, 0.0));
    const auto found = judged(all, options, fine_paths(0.06), quiet);
    for (const auto& method : found.methods) BOOST_TEST(method.error.mean < 0.05);
    BOOST_TEST(found.methods[0].error.mean > found.reference_error->mean);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_compared_is_refused) {
  const trajectory_options options{.step = 0.12, .steps = 20, .trajectories = 5};
  const auto refused = [&](const std::vector<tabulated>& methods, double fine,
                           std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { judged(methods, options, fine_paths(fine)); }, words);
  };
  BOOST_TEST(refused(all, 0.06, {"0.12 in the 6 equal parts", "fine step 0.06"}));
  BOOST_TEST(refused({by_thirds}, 0.03, {"0.12 in the 3 equal parts", "fine step 0.03"}));
  BOOST_TEST(!refused({by_baoab, by_halves}, 0.06, {}));
  BOOST_TEST(refused({by_baoab, tabulated(verlet())}, 0.06, {"must have a letter O, got BAB"}));
  BOOST_TEST(refused({tabulated(verlet())}, 0.06, {"must have a letter O, got BAB"}));
  const tabulated half("half", run_time_word("ABOBA"), {0.5, 0.5, 0.5, 0.5, 0.5}, {});
  BOOST_TEST(refused({half}, 0.06, {"ABOBA must cover one step", "got 0.5"}));
  const tabulated back("back", run_time_word("OABOBAO"), {1.0, 0.5, 0.5, -1.0, 0.5, 0.5, 1.0}, {});
  BOOST_TEST(refused({back}, 0.06, {"forward in time"}));
  const auto along_a_flow = [&] { judged(all, options, fine_steps<>(0.06)); };
  BOOST_TEST(refuses<wrong>(along_a_flow, {"srkn11b", "must have noise to share", "fine_paths"}));
}

BOOST_AUTO_TEST_CASE(the_energy_error_needs_the_noise_alone) {
  const trajectory_options options{.step = 0.1, .steps = 20, .trajectories = 5};
  const auto energy_error = [&](const auto& reference) {
    return trajectory_errors(warm, reference, starts, all, energy_measure(warm), options);
  };
  const auto found = energy_error(fine_paths(0.1 / 6.0));
  BOOST_TEST(!found.reference_error.has_value());
  BOOST_TEST(found.reference.empty());
  for (const auto& method : found.methods) BOOST_TEST(method.error.mean > 0.0);
  BOOST_TEST(energy_error(untrue(0.1 / 6.0)).methods[0].error.mean != found.methods[0].error.mean);
}
