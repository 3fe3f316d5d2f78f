// SPDX-License-Identifier: BSL-1.0
#include <pybind11/pybind11.h>

#include <array>
#include <exception>

#include "commands.hpp"
#include "exit_while_computing.hpp"
#include "refused.hpp"
#include "systems.hpp"

namespace nysalt::python {

namespace {

namespace py = pybind11;

/// The functions on which nysalt/__init__.py is built. Its arguments are those of the program, in a dict;
/// documents are JSON.
void add_all(py::module_& module) {
  leave_from_computations();
  raise_refusals();
  add_systems(module);
  add_commands(module);
  add_trajectories(module);
}

/// Run for each module object that is made, in any interpreter. The types of pybind11 are those of a process,
/// and made once: another object, of a module that is loaded again, has the contents of the first one.
int fill(PyObject* made) {
  static PyObject* first = nullptr;
  if (PyInterpreterState_Get() != PyInterpreterState_Main()) {
    PyErr_SetString(PyExc_ImportError,
                    "nysalt must be imported in the main interpreter, got a sub-interpreter; import nysalt "
                    "there, or in a process of its own");
    return -1;
  }
  if (first != nullptr) return PyDict_Update(PyModule_GetDict(made), PyModule_GetDict(first));
  try {
    py::detail::get_internals();
    auto module = py::reinterpret_borrow<py::module_>(made);
    add_all(module);
  } catch (py::error_already_set& problem) {
    problem.restore();
    return -1;
  } catch (const std::exception& problem) {
    PyErr_SetString(PyExc_ImportError, problem.what());
    return -1;
  }
  first = Py_NewRef(made);
  return 0;
}

}  // namespace

}  // namespace nysalt::python

/// Found by Python. In two phases (PEP 489), as only then each interpreter that imports the module runs
/// fill().
extern "C" PYBIND11_EXPORT PyObject* PyInit__nysalt() {
  PYBIND11_CHECK_PYTHON_VERSION
  static std::array<PyModuleDef_Slot, 2> slots{
      {{Py_mod_exec, reinterpret_cast<void*>(&nysalt::python::fill)}, {0, nullptr}}};
  static PyModuleDef definition{PyModuleDef_HEAD_INIT, "_nysalt", nullptr, 0,      nullptr,
                                slots.data(),          nullptr,   nullptr, nullptr};
  return PyModuleDef_Init(&definition);
}
