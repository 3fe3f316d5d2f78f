// SPDX-License-Identifier: BSL-1.0
// Reference flows by small steps of a method, for systems by their type and for models.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"

namespace nysalt::detail {

/// The number of steps in each of `parts` equal parts of the time t; nothing unless it is a positive integer,
/// to 1e-9 relative.
inline std::optional<std::int64_t> whole_steps(double t, double step, std::int64_t parts = 1) {
  const double ratio = t / step / static_cast<double>(parts);
  const double steps = std::round(ratio);
  if (!(steps >= 1.0) || !(steps < 1e18) || !(std::abs(ratio - steps) <= 1e-9 * steps)) return std::nullopt;
  return static_cast<std::int64_t>(steps);
}

/// A noise source that sums the noise it returns, over each part of a time.
template <class T, int N>
struct summing_noise {
  static constexpr bool is_memoryless = false;
  const finer_noise* path;
  const coarse_graining* coarse;
  vector<T, N>* const* sum;

  void normals(const noise_place& at, vector<T, N>& xi) const {
    path->normals(at, xi);
    if (*sum != nullptr) coarse->next(**sum, xi);
  }
};

/// Advances x on its path by the time t, in steps of a method whose noise was halved `halvings` times; see
/// fine_paths::advance(). Returns the number of steps.
template <HasBath S, Method M, Scalar T>
std::int64_t advance_on_path(const S& system, const M& method, double step, int halvings,
                             phase_point<T, S::dimension>& x, double t, const path_place& at,
                             std::span<vector<T, S::dimension>> xi) {
  const std::int64_t parts = std::max<std::int64_t>(std::ssize(xi), 1);
  const auto of_a_part = whole_steps(t, step, parts);
  if (!of_a_part) {
    throw std::invalid_argument(
        sentence("fine_paths: the time {} in the {} equal parts of the noise must be a multiple of "
                 "the fine step {}",
                 t, parts, step));
  }
  const std::int64_t steps = *of_a_part * parts;
  const double h = t / (static_cast<double>(*of_a_part) * static_cast<double>(parts));
  const double friction = system.bath().friction();
  const finer_noise path(at.seed, std::ldexp(friction * h, halvings), halvings);
  const coarse_graining coarse(friction * h);
  vector<T, S::dimension>* sum = nullptr;
  const auto fine = make_stepper(system, method, h, summing_noise<T, S::dimension>{&path, &coarse, &sum});
  auto run = fine.open(x, at.trajectory);
  run.step = at.step * steps;
  for (std::int64_t k = 0; k < parts; ++k) {
    sum = xi.empty() ? nullptr : &xi[static_cast<std::size_t>(k)];
    if (sum != nullptr) coarse.first(*sum);
    fine.advance(run, *of_a_part);
    if (sum != nullptr) coarse.last(*sum, *of_a_part);
  }
  x = fine.synchronous(run);
  return steps;
}

}  // namespace nysalt::detail
