// SPDX-License-Identifier: BSL-1.0
// Samples of a run as arrays. Their shapes are known ahead: every number has its place in the file from the
// first moment, where it is put when it is known.
#pragma once

#include "hdf5_layout.hpp"
#include "sample_writer.hpp"

namespace nysalt::program {

/// Neighbours in the file are gathered, so that whole trajectories are written some megabytes at a time.
/// What is not taken stays NaN.
class sample_arrays final : public sample_writer {
 public:
  /// Whether the ending of its name says that a file is one of arrays: .h5, .hdf5 or .npy.
  static bool is_of(const std::filesystem::path& file);

  /// `about` becomes the attributes of an HDF5 file. Throws refusal where there is no HDF5, or such a file
  /// would be too large.
  sample_arrays(const std::filesystem::path& file, sampled_shape shape, json about);

  void take(std::int64_t trajectory, const record& segment) override;
  void flush() override;

  /// Makes the file as large as it will be: the head, the times, no trajectory diverged, and all values NaN.
  /// What is no time or value is written here alone.
  void lay_out(unfinished_file& file) override;
  bool go_on(unfinished_file& file, const file_sum& written) override;
  /// Its length, and the sum of all that is not in the arrays.
  std::optional<file_sum> sum_in(const std::filesystem::path& file) const override;
  first_trajectory read_first(const std::filesystem::path& file, std::int64_t every) const override;

 private:
  /// Numbers of eight bytes, one after the other in a file.
  struct array_place {
    std::uint64_t first;  // byte
    std::uint64_t count;
  };
  struct gathered {
    std::uint64_t at = 0;  // byte in the file
    std::vector<double> numbers = {};
    std::uint64_t end() const { return at + 8 * numbers.size(); }
  };

  /// There is one array of trajectories x samples for each observable, and t, step and diverged_at (HDF5), or
  /// one of trajectories x samples x observables (NumPy).
  std::vector<dataset> datasets() const;
  std::vector<array_place> places_in(const std::filesystem::path& file) const;
  std::string npy_head() const;
  template <class Number>
  void fill(const array_place& place, const Number& number);
  void write_into(unfinished_file& file);
  void hand_on(gathered& numbers);

  bool is_npy_;
  json about_;
  unfinished_file* file_ = nullptr;
  std::vector<array_place> places_;  // of the datasets
  std::vector<gathered> gathered_;   // of each array of values
};

}  // namespace nysalt::program
