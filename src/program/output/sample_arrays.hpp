// SPDX-License-Identifier: BSL-1.0
// Samples of a run on their way to their places in a file of arrays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "array_layout.hpp"
#include "sample_sink.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Neighbours in the file are gathered, so that whole trajectories are written some megabytes at a time.
/// What is not taken stays NaN. Refers to the file.
class sample_arrays final : public sample_sink {
 public:
  sample_arrays(unfinished_file& file, const array_layout& layout);

  void take(std::int64_t trajectory, const record& segment) override;
  void flush() override;

 private:
  struct gathered {
    std::uint64_t at = 0;  // byte in the file
    std::vector<double> numbers = {};
    std::uint64_t end() const { return at + 8 * numbers.size(); }
  };
  void hand_on(gathered& numbers);

  unfinished_file* file_;
  sampled_shape shape_;
  array_places places_;
  std::vector<gathered> gathered_;  // of each array of values
};

/// From a finished file of arrays, of every so many of its samples.
first_trajectory read_first_trajectory(const std::filesystem::path& file, const array_layout& layout,
                                       std::int64_t every);

}  // namespace nysalt::program
