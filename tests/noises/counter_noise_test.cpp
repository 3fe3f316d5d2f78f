// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 8 s at -O0, 0.3 s at -O1.
// A normal number is a function of seed and counter alone, of neither lanes nor lengths; every
// place has numbers of its own. The elementary functions beneath are exact to a few roundings. Numbers have
// the normal law, out to its tails, and neighbours in every field of the counter know nothing of each other.
#include "nysalt/noises/counter_noise.hpp"
#include <Random123/philox.h>
#include <set>
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr auto purpose = noise_purpose::initial_state;
constexpr std::int64_t last_step = (std::int64_t{1} << 48U) - 1;
constexpr std::uint64_t last_trajectory = (std::uint64_t{1} << 48U) - 1;
constexpr std::uint64_t last_slot = (std::uint64_t{1} << 24U) - 1;

std::vector<double> numbers(std::uint64_t seed, const noise_counter& first, std::size_t count) {
  std::vector<double> result(count);
  standard_normals<double>(seed, first, result);
  return result;
}

using pair = std::array<double, 2>;
pair one_pair(std::uint64_t seed, const noise_counter& at) {
  pair result;
  standard_normals<double>(seed, at, result);
  return result;
}

/// The same by Random123 and libm, from what the docstrings say.
pair by_others(std::uint64_t seed, const noise_counter& at) {
  const auto word = [](std::uint64_t x) { return static_cast<std::uint32_t>(x & 0xffffffffU); };
  const auto step = static_cast<std::uint64_t>(at.step);
  const std::uint64_t use = std::uint64_t{static_cast<std::uint8_t>(at.purpose)} << 24U;
  const auto w = r123::Philox4x32()({{word(at.trajectory), word(at.trajectory >> 32U | step >> 32U << 16U),
                                      word(step), word(at.slot | use)}},
                                    {{word(seed), word(seed >> 32U)}});
  const std::uint64_t first = (std::uint64_t{w[0]} << 32U) + w[1];
  const std::uint64_t second = (std::uint64_t{w[2]} << 32U) + w[3];
  const double r = std::sqrt(-2.0 * std::log((static_cast<double>(first >> 12U) + 0.5) * 0x1p-52));
  const double t = static_cast<double>((second >> 12U) | 1U) * 0x1p-52 - 0.5;
  const double half_turn = (second & 1U) != 0 ? -1.0 : 1.0;
  const double x = half_turn * r * std::cos(std::numbers::pi / 2.0 * t);
  const double y = half_turn * r * std::sin(std::numbers::pi / 2.0 * t);
  return (second & 2U) != 0 ? pair{y, x} : pair{x, y};
}

/// Lane l has the bits of trajectory first + l alone, for every number of a step.
template <int W>
bool lanes_are_trajectories(std::uint64_t seed, noise_counter at, std::size_t count) {
  std::vector<pack<double, W>> packs(count);
  standard_normals<pack<double, W>>(seed, at, packs);
  bool same = true;
  for (int lane = 0; lane < W; ++lane, ++at.trajectory) {
    const auto alone = numbers(seed, at, count);
    for (std::size_t i = 0; i < count; ++i) same = same && packs[i][lane] == alone[i];
  }
  return same;
}

/// Of a place, or what halves a step there.
template <int N>
std::vector<double> normals(const counter_noise& source, const noise_place& at, bool halves = false) {
  vector<double, N> xi;
  halves ? source.halving(at, xi) : source.normals(at, xi);
  return {xi.begin(), xi.end()};
}

static_assert(std::numeric_limits<long double>::digits > 60, "the judge must know more than the judged");

constexpr double unit = 0x1p-53;  // what one rounding may do

/// Largest relative error over arguments, in units: f of a pack against the judge.
double worst(const std::vector<double>& arguments, const auto& f, const auto& judge) {
  double result = 0.0;
  for (const double x : arguments) {
    const long double right = judge(static_cast<long double>(x));
    const auto off = static_cast<double>(std::abs(f(pack<double>(x))[0] / right - 1.0L));
    result = std::max(result, off / unit);
  }
  return result;
}

/// Numbers of (0, 1) of all sizes: uniform, near 0 and near 1, where log is small.
std::vector<double> unit_interval() {
  draws random;
  std::vector<double> result = {0x1p-53, 1.0 - 0x1p-53, std::sqrt(0.5)};
  for (int n = 0; n < 20'000; ++n) {
    const double u = (static_cast<double>(random.bits() >> 12U) + 0.5) * 0x1p-52;
    result.push_back(u);
    result.push_back(std::ldexp(u, -(n % 52)));
    result.push_back(1.0 - std::ldexp(u, -(n % 52) - 1));
    result.push_back(0.7 + 0.01 * u);  // about sqrt(1/2), where two terms cancel most
  }
  return result;
}

/// Quarter turns from -1/2 to 1/2, of all sizes.
std::vector<double> quarter_turns() {
  draws random;
  std::vector<double> result = {-0.5 + 0x1p-52, -0x1p-52, 0x1p-52, 0.5 - 0x1p-52};
  for (int n = 0; n < 20'000; ++n) {
    const double t = static_cast<double>(random.bits() >> 12U) * 0x1p-52 - 0.5;
    result.push_back(t);
    result.push_back(std::ldexp(t, -(n % 51)));
  }
  return result;
}

constexpr std::size_t count = 100'000;

struct sample {
  std::vector<double> x, y;
};

struct place {
  std::uint64_t seed;
  noise_counter at;
};
place at(std::uint64_t seed, std::uint64_t trajectory, std::uint64_t step = 0, std::uint64_t slot = 0) {
  return {seed, {trajectory, static_cast<std::int64_t>(step), slot, purpose}};
}

/// The pairs at where(0), where(1), ...; `where` gives seed and counter.
sample draw(const auto& where, std::size_t pairs = count) {
  sample result;
  for (std::size_t n = 0; n < pairs; ++n) {
    const auto [seed, at] = where(n);
    const auto [x, y] = one_pair(seed, at);
    result.x.push_back(x);
    result.y.push_back(y);
  }
  return result;
}

/// Pairs that differ in one thing only.
const std::vector<sample>& samples() {
  static const std::vector<sample> all = {draw([](std::uint64_t n) { return at(seed(1), n); }),
                                          draw([](std::uint64_t n) { return at(seed(1), 0, n); }),
                                          draw([](std::uint64_t n) { return at(seed(1), 0, 0, n); }),
                                          draw([](std::uint64_t n) { return at(seed(n), 0); })};
  return all;
}

std::vector<double> squares(std::vector<double> x) {
  for (double& value : x) value *= value;
  return x;
}

/// Whether the number of |z| > end is one that the binomial distribution exceeds, or falls below, with that
/// probability.
bool tail_is_off(const std::vector<double>& x, double end, double probability) {
  const double p = std::erfc(end / std::sqrt(2.0));
  const auto n = static_cast<int>(x.size());
  const auto beyond = static_cast<int>(std::ranges::count_if(x, [&](double z) { return std::abs(z) > end; }));
  return beyond > most_of(n, p, probability) || n - beyond > most_of(n, 1.0 - p, probability);
}

}  // namespace

// Of Philox, its words, and how bits choose points of the plane as Box and Muller ask.
BOOST_AUTO_TEST_CASE(the_numbers_are_those_of_random123_and_libm) {
  const auto check = [](std::uint64_t seed, const noise_counter& at) {
    const pair ours = one_pair(seed, at);
    const pair theirs = by_others(seed, at);
    for (std::size_t k = 0; k < 2; ++k) {  // a root of a logarithm of 4 units of 2^-53, and a sine of 4
      BOOST_TEST(std::abs(ours[k] / theirs[k] - 1.0) <= 16.0 * 0x1p-53);
    }
    BOOST_TEST((one_pair(seed + 1, at) != ours));
  };
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}}) {
    check(seed, {0, 0, 0, {}});
    check(seed, {1, 2, 3, purpose});
    check(seed, {9876543210, 12345678901, 54321});
    check(seed, {last_trajectory, last_step, last_slot, static_cast<noise_purpose>(255)});
  }
  draws random;
  for (int n = 0; n < 1000; ++n) {
    check(random.bits(), {random.bits() >> 16U, static_cast<std::int64_t>(random.bits() >> 16U),
                          random.bits() >> 40U, static_cast<noise_purpose>(random.bits() >> 56U)});
  }
}

BOOST_AUTO_TEST_CASE(a_lane_has_the_bits_of_its_trajectory_alone) {
  for (const std::size_t count : {1U, 2U, 6U, 7U, 51U}) {  // a pair broken, and more than is done in one go
    const noise_counter at = {41, 7, 3, purpose};
    const auto all_are = [&]<int... W>(std::integer_sequence<int, W...>) {
      return (lanes_are_trajectories<W>(5, at, count) && ...);
    };
    BOOST_TEST(all_are(std::integer_sequence<int, 1, 2, 3, 5, 8, 12, 16>()));
  }
  // Lanes carry into the upper word of the trajectory.
  BOOST_TEST(lanes_are_trajectories<16>(5, {0xfffffff9U, 7, 3, purpose}, 6));
  BOOST_TEST(lanes_are_trajectories<16>(5, {last_trajectory - 15, last_step, last_slot, purpose}, 2));
}

BOOST_AUTO_TEST_CASE(numbers_know_neither_how_many_they_are_nor_where_a_call_began) {
  const auto all = numbers(3, {1, 2, 0, purpose}, 400);
  for (const std::size_t slot : {0U, 1U, 7U, 128U}) {
    for (const std::size_t count : {0U, 1U, 2U, 31U, 33U, 100U}) {
      const auto some = numbers(3, {1, 2, slot, purpose}, count);
      BOOST_TEST(std::equal(some.begin(), some.end(), all.begin() + static_cast<std::ptrdiff_t>(2 * slot)));
    }
  }
  static_assert(detail::slots_for(0) == 0 && detail::slots_for(1) == 1 && detail::slots_for(2) == 1 &&
                detail::slots_for(3) == 2);
}

// The counter has 128 bits, and each has its own place: no two of them can be taken for each other.
BOOST_AUTO_TEST_CASE(every_bit_of_every_field_counts_and_no_fields_overlap) {
  const noise_counter zero;
  std::set<pair> seen = {one_pair(0, zero)};
  std::size_t flips = 0;
  const auto flip = [&](std::uint64_t seed, const noise_counter& at) {
    seen.insert(one_pair(seed, at));
    ++flips;
  };
  for (int bit = 0; bit < 48; ++bit) flip(0, {.trajectory = std::uint64_t{1} << bit});
  for (int bit = 0; bit < 48; ++bit) flip(0, {.step = std::int64_t{1} << bit});
  for (int bit = 0; bit < 24; ++bit) flip(0, {.slot = std::uint64_t{1} << bit});
  for (int bit = 0; bit < 8; ++bit) flip(0, {.purpose = static_cast<noise_purpose>(1U << bit)});
  BOOST_TEST(flips == 128U);
  for (int bit = 0; bit < 64; ++bit) flip(std::uint64_t{1} << bit, zero);
  BOOST_TEST(seen.size() == flips + 1);
  flip(0, {.slot = 1});  // a counter for the second time: it is found
  BOOST_TEST(seen.size() == flips);
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
          add(normals<3>(source, {trajectory, step, 0}, true));
        }
      }
    }
  }
  BOOST_TEST(drawn == 2U * 2U * 3U * 3U * 4U * 3U);
  BOOST_TEST(seen.size() == drawn);
  add(normals<3>(counter_noise(1), {0, 0, 0}));  // for the second time: it is found
  BOOST_TEST(seen.size() + 3 == drawn);
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused) {
  const auto refused = [](const noise_counter& at, std::size_t count, std::string_view word) {
    return refuses([&] { numbers(1, at, count); }, {"standard_normals", word});
  };
  BOOST_TEST(
      refused({.trajectory = last_trajectory + 1}, 2, "trajectory must be < 2^48, got 281474976710656"));
  BOOST_TEST(refused({.trajectory = ~std::uint64_t{0}}, 2, "trajectory"));
  BOOST_TEST(refused({.step = last_step + 1}, 2, "< 2^48, got 281474976710656"));
  BOOST_TEST(refused({.step = -1}, 2, "step must be >= 0"));
  BOOST_TEST(refused({.slot = last_slot + 1}, 1, "slot 16777216"));
  BOOST_TEST(refused({.slot = last_slot}, 3, "2 slots from slot 16777215"));
  BOOST_TEST(refused({.slot = ~std::uint64_t{0}}, 2, "slot"));
  BOOST_TEST(!refused({last_trajectory, last_step, last_slot, purpose}, 2, ""));
  std::array<pack<double, 2>, 2> two_trajectories;  // the second lane would be beyond the last trajectory
  BOOST_TEST(refuses(
      [&] { standard_normals<pack<double, 2>>(1, {.trajectory = last_trajectory}, two_trajectories); },
      {"trajectory"}));
  const counter_noise source(3);
  BOOST_TEST(refuses([&] { normals<1>(source, {0, -1, 0}); }, {"step must be", "got -1"}));
  BOOST_TEST(refuses([&] { normals<1>(source, {last_trajectory + 1, 0, 0}); }, {"trajectory"}));
  BOOST_TEST(!refuses([&] { normals<1>(source, {last_trajectory, 0, 0}); }, {}));
}

// k log 2 and 2 artanh s are rounded 1 and 5 times (s thrice) and approximated to 2 units; at worst their sum
// is half of the larger one, which doubles its part of the error.
BOOST_AUTO_TEST_CASE(the_logarithm_is_exact_to_eight_roundings) {
  const auto judge = [](long double x) { return -2.0L * std::log(x); };
  const auto ours = [](const auto& x) { return detail::minus_two_log(x); };
  const auto sloppy = [&](const auto& x) { return ours(x) * (1.0 + 16.0 * unit); };
  BOOST_TEST(worst(unit_interval(), ours, judge) <= 8.0);
  BOOST_TEST(worst(unit_interval(), sloppy, judge) > 8.0);
}

// A polynomial whose terms fall quickly is rounded twice, its argument once, t * once, and approximated to 1
// or 2 units.
BOOST_AUTO_TEST_CASE(sine_and_cosine_are_exact_to_four_roundings) {
  constexpr long double quarter_turn = std::numbers::pi_v<long double> / 2.0L;
  const auto sine = [](const auto& t) { return detail::sine_and_cosine_of_quarter_turns(t).sine; };
  const auto cosine = [](const auto& t) { return detail::sine_and_cosine_of_quarter_turns(t).cosine; };
  const auto right_sine = [](long double t) { return std::sin(quarter_turn * t); };
  const auto right_cosine = [](long double t) { return std::cos(quarter_turn * t); };
  BOOST_TEST(worst(quarter_turns(), sine, right_sine) <= 4.0);
  BOOST_TEST(worst(quarter_turns(), cosine, right_cosine) <= 4.0);
  const auto longer = [&](const auto& t) { return sine(t * (1.0 + 16.0 * unit)); };
  BOOST_TEST(worst(quarter_turns(), longer, right_sine) > 4.0);
}

BOOST_AUTO_TEST_CASE(distances_go_from_just_above_zero_to_their_end) {
  const double longest = detail::squared_distance(0)[0];
  const double shortest = detail::squared_distance(0xffffffffffffffffU)[0];
  BOOST_TEST(std::abs(longest / (106.0 * std::numbers::ln2) - 1.0) <= 8.0 * unit);  // u = 2^-53
  BOOST_TEST(std::abs(shortest / 0x1p-52 - 1.0) <= 8.0 * unit);                     // u = 1 - 2^-53
  BOOST_TEST(detail::squared_distance(0xfffU)[0] == longest);                       // 12 bits are left over
  BOOST_TEST(detail::squared_distance(0x1000U)[0] < longest);
}

BOOST_AUTO_TEST_CASE(the_law_is_normal_by_kolmogorov_and_smirnov) {
  const double allowed = kolmogorov_smirnov_limit(false_alarms / 8);
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(kolmogorov_smirnov(x) <= allowed);
    BOOST_TEST(kolmogorov_smirnov(y) <= allowed);
  }
  auto shifted = samples().front().x;
  for (double& z : shifted) z += 0.06;  // moves F by 0.024, that is 7.6 in these units
  BOOST_TEST(kolmogorov_smirnov(shifted) > allowed);
}

BOOST_AUTO_TEST_CASE(the_tails_are_there) {
  std::vector<double> many(400'000);
  standard_normals<double>(seed(1), {0, 0, 0, purpose}, many);
  constexpr double each = false_alarms / 7;  // two sides of three tails, and a distribution
  for (const double end : {2.0, 3.0, 4.0}) BOOST_TEST(!tail_is_off(many, end, each));  // 25 are beyond 4
  for (double& z : many) z = std::clamp(z, -4.0, 4.0);
  BOOST_TEST(tail_is_off(many, 4.0, each));
  BOOST_TEST(kolmogorov_smirnov(many) <= kolmogorov_smirnov_limit(each));  // which does not see that
}

BOOST_AUTO_TEST_CASE(pairs_and_their_neighbours_are_independent) {
  const auto now = [](const std::vector<double>& x) { return std::vector(x.begin(), x.end() - 1); };
  const auto next = [](const std::vector<double>& x) { return std::vector(x.begin() + 1, x.end()); };
  const double allowed = standard_errors(false_alarms / 33);  // 4 samples, 8 correlations, and one below
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(correlation_off(x, y) <= allowed);
    BOOST_TEST(correlation_off(squares(x), squares(y)) <= allowed);
    BOOST_TEST(correlation_off(squares(x), y) <= allowed);
    BOOST_TEST(correlation_off(x, squares(y)) <= allowed);
    BOOST_TEST(correlation_off(now(x), next(x)) <= allowed);
    BOOST_TEST(correlation_off(now(x), next(y)) <= allowed);
    BOOST_TEST(correlation_off(now(y), next(x)) <= allowed);
    BOOST_TEST(correlation_off(squares(now(x)), squares(next(x))) <= allowed);
  }
  auto [x, y] = samples().front();  // uncorrelated, yet of the same size
  for (std::size_t i = 0; i < count; ++i) y[i] = i % 2 == 0 ? x[i] : -x[i];
  BOOST_TEST(correlation_off(x, y) <=
             1.2 * allowed);  // x^2 has the kurtosis that makes it sqrt(3) times as wide
  BOOST_TEST(correlation_off(squares(x), squares(y)) > allowed);
  for (std::size_t i = 1; i < count; ++i) x[i] += 0.04 * x[i - 1];  // 12 standard errors
  BOOST_TEST(correlation_off(now(x), next(x)) > allowed);
}
