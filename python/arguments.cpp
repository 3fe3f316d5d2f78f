// SPDX-License-Identifier: BSL-1.0
#include "arguments.hpp"
#include "../src/program/systems.hpp"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../src/comparison/checks.hpp"
#include "../src/comparison/comparison.hpp"
#include "../src/program/bundled_systems.hpp"
#include "../src/program/mpi_session.hpp"
#include "refused.hpp"

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

/// Throws what the value raised instead of being converted, unless that says that it cannot be.
[[noreturn]] void refuse_kind(const char* name, const char* kind, const py::handle& value) {
  if (PyErr_Occurred() != nullptr) {
    const py::error_already_set raised;
    if (!says_not_convertible(raised)) throw raised;
  }
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

void take_learning(const argument_reader& arguments, const std::string& prefix, learning_options& how) {
  const auto named = [&](const char* name) { return prefix + name; };
  arguments.take("purpose", how.purpose);
  arguments.take(named("trajectories").c_str(), how.trajectories);
  arguments.take(named("horizon").c_str(), how.horizon);
  arguments.take(named("loss").c_str(), how.loss);
  arguments.take(named("effort").c_str(), how.effort);
  arguments.take(named("random_starts").c_str(), how.random_starts);
  arguments.take("coordinates", how.coordinates);
  arguments.take("fine_step", how.fine_step);
  arguments.take("fix", how.fix);
}

}  // namespace

py::list list_of(const std::vector<std::string>& texts) {
  py::list all;
  for (const auto& text : texts) all.append(text);
  return all;
}

std::vector<std::string> argument_reader::names() const {
  std::vector<std::string> all;
  for (const auto& [name, value] : arguments_) {
    if (!value.is_none()) all.push_back(text_in("the name of an argument", name));
  }
  return all;
}

void argument_reader::take(const char* name, double& to) const {
  if (has(name)) to = number_in(name, arguments_[name]);
}

void argument_reader::take(const char* name, std::int64_t& to) const {
  if (!has(name)) return;
  const py::object value = arguments_[name];
  if (is_truth(value)) refuse_kind(name, "a whole number", value);
  const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!whole) refuse_kind(name, "a whole number", value);
  to = PyLong_AsLongLong(whole.ptr());
  if (PyErr_Occurred() != nullptr) refuse_kind(name, "a whole number that can be counted", value);
}

void argument_reader::take(const char* name, bool& to) const {
  if (!has(name)) return;
  const py::object value = arguments_[name];
  if (!is_truth(value)) refuse_kind(name, "True or False", value);
  to = value.cast<bool>();
}

void argument_reader::take(const char* name, std::string& to) const {
  if (has(name)) to = text_in(name, arguments_[name]);
}

void argument_reader::take(const char* name, std::vector<double>& to) const {
  if (has(name)) to = each<double>(arguments_[name], [&](const auto& one) { return number_in(name, one); });
}

void argument_reader::take(const char* name, std::vector<std::string>& to) const {
  if (has(name))
    to = each<std::string>(arguments_[name], [&](const auto& one) { return text_in(name, one); });
}

void argument_reader::take(const char* name, std::map<std::string, std::string>& to) const {
  if (!has(name)) return;
  for (const auto& [method_name, text] : py::dict(arguments_[name])) {
    to[text_in(name, method_name)] = text_in(name, text);
  }
}

program::common_settings common_of(const argument_reader& arguments, bool calls_python) {
  program::common_settings settings;
  std::int64_t seed = static_cast<std::int64_t>(settings.seed);
  arguments.take("seed", seed);
  if (seed < 0) refuse("seed must not be negative, got {}", seed);
  settings.seed = static_cast<std::uint64_t>(seed);
  std::int64_t threads = program::usual_threads();
  arguments.take("threads", threads);
  if (!std::in_range<int>(threads)) refuse("threads must be a number of threads, got {}", threads);
  settings.execution.threads = static_cast<int>(threads);
  arguments.take("force", settings.force);
  settings.json = true;
  require_sound(settings);
  if (calls_python) settings.execution.threads = 1;
  return settings;
}

namespace {

/// Numbers by name, as name=value.
std::vector<std::string> named_numbers(const argument_reader& arguments) {
  std::vector<std::string> all;
  for (const auto& name : arguments.names()) {
    double value = 0.0;
    arguments.take(name.c_str(), value);
    all.push_back(fmt::format("{}={}", name, value));
  }
  return all;
}

void take_potential(const argument_reader& arguments, program::typed_potential& potential) {
  arguments.take("formula", potential.text);
  if (potential.text.empty()) refuse("potential must be a text, got an empty one");
  arguments.take("variables", potential.variables);
  arguments.take("mass", potential.masses);
  if (arguments.has("around")) potential.around = named_numbers(arguments.inner("around"));
  potential.parameters = named_numbers(arguments.inner("parameters"));
}

/// Those that the system declares, as numbers of its kinds or texts; another is refused with the system's own
/// list.
void take_parameters(const argument_reader& arguments, program::system_settings& settings) {
  for (const auto& name : arguments.names()) settings.parameters[name] = "";
  for (const auto& parameter : program::declaration_of(settings.name).parameters) {
    const char* name = parameter.name.c_str();
    if (!arguments.has(name)) {
      settings.parameters.erase(parameter.name);
      continue;
    }
    const auto take = [&](auto value) {
      arguments.take(name, value);
      settings.parameters[parameter.name] = fmt::format("{}", value);
    };
    if (parameter.is_text()) {
      take(std::string());
    } else if (parameter.is_whole()) {
      take(std::int64_t{});
    } else {
      take(double{});
    }
  }
}

}  // namespace

program::system_settings system_of(const argument_reader& arguments) {
  program::system_settings settings;
  arguments.take("name", settings.name);
  if (arguments.has("formula")) {
    take_potential(arguments, settings.potential);
  } else if (arguments.has("parameters")) {
    take_parameters(arguments.inner("parameters"), settings);
  }
  arguments.take("spread", settings.spread);
  arguments.take("frequency", settings.frequency);
  arguments.take("start", settings.start);
  arguments.take("at", settings.at);
  arguments.take("friction", settings.bath.friction);
  arguments.take("sigma", settings.bath.sigma);
  arguments.take("temperature", settings.bath.temperature);
  return settings;
}

program::learn_command learn_of(const argument_reader& arguments, const program::system_settings& system) {
  program::learn_command command;
  command.system = system;
  take_learning(arguments, "", command.learning);
  arguments.take("family", command.family);
  arguments.take("placement", command.placement);
  arguments.take("step", command.step);
  arguments.take("steps", command.steps);
  arguments.take("enough", command.enough);
  if (command.enough && arguments.has("trajectories")) {
    refuse("enough must come without trajectories, as it finds how many it takes; leave trajectories away");
  }
  return command;
}

program::run_command run_of(const argument_reader& arguments, const program::system_settings& system) {
  program::run_command command;
  command.system = system;
  arguments.take("method", command.method);
  arguments.take("held", command.held);
  arguments.take("placement", command.placement);
  arguments.take("step", command.step);
  arguments.take("horizon", command.horizon);
  arguments.take("trajectories", command.trajectories);
  arguments.take("observables", command.observables);
  arguments.take("sample_every", command.sample_every);
  arguments.take("checks", command.checks);
  return command;
}

program::compare_command compare_of(const argument_reader& arguments,
                                    const program::system_settings& system) {
  program::compare_command command;
  command.system = system;
  take_learning(arguments, "learn_", command.learning);
  arguments.take("methods", command.methods);
  arguments.take("held", command.held);
  arguments.take("placement", command.placement);
  arguments.take("steps", command.steps);
  arguments.take("equal_cost", command.equal_cost);
  arguments.take("prices", command.prices);
  arguments.take("horizon", command.horizon);
  arguments.take("trajectories", command.trajectories);
  arguments.take("metric", command.metrics);
  arguments.take("observable", command.observable);
  arguments.take("levels", command.levels);
  arguments.take("range", command.range);
  arguments.take("bins", command.bins);
  arguments.take("longest_lag", command.longest_lag);
  arguments.take("hmc_temperature", command.hmc_temperature);
  require_fitting(command, [&](const char* field) { return arguments.has(program::spelled(field).c_str()); });
  return command;
}

program::recommend_command recommend_of(const argument_reader& arguments,
                                        const program::system_settings& system) {
  program::recommend_command command;
  command.system = system;
  take_learning(arguments, "learn_", command.learning);
  arguments.take("families", command.families);
  arguments.take("placement", command.placement);
  arguments.take("budget", command.budget);
  arguments.take("budget_seconds", command.budget_seconds);
  arguments.take("error", command.error);
  arguments.take("horizon", command.horizon);
  arguments.take("trajectories", command.trajectories);
  arguments.take("metric", command.metric);
  arguments.take("observable", command.observable);
  arguments.take("hmc_temperature", command.hmc_temperature);
  arguments.take("looks", command.looks);
  arguments.take("reversible", command.reversible);
  return command;
}

sampling_options sampling_of(const argument_reader& arguments, const program::system_settings& system) {
  sampling_options options{.starts_are_thermal = program::is_file_of_starts(system.start)};
  take_learning(arguments, "learn_", options.learning);
  arguments.take("families", options.families);
  arguments.take("length", options.length);
  arguments.take("acceptance", options.acceptance);
  arguments.take("hmc_temperature", options.temperature);
  arguments.take("times_larger", options.times_larger);
  arguments.take("trajectories", options.trajectories);
  return options;
}

}  // namespace nysalt::python
