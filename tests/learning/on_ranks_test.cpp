// SPDX-License-Identifier: BSL-1.0
// Ranks that share the data learn what one learns, to the last bit.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double step = 0.6;
const pendulum swing;

using data_type = flow_map_data;

const normal_around<1> starts({vector<double, 1>(0.5), vector<double, 1>(0.0)}, 0.5, 0.5);

data_options options_for(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return {.step = step, .horizon = 3.0, .trajectories = trajectories, .seed = seed, .ranks = &ranks};
}

data_type make(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return make_flow_map_data(swing, starts, fine_steps(step / 64), options_for(trajectories, seed, ranks));
}

/// All numbers of a fit.
std::vector<double> numbers_of(const learned<nystrom>& fitted) {
  const fit_summary& fit = fitted.summary;
  std::vector<double> all{fit.loss,
                          fit.held_out_loss,
                          fit.held_out_start_loss,
                          fit.held_out_noise,
                          fit.expected_excess,
                          fit.deciding_trajectories,
                          fit.condition,
                          fit.one_step_error,
                          fit.trajectory_error,
                          fit.reference_error,
                          static_cast<double>(fit.samples),
                          static_cast<double>(fit.trajectories),
                          static_cast<double>(fit.held_out_samples),
                          static_cast<double>(fit.learning_evaluations),
                          static_cast<double>(fit.iterations)};
  for (const auto& one : fit.parameters) all.insert(all.end(), {one.value, one.standard_error});
  const auto energies = fitted.method.energies();
  if (energies) all.insert(all.end(), {energies->low, energies->high});
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  const auto is_same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return std::ranges::equal(a, b, is_same);
}

std::vector<double> learned_from(std::int64_t trajectories, const communicator& ranks) {
  const auto data = make(trajectories, 1, ranks);
  const auto held_out = make(trajectories, 2, ranks);
  return numbers_of(learn(nystrom{}, swing, data, held_out));
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_learned_does_not_depend_on_the_ranks) {
  for (const std::int64_t trajectories : {20, 150}) {
    const auto expected = learned_from(trajectories, one_rank);
    BOOST_TEST(!same_bits(learned_from(trajectories + 1, one_rank), expected));  // so the test can tell
    for (const int size : {2, 3, 11}) {                                          // some have nothing
      std::mutex guard;
      run_ranks(size, [&](const thread_communicator& ours) {
        const auto found = learned_from(trajectories, ours);
        const std::lock_guard lock(guard);
        BOOST_TEST(same_bits(found, expected));
      });
    }
  }
}

BOOST_AUTO_TEST_CASE(data_that_grow_change_hands) {
  const auto grown = [](const communicator& ranks) {
    data_type data;
    for (const std::int64_t trajectories : {30, 70, 200}) {
      extend_data(swing, starts, fine_steps(step / 64), options_for(trajectories, 1, ranks), data);
    }
    return numbers_of(learn(nystrom{}, swing, data, make(100, 2, ranks)));
  };
  const auto expected = grown(one_rank);
  for (const int size : {2, 5}) {
    std::mutex guard;
    run_ranks(size, [&](const thread_communicator& ours) {
      const auto found = grown(ours);
      const std::lock_guard lock(guard);
      BOOST_TEST(same_bits(found, expected));
    });
  }
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
      const auto problem = make_learning_problem(run_time_family(nystrom{}), swing, data, data, {});
      const traffic before = ours.seen();
      problem.loss(problem.family.starts.front().theta);
      const std::lock_guard lock(guard);
      most.received = std::max(most.received, ours.seen().received - before.received);
      most.sent = std::max(most.sent, ours.seen().sent - before.sent);
      most.together = std::max(most.together, ours.seen().together - before.together);
      most.bytes = std::max(most.bytes, ours.seen().bytes - before.bytes);
    });
    return most;
  };
  constexpr std::int64_t of_column = 8 * (1 + 2 + 3);  // r^T r, J^T r and half of J^T J for two parameters
  for (const int size : {2, 4, 8}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(size))) - 1;
    for (const std::int64_t trajectories : {16 * 8, 16 * 64}) {
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
  std::mutex guard;
  int refused = 0;
  run_ranks(3, [&](const thread_communicator& ours) {
    const auto data = make(96, 1, ours);
    const auto error = [&]<class T>(const phase_point<T, 1>& start, const phase_point<T, 1>& finish,
                                    const phase_point<T, 1>& wanted) -> T {
      const auto q = start.q[0].value;
      for (int k = 0; k < lanes_in<decltype(T::value)>; ++k) {
        if (lane(q, k) == place) throw std::invalid_argument(words);
      }
      return finish.q[0] - wanted.q[0];
    };
    const own_loss of_place{"place", 1, error};
    const auto problem = make_learning_problem(run_time_family(nystrom{}), swing, data, data, {}, of_place);
    try {
      problem.loss(problem.family.starts.front().theta);
    } catch (const std::invalid_argument& thrown) {
      const std::lock_guard lock(guard);
      BOOST_TEST(thrown.what() == words);
      ++refused;
    }
  });
  BOOST_TEST(refused == 3);
}

BOOST_AUTO_TEST_CASE(bad_data_on_one_rank_are_refused_on_all) {
  const std::string words =
      "learn: the finish of pair 352 of the data, in trajectory 70, must be finite: p1 is nan";
  std::mutex guard;
  int refused = 0;
  run_ranks(3, [&](const thread_communicator& ours) {
    auto data = make(96, 1, ours);
    const std::size_t bad = 352;
    if (data.first_pair() <= bad && bad < data.first_pair() + data.pairs()) {
      data.finish[bad - data.first_pair()].p[0] = std::nan("");
    }
    try {
      learn(nystrom{}, swing, data, data);
    } catch (const std::invalid_argument& thrown) {
      const std::lock_guard lock(guard);
      BOOST_TEST(thrown.what() == words);
      ++refused;
    }
  });
  BOOST_TEST(refused == 3);
}
