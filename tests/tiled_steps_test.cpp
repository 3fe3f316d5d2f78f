// SPDX-License-Identifier: BSL-1.0
// Steps tile by tile have the bits of steps in a plain loop, for any number of threads.
#include "nysalt/detail/tiled_steps.hpp"

#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <vector>

#include "nysalt/integrate.hpp"
#include "nysalt/model.hpp"
#include "support/draws.hpp"
#include "support/local_systems.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"
#include "support/sanitizers.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

const std::vector<tabulated> words = words_in_turn();

/// Whether a run of the model, watched every that many steps, shows the states of a plain loop.
bool moves_as_in_a_loop(const auto& system, const tabulated& method, std::int64_t steps, std::int64_t every,
                        int threads) {
  draws random;
  const state start = random.state(system, 0.5);
  std::vector<state> expected;
  std::vector<state> found;
  const auto keep_in = [](std::vector<state>& states) {
    return [&states](std::int64_t, double, const state& x) { states.push_back(x); };
  };
  const double h = 0.01;
  const auto loop = integrate(make_stepper(system, method, h), start, steps, keep_in(expected), every);
  const model shared = model(system).on_threads(threads);
  const auto tiles = integrate(make_stepper(shared, method, h), start, steps, keep_in(found), every);
  bool result = same_bits(loop.finish, tiles.finish) && found.size() == expected.size();
  for (std::size_t k = 0; result && k < found.size(); ++k) result = same_bits(expected[k], found[k]);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(tiles_have_the_bits_of_a_loop) {
  // Around the sizes of tiles, which are 1024 or 2048 sites here, and of one tile alone; the last is large
  // enough for three threads.
  for (const Eigen::Index sites : {16, 40, 1023, 1024, 1025, 2049, 5000, 13000}) {
    for_each_local_system(
        [&](const auto& system) {
          for (const auto& method : words) {
            for (const int threads : {1, 3}) {
              BOOST_TEST_CONTEXT(describe(system) << ", " << method.name() << ", " << threads << " threads") {
                BOOST_TEST(moves_as_in_a_loop(system, method, 37, 37, threads));
              }
            }
          }
        },
        sites);
  }
}

BOOST_AUTO_TEST_CASE(watched_runs_show_the_states_of_a_loop) {
  for (const std::int64_t every : {1, 3, 64, 100}) {
    for_each_local_system(
        [&](const auto& system) {
          for (const auto& method : words) {
            BOOST_TEST_CONTEXT(describe(system) << ", " << method.name() << ", every " << every) {
              BOOST_TEST(moves_as_in_a_loop(system, method, 130, every, 2));
            }
          }
        },
        every < 64 ? 300 : 9000);  // on one thread and on two
  }
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

BOOST_AUTO_TEST_CASE(a_reach_that_is_too_short_has_other_bits) {
  // Under AddressSanitizer the system would be found to read beyond a tile, and beyond its memory.
  if (!under_address_sanitizer) {
    BOOST_TEST(!moves_as_in_a_loop(short_sighted(5000), tabulated(verlet()), 100, 100, 2));
  }
  BOOST_TEST(moves_as_in_a_loop(far_springs(5000), tabulated(verlet()), 100, 100, 2));
}

BOOST_AUTO_TEST_CASE(portions_are_the_letters_of_the_steps) {
  detail::step_program<double> program;
  program.pairs = {{1.0, 2.0}, {3.0, 4.0}};
  program.begins_with_kick = true;
  program.keeps_last_force = false;
  for (const int kicks : {1, 2, 3, 5, 100}) {
    detail::letters_in_portions letters(program, 7);
    std::vector<double> coefficients;
    for (auto portion = letters.next(kicks); !portion.empty(); portion = letters.next(kicks)) {
      int taken = 0;
      for (const auto& letter : portion) {
        BOOST_TEST(letter.is_kick == (coefficients.size() % 2 == 0));
        taken += letter.is_kick;
        coefficients.push_back(letter.coefficient);
      }
      BOOST_TEST(taken <= kicks);
    }
    BOOST_TEST(coefficients.size() == 28U);
    for (std::size_t k = 0; k < coefficients.size(); ++k)
      BOOST_TEST(coefficients[k] == static_cast<double>(k % 4 + 1));
  }
}

namespace {
/// Sites that do not fit together.
struct misfit : far_springs {
  Eigen::Index row = 1;
  Eigen::Index far = 3;
  Eigen::Index all = 30;
  using far_springs::far_springs;
  Eigen::Index sites() const { return all; }
  Eigen::Index reach() const { return far; }
  Eigen::Index sites_of_row() const { return row; }
};
/// Forces on sites from nothing but the sites.
struct single_wells : far_springs {
  using far_springs::far_springs;
  static constexpr Eigen::Index reach() { return 0; }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i] = q[i] * q[i] * q[i] * -1.0;
  }
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < components; ++c) f(c, i) = q(c, i) * q(c, i) * q(c, i) * -1.0;
    }
  }
};
}  // namespace

BOOST_AUTO_TEST_CASE(sites_that_do_not_fit_together_are_refused) {
  const auto with = [](auto member, Eigen::Index value) {
    misfit result(30);
    result.*member = value;
    return result;
  };
  BOOST_CHECK_NO_THROW(model(misfit(30)));
  BOOST_TEST(refuses<std::invalid_argument>([&] { model(with(&misfit::all, 29)); },
                                            {"coordinates, 60, got 2 * 29"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { model(with(&misfit::far, -1)); },
                                            {"reach() must not be negative"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { model(with(&misfit::row, 7)); }, {"got 3, 30 and 7"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { model(with(&misfit::row, 0)); }, {"got 3, 30 and 0"}));
  BOOST_TEST(moves_as_in_a_loop(single_wells(3000), tabulated(verlet()), 100, 100, 2));
}

BOOST_AUTO_TEST_CASE(a_model_needs_a_thread) {
  const model chain(fpu_chain<>(3, 50.0));
  BOOST_TEST(chain.threads() == 1);
  BOOST_TEST(chain.on_threads(4).threads() == 4);
  BOOST_TEST(
      refuses<std::invalid_argument>([&] { chain.on_threads(0); }, {"threads must be at least 1, got 0"}));
}
