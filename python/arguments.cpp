// SPDX-License-Identifier: BSL-1.0
#include "arguments.hpp"
#include "../src/program/systems.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

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
using program::option_row;
using program::option_rows;
using program::refuse;
namespace trait = program::trait;

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

/// Of a dict, as name=value.
std::vector<std::string> named_numbers(const char* name, const py::object& value) {
  if (!py::hasattr(value, "keys")) refuse("{} must be a dict of numbers by name, got {}", name, shown(value));
  std::vector<std::string> all;
  for (const auto& [key, number] : py::dict(value)) {
    const std::string of = text_in("the name of an argument", key);
    all.push_back(fmt::format("{}={}", of, number_in(of.c_str(), number)));
  }
  return all;
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

void argument_reader::take(const program::option_rows& rows) const {
  for (const auto& row : rows) {
    const std::string name = program::spelled(row.field);
    if (!has(name.c_str())) continue;
    const std::string other = program::spelled(row.excludes);
    if (has(other.c_str())) refuse("{0} must come without {1}; leave {1} away", name, other);
    if (row.is(trait::by_name)) {
      *std::get<std::vector<std::string>*>(row.to) = named_numbers(name.c_str(), arguments_[name.c_str()]);
    } else {
      std::visit([&](auto* to) { take(name.c_str(), *to); }, row.to);
    }
  }
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

void argument_reader::take(const char* name, int& to) const {
  std::int64_t whole = to;
  take(name, whole);
  if (!std::in_range<int>(whole)) refuse("{} must be a number of {}, got {}", name, name, whole);
  to = static_cast<int>(whole);
}

void argument_reader::take(const char* name, std::uint64_t& to) const {
  auto whole = static_cast<std::int64_t>(to);
  take(name, whole);
  if (whole < 0) refuse("{} must not be negative, got {}", name, whole);
  to = static_cast<std::uint64_t>(whole);
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
  settings.execution.threads = program::usual_threads();
  arguments.take(common_rows(settings, program::run_command::forced));
  settings.json = true;
  require_sound(settings);
  if (calls_python) settings.execution.threads = 1;
  return settings;
}

namespace {

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
    arguments.take("formula", settings.potential.text);
    if (settings.potential.text.empty()) refuse("potential must be a text, got an empty one");
    arguments.take(formula_rows(settings.potential));
    settings.potential.parameters = named_numbers("parameters", arguments["parameters"]);
  } else if (arguments.has("parameters")) {
    take_parameters(arguments.inner("parameters"), settings);
  }
  arguments.take(start_rows(settings));
  return settings;
}

namespace {

template <class Command>
Command command_of(const argument_reader& arguments, const program::system_settings& system) {
  Command command;
  arguments.take(program::rows_of(command));
  command.system = system;
  return command;
}

}  // namespace

program::learn_command learn_of(const argument_reader& arguments, const program::system_settings& system) {
  return command_of<program::learn_command>(arguments, system);
}

program::run_command run_of(const argument_reader& arguments, const program::system_settings& system) {
  auto command = command_of<program::run_command>(arguments, system);
  arguments.take("held", command.held);
  return command;
}

program::compare_command compare_of(const argument_reader& arguments,
                                    const program::system_settings& system) {
  auto command = command_of<program::compare_command>(arguments, system);
  arguments.take("held", command.held);
  require_fitting(command, [&](const char* field) { return arguments.has(program::spelled(field).c_str()); });
  return command;
}

program::recommend_command recommend_of(const argument_reader& arguments,
                                        const program::system_settings& system) {
  return command_of<program::recommend_command>(arguments, system);
}

sampling_options sampling_of(const argument_reader& arguments, const program::system_settings& system) {
  sampling_options options{.starts_are_thermal = program::is_file_of_starts(system.start)};
  arguments.take(program::rows_of(options));
  return options;
}

namespace {

template <class T>
const char* type_of(const T&) {
  if (std::is_same_v<T, bool>) return "bool";
  if (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>) return "float";
  if (std::is_same_v<T, std::vector<double>>) return "Numbers";
  if (std::is_same_v<T, std::vector<std::string>>) return "Texts";
  return std::is_same_v<T, std::string> || std::is_same_v<T, std::optional<std::string>> ? "str" : "int";
}

template <class T>
py::object default_of(const T& value, const option_row& row) {
  if (row.is(trait::machine) || (value == T{} && !std::is_same_v<T, bool>)) return py::none();
  if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    if (value.size() == 1) return py::cast(value.front());
  }
  return py::cast(value);
}

py::list keywords_in(const option_rows& rows) {
  py::list all;
  for (const auto& row : rows) {
    if (row.is(trait::program_only)) continue;
    const std::string help = (row.is(trait::negated) ? "False: " : "") + row.help;
    const auto add = [&](auto* to) {
      all.append(py::make_tuple(program::spelled(row.field),
                                row.is(trait::by_name) ? "Mapping[str, float]" : type_of(*to),
                                default_of(*to, row), program::spelled_in(help)));
    };
    std::visit(add, row.to);
  }
  return all;
}

template <class Command>
py::list keywords_of(const char* forced) {
  Command command;
  program::common_settings common;
  return keywords_in(program::joined({program::rows_of(command), common_rows(common, forced)}));
}

}  // namespace

py::dict keywords() {
  program::system_settings system;
  program::export_command source;
  py::dict all;
  all["system"] = keywords_in(start_rows(system));
  all["potential"] = keywords_in(program::joined({formula_rows(system.potential), start_rows(system)}));
  all["learn"] = keywords_of<program::learn_command>("");
  all["run"] = keywords_of<program::run_command>(program::run_command::forced);
  all["compare"] = keywords_of<program::compare_command>(program::compare_command::forced);
  all["recommend"] = keywords_of<program::recommend_command>("");
  all["recommend_for_sampling"] = keywords_of<sampling_options>("");
  all["export"] = keywords_in(program::rows_of(source));
  return all;
}

}  // namespace nysalt::python
