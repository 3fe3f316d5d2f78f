// SPDX-License-Identifier: BSL-1.0
#include "systems.hpp"

#include <cmath>
#include <string>

#include "../src/comparison/json.hpp"
#include "../src/comparison/learning.hpp"
#include "../src/comparison/prepared_problem.hpp"
#include "../src/comparison/refusal.hpp"
#include "../src/comparison/seeds.hpp"
#include "../src/plugin/build.hpp"
#include "../src/program/systems.hpp"
#include "arguments.hpp"
#include "arrays.hpp"
#include "computing.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::refuse;

std::int64_t states_in(const held_system& system, const std::vector<std::int64_t>& shape, const char* name) {
  const std::int64_t n = system.model->dimension();
  if (shape == std::vector<std::int64_t>{n}) return 1;
  if (shape.size() == 2 && shape[0] >= 1 && shape[1] == n) return shape[0];
  refuse("{} must have the shape ({},) or (trajectories, {}), got {}", name, n, n, shape_text(shape));
}

namespace {

std::unique_ptr<held_system> bundled(const py::dict& arguments) {
  auto made = std::make_unique<held_system>();
  made->settings = system_of(argument_reader(arguments));
  // Every command takes the system as it is now, also where its file is edited or the current folder changes.
  without_lock([&] {
    made->settings.declared = &declaration_in(made->settings);
    made->settings.files = files_of(made->settings);
  });
  made->model = make_system(made->settings);
  return made;
}

std::unique_ptr<held_system> own(const py::dict& arguments) {
  const argument_reader asked(arguments);
  auto made = std::make_unique<held_system>();
  auto functions = std::make_shared<own_functions>(own_functions_of(asked, made->functions));
  const nysalt::detail::usual_rounding rounding;
  examine(*functions);
  rounding.require();
  made->functions->may_overflow = true;
  made->own = functions;
  made->settings = system_of(asked);
  made->settings.start = "law";
  made->settings.own = [functions](const program::surroundings& in) { return make_own(functions, in); };
  made->model = make_system(made->settings);
  return made;
}

std::string build(const py::dict& arguments) {
  const argument_reader asked(arguments);
  std::string source;
  std::string output;
  asked.take("source", source);
  asked.take("output", output);
  std::string made;
  without_lock([&] { made = program::build_library(source, output); });
  return made;
}

/// f(m) for each of the states in q, which must have the shape of p.
void for_states(const held_system& system, const numbers_array& q, const auto& f) {
  const std::int64_t count = states_in(system, shape_of(q), "q");
  const auto all = [&] {
    for (std::int64_t m = 0; m < count; ++m) f(m);
  };
  if (!system.calls_python()) return without_lock(all);
  const nysalt::detail::usual_rounding rounding;
  all();
  rounding.require();
}

py::object energy(const held_system& system, const py::object& of_q, const py::object& of_p) {
  const numbers_array q = numbers_of(of_q, "q");
  const numbers_array p = numbers_of(of_p, "p");
  const auto count = static_cast<std::size_t>(states_in(system, shape_of(q), "q"));
  if (shape_of(p) != shape_of(q)) {
    refuse("p must have the shape of q, {}, got {}", shape_text(shape_of(q)), shape_text(shape_of(p)));
  }
  py::array_t<double> result(static_cast<py::ssize_t>(count));
  double* to = result.mutable_data();
  const auto n = static_cast<std::size_t>(system.model->dimension());
  const auto all_q = numbers_in(q);
  const auto all_p = numbers_in(p);
  for_states(system, q, [&](std::int64_t m) {
    const auto first = static_cast<std::size_t>(m) * n;
    to[m] = system.model->energy(all_q.subspan(first, n), all_p.subspan(first, n));
  });
  if (q.ndim() == 1) return py::float_(result.at(0));
  return result;
}

py::array force(const held_system& system, const py::object& of_q) {
  const numbers_array q = numbers_of(of_q, "q");
  states_in(system, shape_of(q), "q");
  py::array_t<double> result(std::vector<py::ssize_t>(q.shape(), q.shape() + q.ndim()));
  const std::span<double> to(result.mutable_data(), static_cast<std::size_t>(result.size()));
  const auto n = static_cast<std::size_t>(system.model->dimension());
  const auto all = numbers_in(q);
  for_states(system, q, [&](std::int64_t m) {
    const auto first = static_cast<std::size_t>(m) * n;
    system.model->force(all.subspan(first, n), to.subspan(first, n));
  });
  return result;
}

program::role role_named(const std::string& name) {
  if (name == "training") return program::role::training;
  if (name == "held_out") return program::role::held_out;
  if (name == "test") return program::role::test;
  refuse("unknown role '{}': it is one of training, held_out, test", name);
}

/// q, p and warnings.
py::tuple starts(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  std::int64_t count = 1;
  asked.take("trajectories", count);
  if (count < 1) refuse("trajectories must be at least 1, got {}", count);
  std::string role = "test";
  asked.take("role", role);
  const auto common = common_of(asked, system.calls_python());
  const std::uint64_t seed = seed_for(role_named(role), common.seed);
  const std::int64_t n = system.model->dimension();
  py::array_t<double> q({count, n});
  py::array_t<double> p({count, n});
  const std::span<double> to_q(q.mutable_data(), static_cast<std::size_t>(q.size()));
  const std::span<double> to_p(p.mutable_data(), static_cast<std::size_t>(p.size()));
  std::vector<std::string> warnings;
  compute(system.calls_python(), [&] {
    const auto made = make_system(system.settings);
    program::progress shown;
    prepare_starts(*made, common, shown, warnings);
    for (std::int64_t m = 0; m < count; ++m) {
      const auto first = static_cast<std::size_t>(m * n);
      const auto width = static_cast<std::size_t>(n);
      made->start_state(seed, static_cast<std::uint64_t>(m), to_q.subspan(first, width),
                        to_p.subspan(first, width));
    }
  });
  return py::make_tuple(q, p, list_of(warnings));
}

py::dict facts(const held_system& system) {
  const program::prepared_problem& described_system = *system.model;
  py::list bands;
  for (const auto& band : described_system.frequency_bands())
    bands.append(py::make_tuple(band.low, band.high));
  py::list observables;
  for (const auto& name : described_system.observables()) observables.append(name);
  py::dict all;
  all["description"] = described_system.description();
  all["kind"] = described_system.kind();
  all["dimension"] = described_system.dimension();
  all["observables"] = observables;
  py::list letters;
  for (const auto& one : described_system.letters()) letters.append(std::string(1, one.letter));
  all["letters"] = letters;
  all["default_observable"] = described_system.default_observable();
  all["frequency_bands"] = bands;
  all["highest_frequency"] = described_system.frequency_of_law();
  all["starts"] = described_system.starts();
  all["parameters"] = described_system.parameters().dump();
  all["calls_python"] = system.calls_python();
  return all;
}

/// The functions of a system that a cycle of references may go through; null where there are none (yet).
functions_of_python* functions_of(PyObject* self) {
  const auto* held =
      reinterpret_cast<py::detail::instance*>(self)->get_value_and_holder().value_ptr<held_system>();
  return held == nullptr ? nullptr : held->functions.get();
}

void let_python_collect(PyHeapTypeObject* type) {
  type->ht_type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type->ht_type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (const auto* functions = functions_of(self)) {
      Py_VISIT(functions->potential.ptr());
      Py_VISIT(functions->force.ptr());
      Py_VISIT(functions->starts.ptr());
    }
    return 0;
  };
  type->ht_type.tp_clear = [](PyObject* self) {
    if (auto* functions = functions_of(self)) *functions = functions_of_python();
    return 0;
  };
}

}  // namespace

void add_systems(py::module_& module) {
  py::class_<held_system>(module, "held_system", py::custom_type_setup(&let_python_collect))
      .def("facts", &facts, rounded_as_usual())
      .def("energy", &energy, rounded_as_usual())
      .def("force", &force, rounded_as_usual())
      .def("starts", &starts, rounded_as_usual());
  module.def("bundled", &bundled, rounded_as_usual());
  module.def("build", &build, rounded_as_usual());
  module.def("own", &own, rounded_as_usual());
}

}  // namespace nysalt::python
