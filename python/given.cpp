// SPDX-License-Identifier: BSL-1.0
#include "given.hpp"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../src/program/checks.hpp"
#include "../src/program/comparison.hpp"
#include "../src/program/world.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::refuse;

std::string shown(const py::handle& value) {
  constexpr py::ssize_t most = 80;
  const py::str all(py::str(" ").attr("join")(py::repr(value).attr("split")()));
  if (py::len(all) <= most) return all.cast<std::string>();
  return py::str(all[py::slice(0, most, 1)]).cast<std::string>() + "...";
}

namespace {

bool is_truth(const py::handle& value) {
  const std::string type = Py_TYPE(value.ptr())->tp_name;
  return py::isinstance<py::bool_>(value) || type == "numpy.bool_" || type == "numpy.bool";
}

/// Of what Python would turn into one.
bool is_no_number(const py::handle& value) {
  const std::string type = Py_TYPE(value.ptr())->tp_name;
  return py::isinstance<py::str>(value) || is_truth(value) || type.starts_with("numpy.complex");
}

[[noreturn]] void refuse_kind(const char* name, const char* kind, const py::handle& value) {
  PyErr_Clear();
  refuse("{} must be {}, got {}", name, kind, shown(value));
}

double number_in(const char* name, const py::handle& value) {
  if (is_no_number(value)) refuse_kind(name, "a number", value);
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) refuse_kind(name, "a number", value);
  if (!std::isfinite(number)) refuse("{} must be finite, got {}", name, shown(value));
  return number;
}

std::string text_in(const char* name, const py::handle& value) {
  if (!py::isinstance<py::str>(value)) refuse_kind(name, "a text", value);
  py::ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (text == nullptr) refuse_kind(name, "a text of whole characters", value);
  return {text, static_cast<std::size_t>(size)};
}

/// Of one thing, or of each in a sequence.
template <class T>
std::vector<T> each(const py::object& value, const auto& thing) {
  const bool is_one =
      py::isinstance<py::str>(value) || PySequence_Check(value.ptr()) == 0 ||
      (py::isinstance<py::array>(value) && py::reinterpret_borrow<py::array>(value).ndim() == 0);
  if (is_one) return {thing(value)};
  std::vector<T> all;
  for (const auto& item : value) all.push_back(thing(item));
  return all;
}

void take_learning(const given& arguments, const std::string& prefix, program::learn_settings& how) {
  const auto named = [&](const char* name) { return prefix + name; };
  arguments.take(named("trajectories").c_str(), how.trajectories);
  arguments.take(named("horizon").c_str(), how.horizon);
  arguments.take(named("loss").c_str(), how.loss);
  arguments.take(named("random_starts").c_str(), how.random_starts);
  arguments.take("coordinates", how.coordinates);
  arguments.take("fine_step", how.fine_step);
  arguments.take("fix", how.fix);
}

}  // namespace

void given::take(const char* name, double& to) const {
  if (has(name)) to = number_in(name, arguments_[name]);
}

void given::take(const char* name, std::int64_t& to) const {
  if (!has(name)) return;
  const py::object value = arguments_[name];
  if (is_truth(value)) refuse_kind(name, "a whole number", value);
  const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!whole) refuse_kind(name, "a whole number", value);
  to = PyLong_AsLongLong(whole.ptr());
  if (PyErr_Occurred() != nullptr) refuse_kind(name, "a whole number that can be counted", value);
}

void given::take(const char* name, bool& to) const {
  if (!has(name)) return;
  const py::object value = arguments_[name];
  if (!is_truth(value)) refuse_kind(name, "True or False", value);
  to = value.cast<bool>();
}

void given::take(const char* name, std::string& to) const {
  if (has(name)) to = text_in(name, arguments_[name]);
}

void given::take(const char* name, std::vector<double>& to) const {
  if (has(name)) to = each<double>(arguments_[name], [&](const auto& one) { return number_in(name, one); });
}

void given::take(const char* name, std::vector<std::string>& to) const {
  if (has(name))
    to = each<std::string>(arguments_[name], [&](const auto& one) { return text_in(name, one); });
}

void given::take(const char* name, program::held_methods& to) const {
  if (!has(name)) return;
  for (const auto& [its_name, text] : py::dict(arguments_[name])) {
    to[text_in(name, its_name)] = text_in(name, text);
  }
}

program::common_settings common_of(const given& arguments, bool calls_python) {
  program::common_settings its;
  std::int64_t seed = static_cast<std::int64_t>(its.seed);
  arguments.take("seed", seed);
  if (seed < 0) refuse("seed must not be negative, got {}", seed);
  its.seed = static_cast<std::uint64_t>(seed);
  std::int64_t threads = program::usual_threads();
  arguments.take("threads", threads);
  if (!std::in_range<int>(threads)) refuse("threads must be a number of threads, got {}", threads);
  its.threads = static_cast<int>(threads);
  arguments.take("force", its.force);
  its.json = true;
  require_sound(its);
  if (calls_python) its.threads = 1;
  return its;
}

program::system_settings system_of(const given& arguments) {
  program::system_settings its;
  arguments.take("name", its.name);
  arguments.take("pairs", its.pairs);
  arguments.take("omega", its.omega);
  arguments.take("masses", its.masses);
  arguments.take("spring", its.spring);
  arguments.take("atoms", its.atoms);
  arguments.take("space", its.space);
  arguments.take("eccentricity", its.eccentricity);
  arguments.take("spread", its.spread);
  arguments.take("start", its.start);
  arguments.take("friction", its.bath.friction);
  arguments.take("sigma", its.bath.sigma);
  arguments.take("temperature", its.bath.temperature);
  return its;
}

program::learn_command learn_of(const given& arguments, const program::system_settings& system) {
  program::learn_command its;
  its.system = system;
  take_learning(arguments, "", its.learning);
  arguments.take("family", its.family);
  arguments.take("placement", its.placement);
  arguments.take("step", its.step);
  arguments.take("steps", its.steps);
  arguments.take("enough", its.enough);
  if (its.enough && arguments.has("trajectories")) {
    refuse("enough finds how many trajectories it takes: leave trajectories away");
  }
  return its;
}

program::run_command run_of(const given& arguments, const program::system_settings& system) {
  program::run_command its;
  its.system = system;
  arguments.take("method", its.method);
  arguments.take("held", its.held);
  arguments.take("placement", its.placement);
  arguments.take("step", its.step);
  arguments.take("horizon", its.horizon);
  arguments.take("trajectories", its.trajectories);
  arguments.take("observables", its.observables);
  arguments.take("sample_every", its.sample_every);
  return its;
}

program::compare_command compare_of(const given& arguments, const program::system_settings& system) {
  program::compare_command its;
  its.system = system;
  take_learning(arguments, "learn_", its.learning);
  arguments.take("methods", its.methods);
  arguments.take("held", its.held);
  arguments.take("placement", its.placement);
  arguments.take("steps", its.steps);
  arguments.take("equal_cost", its.equal_cost);
  arguments.take("horizon", its.horizon);
  arguments.take("trajectories", its.trajectories);
  arguments.take("metric", its.metrics);
  arguments.take("observable", its.observable);
  arguments.take("levels", its.levels);
  arguments.take("range", its.range);
  arguments.take("bins", its.bins);
  arguments.take("longest_lag", its.longest_lag);
  arguments.take("hmc_temperature", its.hmc_temperature);
  require_fitting(its, [&](const char* option) {
    std::string name = option + 2;
    std::ranges::replace(name, '-', '_');
    return arguments.has(name.c_str());
  });
  return its;
}

program::recommend_command recommend_of(const given& arguments, const program::system_settings& system) {
  program::recommend_command its;
  its.system = system;
  take_learning(arguments, "learn_", its.learning);
  arguments.take("families", its.families);
  arguments.take("placement", its.placement);
  arguments.take("budget", its.budget);
  arguments.take("budget_seconds", its.budget_seconds);
  arguments.take("error", its.error);
  arguments.take("horizon", its.horizon);
  arguments.take("trajectories", its.trajectories);
  arguments.take("metric", its.metric);
  arguments.take("observable", its.observable);
  arguments.take("hmc_temperature", its.hmc_temperature);
  arguments.take("reversible", its.reversible);
  return its;
}

}  // namespace nysalt::python
