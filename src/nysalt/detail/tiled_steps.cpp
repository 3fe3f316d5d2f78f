// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/tiled_steps.hpp"

#include <algorithm>

namespace nysalt::detail {

std::span<const tile_letter> letters_in_portions::next(int kicks) {
  portion_.clear();
  const std::size_t letters = 2 * program_->pairs.size();
  int taken = 0;
  for (; step_ < steps_; ++step_, letter_ = 0) {
    for (; letter_ < letters; ++letter_) {
      const bool is_kick = program_->begins_with_kick == (letter_ % 2 == 0);
      if (is_kick && taken == kicks) return portion_;
      if (is_kick) ++taken;
      const bool is_last = step_ + 1 == steps_ && letter_ + 1 == letters;
      portion_.push_back({.coefficient = program_->pairs[letter_ / 2][letter_ % 2],
                          .is_kick = is_kick,
                          .keeps_force = is_last && program_->keeps_last_force});
    }
  }
  return portion_;
}

tiled_steps::tiled_steps(const site_kernels& system, int threads, std::int64_t kicks)
    : layout_(system.layout()), window_(system, 0, layout_.sites, threads, kicks) {}

void tiled_steps::advance(double* q, double* p, double* f, const step_program<double>& program,
                          std::int64_t steps) {
  letters_in_portions letters(program, steps);
  const int most = window_.kicks_of_sweep();
  for (auto portion = letters.next(most); !portion.empty(); portion = letters.next(most)) {
    if (layout_.is_periodic) {  // the last sites are to the left of the first, and the first to the right
      const auto kicks = static_cast<int>(std::ranges::count_if(portion, &tile_letter::is_kick));
      left_halo_.resize(window_.halo_size(kicks));
      right_halo_.resize(window_.halo_size(kicks));
      window_.copy_edge(side::right, kicks, q, p, left_halo_);
      window_.copy_edge(side::left, kicks, q, p, right_halo_);
    }
    window_.sweep(portion, q, p, f, left_halo_, right_halo_);
  }
}

}  // namespace nysalt::detail
