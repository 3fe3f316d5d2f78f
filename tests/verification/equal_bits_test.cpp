// SPDX-License-Identifier: BSL-1.0
// Trajectories of systems made of + - * / sqrt have the same bits from any compiler, in any lanes, on any
// number of threads: the hashes below are those of all of them.
#include <boost/test/unit_test.hpp>

#include <bit>
#include <cstdint>
#include <vector>

#include "../support/systems.hpp"
#include "nysalt/ensemble_loop.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/lockstep.hpp"
#include "nysalt/methods/blanes_moan.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Coordinates in -1/4..1/4 that no generator and no library function has a part in.
template <System S>
phase_point<double, S::dimension> start_of(const S& system, std::int64_t m) {
  phase_point<double, S::dimension> x{make_vector<double>(system), make_vector<double>(system)};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto residue = [](std::int64_t k) { return static_cast<double>(k % 101) / 202.0 - 0.25; };
    x.q[i] = residue(37 * m + 11 * i + 5);
    x.p[i] = residue(53 * m + 29 * i + 17);
  }
  return x;
}

/// FNV-1a over the bits of all finishes, in the order of the trajectories.
template <class T, System S, Method M>
std::uint64_t hash(const S& system, const M& method, double step, int threads) {
  constexpr std::int64_t count = 37;
  const auto stepper = make_stepper(system, method, step);
  std::vector<phase_point<double, S::dimension>> finishes(count);
  for_each_block(count, lanes_in<T>, threads, [&](std::int64_t first, int n) {
    const auto start = gather<T, S::dimension>(n, [&](int k) { return start_of(system, first + k); });
    lockstep<decltype(make_stepper(system, method, step)), T> all(stepper, start, n);
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

template <System S, Method M>
void must_have(std::uint64_t expected, const S& system, const M& method, double step) {
  BOOST_TEST_CONTEXT(describe(system) << ", " << method.name()) {
    BOOST_TEST((hash<double>(system, method, step, 1)) == expected);
    BOOST_TEST((hash<pack<double, 1>>(system, method, step, 1)) == expected);
    BOOST_TEST((hash<pack<double, 8>>(system, method, step, 2)) == expected);
    BOOST_TEST((hash<pack<double, 16>>(system, method, step, 1)) == expected);
    BOOST_TEST((hash<pack<double, 16>>(system, method, step, 2)) == expected);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_chain) {
  const fpu_chain<3> chain(50.0);
  const member<nystrom> learned({0.51, 0.4});
  must_have(0xa3039e62515f01ffU, chain, verlet(), 0.01);
  must_have(0x72d20a23d494d637U, chain, learned, 0.03);
  must_have(0x72d20a23d494d637U, chain, tabulated(learned), 0.03);
  must_have(0xef0fece6c771e772U, chain, srkn6b(), 0.05);
  must_have(0x72d20a23d494d637U, fpu_chain<>(3, 50.0), learned, 0.03);
}

BOOST_AUTO_TEST_CASE(other_systems) {
  must_have(0xbbe778e91101a5f4U, henon_heiles(), srkn11b(), 0.1);
  must_have(0x8e5652c3e009195cU, relativistic(), verlet(), 0.1);
  // Its modes come from an eigensolver, but a trajectory does not ask for them.
  must_have(0x778e5a0cd91d7a34U, linear_chain::between_walls(5, 2.0, 3.0), verlet(), 0.1);
}

// One bit of one number is enough to be seen.
BOOST_AUTO_TEST_CASE(the_hash_sees_the_last_bit) {
  const auto of = [](double omega) { return hash<double>(fpu_chain<3>(omega), verlet(), 0.01, 1); };
  BOOST_TEST(of(50.0) != of(std::nextafter(50.0, 51.0)));
}
