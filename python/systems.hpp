// SPDX-License-Identifier: BSL-1.0
// A system as Python holds it.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "../src/comparison/prepared_problem.hpp"
#include "own_functions_of.hpp"

namespace nysalt::python {

struct held_system {
  program::system_settings settings;  // of which each command makes its own
  // For what Python asks of the system without starts; the starts of the model are not prepared.
  std::unique_ptr<program::prepared_problem> model;
  std::shared_ptr<functions_of_python> functions;  // null of a bundled one
  std::shared_ptr<const own_functions> own;        // that call them; null of a bundled one
  std::unique_ptr<std::mutex> sees_frequencies = std::make_unique<std::mutex>();

  /// The result of work(), which may find the frequencies that the model keeps: of one thread at a time. A
  /// system of Python has the interpreter's lock, and must not wait for another.
  auto seeing_frequencies(const auto& work) const {
    if (calls_python()) return work();
    const std::lock_guard lock(*sees_frequencies);
    return work();
  }

  bool calls_python() const { return functions != nullptr; }
};

/// Number of states of the system in an array. Throws refusal unless its shape is (dimension,) or
/// (trajectories, dimension).
std::int64_t states_in(const held_system& system, const std::vector<std::int64_t>& shape, const char* name);

void add_systems(pybind11::module_& module);

}  // namespace nysalt::python
