// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 3 s at -O0, 0.7 s at -O1.
// Ranks that share the data learn what one learns, to the last bit, as sums over trajectories are added in
// the order of tree_sum.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "../support/ranks_as_threads.hpp"
#include "nysalt/detail/tree_sum.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/state_error.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double step = 0.6;
const pendulum swing;
const run_time_family two_stages{nystrom()};

const normal_around<1> starts({vector<double, 1>(0.5), vector<double, 1>(0.0)}, 0.5, 0.5);

data_options options_for(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return {.step = step, .horizon = 3.0, .trajectories = trajectories, .seed = seed, .ranks = &ranks};
}

flow_map_data make(std::int64_t trajectories, std::uint64_t seed, const communicator& ranks) {
  return make_flow_map_data(swing, starts, fine_steps(step / 64), options_for(trajectories, seed, ranks));
}

/// All numbers of a fit.
std::vector<double> numbers_of(const flow_map_data& data, const flow_map_data& held_out) {
  const fit_summary fit =
      learn(two_stages, swing, data, held_out, {.random_starts = 2, .planned_steps = 300}).summary;
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
  if (data.energies) all.insert(all.end(), {data.energies->low, data.energies->high});
  return all;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  const auto is_same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return std::ranges::equal(a, b, is_same);
}

std::vector<double> learned_from(std::int64_t trajectories, const communicator& ranks) {
  return numbers_of(make(trajectories, 1, ranks), make(trajectories, 2, ranks));
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_learned_does_not_depend_on_the_ranks) {
  for (const auto& [trajectories, size] : {std::pair(9, 11), std::pair(90, 3)}) {  // of 11 some have nothing
    const auto expected = learned_from(trajectories, one_rank);
    BOOST_TEST(!same_bits(learned_from(trajectories + 1, one_rank), expected));  // so the test can tell
    std::mutex guard;
    run_ranks(size, [&, count = trajectories](const thread_communicator& ours) {
      const auto found = learned_from(count, ours);
      const std::lock_guard lock(guard);
      BOOST_TEST(same_bits(found, expected));
    });
  }
}

BOOST_AUTO_TEST_CASE(data_that_grow_change_hands) {
  const auto grown = [](const communicator& ranks) {
    flow_map_data data;
    for (const std::int64_t trajectories : {30, 70, 110}) {
      extend_data(swing, starts, fine_steps(step / 64), options_for(trajectories, 1, ranks), data);
    }
    return numbers_of(data, make(40, 2, ranks));
  };
  const auto expected = grown(one_rank);
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
      const auto problem = make_learning_problem(two_stages, swing, data, data, {});
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
    const auto problem = make_learning_problem(two_stages, swing, data, data, {}, of_place);
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
      learn(two_stages, swing, data, data);
    } catch (const std::invalid_argument& thrown) {
      const std::lock_guard lock(guard);
      BOOST_TEST(thrown.what() == words);
      ++refused;
    }
  });
  BOOST_TEST(refused == 3);
}

namespace {

const fpu_chain<3> chain(50.0);
const Eigen::VectorXd theta = Eigen::Vector2d(0.45, 0.38);

flow_map_data data_of_chain(std::uint64_t seed) {
  return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps<>(1e-3),
                            {.step = 0.02, .horizon = 0.1, .trajectories = 203, .seed = seed});
}

/// Term after term: the order that is not ours.
template <class T>
T sum_in_order(const std::vector<T>& terms) {
  T sum = terms.front();
  for (std::size_t m = 1; m < terms.size(); ++m) sum += terms[m];
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_CASE(loss_and_gradient_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of_chain(1);
  const metric measure(chain, data, coordinates::qp);
  const after_steps<> loss(two_stages, chain, data, state_error(measure));
  int losses_differ = 0;
  int gradients_differ = 0;
  for (const double beta1 : {0.36, 0.37, 0.38, 0.39, 0.40}) {
    const Eigen::VectorXd at = Eigen::Vector2d(0.45, beta1);
    const auto losses = trajectory_losses(loss, at);
    const auto gradients = trajectory_gradients(loss, at);
    const Eigen::VectorXd gradient = squares_at(loss, at).gradient();
    BOOST_TEST(loss_value(loss, at) == tree_sum(losses));
    BOOST_TEST((gradient == tree_sum(gradients)));
    losses_differ += loss_value(loss, at) != sum_in_order(losses);
    gradients_differ += gradient != sum_in_order(gradients);
  }
  BOOST_TEST(losses_differ > 0);  // not always, but another order has other bits
  BOOST_TEST(gradients_differ > 0);
}

BOOST_AUTO_TEST_CASE(weights_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of_chain(1);
  const metric measure(chain, data, coordinates::qp);
  std::vector<Eigen::VectorXd> squares;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    squares.push_back(Eigen::VectorXd::Zero(12));
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      for (Eigen::Index i = 0; i < 6; ++i) {
        const double dq = data.finish[n].q[i] - data.start[n].q[i];
        const double dp = data.finish[n].p[i] - data.start[n].p[i];
        squares[m][i] += dq * dq / static_cast<double>(data.pairs());
        squares[m][6 + i] += dp * dp / static_cast<double>(data.pairs());
      }
    }
  }
  const auto weights_of = [](const Eigen::VectorXd& sigma) {
    Eigen::VectorXd weights = sigma;
    for (double& x : weights) x = 1.0 / std::sqrt(x);  // Eigen's own roots round differently
    return weights;
  };
  const vector<double, 6> ones = vector<double, 6>::Ones();
  const phase_point<double, 6> zero{vector<double, 6>::Zero(), vector<double, 6>::Zero()};
  Eigen::VectorXd weights(12);
  measure.residual(ones, ones, zero, weights.data());
  BOOST_TEST((weights == weights_of(tree_sum(squares))));
  BOOST_TEST((weights != weights_of(sum_in_order(squares))));
}

BOOST_AUTO_TEST_CASE(standard_errors_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of_chain(1);
  const metric measure(chain, data, coordinates::qp);
  const after_steps<> loss(two_stages, chain, data, state_error(measure));
  const curvature bend(hessian(loss, theta), {0, 1});
  const auto scores = trajectory_gradients(loss, theta);
  std::vector<Eigen::VectorXd> squares;
  for (const auto& score : scores) squares.push_back(bend.solve(score).cwiseAbs2());
  const auto errors_of = [](const Eigen::VectorXd& sum) {
    return Eigen::VectorXd((sum * (203.0 / 202.0)).cwiseSqrt());
  };
  BOOST_TEST((bend.standard_errors(scores) == errors_of(tree_sum(squares))));
  BOOST_TEST((bend.standard_errors(scores) != errors_of(sum_in_order(squares))));
}

BOOST_AUTO_TEST_CASE(the_error_of_the_reference_is_summed_over_trajectories_in_a_tree) {
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto data = data_of_chain(seed);
    const auto fit =
        learn(two_stages, chain, data, data,
              {.coordinates = coordinates::qp, .fixed = {theta[0], theta[1]}, .planned_steps = 200})
            .summary;
    const metric measure(chain, data, coordinates::qp);
    std::vector<double> squares(203, 0.0);
    std::vector<double> r(12);
    BOOST_TEST(data.finer.size() == 16U);
    for (const auto& [pair, finish] : data.finer) {
      measure.residual(finish.q, finish.p, data.finish[pair], r.data());
      for (const double x : r) squares[pair / 5] += x * x;  // five steps a trajectory
    }
    BOOST_TEST(fit.reference_error == std::sqrt(tree_sum(squares) / 16.0));
    differ += fit.reference_error != std::sqrt(sum_in_order(squares) / 16.0);
  }
  BOOST_TEST(differ > 0);
}
