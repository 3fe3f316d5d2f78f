// SPDX-License-Identifier: BSL-1.0
#include "refused.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "../src/comparison/progress.hpp"
#include "../src/comparison/refusal.hpp"
#include "../src/comparison/spelling.hpp"

namespace nysalt::python {

namespace {

constexpr program::spelling in_arguments{.prefix = "",
                                         .between_words = '_',
                                         .learning = "learn_",
                                         .renamed = [](std::string_view field) -> std::string_view {
                                           return field == "metrics" ? "metric" : field;
                                         },
                                         .equals = "=",
                                         .switched_on = "=True",
                                         .quote = "\"",
                                         .separator = ", ",
                                         .learn = "nysalt.learn(system, ",
                                         .learned = ")"};

}  // namespace

bool says_not_convertible(const pybind11::error_already_set& raised) {
  const std::array kinds{PyExc_TypeError, PyExc_ValueError, PyExc_OverflowError};
  return std::ranges::any_of(kinds, [&](PyObject* kind) { return raised.matches(kind); });
}

void raise_refusals() {
  spell(in_arguments);
  // Of this module only: other modules translate their own exceptions.
  pybind11::register_local_exception_translator([](std::exception_ptr thrown) {
    const auto raise = [](PyObject* kind, const std::exception& problem) {
      const std::string text = problem.what();
      PyObject* const shown = PyUnicode_DecodeUTF8(text.data(), std::ssize(text), "replace");
      PyErr_SetObject(kind, shown);
      Py_XDECREF(shown);
    };
    try {
      std::rethrow_exception(thrown);
    } catch (const pybind11::builtin_exception&) {  // pybind11 translates its other exceptions
      throw;
    } catch (const program::refusal& problem) {
      raise(PyExc_ValueError, problem);
    } catch (const std::invalid_argument& problem) {
      raise(PyExc_ValueError, problem);
    } catch (const program::ended_early& problem) {
      raise(PyExc_KeyboardInterrupt, problem);
    } catch (const std::runtime_error& problem) {
      raise(PyExc_RuntimeError, problem);
    }
  });
}

}  // namespace nysalt::python
