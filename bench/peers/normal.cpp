// SPDX-License-Identifier: BSL-1.0
#include "normal.hpp"

#include <boost/random/normal_distribution.hpp>
#include <random>

#include "splitmix.hpp"

namespace nysalt::bench {

namespace {

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
