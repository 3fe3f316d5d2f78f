// SPDX-License-Identifier: BSL-1.0
// Pairs in a bath come with the noise that led from one to the other.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/require_valid.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/in_lanes.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"
#include "support/same_pairs.hpp"
#include "support/seeds.hpp"
#include "support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using system_type = in_bath<fpu_chain<3>>;
using numbers = vector<double, 6>;
constexpr double fine = 1e-3;
const fpu_chain<3> without_bath(50.0);
const fpu_law<3> law(without_bath);
const system_type chain(without_bath, bath::of_sigma(2.0, 0.3));

flow_map_data made(const data_options& options, const auto& system) {
  return make_flow_map_data(system, law, fine_paths(fine), options);
}
flow_map_data made(const data_options& options) { return made(options, chain); }

/// The noise of a path from one fine step to another, drawn again.
numbers noise_between(std::uint64_t seed, std::uint64_t trajectory, std::int64_t from, std::int64_t to) {
  std::vector<numbers> each(static_cast<std::size_t>(to - from));
  for (auto& xi : each) counter_noise(seed).normals(noise_place{trajectory, from++, 0}, xi);
  numbers result;
  coarse_graining(chain.bath().friction() * fine).over(std::span<const numbers>(each), result);
  return result;
}

/// One number of each pair.
std::vector<double> column(const flow_map_data& data, std::size_t part, Eigen::Index i) {
  std::vector<double> result;
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  for (std::size_t n = 0; n < data.pairs(); ++n) result.push_back(data.noise[n * parts + part][i]);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_noise_is_that_of_the_path_in_parts) {
  const auto data = made({.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = 3});
  BOOST_TEST(data.pairs() == 105U);
  BOOST_TEST(data.noise.size() == 315U);
  require_valid(data, chain);
  double worst = 0.0;
  double worst_of_next = INFINITY;
  for (std::size_t m = 0; m < 21; ++m) {
    for (std::int64_t part = 0; part < 15; ++part) {  // five steps of three
      const numbers& xi = data.noise[3 * data.first_of[m] + static_cast<std::size_t>(part)];
      const auto off = [&](const numbers& expected) { return (xi - expected).cwiseAbs().maxCoeff(); };
      worst = std::max(worst, off(noise_between(7, m, 4 * part, 4 * part + 4)));
      worst_of_next = std::min(worst_of_next, off(noise_between(7, m, 4 * part + 4, 4 * part + 8)));
    }
  }
  BOOST_TEST(worst <= 4 * 4 * eps);  // four additions of numbers below 4
  BOOST_TEST(worst_of_next > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_coarse_step_with_the_noise_of_the_data_is_near_and_without_it_far) {
  const auto data = made({.step = 0.012, .horizon = 0.06, .trajectories = 20, .seed = 7, .noise_parts = 1});
  const auto c = baoab::coefficients();
  const bath& heat_bath = chain.bath();
  const auto distances = [&](std::size_t shift) {
    double sum = 0.0;
    for (std::size_t n = 0; n + shift < data.pairs(); ++n) {
      phase_point<double, 6> x = data.start[n];
      numbers f;
      force<double>(chain, x.q, f);
      x.p += f * (c[0] * data.step);
      x.q += x.p * (c[1] * data.step);
      x.p = x.p * heat_bath.decay(data.step) + data.noise[n + shift] * heat_bath.deviation(data.step);
      x.q += x.p * (c[3] * data.step);
      force<double>(chain, x.q, f);
      x.p += f * (c[4] * data.step);
      sum += (x.p - data.finish[n].p).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(data.pairs()));
  };
  // The noise of a step is .3 sqrt(.012) = .033 in each of six momenta; a foreign one errs by sqrt 2 of that.
  const double noise = 0.3 * std::sqrt(0.012 * 6.0);
  BOOST_TEST(distances(1) == noise * std::sqrt(2.0), boost::test_tools::tolerance(0.15));
  // Verlet errs by z^3/12 = .018 of momenta of 1.7, and some z/2 of the noise with z = .6.
  BOOST_TEST(distances(0) < 0.4 * noise * std::sqrt(2.0));
}

BOOST_AUTO_TEST_CASE(parts_change_no_state_and_are_of_one_path) {
  const auto with = [](int parts) {
    return made({.step = 0.012, .horizon = 0.06, .trajectories = 5, .seed = 7, .noise_parts = parts});
  };
  const auto none = with(0);
  BOOST_TEST(none.noise.size() == 0U);
  const auto one = with(1);
  for (const int parts : {1, 2, 3, 4, 6, 12}) {
    const auto data = with(parts);
    const auto count = static_cast<std::size_t>(parts);
    double worst = 0.0;
    for (std::size_t n = 0; n < data.pairs(); ++n) {
      BOOST_TEST(same_bits(data.finish[n], none.finish[n]));
      Eigen::VectorXd whole(6);
      coarse_graining(2.0 * 0.012 / parts).over(data.noise, n * count, count, whole);
      worst = std::max(worst, (whole - one.noise[n]).cwiseAbs().maxCoeff());
    }
    BOOST_TEST(worst <= 12 * 4 * eps);
  }
}

BOOST_AUTO_TEST_CASE(seeds_have_independent_noise) {
  const auto of_seed = [](std::uint64_t number) {
    return made({.step = 0.004, .horizon = 0.2, .trajectories = 40, .seed = seed(number), .noise_parts = 2});
  };
  const auto data = of_seed(1);
  const auto held_out = of_seed(2);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const auto x = column(data, 0, i);
    const auto off = [&](const std::vector<double>& y) {
      return std::abs(correlation(x, y)) * std::sqrt(static_cast<double>(x.size()));
    };
    const double allowed = standard_errors(false_alarms / 24);  // six momenta, four comparisons
    BOOST_TEST(mean_off(x, 0.0, 1.0) <= allowed);
    BOOST_TEST(deviation_off(x, 1.0) <= allowed);
    BOOST_TEST(off(column(data, 1, i)) <= allowed);
    BOOST_TEST(off(column(held_out, 0, i)) <= allowed);
    BOOST_TEST(off(column(of_seed(1), 0, i)) > allowed);
  }
}

BOOST_AUTO_TEST_CASE(threads_and_lanes_change_no_bit) {
  const auto with = [](const auto& system, int threads, std::uint64_t seed = 1) {
    const data_options options{.step = 0.012,
                               .horizon = 0.06,
                               .trajectories = 21,
                               .seed = seed,
                               .noise_parts = 2,
                               .threads = threads};
    return made(options, system);
  };
  const auto one = with(in_lanes<system_type, 1>(chain), 1);
  BOOST_TEST(same_bits(with(chain, 1), one));
  BOOST_TEST(same_bits(with(chain, 2), one));
  BOOST_TEST(same_bits(with(in_lanes<system_type, 3>(chain), 2), one));
  BOOST_TEST(!same_bits(with(chain, 1, 2), one));
}

BOOST_AUTO_TEST_CASE(checks_see_the_same_path_at_half_the_step) {
  const auto data = made({.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = 1});
  BOOST_TEST(data.finer.size() == 16U);  // one somewhere in each sixteenth of 105
  for (const auto& [pair, finish] : data.finer) {
    const auto finer = [&, first = pair](const path_place& at) {
      phase_point<double, 6> x = data.start[first];
      fine_paths(fine).finer().advance(chain, x, 0.012, at, std::span<numbers>());
      return x;
    };
    const std::uint64_t m = pair / 5;
    const auto n = static_cast<std::int64_t>(pair % 5);
    BOOST_TEST(same_bits(finish, finer({7, m, n})));
    BOOST_TEST(!same_bits(finish, finer({7, m, n + 1})));
    // The same noise: sigma h in momenta as kicks feel it, not sigma sqrt(step).
    BOOST_TEST(distance(finish, data.finish[pair]) < 0.3 * 0.1 * std::sqrt(0.012));
  }
  // Twelve evaluations a step and one to open, for 105 pairs; twice the steps for the checks.
  BOOST_TEST(data.evaluations == 105 * 13 + 16 * 25);
}

BOOST_AUTO_TEST_CASE(noise_that_cannot_be_had_is_refused) {
  const auto refused = [](const auto& system, const auto& reference, int parts,
                          std::initializer_list<std::string_view> words) {
    const data_options options{.step = 0.012, .trajectories = 1, .noise_parts = parts};
    return refuses<wrong>([&] { make_flow_map_data(system, law, reference, options); }, words);
  };
  BOOST_TEST(refused(without_bath, fine_steps<>(fine), 1, {"srkn11b", "must have noise", "take fine_paths"}));
  BOOST_TEST(!refused(without_bath, fine_steps<>(fine), 0, {}));
  BOOST_TEST(refused(chain, fine_steps<>(fine), 0, {"bath(friction=2, sigma=0.3)", "must have a letter O"}));
  BOOST_TEST(refused(chain, fine_steps<>(fine), 1, {"must have noise", "take fine_paths"}));
  BOOST_TEST(refused(chain, fine_paths(fine), 5, {"0.012 in the 5 equal parts", "fine step 0.001"}));
  BOOST_TEST(refused(chain, fine_paths(fine), -1, {"noise_parts must be >= 0, got -1"}));
  BOOST_TEST(refused(chain, fine_paths(0.005), 1, {"0.012 in the 1 equal parts", "fine step 0.005"}));
}

BOOST_AUTO_TEST_CASE(an_exact_flow_is_of_no_bath) {
  const in_bath oscillator(harmonic_oscillator(1.0), bath::of_sigma(0.1, 0.0));
  BOOST_TEST(refuses<wrong>([&] { exact_linear{oscillator}; }, {"exact_linear", "in no bath"}));
  const exact_linear of_the_alone(oscillator.base());
  const listed<1> starts({{vector<double, 1>(1.0), vector<double, 1>(0.0)}});
  const auto make = [&] {
    make_flow_map_data(oscillator, starts, of_the_alone, {.step = 0.1, .trajectories = 1});
  };
  BOOST_TEST(refuses<wrong>(make, {"that of the constructor, harmonic_oscillator", "in bath(friction=0.1"}));
}

BOOST_AUTO_TEST_CASE(more_trajectories_of_the_same_are_those_made_at_once) {
  data_options options{.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = 3};
  const auto at_once = made(options);
  flow_map_data grown;
  for (const std::int64_t trajectories : {5, 13, 21}) {
    options.trajectories = trajectories;
    extend_data(chain, law, fine_paths(fine), options, grown);
    BOOST_TEST(grown.trajectories() == static_cast<std::size_t>(trajectories));
    require_valid(grown, chain);
  }
  BOOST_TEST(grown.first_of == at_once.first_of, boost::test_tools::per_element());
  BOOST_TEST(grown.noise == at_once.noise);
  BOOST_TEST(grown.energies->low == at_once.energies->low);
  BOOST_TEST(grown.energies->high == at_once.energies->high);
  BOOST_TEST(grown.finer.size() > at_once.finer.size());  // some of each part
  // Each is of its own path: that of another would be farther off than the reference errs.
  for (const auto& [pair, finish] : grown.finer) {
    BOOST_TEST((finish.p - grown.finish[pair].p).norm() < 0.01 * (finish.p - grown.start[pair].p).norm());
  }
  grown.finer = at_once.finer;
  grown.evaluations = at_once.evaluations;
  BOOST_TEST(same_bits(grown, at_once));
  flow_map_data again;
  extend_data(chain, law, fine_paths(fine), options, again);
  BOOST_TEST(same_bits(again, at_once));
  options.trajectories = 4;
  extend_data(chain, law, fine_paths(fine), options, again);
  BOOST_TEST(again.trajectories() == 21U);  // there are enough
}

BOOST_AUTO_TEST_CASE(noise_that_is_not_whole_is_refused) {
  const auto whole = made({.step = 0.012, .horizon = 0.06, .trajectories = 2, .noise_parts = 2});
  const auto refused = [&](const auto& spoil, std::initializer_list<std::string_view> words) {
    auto data = whole;
    spoil(data);
    return refuses<wrong>([&] { require_valid(data, chain); }, words);
  };
  BOOST_TEST(!refused([](auto&) {}, {}));
  BOOST_TEST(
      refused([](auto& d) { d.noise.resize(19, 6); }, {"10 pairs with noise in 2 parts that hold 19"}));
  BOOST_TEST(refused([](auto& d) { d.noise_parts = 1; }, {"in 1 parts that hold 20"}));
  BOOST_TEST(refused([](auto& d) { d.noise_parts = -2; }, {"in -2 parts"}));
  BOOST_TEST(refused([](auto& d) { d.noise[13][2] = NAN; },
                     {"must be finite", "coordinate 3 of noise 13 = nan", "in pair 6 of trajectory 1"}));
  BOOST_TEST(refuses<wrong>([&] { require_valid(whole, without_bath); }, {"in bath(friction=2"}));
}
