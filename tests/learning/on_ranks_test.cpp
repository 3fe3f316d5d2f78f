// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 3 s at -O0, 0.7 s at -O1.
// Ranks that share the data learn what one learns, to the last bit, as sums over trajectories are added in
// the order of tree_sum.
#include <atomic>
#include <bit>
#include <mutex>

#include "../../src/nysalt/learning/problem.hpp"
#include "../support/learned.hpp"
#include "../support/ranks_as_threads.hpp"
#include "nysalt/core/tree_sum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double step = 0.6;
const pendulum swing;
const family two_stages{nystrom()};

const normal_around<1> starts({vector<double, 1>(0.5), vector<double, 1>(0.0)}, 0.5, 0.5);

data_options options_for(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return {.step = step,
          .horizon = 3.0,
          .trajectories = trajectories,
          .seed = seed,
          .execution = {.ranks = &ranks}};
}

flow_map_data make(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return make_flow_map_data(swing, starts, fine_steps(step / 64), options_for(trajectories, seed, ranks));
}

/// What is learned, how well it is known, and how well it does.
std::vector<double> numbers_of(const flow_map_data& data, const flow_map_data& held_out) {
  const fit_summary fit =
      learn(two_stages, swing, data, held_out, {.random_starts = 2, .planned_steps = 300}).summary;
  std::vector<double> all{fit.loss,           fit.held_out_loss,  fit.held_out_noise, fit.reference_error,
                          data.energies->low, data.energies->high};
  for (const auto& one : fit.parameters) all.insert(all.end(), {one.value, one.standard_error});
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return std::ranges::equal(a, b, {}, bits, bits);
}

/// Whether all of three ranks refuse with these words.
void check_refusal_on_ranks(const std::string& words, const std::function<void(const communicator&)>& act) {
  std::atomic<int> refused = 0;
  run_ranks(3, [&](const thread_communicator& ours) {
    try {
      act(ours);
    } catch (const std::invalid_argument& thrown) {
      refused += thrown.what() == words;
    }
  });
  BOOST_TEST(refused == 3);
}

}  // namespace

// All of learning with data that do not grow: invariance/results_test.cpp.
BOOST_AUTO_TEST_CASE(data_that_grow_change_hands) {
  const auto grown = [](const communicator& ranks) {
    flow_map_data data;
    for (const std::int64_t trajectories : {30, 70, 110}) {
      detail::extend_data(swing, starts, fine_steps(step / 64), options_for(trajectories, 1, ranks), data);
    }
    return numbers_of(data, make(40, 2, ranks));
  };
  const std::vector<double> expected = grown(one_rank);
  BOOST_TEST(!same_bits(numbers_of(make(110, 3, one_rank), make(40, 2, one_rank)), expected));
  std::mutex guard;
  run_ranks(3, [&](const thread_communicator& ours) {
    const auto found = grown(ours);
    const std::lock_guard lock(guard);
    BOOST_TEST(same_bits(found, expected));
  });
}

BOOST_AUTO_TEST_CASE(each_rank_keeps_its_own_pairs_alone) {
  std::mutex guard;
  std::size_t sum = 0;
  std::size_t most = 0;
  run_ranks(4, [&](const thread_communicator& ours) {
    const auto data = make(640, 1, ours);
    const std::lock_guard lock(guard);
    sum += data.pairs();
    most = std::max(most, data.pairs());
  });
  BOOST_TEST(sum == 640U * 5);
  BOOST_TEST(most == 160U * 5);
}

BOOST_AUTO_TEST_CASE(a_pass_over_the_data_is_one_sum_whatever_the_data) {
  const auto traffic_of_pass = [](int size, std::int64_t trajectories) {
    traffic most;
    std::mutex guard;
    run_ranks(size, [&](const thread_communicator& ours) {
      const auto data = make(trajectories, 1, ours);
      const learning_problem problem(two_stages, swing, data, data, {});
      const traffic before = ours.seen();
      problem.loss(problem.family.starts.front().theta);
      const std::lock_guard lock(guard);
      for (const auto part : {&traffic::received, &traffic::sent, &traffic::together, &traffic::bytes}) {
        most.*part = std::max(most.*part, ours.seen().*part - before.*part);
      }
    });
    return most;
  };
  constexpr std::int64_t of_column = 8 * (1 + 2 + 3);  // r^T r, J^T r and half of J^T J for two parameters
  for (const int size : {2, 4, 8}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(size))) - 1;
    for (const std::int64_t trajectories : {16 * 8, 16 * 16}) {
      const auto seen = traffic_of_pass(size, trajectories);
      BOOST_TEST(seen.received == log2);
      BOOST_TEST(seen.sent == 1);
      BOOST_TEST(seen.together == 1);
      BOOST_TEST(seen.bytes == of_column * (log2 + 1));
    }
  }
}

BOOST_AUTO_TEST_CASE(an_own_loss_that_throws_on_one_rank_throws_on_all) {
  const std::string words = "of this trajectory there is nothing to say";
  const double place = starts(1, 70).q[0];
  check_refusal_on_ranks(words, [&](const communicator& ranks) {
    const auto data = make(96, 1, ranks);
    const auto error = [&]<class T>(const phase_point<T, 1>& start, const phase_point<T, 1>& finish,
                                    const phase_point<T, 1>& wanted) -> T {
      const auto q = start.q[0].value;
      for (int k = 0; k < lanes_in<decltype(T::value)>; ++k) {
        if (lane(q, k) == place) throw std::invalid_argument(words);
      }
      return finish.q[0] - wanted.q[0];
    };
    const own_loss of_place{"place", 1, error};
    const learning_problem problem(two_stages, swing, data, data, {.loss = loss_of(swing, of_place)});
    problem.loss(problem.family.starts.front().theta);
  });
}

BOOST_AUTO_TEST_CASE(bad_data_on_one_rank_are_refused_on_all) {
  const std::string words =
      "learn: the finish of pair 352 of the data, in trajectory 70, must be finite: p1 is nan";
  check_refusal_on_ranks(words, [](const communicator& ranks) {
    auto data = make(96, 1, ranks);
    const std::size_t bad = 352;
    if (data.first_pair() <= bad && bad < data.first_pair() + data.pairs()) {
      data.finish[bad - data.first_pair()].p[0] = std::nan("");
    }
    learn(two_stages, swing, data, data);
  });
}

// The mean over the pairs that were checked, 16 of them, added over trajectories in a tree.
BOOST_AUTO_TEST_CASE(the_error_of_the_reference_is_the_root_mean_square_of_its_pairs) {
  const fpu_chain<3> chain(50.0);
  const auto data = make_flow_map_data(chain, fpu_law<3>(chain), fine_steps(1e-3),
                                       {.step = 0.02, .horizon = 0.1, .trajectories = 203});
  const fit_options options{.coordinates = coordinates::qp, .fixed = {0.45, 0.38}, .planned_steps = 200};
  const auto fit = learn(two_stages, chain, data, data, options).summary;
  const metric measure(chain, data, coordinates::qp);
  std::vector<double> squares(203, 0.0);
  std::vector<double> r(12);
  BOOST_TEST(data.finer.size() == 16U);
  for (const auto& [pair, finish] : data.finer) {
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) squares[pair / 5] += x * x;  // five steps a trajectory
  }
  BOOST_TEST(fit.reference_error == std::sqrt(tree_sum(squares) / 16.0));
}
