// SPDX-License-Identifier: BSL-1.0
#include "facts_of_data.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace nysalt::detail {

bool begin_alike(const flow_map_data& a, const flow_map_data& b) {
  const communicator& ranks = a.share().ranks();
  bool result = false;
  if (ranks.is_first()) {
    const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
    result = a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
  }
  broadcast(ranks, result);
  return result;
}

double error_of_reference(const flow_map_data& data, const metric& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    double& of_trajectory = squares[data.trajectory_of(pair)];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  const auto checks = data.share().ranks().sum(std::ssize(data.finer));
  const double difference = std::sqrt(data.share().sum(squares) / static_cast<double>(checks));
  return data.noise_parts > 0 ? error_over_difference * difference : difference;
}

int shortest_of(const flow_map_data& data) {
  std::size_t least = data.all_pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  const auto of_all = data.share().ranks().minimum(static_cast<std::int64_t>(least));
  return static_cast<int>(std::max<std::int64_t>(of_all, 1));
}

Eigen::VectorXd motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how) {
  const auto last = static_cast<std::size_t>(how.steps.back());
  const window_starts starts(data, last, static_cast<std::size_t>(how.apart));
  const double terms =
      static_cast<double>(data.share().ranks().sum(std::ssize(starts.pairs)) * std::ssize(how.steps));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(measure.residuals());
  std::vector<Eigen::VectorXd> squares(data.trajectories(), zero);
  Eigen::VectorXd r = zero;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = starts.first_of[m]; n < starts.first_of[m + 1]; ++n) {
      const std::size_t first = starts.pairs[n];
      for (const int steps : how.steps) {
        const auto& finish = data.finish[first + static_cast<std::size_t>(steps) - 1];
        measure.residual(finish.q, finish.p, data.start[first], r.data());
        squares[m] += r.cwiseAbs2() / terms;
      }
    }
  }
  return data.share().sum(squares, zero);
}

int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates) {
  constexpr std::int64_t enough = 1200;  // coordinates of all trajectories
  constexpr std::int64_t least = 16;
  const std::int64_t all = data.share().total();
  return static_cast<int>(
      std::clamp<std::int64_t>(all * coordinates / enough, 1, std::max<std::int64_t>(all / least, 1)));
}

}  // namespace nysalt::detail
