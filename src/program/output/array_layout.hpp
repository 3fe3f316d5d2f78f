// SPDX-License-Identifier: BSL-1.0
// Samples of a run as arrays. Their shapes are known ahead: every number has its place in the file from the
// first moment, where it is put when it is known.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "hdf5_layout.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Of all trajectories of a run, at steps 0, every, 2 every, ...
struct sampled_shape {
  std::int64_t trajectories;
  std::int64_t samples;  // of each
  std::vector<std::string> observables;
  double step;
  std::int64_t every;

  std::uint64_t numbers() const {  // of one observable
    return static_cast<std::uint64_t>(trajectories) * static_cast<std::uint64_t>(samples);
  }
};

/// Numbers of eight bytes, one after the other in a file.
struct array_place {
  std::uint64_t first = 0;  // byte
  std::uint64_t count = 0;
  std::uint64_t end() const { return first + 8 * count; }
};

/// Where a file has them. Of values there is one array of trajectories x samples for each observable (HDF5),
/// or one of trajectories x samples x observables (NumPy), which has none of the others.
struct array_places {
  std::vector<array_place> values;
  array_place t;
  array_place step;
  array_place diverged_at;
};

class array_layout {
 public:
  /// Whether the ending of its name says that a file is one of arrays: .h5, .hdf5 or .npy.
  static bool is_of(const std::filesystem::path& file);

  /// `about` becomes the attributes of an HDF5 file. Throws refusal where there is no HDF5, or such a file
  /// would be too large.
  array_layout(const std::filesystem::path& file, sampled_shape shape, json about);

  const sampled_shape& shape() const { return shape_; }
  /// Makes the file as large as it will be: the head, the times, no trajectory diverged, and all values NaN.
  /// What is no time or value is written here alone. Throws refusal if there is no room for it.
  void lay_out(unfinished_file& file) const;
  /// In a file that was laid out so. Throws refusal if it is none.
  array_places places_in(const std::filesystem::path& file) const;
  /// Its length, and the sum of all that is not in the arrays; nothing if it was not laid out so.
  std::optional<file_sum> sum_of_head(const std::filesystem::path& file) const;

 private:
  std::vector<hdf5_dataset> datasets() const;
  std::string npy_head() const;
  std::uint64_t bytes() const;

  bool is_npy_;
  sampled_shape shape_;
  json about_;
};

}  // namespace nysalt::program
