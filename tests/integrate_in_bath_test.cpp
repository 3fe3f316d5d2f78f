// SPDX-License-Identifier: BSL-1.0
// Many noisy trajectories, in lanes and on threads: each is as it would be alone, with its own noise.
#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t trajectories = 21;  // fill no number of lanes
constexpr std::int64_t steps = 300;
constexpr std::int64_t every = 7;

/// Some of these leave the well, at times of their own.
const in_bath galaxy(henon_heiles(), bath::of_sigma(0.05, 0.05));
const normal_around<2> law({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.4, 0.4);

struct seen {
  std::vector<std::vector<double>> values;
  std::vector<std::optional<std::int64_t>> diverged_at;
  friend bool operator==(const seen&, const seen&) = default;
};

template <class Method>
auto stepper_of(const Method& method, std::uint64_t seed) {
  return make_stepper(galaxy, method, 0.1, counter_noise(seed));
}

template <class T>
seen together(const auto& method, int threads, std::int64_t first = 0, std::int64_t count = trajectories) {
  seen result{std::vector<std::vector<double>>(static_cast<std::size_t>(count)), {}};
  const auto read = [](const auto& x, std::span<T> numbers) { numbers[0] = x.p[0]; };
  const auto take = [&](std::int64_t m, std::int64_t, std::span<const double> numbers) {
    result.values[static_cast<std::size_t>(m - first)].push_back(numbers[0]);
  };
  const ensemble_options options{
      .trajectories = count, .steps = steps, .every = every, .threads = threads, .first = first};
  result.diverged_at = integrate_ensemble<T>(stepper_of(method, 5), law, options, 1, read, take);
  return result;
}

/// By integrate, one after the other, with the noise of trajectory m + shift.
seen alone(const auto& method, std::uint64_t shift = 0) {
  seen result{std::vector<std::vector<double>>(trajectories), {}};
  const auto stepper = stepper_of(method, 5);
  for (std::uint64_t m = 0; m < trajectories; ++m) {
    const auto observe = [&](std::int64_t, double, const auto& x) { result.values[m].push_back(x.p[0]); };
    result.diverged_at.push_back(integrate(stepper, law(1, m), steps, observe, every, m + shift).diverged_at);
  }
  return result;
}

template <class Method>
void compare(const Method& method) {
  const auto expected = alone(method);
  std::int64_t diverged = 0;
  for (const auto& at : expected.diverged_at) diverged += at ? 1 : 0;
  BOOST_TEST(diverged > 0);
  BOOST_TEST(diverged < trajectories);
  for (const int threads : {1, 2}) {
    BOOST_TEST((together<pack<double, 16>>(method, threads) == expected));
    BOOST_TEST((together<pack<double, 8>>(method, threads) == expected));
    BOOST_TEST((together<double>(method, threads) == expected));
  }
  BOOST_TEST(!(alone(method, 1) == expected));  // each has its own noise
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_is_as_if_alone) { compare(baoab()); }
BOOST_AUTO_TEST_CASE(also_where_halves_meet) { compare(obabo()); }

BOOST_AUTO_TEST_CASE(a_part_of_an_ensemble_has_the_noise_that_it_has_in_the_whole) {
  using T = pack<double, 8>;
  const auto whole = together<T>(obabo(), 1);
  const auto part = together<T>(obabo(), 1, 10, 5);
  for (std::size_t i = 0; i < 5; ++i) BOOST_TEST((part.values[i] == whole.values[10 + i]));
}

// In parts or at once: the same.
BOOST_AUTO_TEST_CASE(lockstep_goes_on_where_it_stopped) {
  using T = pack<double, 8>;
  const auto stepper = stepper_of(obabo(), 5);
  const auto start = sound_starts<T>(galaxy, law, 1, 3, 8);
  lockstep<std::remove_cvref_t<decltype(stepper)>, T> whole(stepper, start, 8, 3);
  lockstep<std::remove_cvref_t<decltype(stepper)>, T> parts(stepper, start, 8, 3);
  lockstep<std::remove_cvref_t<decltype(stepper)>, T> other(stepper, start, 8, 4);
  whole.go_on(128);
  parts.go_on(64);
  parts.go_on(128);
  other.go_on(128);
  for (int k = 0; k < 8; ++k) {
    const auto expected = lane(whole.synchronous(), k);
    if (whole.diverged_at(k)) continue;
    BOOST_TEST((lane(parts.synchronous(), k).p == expected.p));
    BOOST_TEST((lane(other.synchronous(), k).p != expected.p));
  }
}

BOOST_AUTO_TEST_CASE(an_ensemble_by_its_method_needs_a_source_of_noise) {
  const auto no_observer = [](auto&&...) {};
  const auto first = [](const auto& x) { return x.p[0]; };
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] { integrate_ensemble(galaxy, baoab(), 0.1, law, {.trajectories = 2}, first, no_observer); },
      {"source of noise", "counter_noise"}));
}
