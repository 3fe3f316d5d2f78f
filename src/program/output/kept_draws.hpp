// SPDX-License-Identifier: BSL-1.0
// All draws of `sample`, and what is known of each scalar.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "nysalt/hmc.hpp"
#include "nysalt/shard.hpp"

namespace nysalt::program {

/// Of a chain draw after draw: scalar 0 is the potential, the others are the first coordinates.
class kept_draws {
 public:
  kept_draws(std::int64_t chains, std::int64_t draws, std::int64_t coordinates);

  /// From several threads, of several chains.
  void take(const hmc_draw& draw);
  /// After that all ranks have the draws of all chains.
  void gather(const communicator& ranks);

  /// The first `draws` of each chain, as numbers of a work file, and back.
  std::vector<double> first(std::int64_t draws) const;
  void restore(std::span<const double> numbers, std::int64_t draws);

  std::size_t scalars() const { return width_; }
  static std::string name(std::size_t scalar);
  std::vector<std::vector<double>> chains_of(std::size_t scalar) const;
  std::string csv() const;

 private:
  std::size_t chains_;
  std::size_t draws_;
  std::size_t width_;
  std::vector<double> numbers_;  // chain after chain
};

/// Statistics of a scalar.
struct summary_of_scalar {
  std::string name;
  double mean = 0.0;
  double deviation = 0.0;
  double effective = 0.0;  // independent draws that would give the mean the same error
  double reduction = 0.0;  // split-R-hat
  double standard_error() const { return deviation / std::sqrt(effective); }
};
summary_of_scalar summary_of(const kept_draws& draws, std::size_t scalar);

}  // namespace nysalt::program
