// SPDX-License-Identifier: BSL-1.0
// Files that HDF5 lays out, and others may fill: numbers lie in them as in memory, one after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "comparison/json.hpp"

namespace nysalt::program {

/// Whether the program was built with HDF5.
bool has_hdf5();
/// Empty without HDF5.
std::string hdf5_version();

/// Numbers of eight bytes.
struct dataset {
  std::string name;
  std::vector<std::uint64_t> shape;
  bool is_of_integers = false;  // else double

  std::uint64_t count() const {
    return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies());
  }
};

/// Makes a file with these datasets, whose numbers are not written yet, and attributes: texts, numbers, lists
/// of doubles; anything else as JSON. Equal calls make equal bytes. Throws std::runtime_error if it cannot.
void make_hdf5(const std::filesystem::path& file, const std::vector<dataset>& datasets,
               const json& attributes);

/// Where the numbers of each dataset begin, in bytes. Throws std::runtime_error if the file has no such
/// datasets.
std::vector<std::uint64_t> places_in_hdf5(const std::filesystem::path& file,
                                          const std::vector<dataset>& datasets);

/// A text that is an attribute of a file. Throws std::runtime_error if it has none of that name.
std::string text_in_hdf5(const std::filesystem::path& file, const std::string& name);

/// The datasets of a file whose numbers lie in it in one piece, and where they begin, in bytes. Throws
/// std::runtime_error for what is no file of HDF5.
std::vector<std::pair<dataset, std::uint64_t>> datasets_in_hdf5(const std::filesystem::path& file);

}  // namespace nysalt::program
