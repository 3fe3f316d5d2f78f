// SPDX-License-Identifier: BSL-1.0
#include "refused.hpp"

#include <pybind11/pybind11.h>

#include <cctype>
#include <stdexcept>

#include "../src/comparison/progress.hpp"
#include "../src/comparison/refusal.hpp"

namespace nysalt::python {

std::string in_words_of_python(const std::string& text) {
  const std::size_t proposal = text.find("nysalt learn --");
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = text.compare(i, 2, "--") == 0 && i + 2 < text.size() &&
                        std::islower(static_cast<unsigned char>(text[i + 2])) != 0;
    if (!begins || i > proposal) {
      result += text[i];
      continue;
    }
    std::string name;
    for (i += 2; i < text.size(); ++i) {
      const bool goes_on = std::islower(static_cast<unsigned char>(text[i])) != 0 ||
                           (text[i] == '-' && i + 1 < text.size() &&
                            std::islower(static_cast<unsigned char>(text[i + 1])) != 0);
      if (!goes_on) break;
      name += text[i] == '-' ? '_' : text[i];
    }
    --i;
    result += name;
    if (name == "force" || name == "equal_cost" || name == "reversible") result += "=True";
  }
  return result;
}

void tell_refusals() {
  // Of this module alone: others' exceptions are told by others.
  pybind11::register_local_exception_translator([](std::exception_ptr thrown) {
    const auto tell = [](PyObject* kind, const std::exception& problem) {
      PyErr_SetString(kind, in_words_of_python(problem.what()).c_str());
    };
    try {
      std::rethrow_exception(thrown);
    } catch (const pybind11::builtin_exception&) {  // and others of pybind11 are told by it
      throw;
    } catch (const program::refusal& problem) {
      tell(PyExc_ValueError, problem);
    } catch (const std::invalid_argument& problem) {
      tell(PyExc_ValueError, problem);
    } catch (const program::ended_early& problem) {
      tell(PyExc_KeyboardInterrupt, problem);
    } catch (const std::runtime_error& problem) {
      tell(PyExc_RuntimeError, problem);
    }
  });
}

}  // namespace nysalt::python
