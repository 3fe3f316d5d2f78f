// SPDX-License-Identifier: BSL-1.0
// Somebody else's module, whose exceptions are its own.
#include <pybind11/pybind11.h>

#include <stdexcept>

PYBIND11_MODULE(neighbour, module) {
  module.def("overflow", [] { throw std::overflow_error("--too-large was given"); });
  module.def("invalid", [] { throw std::invalid_argument("give --force"); });
}
