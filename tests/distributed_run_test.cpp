// SPDX-License-Identifier: BSL-1.0
// A trajectory that ranks share has the bits of one process, also where it is saved and resumed by other
// ranks.
#include "nysalt/distributed_run.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <stdexcept>
#include <vector>

#include "nysalt/integrate.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/draws.hpp"
#include "support/local_systems.hpp"
#include "support/ranks_as_threads.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

const std::vector<tabulated> words = words_in_turn();

/// Reads its share of a state that all ranks know.
distributed_run::start from(const state& all, Eigen::Index components) {
  return [&all, components](Eigen::Index first, std::span<double> q, std::span<double> p) {
    std::copy_n(all.q.data() + components * first, q.size(), q.begin());
    std::copy_n(all.p.data() + components * first, p.size(), p.begin());
  };
}

/// What the action throws, if it throws.
std::exception_ptr thrown_by(const auto& action) {
  try {
    action();
  } catch (...) {
    return std::current_exception();
  }
  return {};
}

void throw_again(const std::exception_ptr& thrown) {
  if (thrown) std::rethrow_exception(thrown);
}

struct shared_end {
  state finish;
  double energy = 0.0;
};

/// Steps of all ranks together, with a stop in between where the run is saved.
shared_end on_ranks(const auto& system, const tabulated& method, const state& start, int before, int after) {
  constexpr Eigen::Index components = std::decay_t<decltype(system)>::components;
  state open = start;
  std::int64_t step = 0;
  shared_end result{start, 0.0};
  const auto collect = [&](const phase_point<double, Eigen::Dynamic>& part, Eigen::Index first, state& to) {
    std::copy_n(part.q.data(), part.q.size(), to.q.data() + components * first);
    std::copy_n(part.p.data(), part.p.size(), to.p.data() + components * first);
  };
  run_ranks(before, [&](const communicator& ranks) {
    distributed_run run(system, method, 0.01, from(start, components), ranks);
    run.advance(41);
    collect(run.open().state, run.first_site(), open);
    if (ranks.is_first()) step = run.step();
  });
  run_ranks(after, [&](const communicator& ranks) {
    distributed_run run(system, method, 0.01, from(start, components), ranks);
    run.resume(step, from(open, components));
    run.advance(30);
    collect(run.synchronous(), run.first_site(), result.finish);
    const double energy = run.energy();
    if (!run.is_finite()) throw std::runtime_error("not finite");
    if (ranks.is_first()) result.energy = energy;
  });
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(any_number_of_ranks_has_the_bits_of_a_loop) {
  const auto check = [](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    if constexpr (!detail::HasPotentialInRange<S>) {
      return;
    } else {
      if (system.sites() < 4096) return;
      draws random;
      const state start = random.state(system, 0.5);
      for (const auto& method : words) {
        const auto loop = integrate(make_stepper(system, method, 0.01), start, 71).finish;
        const auto alone = on_ranks(system, method, start, 1, 1);
        for (const auto& [before, after] :
             {std::pair(1, 1), std::pair(2, 3), std::pair(4, 2), std::pair(3, 1)}) {
          BOOST_TEST_CONTEXT(describe(system)
                             << ", " << method.name() << ", " << before << " ranks and " << after) {
            const auto shared = on_ranks(system, method, start, before, after);
            BOOST_TEST(same_bits(shared.finish, loop));
            BOOST_TEST(shared.energy == alone.energy);
          }
        }
        // Sums of 2 n terms in two orders; the terms are positive but for those of the lattice.
        const double n = static_cast<double>(8 * system.size());
        const double size = absolute_potential(system, loop.q) + loop.p.squaredNorm();
        BOOST_TEST(std::abs(alone.energy - energy<double>(system, loop)) <= n * eps * size);
      }
    }
  };
  for_each_local_system(check, 5000);
  for_each_local_system(check, 20'000);
}

BOOST_AUTO_TEST_CASE(what_ranks_cannot_share_is_refused_on_all_of_them) {
  const fpu_chain<> chain(2000, 50.0);
  const state rest{Eigen::VectorXd::Zero(4000), Eigen::VectorXd::Zero(4000)};
  const auto refused = [&](const model& system, const auto& method, int ranks,
                           std::initializer_list<std::string_view> words_of_message) {
    int thrown = 0;
    std::mutex guard;  // Boost.Test takes one thread at a time
    run_ranks(ranks, [&](const communicator& among) {
      const auto what = thrown_by([&] { distributed_run(system, method, 0.01, from(rest, 2), among); });
      const bool is_foreseen = !detail::can_be_distributed(system, tabulated(method), among);
      const std::lock_guard lock(guard);
      thrown += is_foreseen && refuses<std::invalid_argument>([&] { throw_again(what); }, words_of_message);
    });
    return thrown == ranks;
  };
  BOOST_TEST(refused(chain, verlet(), 3, {"at least 1 sites a rank", "3 ranks"}));
  BOOST_TEST(refused(henon_heiles(), verlet(), 2, {"LocalSystem", "henon"}));
  BOOST_TEST(refused(chain, takahashi_imada(), 2, {"drifts A and kicks B in turn"}));
  const in_bath warm(chain, bath::of_sigma(0.1, 0.05));
  BOOST_TEST(refused(warm, verlet(), 2, {"bath"}));
  state bad = rest;
  bad.q[3999] = std::numeric_limits<double>::infinity();
  int thrown = 0;
  std::mutex guard;
  run_ranks(2, [&](const communicator& among) {
    const auto what = thrown_by([&] { distributed_run(chain, verlet(), 0.01, from(bad, 2), among); });
    const std::lock_guard lock(guard);
    thrown += refuses<std::invalid_argument>([&] { throw_again(what); }, {"start must be finite"});
  });
  BOOST_TEST(thrown == 2);
  run_ranks(3, [&](const communicator& among) {
    const bool is_served = detail::can_be_distributed(fpu_chain<>(4000, 50.0), tabulated(verlet()), among);
    const std::lock_guard lock(guard);
    thrown -= is_served;
  });
  BOOST_TEST(thrown == -1);
  distributed_run alone_run(chain, verlet(), 0.01, from(rest, 2));
  BOOST_TEST(
      refuses<std::invalid_argument>([&] { alone_run.advance(-1); }, {"must not be negative, got -1"}));
}
