// SPDX-License-Identifier: BSL-1.0
#include "commands.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "../src/comparison/exported_source.hpp"
#include "../src/comparison/inputs.hpp"
#include "../src/comparison/method_file.hpp"
#include "../src/comparison/recommendation.hpp"
#include "../src/comparison/sampling_choice.hpp"
#include "../src/program/fitted_family.hpp"
#include "../src/program/listing.hpp"
#include "../src/program/systems.hpp"
#include "../src/report/comparison_report.hpp"
#include "../src/report/write_file.hpp"
#include "arguments.hpp"
#include "build_info.hpp"
#include "computing.hpp"
#include "refused.hpp"
#include "systems.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::json;

namespace {

std::string dumped(const json& document) {
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

py::tuple learn(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto command = learn_of(asked, system.settings);
  std::string document;
  std::string file;
  compute(system.calls_python(), [&] {
    program::fitted_family fit(command, common);
    fit.learn();
    document = dumped(fit.document());
    file = program::text_of(fit.scheme());
  });
  return py::make_tuple(document, file);
}

std::string compare(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto command = compare_of(asked, system.settings);
  std::string document;
  compute(system.calls_python(), [&] {
    program::comparison all(program::make_system(command.system), command, common);
    program::work_file nowhere;
    all.learn_and_measure(nowhere);
    document = dumped(document_of(all));
  });
  return document;
}

/// The document of a choice, and the file and the name of the method to take, which is in `output` from the
/// moment on that it is the best so far; make() makes the choice.
py::tuple chosen(const held_system& system, const std::string& output, const auto& make) {
  std::string document;
  py::object file = py::none();
  std::optional<program::chosen_method> best;
  bool is_kept = false;
  compute(system.calls_python(), [&] {
    auto all = make();
    all->learn_and_rank([&](const program::chosen_method& so_far) {
      if (output.empty()) return;
      write_file(output, so_far.text);
      is_kept = true;
    });
    document = dumped(all->document());
    best = all->chosen();
    if (!output.empty() && best) write_file(output, best->text);
    if (is_kept && !best) std::filesystem::remove(output);
  });
  py::object name = py::none();
  if (best) {
    file = py::str(best->text);
    name = py::str(best->name);
  }
  return py::make_tuple(document, file, name);
}

std::string output_of(const argument_reader& asked) {
  std::string output;
  asked.take("output", output);
  return output;
}

py::tuple recommend(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto command = recommend_of(asked, system.settings);
  return chosen(system, output_of(asked), [&] {
    return std::make_unique<program::recommendation>(program::make_system(command.system), command, common);
  });
}

py::tuple recommend_for_sampling(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto options = sampling_of(asked, system.settings);
  return chosen(system, output_of(asked), [&] {
    return std::make_unique<program::sampling_choice>(program::make_system(system.settings), options, common);
  });
}

/// The contents of a file of a method, and whether it is one. Of a scheme at a step, or at that with which it
/// begins.
py::dict method(const std::string& text, const std::string& name, const py::object& step) {
  const auto file = program::method_file_in(text, name);
  double at = file.learned ? file.learned->curve.steps().front() : 0.0;
  py::dict arguments;
  arguments["step"] = step;
  argument_reader(arguments).take("step", at);
  const nysalt::method found = file.learned ? file.learned->at(at) : *file.table;
  py::list coefficients;
  for (const double c : found.coefficients()) coefficients.append(c);
  py::dict all;
  all["is_learned"] = file.learned.has_value();
  all["letters"] = found.letters().letters();
  all["coefficients"] = coefficients;
  all["order"] = found.order;
  all["symmetric"] = found.symmetric;
  all["evaluations_per_step"] = found.letters().evaluations_per_step;
  return all;
}

/// The text of `nysalt export`.
std::string export_method(const py::dict& arguments) {
  const argument_reader asked(arguments);
  program::export_command command;
  std::map<std::string, std::string> held;
  asked.take("method", command.method);
  asked.take("held", held);
  asked.take(program::rows_of(command));
  return program::export_text(
      command.host, command.template_file,
      program::exported_from(program::find_method(command.method, held), command.how));
}

void save(const std::string& path, const std::string& text) {
  try {
    write_file(path, text);
  } catch (const std::runtime_error& problem) {
    PyErr_SetString(PyExc_OSError, problem.what());
    throw py::error_already_set();
  }
}

}  // namespace

void add_commands(py::module_& module) {
  module.attr("version") = program::version;
  module.def("keywords", &keywords);
  module.def("learn", &learn, rounded_as_usual());
  module.def("compare", &compare, rounded_as_usual());
  module.def("recommend", &recommend, rounded_as_usual());
  module.def("recommend_for_sampling", &recommend_for_sampling, rounded_as_usual());
  module.def("listing", [] { return dumped(program::listing()); });
  module.def("method", &method, rounded_as_usual());
  module.def("require_readable", [](const std::string& file) { program::require_readable(file); });
  module.attr("longest_method_file") = program::longest_method_file;
  module.def("export", &export_method, rounded_as_usual());
  module.def("save", &save);
}

}  // namespace nysalt::python
