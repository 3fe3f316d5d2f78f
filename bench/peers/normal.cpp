// SPDX-License-Identifier: BSL-1.0
#include "normal.hpp"

#include <boost/random/normal_distribution.hpp>
#include <limits>
#include <random>

namespace nysalt::bench {

namespace {

/// A counter and a hash of it [steele_lea_flood_2014], with the constants of Java's SplittableRandom.
class splitmix {
 public:
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

 private:
  std::uint64_t state_ = 1;
};

template <class Distribution, class Engine>
void fill(std::span<double> numbers) {
  static Engine engine;  // as programs hold them; not seeded anew at each turn
  static Distribution normal;
  for (double& x : numbers) x = normal(engine);
}

}  // namespace

template <>
void std_normal<this_build>(std::span<double> numbers) {
  fill<std::normal_distribution<double>, std::mt19937_64>(numbers);
}
template <>
void std_normal_splitmix<this_build>(std::span<double> numbers) {
  fill<std::normal_distribution<double>, splitmix>(numbers);
}
template <>
void boost_ziggurat<this_build>(std::span<double> numbers) {
  fill<boost::random::normal_distribution<double>, std::mt19937_64>(numbers);
}
template <>
void boost_ziggurat_splitmix<this_build>(std::span<double> numbers) {
  fill<boost::random::normal_distribution<double>, splitmix>(numbers);
}

}  // namespace nysalt::bench
