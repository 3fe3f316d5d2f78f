// SPDX-License-Identifier: BSL-1.0
#include "arrays.hpp"

#include "../src/comparison/refusal.hpp"
#include "refused.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::refuse;

std::string shape_text(const std::vector<std::int64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) text += fmt::format("{}{}", i > 0 ? ", " : "", shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::vector<std::int64_t> shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

std::span<double> writable(const py::handle& given, const std::string& name,
                           const std::vector<std::int64_t>& shape) {
  if (!py::isinstance<py::array>(given)) {
    refuse("{} must be a NumPy array of float64 to be filled, got {}", name, Py_TYPE(given.ptr())->tp_name);
  }
  auto array = py::reinterpret_borrow<py::array>(given);
  if (!py::isinstance<py::array_t<double>>(given)) {
    refuse("{} must hold float64 to be filled, got {}", name, py::str(array.dtype()).cast<std::string>());
  }
  if (shape_of(array) != shape) {
    refuse("{} must have the shape {}, got {}", name, shape_text(shape), shape_text(shape_of(array)));
  }
  if ((array.flags() & py::array::c_style) == 0) {
    refuse("{} must lie one row after the other to be filled; take a copy by np.ascontiguousarray", name);
  }
  if ((array.flags() & aligned) == 0) {
    refuse("{} must lie where a float64 may, at a multiple of its size", name);
  }
  if (!array.writeable()) refuse("{} must be writable to be filled, got a read-only array", name);
  return {static_cast<double*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

namespace {

std::string what_it_holds(const py::array& array) {
  switch (array.dtype().kind()) {
    case 'c':
      return "complex ones";
    case 'S':
    case 'U':
      return "text";
    case 'M':
    case 'm':
      return "dates or times";
    case 'O':
      return "objects";
    default:
      return py::str(array.dtype()).cast<std::string>();
  }
}

py::array array_of(const py::handle& given, const std::string& name) {
  try {
    return py::array(py::reinterpret_borrow<py::object>(given));
  } catch (const py::error_already_set& raised) {
    if (!says_not_convertible(raised)) throw;
    refuse("{} must hold real numbers, got {}", name, Py_TYPE(given.ptr())->tp_name);
  }
}

}  // namespace

numbers_array numbers_of(const py::handle& given, const std::string& name) {
  const auto array = array_of(given, name);
  const bool is_real = std::string("biuf").find(array.dtype().kind()) != std::string::npos;
  if (!is_real) refuse("{} must hold real numbers, got {}", name, what_it_holds(array));
  return numbers_array(array);
}

std::span<const double> numbers_in(const numbers_array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

}  // namespace nysalt::python
