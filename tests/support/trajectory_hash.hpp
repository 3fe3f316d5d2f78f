// SPDX-License-Identifier: BSL-1.0
// One number for the bits of many trajectories.
#pragma once

#include <boost/test/unit_test.hpp>

#include <bit>
#include <cstdint>
#include <vector>

#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/method.hpp"

namespace nysalt::test {

/// Coordinates in -1/4..1/4 that no generator and no library function has a part in.
template <System S>
phase_point<double, S::dimension> hashed_start(const S& system, std::int64_t m) {
  phase_point<double, S::dimension> x{make_vector<double>(system), make_vector<double>(system)};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto residue = [](std::int64_t k) { return static_cast<double>(k % 101) / 202.0 - 0.25; };
    x.q[i] = residue(37 * m + 11 * i + 5);
    x.p[i] = residue(53 * m + 29 * i + 17);
  }
  return x;
}

/// FNV-1a over the bits of all finishes, in the order of the trajectories.
template <class T, System S, Method M, NoiseSource Noise = no_noise>
std::uint64_t trajectory_hash(const S& system, const M& method, double step, int threads,
                              const Noise& noise = {}) {
  constexpr std::int64_t count = 37;
  const auto stepper = make_stepper(system, method, step, noise);
  std::vector<phase_point<double, S::dimension>> finishes(count);
  for_each_block(count, lanes_in<T>, threads, [&](std::int64_t first, int n) {
    const auto start = gather<T, S::dimension>(n, [&](int k) { return hashed_start(system, first + k); });
    lockstep<std::remove_cvref_t<decltype(stepper)>, T> all(stepper, start, n, first);
    all.go_on(1000);
    const auto finish = all.synchronous();
    for (int k = 0; k < n; ++k) finishes[static_cast<std::size_t>(first + k)] = lane(finish, k);
  });
  std::uint64_t result = 0xcbf29ce484222325U;  // FNV's offset basis and prime for 64 bits
  const auto add = [&](double x) { result = (result ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3U; };
  for (const auto& x : finishes) {
    for (const double q : x.q) add(q);
    for (const double p : x.p) add(p);
  }
  return result;
}

template <System S, Method M, NoiseSource Noise = no_noise>
void must_have(std::uint64_t expected, const S& system, const M& method, double step,
               const Noise& noise = {}) {
  BOOST_TEST_CONTEXT(describe(system) << ", " << method.name()) {
    BOOST_TEST((trajectory_hash<double>(system, method, step, 1, noise)) == expected);
    BOOST_TEST((trajectory_hash<pack<double, 1>>(system, method, step, 1, noise)) == expected);
    BOOST_TEST((trajectory_hash<pack<double, 8>>(system, method, step, 2, noise)) == expected);
    BOOST_TEST((trajectory_hash<pack<double, 16>>(system, method, step, 1, noise)) == expected);
    BOOST_TEST((trajectory_hash<pack<double, 16>>(system, method, step, 2, noise)) == expected);
  }
}

}  // namespace nysalt::test
