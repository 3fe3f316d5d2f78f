// SPDX-License-Identifier: BSL-1.0
// NumPy arrays as the numbers that they are, where they lie.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nysalt::python {

constexpr int aligned = pybind11::detail::npy_api::NPY_ARRAY_ALIGNED_;
using numbers_array =
    pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast | aligned>;

/// "(8, 101, 1)"
std::string shape_text(const std::vector<std::int64_t>& shape);
std::vector<std::int64_t> shape_of(const pybind11::array& array);

/// Of an array to be filled. Throws refusal, in one sentence, unless it is one of float64 of that shape, one
/// row after the other, that may be written.
std::span<double> writable(const pybind11::handle& array, const std::string& name,
                           const std::vector<std::int64_t>& shape);

/// The argument, an array, a list or a number, as an array: itself where it is an array of float64 already,
/// else a copy. Throws refusal unless it holds real numbers: complex ones, text, dates and objects are none.
numbers_array numbers_of(const pybind11::handle& given, const std::string& name);

/// To read.
std::span<const double> numbers_in(const numbers_array& array);

}  // namespace nysalt::python
