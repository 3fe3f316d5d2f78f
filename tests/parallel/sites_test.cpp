// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 20 s at -O0, 1 s at -O1.
// A trajectory whose sites are shared has the bits of a plain loop: by tiles, on threads, and by ranks, also
// where it is saved and resumed by other ranks.
#include "../laws/compiled_specimens.hpp"
#include "../support/draws.hpp"
#include "../support/local_systems.hpp"
#include "../support/ranks_as_threads.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/sanitizers.hpp"
#include "nysalt/core.hpp"
#include "nysalt/distributed_run.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using state = phase_point<double, Eigen::Dynamic>;
/// That begin with either letter, merge or not, and keep their last force or not.
const std::vector<method> words{method(verlet()), method(verlet_aba()), euler("AB"), euler("BA")};
constexpr double h = 0.01;

/// Whether a run of the model, watched every that many steps, shows the states of a plain loop.
bool moves_as_in_a_loop(const auto& system, const method& method, std::int64_t steps, std::int64_t every,
                        int threads) {
  draws random;
  const state start = random.state(system, 0.5);
  std::vector<state> expected;
  std::vector<state> found;
  const auto keep_in = [](std::vector<state>& states) {
    return [&states](std::int64_t, double, const state& x) { states.push_back(x); };
  };
  const auto loop = integrate(make_stepper(system, method, h), start, steps, keep_in(expected), every);
  const model shared = model(system).on_threads(threads);
  const auto tiles = integrate(make_stepper(shared, method, h), start, steps, keep_in(found), every);
  return same_bits(loop.finish, tiles.finish) &&
         std::ranges::equal(expected, found, [](const state& x, const state& y) { return same_bits(x, y); });
}

/// Reads its share of a state that all ranks know.
distributed_run::start from(const state& all, Eigen::Index components) {
  return [&all, components](Eigen::Index first, std::span<double> q, std::span<double> p) {
    std::copy_n(all.q.data() + components * first, q.size(), q.begin());
    std::copy_n(all.p.data() + components * first, p.size(), p.begin());
  };
}

struct shared_end {
  state finish;
  double energy = 0.0;
};

/// Steps of all ranks together, with a stop in between where the run is saved.
shared_end on_ranks(const model& system, Eigen::Index components, const method& method, const state& start,
                    int before, int after) {
  state open = start;
  std::int64_t step = 0;
  shared_end end{start, 0.0};
  const auto collect = [&](const state& part, Eigen::Index first, state& to) {
    std::copy_n(part.q.data(), part.q.size(), to.q.data() + components * first);
    std::copy_n(part.p.data(), part.p.size(), to.p.data() + components * first);
  };
  run_ranks(before, [&](const communicator& ranks) {
    distributed_run run(system, method, h, from(start, components), ranks);
    run.advance(41);
    collect(run.open().state, run.first_site(), open);
    if (ranks.is_first()) step = run.step();
  });
  run_ranks(after, [&](const communicator& ranks) {
    distributed_run run(system, method, h, from(start, components), ranks);
    run.resume(step, from(open, components));
    run.advance(30);
    collect(run.synchronous(), run.first_site(), end.finish);
    const double energy = run.energy();
    if (!run.is_finite()) throw std::runtime_error("not finite");
    if (ranks.is_first()) end.energy = energy;
  });
  return end;
}

}  // namespace

BOOST_AUTO_TEST_CASE(tiles_have_the_bits_of_a_loop) {
  const auto check = [](Eigen::Index sites, std::int64_t steps, std::int64_t every, int threads) {
    for_each_local_system(
        [&](const auto& system) {
          for (const auto& method : sites == 40 || sites == 1025 ? words_in_turn() : words) {
            BOOST_TEST(moves_as_in_a_loop(system, method, steps, every, threads),
                       describe(system) << ", " << method.name() << ", every " << every << ", " << threads);
          }
        },
        sites);
  };
  // Around the sizes of tiles, which are 1024 or 2048 sites here, and of one tile alone; the last is large
  // enough for three threads, and is watched.
  for (const Eigen::Index sites : {16, 40, 1023, 1024, 1025, 2049}) check(sites, 37, 37, 1);
  for (const int threads : {1, 3}) check(13000, 37, 8, threads);
  for (const std::int64_t every : {1, 3, 64, 100}) check(300, 130, every, 2);
}

BOOST_AUTO_TEST_CASE(any_number_of_ranks_has_the_bits_of_a_loop) {
  const auto check = [](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    if constexpr (detail::HasPotentialInRange<S>) {
      if (system.sites() < 4096) return;
      draws random;
      const state start = random.state(system, 0.5);
      const model on_two = model(system).on_threads(2);
      for (const auto& method : words) {
        const auto loop = integrate(make_stepper(system, method, h), start, 71).finish;
        const auto alone = on_ranks(on_two, S::components, method, start, 1, 1);
        for (const auto& [before, after] : {std::pair(2, 3), {4, 2}, {3, 1}}) {
          const auto shared = on_ranks(on_two, S::components, method, start, before, after);
          const bool same = same_bits(shared.finish, loop) && shared.energy == alone.energy;
          BOOST_TEST(same, describe(system)
                               << ", " << method.name() << ", " << before << " ranks and " << after);
        }
        // Sums of 2 n terms in two orders; the terms are positive but for those of the lattice.
        const double n = static_cast<double>(8 * system.size());
        const double size = absolute_potential(system, loop.q) + loop.p.squaredNorm();
        BOOST_TEST(std::abs(alone.energy - energy<double>(system, loop)) <= n * eps * size);
      }
    }
  };
  for_each_local_system(check, 10'000);  // enough sites for two threads of one rank
}

namespace {

struct told_sites {
  Eigen::Index far = 3;
  Eigen::Index row = 1;
  bool alone = false;  // in wells, without springs
};
/// Springs that say of themselves what they are told to, right or wrong.
struct springs_as_told : far_springs {
  Eigen::Index all;
  told_sites told;
  springs_as_told(Eigen::Index points, const told_sites& as) : far_springs(points), all(points), told(as) {}
  Eigen::Index sites() const { return all; }
  Eigen::Index reach() const { return told.far; }
  Eigen::Index sites_of_row() const { return told.row; }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    if (!told.alone) return far_springs::force(q, f);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i] = q[i] * q[i] * q[i] * -1.0;
  }
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    if (!told.alone) return far_springs::force_in_range(q, f, begin, end);
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < components; ++c) f(c, i) = q(c, i) * q(c, i) * q(c, i) * -1.0;
    }
  }
};
springs_as_told sites_of(Eigen::Index points, const told_sites& as) { return {points, as}; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_reach_that_is_too_short_has_other_bits) {
  // Under AddressSanitizer the system would be found to read beyond a tile, and beyond its memory.
  if (!under_address_sanitizer) {
    BOOST_TEST(!moves_as_in_a_loop(sites_of(3000, {.far = 2}), method(verlet()), 100, 100, 1));
  }
  BOOST_TEST(moves_as_in_a_loop(sites_of(3000, {}), method(verlet()), 100, 100, 1));
  BOOST_TEST(moves_as_in_a_loop(sites_of(3000, {.far = 0, .alone = true}), method(verlet()), 100, 100, 1));
}

BOOST_AUTO_TEST_CASE(threads_take_systems_that_are_worth_them) {
  const auto lattice = [](Eigen::Index side) {
    return detail::site_layout{
        .sites = side * side, .reach = side, .sites_of_row = side, .is_periodic = true};
  };
  using detail::threads_in_tiles;
  BOOST_TEST(threads_in_tiles({.sites = 63}, 4) == 0);
  BOOST_TEST(threads_in_tiles({.sites = 64}, 4) == 1);
  BOOST_TEST(threads_in_tiles({.sites = 8191}, 4) == 1);
  BOOST_TEST(threads_in_tiles({.sites = 8192}, 4) == 2);
  BOOST_TEST(threads_in_tiles({.sites = 4096, .components = 2}, 4) == 2);
  BOOST_TEST(threads_in_tiles({.sites = 1'000'000}, 4) == 4);
  BOOST_TEST(threads_in_tiles({.sites = 1'000'000}, 1, 4) == 1);
  BOOST_TEST(threads_in_tiles({.sites = 1'000'000}, 1, 3) == 0);  // observed too often
  BOOST_TEST(threads_in_tiles({.sites = 1'000'000}, 4, 1) == 4);
  BOOST_TEST(threads_in_tiles(lattice(32), 2) == 0);
  BOOST_TEST(threads_in_tiles(lattice(100), 1) == 0);
  BOOST_TEST(threads_in_tiles(lattice(100), 2) == 2);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_shared_is_refused) {
  const auto misfits = [](Eigen::Index all, const told_sites& as, std::string_view said) {
    auto system = sites_of(30, as);
    system.all = all;
    return refuses<wrong>([&] { model{system}; }, {said});
  };
  BOOST_TEST(!misfits(30, {}, ""));
  BOOST_TEST(misfits(29, {}, "coordinates, 60, got 2 * 29"));
  BOOST_TEST(misfits(30, {.far = -1}, "reach() must not be negative"));
  BOOST_TEST(misfits(30, {.row = 7}, "got 3, 30 and 7"));
  BOOST_TEST(misfits(30, {.row = 0}, "got 3, 30 and 0"));
  const model chain = fpu_chain<>(2000, 50.0);
  BOOST_TEST(chain.threads() == 1);
  BOOST_TEST(chain.on_threads(4).threads() == 4);
  BOOST_TEST(refuses<wrong>([&] { chain.on_threads(0); }, {"threads must be at least 1, got 0"}));

  // By ranks, on all of them.
  const state rest{Eigen::VectorXd::Zero(4000), Eigen::VectorXd::Zero(4000)};
  state bad = rest;
  bad.q[3999] = std::numeric_limits<double>::infinity();
  const auto refused = [](const model& system, const method& method, const state& start, int ranks,
                          bool is_foreseen, std::initializer_list<std::string_view> said) {
    int thrown = 0;
    std::mutex guard;  // Boost.Test takes one thread at a time
    run_ranks(ranks, [&](const communicator& among) {
      std::exception_ptr what;
      try {
        distributed_run(system, method, h, from(start, 2), among);
      } catch (...) {
        what = std::current_exception();
      }
      const bool is_possible = detail::can_be_distributed(system, method, among);
      const std::lock_guard lock(guard);
      const auto again = [&] {
        if (what) std::rethrow_exception(what);
      };
      thrown += is_possible != is_foreseen && refuses<wrong>(again, said);
    });
    return thrown == ranks;
  };
  const nysalt::method by_verlet{verlet()};
  BOOST_TEST(refused(chain, by_verlet, rest, 3, true, {"at least 1 sites a rank", "3 ranks"}));
  BOOST_TEST(refused(henon_heiles(), by_verlet, rest, 2, true, {"LocalSystem", "henon"}));
  BOOST_TEST(
      refused(chain, nysalt::method(takahashi_imada()), rest, 2, true, {"drifts A and kicks B in turn"}));
  const in_bath warm(fpu_chain<>(2000, 50.0), bath::of_sigma(0.1, 0.05));
  BOOST_TEST(refused(warm, by_verlet, rest, 2, true, {"bath"}));
  BOOST_TEST(refused(chain, by_verlet, bad, 2, false, {"start must be finite"}));
  run_ranks(3, [](const communicator& among) {
    if (!detail::can_be_distributed(fpu_chain<>(4000, 50.0), nysalt::method(verlet()), among))
      throw std::logic_error("enough sites are refused");
  });
  distributed_run alone(chain, by_verlet, h, from(rest, 2));
  BOOST_TEST(refuses<wrong>([&] { alone.advance(-1); }, {"must not be negative, got -1"}));
}
