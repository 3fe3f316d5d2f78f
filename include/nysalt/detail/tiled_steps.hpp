// SPDX-License-Identifier: BSL-1.0
// Steps of a single trajectory of a local system, tile by tile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/detail/site_window.hpp"
#include "nysalt/detail/step_program.hpp"

namespace nysalt::detail {

/// The letters of many steps of drifts and kicks in turn, in portions of bounded numbers of kicks.
class letters_in_portions {
 public:
  /// Refers to the program, whose `pairs` are not empty.
  letters_in_portions(const step_program<double>& program, std::int64_t steps)
      : program_(&program), steps_(steps) {}
  /// The next portion; an empty one after the last step. It is valid until the next call.
  std::span<const tile_letter> next(int kicks);

 private:
  const step_program<double>* program_;
  std::int64_t steps_;
  std::int64_t step_ = 0;
  std::size_t letter_ = 0;  // of that step
  std::vector<tile_letter> portion_;
};

/// Steps of a whole system by several threads.
class tiled_steps {
 public:
  /// For at most that number of kicks between two observations. Refers to the functions.
  tiled_steps(const site_kernels& system, int threads, std::int64_t kicks);
  /// `steps` steps of the program. Cost: that of the steps, and of moving the state to the cache and back
  /// once for some tens of kicks.
  void advance(double* q, double* p, double* f, const step_program<double>& program, std::int64_t steps);

 private:
  site_layout layout_;
  site_window window_;
  std::vector<double> left_halo_;
  std::vector<double> right_halo_;
};

}  // namespace nysalt::detail
