// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/require_valid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "nysalt/detail/collectively.hpp"
#include "nysalt/detail/sentence.hpp"

namespace nysalt {

namespace {

[[noreturn]] void refuse_size(const char* what, std::size_t n, Eigen::Index found, Eigen::Index wanted) {
  throw std::invalid_argument(sentence(
      "{} {} of the data must have the dimension of the system, got {} for {}", what, n, found, wanted));
}

void require_valid_here(const flow_map_data& data, const model& system) {
  const auto number_of = [&](std::size_t pair) { return data.first_pair() + pair; };
  const auto trajectory_of = [&](std::size_t pair) {
    return static_cast<std::size_t>(data.share().first()) + data.trajectory_of(pair);
  };
  if (data.system != describe(system)) {
    throw std::invalid_argument(sentence("learn: the data must be of the system, got data of {} for {}",
                                         data.system, describe(system)));
  }
  const bool covers = !data.first_of.empty() && data.first_of.front() == 0 &&
                      data.first_of.back() == data.pairs() &&
                      std::is_sorted(data.first_of.begin(), data.first_of.end());
  if (data.all_pairs() == 0 || data.finish.size() != data.pairs() || !covers) {
    throw std::invalid_argument(
        sentence("learn: the data must be whole, got {} starts, {} finishes, {} trajectories", data.pairs(),
                 data.finish.size(), data.trajectories()));
  }
  if (data.noise_parts < 0 ||
      data.noise.size() != data.pairs() * static_cast<std::size_t>(data.noise_parts)) {
    throw std::invalid_argument(
        sentence("learn: the data must be whole, got {} pairs with noise in {} parts that hold {}",
                 data.pairs(), data.noise_parts, data.noise.size()));
  }
  if (data.step == 0.0 || !std::isfinite(data.step)) {
    throw std::invalid_argument(
        sentence("learn: the step of the data must be positive and finite, got {}", data.step));
  }
  for (std::size_t n = 0; n < data.noise.size(); ++n) {
    const auto noise = data.noise[n];
    if (noise.size() != size(system)) refuse_size("noise", n, noise.size(), size(system));
    for (Eigen::Index i = 0; i < noise.size(); ++i) {
      if (std::isfinite(noise[i])) continue;
      const std::size_t pair = n / static_cast<std::size_t>(data.noise_parts);
      throw std::invalid_argument(sentence(
          "learn: the data must be finite, got coordinate {} of noise {} = {}, in pair {} of trajectory {}",
          i + 1, n, noise[i], number_of(pair), trajectory_of(pair)));
    }
  }
  const auto require_sound = [&](const char* what, std::size_t pair, const auto& x) {
    if (x.q.size() != size(system)) refuse_size(what, pair, x.q.size(), size(system));
    if (x.p.size() != size(system)) refuse_size(what, pair, x.p.size(), size(system));
    if (is_finite(x)) return;
    throw std::invalid_argument(sentence(
        "learn: the {} of pair {} of the data, in trajectory {}, must be finite: {}", what, number_of(pair),
        trajectory_of(pair), detail::not_finite_in(phase_point<double, Eigen::Dynamic>(x))));
  };
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    require_sound("start", n, data.start[n]);
    require_sound("finish", n, data.finish[n]);
  }
  for (const auto& [pair, finish] : data.finer) {
    if (pair >= data.pairs()) {
      throw std::invalid_argument(
          sentence("learn: the data must be whole, got a finer finish of pair {} of {}", pair, data.pairs()));
    }
    require_sound("finer finish", pair, finish);
  }
}

}  // namespace

void require_valid(const flow_map_data& data, const model& system) {
  collectively(data.share().ranks(), [&] { require_valid_here(data, system); });
}

}  // namespace nysalt
