// SPDX-License-Identifier: BSL-1.0
// Several measures of one set of runs are those of each alone.
#include <boost/test/unit_test.hpp>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "../support/in_lanes.hpp"
#include "../support/refusal.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, 6>;
using pair = member<nystrom>;

const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
const fine_steps<> reference(5e-4);
const std::array<pair, 2> pairs{pair({.5, .375}), pair({.5, .4034})};
const auto stiff_energy = [](const state& x) { return chain.stiff_energy(x); };
const std::vector<error_measure> all{energy_measure(chain), state_measure(chain), exchange_measure(chain),
                                     path_measure(chain, stiff_energy)};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(const estimate& a, const estimate& b) {
  return same_bits(a.mean, b.mean) && same_bits(a.standard_error, b.standard_error);
}
bool same_bits(const std::optional<estimate>& a, const std::optional<estimate>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
}
bool same_bits(const method_error& a, const method_error& b) {
  bool same = same_bits(a.error, b.error) && a.diverged == b.diverged &&
              same_bits(a.evaluations_per_time, b.evaluations_per_time);
  for (std::size_t k = 0; same && k < a.of_each.size(); ++k) same = same_bits(a.of_each[k], b.of_each[k]);
  for (std::size_t k = 0; same && k < a.diverged_at.size(); ++k) {
    same = a.diverged_at[k].trajectory == b.diverged_at[k].trajectory &&
           a.diverged_at[k].step == b.diverged_at[k].step;
  }
  return same;
}
bool same_bits(const trajectory_errors_result& a, const trajectory_errors_result& b) {
  bool same = a.methods.size() == b.methods.size() && same_bits(a.reference_error, b.reference_error) &&
              a.reference == b.reference && same_bits(a.null_model, b.null_model) &&
              a.predictable_until == b.predictable_until;
  for (std::size_t n = 0; same && n < a.methods.size(); ++n) same = same_bits(a.methods[n], b.methods[n]);
  return same;
}

/// The reference, counting how often it is asked; with one trajectory at a time.
struct counting {
  std::int64_t* asked;
  template <class S>
  void advance(const S& system, state& x, double t) const {
    reference.advance(system, x, t);
    ++*asked;
  }
  counting finer() const { return *this; }
  std::string description() const { return "one that counts"; }
};

}  // namespace

// At a step of .1, z = 2.5 of each half, some diverge, at steps that the measures see differently.
BOOST_AUTO_TEST_CASE(each_measure_says_what_it_says_alone) {
  for (const double step : {.02, .1}) {
    for (const bool more : {false, true}) {
      trajectory_options options{.step = step, .steps = 100, .trajectories = 37, .threads = 2};
      options.null_model = more;
      if (more) options.perturbation = 1e-6;
      const auto together = trajectory_errors(chain, reference, law, pairs, std::span(all), options);
      BOOST_REQUIRE(together.size() == all.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto alone = trajectory_errors(chain, reference, law, pairs, all[i], options);
        BOOST_TEST(same_bits(together[i], alone));
        BOOST_TEST(!same_bits(together[(i + 1) % all.size()], alone));
        BOOST_TEST(alone.null_model.has_value() == (more && all[i].needs_reference));
        BOOST_TEST(alone.predictable_until.has_value() == (more && all[i].needs_reference));
      }
      BOOST_TEST((together[1].methods[0].diverged > 0) == (step == .1));
    }
  }
}

BOOST_AUTO_TEST_CASE(in_a_bath_they_do_so_too) {
  const in_bath<harmonic_oscillator> warm(harmonic_oscillator(2.0), bath::of_sigma(0.5, 0.4));
  const normal_around<1> starts({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 1.0);
  const std::vector measures{energy_measure(warm), state_measure(warm)};
  const trajectory_options options{.step = .1, .steps = 100, .trajectories = 20, .perturbation = 1e-6};
  const auto run = [&](const auto& by) {
    return trajectory_errors(warm, fine_paths(.1 / 6.0), starts, baoab(), by, options);
  };
  const auto together = run(std::span(measures));
  BOOST_TEST(same_bits(together[0], run(measures[0])));
  BOOST_TEST(same_bits(together[1], run(measures[1])));
  BOOST_TEST(!same_bits(together[0].methods[0], together[1].methods[0]));
}

// Once along each of 20 trajectories, and along 16 for the finer one; as often for perturbed starts. None
// is needed if energies alone are compared.
BOOST_AUTO_TEST_CASE(one_reference_serves_all_measures) {
  const in_lanes<fpu_chain<3>, 1> singly(chain);
  const auto asked = [&](const auto& measures, std::optional<double> perturbation) {
    std::int64_t count = 0;
    const trajectory_options options{
        .step = .02, .steps = 5, .trajectories = 20, .null_model = true, .perturbation = perturbation};
    trajectory_errors(singly, counting{&count}, law, pairs, std::span(measures), options);
    return count;
  };
  const std::vector three{state_measure(singly), energy_measure(singly), exchange_measure(singly)};
  BOOST_TEST(asked(std::vector{state_measure(singly)}, {}) == 5 * (20 + 16));
  BOOST_TEST(asked(three, {}) == 5 * (20 + 16));
  BOOST_TEST(asked(three, 1e-6) == 5 * (20 + 2 * 16));
  BOOST_TEST(asked(std::vector{energy_measure(singly), energy_measure(singly)}, 1e-6) == 0);
}

BOOST_AUTO_TEST_CASE(a_measure_in_trouble_is_named) {
  const trajectory_options options{.step = .02, .steps = 5, .trajectories = 20};
  const auto judge = [&](const error_measure& second) {
    const std::array two{state_measure(chain), second};
    trajectory_errors(chain, reference, law, pairs, std::span<const error_measure>(two), options);
  };
  BOOST_CHECK_NO_THROW(judge(energy_measure(chain)));
  const auto nothing = path_measure(chain, [](const state&) { return 0.0; });
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge(nothing); }, {"path error", "must not be 0"}));
  const auto no_number = path_measure(chain, [](const state&) { return NAN; });
  BOOST_TEST(
      refuses<std::runtime_error>([&] { judge(no_number); }, {"trajectory 0 ", "path error", "step 1"}));
}

// 1e9 numbers are the most. Of 1 method and 2 references, intervals of 64 samples in all lanes hold 6e8 with
// one measure of this width, and 1.2e9 with two.
BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  error_measure wide = state_measure(chain);
  wide.width = 600'000'000 / (3 * 64 * default_lanes);
  const std::vector two{wide, wide};
  const trajectory_options options{.step = .02, .steps = 5, .trajectories = 1};
  const auto judge = [&](std::span<const error_measure> measures, const trajectory_options& run_options) {
    trajectory_errors(chain, reference, law, pairs[0], measures, run_options);
  };
  BOOST_CHECK_NO_THROW(require_room(options, 1, wide.width));
  const auto too_wide = [&] { judge(two, options); };
  BOOST_TEST(refuses<std::invalid_argument>(
      too_wide, {std::to_string(2 * wide.width) + " numbers", "fit into memory"}));
  const trajectory_options many{.step = .02, .steps = 5, .trajectories = 40'000'000};
  BOOST_CHECK_NO_THROW(require_room(many, 1, 1, 2));
  BOOST_TEST(refuses<std::invalid_argument>([&] { require_room(many, 1, 1, 3); }, {"fit into memory"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge({}, options); }, {"measures must be one or more"}));
  for (const double perturbation : {0.0, -1.0, static_cast<double>(INFINITY), std::nan("")}) {
    trajectory_options perturbed_options = options;
    perturbed_options.perturbation = perturbation;
    BOOST_TEST(
        refuses<std::invalid_argument>([&] { judge(std::span(all), perturbed_options); }, {"perturbation"}));
  }
}
