// SPDX-License-Identifier: BSL-1.0
#include "own_functions_of.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../src/comparison/refusal.hpp"
#include "arrays.hpp"
#include "computing.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::refuse;

namespace {

py::object function_in(const argument_reader& arguments, const char* name, const char* what) {
  if (!arguments.has(name)) refuse("a Hamiltonian must have {}, got none; give {}", what, name);
  py::object function = arguments[name];
  if (PyCallable_Check(function.ptr()) == 0) {
    refuse("{} must be a function, got {}", name, shown(function));
  }
  return function;
}

/// Throws what the function raises, and refusal where its system was collected.
py::object answer(const py::object& function, const py::tuple& arguments) {
  if (!function)
    refuse(
        "cannot call this Hamiltonian: it is gone, as it was in a cycle of references that nothing else "
        "held; keep a reference to it");
  return called(function, arguments);
}

/// A copy, which the function may keep.
py::array_t<double> column(std::span<const double> q) {
  return py::array_t<double>(static_cast<py::ssize_t>(q.size()), q.data());
}

/// (trajectories, dimension) states, which the function may keep.
py::array_t<double> rows(std::span<const double> q, std::int64_t count) {
  const auto each = static_cast<py::ssize_t>(q.size()) / count;
  return py::array_t<double>(std::vector<py::ssize_t>{static_cast<py::ssize_t>(count), each}, q.data());
}

void put(const py::handle& found, const std::string& what, const std::vector<std::int64_t>& wanted,
         std::span<double> to) {
  if (found.is_none()) refuse("{} must return numbers, got None; end it with a return", what);
  const numbers_array numbers = numbers_of(found, what);
  if (shape_of(numbers) != wanted) {
    refuse("{} must have the shape {}, got {}", what, shape_text(wanted), shape_text(shape_of(numbers)));
  }
  std::ranges::copy(numbers_in(numbers), to.begin());
}
void put(const py::handle& found, const std::string& what, std::span<double> to) {
  put(found, what, {static_cast<std::int64_t>(to.size())}, to);
}

double number_in(const py::object& found) {
  if (PyFloat_Check(found.ptr()) != 0) return PyFloat_AS_DOUBLE(found.ptr());
  if (found.is_none()) refuse("potential(q) must return a number, got None; end it with a return");
  const numbers_array numbers = numbers_of(found, "potential(q)");
  if (numbers.size() == 1) return numbers_in(numbers).front();
  refuse("potential(q) must be one number, got the shape {}", shape_text(shape_of(numbers)));
}

/// find(), which puts numbers into `to`; NaN where a function overflows, and may.
void put_or_nan(const functions_of_python& kept, std::span<double> to, const auto& find) {
  try {
    find();
  } catch (py::error_already_set& problem) {
    const bool overflows = problem.matches(PyExc_OverflowError) || problem.matches(PyExc_FloatingPointError);
    if (!kept.may_overflow || !overflows) throw;
    std::ranges::fill(to, std::numeric_limits<double>::quiet_NaN());
  }
}

std::string name_in(const argument_reader& arguments) {
  std::string name;
  arguments.take("name", name);
  if (name.empty()) refuse("a Hamiltonian must have a name, by which schemes know it, got none");
  if (arguments["name"].attr("isprintable")().cast<bool>()) return name;
  refuse("the name of a Hamiltonian must be one line that can be printed, got {}", shown(arguments["name"]));
}

std::int64_t dimension_in(const argument_reader& arguments) {
  constexpr std::int64_t most = 10'000'000;  // numbers: ten such arrays take a gigabyte
  std::int64_t dimension = 0;
  arguments.take("dimension", dimension);
  if (dimension < 1) refuse("dimension must be at least 1, got {}", dimension);
  if (dimension > most) {
    refuse("dimension must be at most {}, or states do not fit into memory, got {}", most, dimension);
  }
  return dimension;
}

std::vector<double> inverse_masses_in(const argument_reader& arguments, std::int64_t dimension) {
  std::vector<double> all{1.0};
  arguments.take("inverse_mass", all);
  if (all.size() == 1) all.resize(static_cast<std::size_t>(dimension), all.front());
  if (std::ssize(all) != dimension) {
    refuse("inverse_mass must be one number or {}, got {}", dimension, all.size());
  }
  for (const double one : all) {
    if (!(one > 0.0)) refuse("inverse_mass must be positive, got {}", one);
  }
  return all;
}

/// Functions of arrays (trajectories, dimension).
void take_many(own_functions& functions, const std::shared_ptr<functions_of_python>& kept) {
  functions.potentials = [kept](std::span<const double> q, std::int64_t count, std::span<double> v) {
    put_or_nan(*kept, v,
               [&] { put(answer(kept->potential, py::make_tuple(rows(q, count))), "potential(q)", v); });
    require_no_signal();
  };
  functions.forces = [kept](std::span<const double> q, std::int64_t count, std::span<double> f) {
    put_or_nan(*kept, f, [&] {
      put(answer(kept->force, py::make_tuple(rows(q, count))), "force(q)",
          {count, static_cast<std::int64_t>(f.size()) / count}, f);
    });
    require_no_signal();
  };
  functions.potential = [all = functions.potentials](std::span<const double> q) {
    double found = 0.0;
    all(q, 1, {&found, 1});
    return found;
  };
  functions.force = [all = functions.forces](std::span<const double> q, std::span<double> f) {
    all(q, 1, f);
  };
}

}  // namespace

own_functions own_functions_of(const argument_reader& arguments, std::shared_ptr<functions_of_python>& kept) {
  own_functions functions{};
  functions.name = name_in(arguments);
  arguments.take("kind", functions.kind);
  functions.dimension = dimension_in(arguments);
  functions.inverse_masses = inverse_masses_in(arguments, functions.dimension);
  arguments.take("frequency", functions.frequency);
  if (arguments.has("frequency") && !(functions.frequency > 0.0)) {
    refuse("frequency must be positive, got {}", functions.frequency);
  }
  kept = std::make_shared<functions_of_python>();
  kept->potential = function_in(arguments, "potential", "V");
  kept->force = function_in(arguments, "force", "-grad V");
  kept->starts = function_in(arguments, "starts", "starts of trajectories");
  bool is_batched = false;
  arguments.take("batched", is_batched);
  if (is_batched) {
    take_many(functions, kept);
  } else {
    functions.potential = [kept](std::span<const double> q) {
      double found = 0.0;
      put_or_nan(*kept, {&found, 1},
                 [&] { found = number_in(answer(kept->potential, py::make_tuple(column(q)))); });
      require_no_signal();
      return found;
    };
    functions.force = [kept](std::span<const double> q, std::span<double> f) {
      put_or_nan(*kept, f, [&] { put(answer(kept->force, py::make_tuple(column(q))), "force(q)", f); });
      require_no_signal();
    };
  }
  functions.start = [kept](std::uint64_t seed, std::uint64_t n, std::span<double> q, std::span<double> p) {
    const py::object found = answer(kept->starts, py::make_tuple(seed, n));
    if (PySequence_Check(found.ptr()) == 0 || py::len(found) != 2) {
      refuse("starts(seed, n) must be a pair (q, p), got {}", shown(found));
    }
    put(found[py::int_(0)], "q of starts(seed, n)", q);
    put(found[py::int_(1)], "p of starts(seed, n)", p);
  };
  return functions;
}

}  // namespace nysalt::python
