// SPDX-License-Identifier: BSL-1.0
// Files of arrays that `run` wrote, to be read again.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "comparison/json.hpp"

namespace nysalt::program {

/// Whether the ending of its name says that a file is one of arrays: .h5, .hdf5 or .npy.
bool is_of_arrays(const std::filesystem::path& file);

/// The beginning of a file of NumPy of float64, of version 1.0: six bytes of magic, two of the version, two
/// of the length of what follows, a literal of Python, and blanks up to a multiple of 64 bytes in all.
std::string npy_head(const std::array<std::int64_t, 3>& shape);

/// The samples of a finished output. Numbers are read where they are asked for.
class written_arrays {
 public:
  /// Throws refusal, in the name of the option if there is one, for what is no such file, and for one of HDF5
  /// where there is no HDF5.
  written_arrays(const std::string& option, const std::string& file);

  const std::vector<std::string>& observables() const { return observables_; }
  std::int64_t trajectories() const { return trajectories_; }
  std::int64_t samples() const {
    return samples_;
  }  ///< of each trajectory, at steps 0, every(), 2 every(), ...
  std::int64_t every() const { return every_; }
  /// What the file says of itself: with members `method` and `description`.
  const json& about() const { return about_; }
  /// One number; NaN from where the trajectory diverged on. Throws refusal if the file is shorter.
  double number(std::int64_t trajectory, std::int64_t sample, std::size_t observable);

 private:
  void find_in_npy();
  void find_in_hdf5();
  [[noreturn]] void refuse_foreign() const;

  std::string where_;  // option and file
  std::filesystem::path file_;
  std::ifstream input_;
  json about_;
  std::vector<std::string> observables_;
  std::vector<std::uint64_t> first_;  // byte of the first number of each observable
  std::int64_t apart_ = 1;            // numbers from one sample to the next
  std::int64_t trajectories_ = 0;
  std::int64_t samples_ = 0;
  std::int64_t every_ = 1;
};

}  // namespace nysalt::program
