// SPDX-License-Identifier: BSL-1.0
// Normal numbers: ours, in all lanes, against generators that make one after the other.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/noises/counter_noise.hpp"
#include "peers/normal.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr std::size_t batch = 96;  // packs: 12 kB with 16 lanes

void ours(std::span<pack<double>> numbers) {
  static std::int64_t step = 0;
  standard_normals<pack<double>>(
      1, {.trajectory = 0, .step = ++step, .purpose = noise_purpose::initial_state}, numbers);
}

/// Mean and variance to 5 standard errors: generators cannot agree otherwise.
void require_normal(const std::string& what, const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double one : x) {
    sum += one;
    squares += one * one;
  }
  if (std::abs(sum / n) < 5.0 / std::sqrt(n) && std::abs(squares / n - 1.0) < 5.0 * std::sqrt(2.0 / n))
    return;
  throw std::runtime_error(
      fmt::format("{} has mean {} and variance {}: not normal", what, sum / n, squares / n));
}

}  // namespace

void race_noise() {
  std::vector<runner> runners;
  const auto packs = std::make_shared<std::vector<pack<double>>>(batch);
  runners.push_back({"ours", static_cast<double>(batch * pack<double>::lanes), [packs] {
                       ours(*packs);
                       benchmark::DoNotOptimize(packs->data());
                       benchmark::ClobberMemory();
                     }});
  std::vector<double> seen;
  for (int n = 0; n < 100; ++n) {
    ours(*packs);
    for (const auto& x : *packs) {
      for (int lane = 0; lane < pack<double>::lanes; ++lane) seen.push_back(x[lane]);
    }
  }
  require_normal("ours", seen);

  const auto numbers = std::make_shared<std::vector<double>>(batch * pack<double>::lanes);
  const auto add = [&](const std::string& name, void (*fill)(std::span<double>)) {
    std::vector<double> tried(100 * batch * pack<double>::lanes);
    fill(tried);
    require_normal(name, tried);
    runners.push_back({name, static_cast<double>(batch * pack<double>::lanes), [numbers, fill] {
                         fill(*numbers);
                         benchmark::DoNotOptimize(numbers->data());
                         benchmark::ClobberMemory();
                       }});
  };
  add("std::normal_distribution", std_normal<contraction::off>);
  add("std::normal_distribution, splitmix64", std_normal_splitmix<contraction::off>);
  add("Boost's ziggurat", boost_ziggurat<contraction::off>);
  add("Boost's ziggurat, splitmix64", boost_ziggurat_splitmix<contraction::off>);
  race("noise", std::move(runners));
}

}  // namespace nysalt::bench
