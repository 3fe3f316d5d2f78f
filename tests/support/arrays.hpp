// SPDX-License-Identifier: BSL-1.0
// Files of arrays as others read them: NumPy's by its own few rules, HDF5's by its library.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#if defined NYSALT_HAS_HDF5
#include <hdf5.h>
#endif

namespace nysalt::test {

struct array {
  std::vector<std::uint64_t> shape;
  std::vector<double> numbers;  // in C order
};

/// Of doubles, version 1.0.
inline array read_npy(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  if (text.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8)) throw std::runtime_error("no .npy");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[i]));
  };
  const std::size_t begin = 10 + byte(8) + 256 * byte(9);
  const std::string head = text.substr(10, begin - 10);
  if (begin % 64 != 0 || head.back() != '\n' || head.find("'descr': '<f8'") == std::string::npos ||
      head.find("'fortran_order': False") == std::string::npos) {
    throw std::runtime_error("another head");
  }
  array result;
  std::uint64_t count = 1;
  const char* rest = head.c_str() + head.find("'shape': (") + 10;
  for (char* end = nullptr; *rest != ')'; rest = end + std::strspn(end, ", ")) {
    result.shape.push_back(std::strtoull(rest, &end, 10));
    count *= result.shape.back();
  }
  result.numbers.resize(count);
  if (text.size() - begin != 8 * count) throw std::runtime_error("another length");
  std::memcpy(result.numbers.data(), text.data() + begin, 8 * count);
  return result;
}

#if defined NYSALT_HAS_HDF5
/// A dataset; whole numbers too, as doubles.
inline array read_hdf5(const std::filesystem::path& file, const std::string& name) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(opened, name.c_str(), H5P_DEFAULT);
  if (data < 0) throw std::runtime_error("no dataset " + name);
  const hid_t space = H5Dget_space(data);
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  array result{{shape.begin(), shape.end()},
               std::vector<double>(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)))};
  if (H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.numbers.data()) < 0) {
    throw std::runtime_error("cannot read " + name);
  }
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(opened);
  return result;
}

/// A text among the attributes.
inline std::string text_in_hdf5(const std::filesystem::path& file, const std::string& name) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(opened, name.c_str(), H5P_DEFAULT);
  if (attribute < 0) throw std::runtime_error("no attribute " + name);
  const hid_t type = H5Aget_type(attribute);
  char* text = nullptr;
  H5Aread(attribute, type, static_cast<void*>(&text));
  std::string result = text;
  H5free_memory(text);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(opened);
  return result;
}

/// Numbers among the attributes.
inline std::vector<double> numbers_in_hdf5(const std::filesystem::path& file, const std::string& name) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(opened, name.c_str(), H5P_DEFAULT);
  if (attribute < 0) throw std::runtime_error("no attribute " + name);
  const hid_t space = H5Aget_space(attribute);
  std::vector<double> result(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Aread(attribute, H5T_NATIVE_DOUBLE, result.data());
  H5Sclose(space);
  H5Aclose(attribute);
  H5Fclose(opened);
  return result;
}
#endif

}  // namespace nysalt::test
