// SPDX-License-Identifier: BSL-1.0
// Fresh noise: every place has its own numbers, and no two uses share one.
#include "nysalt/noises/counter_noise.hpp"

#include <boost/test/unit_test.hpp>

#include <set>
#include <vector>

#include "../support/refusal.hpp"
#include "nysalt/noises/none.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <int N>
std::vector<double> normals(const counter_noise& source, const noise_place& at) {
  vector<double, N> xi;
  source.normals(at, xi);
  return {xi.begin(), xi.end()};
}
template <int N>
std::vector<double> halves(const counter_noise& source, const noise_place& at) {
  vector<double, N> zeta;
  source.halving(at, zeta);
  return {zeta.begin(), zeta.end()};
}

}  // namespace

static_assert(NoiseSource<counter_noise> && NoiseSource<no_noise>);
static_assert(counter_noise::is_memoryless && !no_noise::is_memoryless);

BOOST_AUTO_TEST_CASE(the_numbers_of_a_place_are_a_function_of_it) {
  const noise_place here{5, 7, 1};
  BOOST_TEST(normals<3>(counter_noise(1), here) == normals<3>(counter_noise(1), here));
  const counter_noise burn_in(1, noise_purpose::burn_in);
  BOOST_TEST(normals<3>(burn_in, here) == normals<3>(burn_in, here));
}

// Trajectories, steps, letters, seeds, purposes, halves: among all their numbers there are no two alike.
// 53 bits collide among 2000 numbers with a probability of 2e-10.
BOOST_AUTO_TEST_CASE(no_two_places_share_a_number) {
  std::set<double> seen;
  std::size_t drawn = 0;
  const auto add = [&](const std::vector<double>& numbers) {
    seen.insert(numbers.begin(), numbers.end());
    drawn += numbers.size();
  };
  for (const auto purpose : {noise_purpose::bath, noise_purpose::burn_in}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const counter_noise source(seed, purpose);
      for (const std::uint64_t trajectory : {0U, 1U, 2U}) {
        for (const std::int64_t step : {0, 1, 2}) {
          for (const int letter : {0, 1, 2}) add(normals<3>(source, {trajectory, step, letter}));
          add(halves<3>(source, {trajectory, step, 0}));
        }
      }
    }
  }
  BOOST_TEST(drawn == 2U * 2U * 3U * 3U * 4U * 3U);
  BOOST_TEST(seen.size() == drawn);
  add(normals<3>(counter_noise(1), {0, 0, 0}));  // for the second time: it is found
  BOOST_TEST(seen.size() + 3 == drawn);
}

BOOST_AUTO_TEST_CASE(a_lane_sees_the_noise_of_its_trajectory) {
  const counter_noise source(3);
  vector<pack<double, 5>, 3> xi;
  vector<pack<double, 5>, 3> zeta;
  source.normals({11, 4, 1}, xi);
  source.halving({11, 4, 0}, zeta);
  for (int k = 0; k < 5; ++k) {
    const auto trajectory = static_cast<std::uint64_t>(11 + k);
    const auto alone = normals<3>(source, {trajectory, 4, 1});
    const auto halves_alone = halves<3>(source, {trajectory, 4, 0});
    for (int i = 0; i < 3; ++i) {
      BOOST_TEST(xi[i][k] == alone[static_cast<std::size_t>(i)]);
      BOOST_TEST(zeta[i][k] == halves_alone[static_cast<std::size_t>(i)]);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_counted_is_refused) {
  using wrong = std::invalid_argument;
  const counter_noise source(3);
  BOOST_TEST(refuses<wrong>([&] { normals<1>(source, {0, -1, 0}); }, {"step must be", "got -1"}));
  BOOST_TEST(refuses<wrong>([&] { normals<1>(source, {std::uint64_t{1} << 48U, 0, 0}); }, {"trajectory"}));
  BOOST_TEST(!refuses<wrong>([&] { normals<1>(source, {(std::uint64_t{1} << 48U) - 1, 0, 0}); }, {}));
}
