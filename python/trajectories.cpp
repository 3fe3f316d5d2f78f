// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "../src/comparison/checks.hpp"
#include "../src/comparison/judging.hpp"
#include "../src/comparison/learning.hpp"
#include "../src/comparison/method_source.hpp"
#include "../src/comparison/sampled_run.hpp"
#include "../src/program/output/planned_run.hpp"
#include "arguments.hpp"
#include "arrays.hpp"
#include "commands.hpp"
#include "computing.hpp"
#include "systems.hpp"
#include "together.hpp"

namespace nysalt::python {

namespace py = pybind11;
using program::refuse;

namespace {

bool overlap(std::span<const double> a, std::span<const double> b) {
  return a.data() < b.data() + b.size() && b.data() < a.data() + a.size();
}
bool lies_across(std::span<const double> a, std::span<const double> b) {
  return overlap(a, b) && a.data() != b.data();
}

void require_finite(std::span<const double> all, std::int64_t dimension, const char* name) {
  for (std::int64_t i = 0; i < std::ssize(all); ++i) {
    const double one = all[static_cast<std::size_t>(i)];
    if (std::isfinite(one)) continue;
    refuse("the state of trajectory {} must be finite, got {}{} = {}", i / dimension, name, i % dimension + 1,
           one);
  }
}

/// States to begin at, of shape (dimension,) or (trajectories, dimension); without p at rest.
void take_states(const held_system& system, const py::object& from_q, const py::object& from_p,
                 program::system_settings& settings) {
  if (from_q.is_none()) {
    if (!from_p.is_none()) refuse("p must come with q; give the coordinates to begin at");
    return;
  }
  const numbers_array q = numbers_of(from_q, "q");
  const auto shape = shape_of(q);
  const std::int64_t count = states_in(system, shape, "q");
  const Eigen::Index size = system.model->dimension();
  std::optional<numbers_array> p;
  if (!from_p.is_none()) p = numbers_of(from_p, "p");
  if (p && shape_of(*p) != shape) {
    refuse("p must have the shape of q, {}, got {}", shape_text(shape), shape_text(shape_of(*p)));
  }
  require_finite(numbers_in(q), size, "q");
  if (p) require_finite(numbers_in(*p), size, "p");
  if (!settings.start.empty() || !settings.at.empty())
    refuse("q must come without start and at of the system; leave one of them away");
  settings.spread.reset();
  for (std::int64_t n = 0; n < count; ++n) {
    const auto row = [&](const numbers_array& all) -> Eigen::VectorXd {
      return Eigen::Map<const Eigen::VectorXd>(numbers_in(all).data() + n * size, size);
    };
    settings.states.push_back({row(q), p ? row(*p) : Eigen::VectorXd::Zero(size)});
  }
}

/// The samples of a run are written where NumPy has them: in a new array, or in the one that is given.
py::dict run(const held_system& system, const py::dict& arguments, const py::object& from_q,
             const py::object& from_p, const py::object& out) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  auto command = run_of(asked, system.settings);
  take_states(system, from_q, from_p, command.system);
  std::unique_ptr<program::planned_run> planned;
  compute(system.calls_python(), [&] { planned = std::make_unique<program::planned_run>(command, common); });
  const auto& observables = planned->command.observables;
  const auto plan = planned->plan;
  const std::int64_t every = command.sample_every;
  const std::int64_t samples = plan.steps / every + 1;
  const std::vector<std::int64_t> shape{plan.count, samples, std::ssize(observables)};

  const py::object values = out.is_none() ? py::object(py::array_t<double>(shape)) : out;
  const std::span<double> to = writable(values, "out", shape);
  py::array_t<double> t(samples);
  for (std::int64_t i = 0; i < samples; ++i) t.mutable_at(i) = static_cast<double>(i * every) * plan.step;
  py::array_t<std::int64_t> diverged(plan.count);
  std::int64_t* const lost = diverged.mutable_data();
  std::fill_n(lost, plan.count, -1);

  const auto began = std::chrono::steady_clock::now();
  std::vector<std::string> warnings;
  std::int64_t evaluations = 0;
  double energy_error = 0.0;
  compute(system.calls_python(), [&] {
    program::progress shown;
    auto& planned_system = *planned->system;
    warnings = planned->warnings;
    prepare_starts(planned_system, common, shown, warnings);
    for (const auto& text : planned->warnings_of_steps()) warnings.push_back(text);
    const program::sampled_plan sampled{.trajectories = plan,
                                        .observables = observables,
                                        .every = every,
                                        .segment = program::short_segment(planned_system.dimension())};
    const auto take = [&](std::int64_t m, const program::record& one) {
      const std::int64_t row = m * samples + one.first / every;
      std::ranges::copy(one.values, to.begin() + row * std::ssize(observables));
      if (one.diverged_at) lost[m] = *one.diverged_at;
    };
    std::ranges::fill(to, std::numeric_limits<double>::quiet_NaN());
    energy_error = program::run(planned_system, *planned->method, sampled, take, shown.counter(1000));
    if (auto text = planned->warning_of_energy(energy_error)) warnings.push_back(std::move(*text));
    evaluations = planned_system.count_evaluations(*planned->method, plan);
  });
  py::dict result;
  result["t"] = t;
  result["values"] = values;
  result["diverged"] = diverged;
  result["observables"] = list_of(observables);
  result["system"] = planned->system->description();
  result["starts"] = planned->system->starts();
  result["steps"] = plan.steps;
  result["evaluations"] = evaluations;
  result["energy_error"] = energy_error;
  result["judgement"] = program::as_json(planned->judged()).dump();
  result["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result["warnings"] = list_of(warnings);
  return result;
}

/// The arrays of a pair that is given, or new ones.
std::pair<py::object, py::object> pair_to_fill(const py::object& out,
                                               const std::vector<std::int64_t>& shape) {
  if (out.is_none()) return {py::array_t<double>(shape), py::array_t<double>(shape)};
  if (PySequence_Check(out.ptr()) == 0 || py::len(out) != 2) {
    refuse("out must be a pair (q, p) of arrays, got {}", shown(out));
  }
  return {out[py::int_(0)], out[py::int_(1)]};
}

/// From q and p into the pair `out`, which may be the same, or into new arrays. Returns these and warnings.
py::tuple integrate(const held_system& system, const py::dict& arguments, const py::object& from_q,
                    const py::object& from_p, const py::object& out) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto command = run_of(asked, system.settings);
  program::require_positive("step", command.step);
  std::int64_t steps = 0;
  asked.take("steps", steps);
  if (steps < 0) refuse("steps must not be negative, got {}", steps);
  const numbers_array q = numbers_of(from_q, "q");
  const numbers_array p = numbers_of(from_p, "p");
  const auto shape = shape_of(q);
  const std::int64_t count = states_in(system, shape, "q");
  if (shape_of(p) != shape) {
    refuse("p must have the shape of q, {}, got {}", shape_text(shape), shape_text(shape_of(p)));
  }
  require_finite(numbers_in(q), system.model->dimension(), "q");
  require_finite(numbers_in(p), system.model->dimension(), "p");
  const auto [to_q, to_p] = pair_to_fill(out, shape);
  const std::span<double> all_q = writable(to_q, "q of out", shape);
  const std::span<double> all_p = writable(to_p, "p of out", shape);
  if (overlap(all_q, all_p)) refuse("q and p of out must not share memory; give two arrays");
  if (overlap(all_q, numbers_in(p)) || overlap(all_p, numbers_in(q)) || lies_across(all_q, numbers_in(q)) ||
      lies_across(all_p, numbers_in(p))) {
    refuse("out must be q and p themselves or share no memory with them; give other arrays");
  }
  std::vector<std::string> warnings;
  compute(system.calls_python(), [&] {
    const nysalt::method method = system.seeing_frequencies([&] {
      const auto source = program::find_method(command.method, command.held, system.model->letters());
      return coefficients_at(source, *system.model, command.step, common.force,
                             program::placement_asked(command.placement), warnings);
    });
    // From here on nothing is refused.
    if (q.data() != all_q.data()) std::ranges::copy(numbers_in(q), all_q.begin());
    if (p.data() != all_p.data()) std::ranges::copy(numbers_in(p), all_p.begin());
    if (steps == 0) return;
    const program::trajectories_plan plan{
        command.step, steps, count, seed_for(program::role::test, common.seed), common.execution.threads};
    if (system.own && goes_together(*system.own, method)) {
      integrate_together(system.own, system.model->heat_bath(), method, plan, all_q, all_p);
      return;
    }
    program::progress shown;
    program::integrate(*system.model, method, plan, all_q, all_p, shown.counter(1000));
  });
  return py::make_tuple(to_q, to_p, list_of(warnings));
}

/// The judgement of a method at a step, as the text of a document, and warnings.
py::tuple judge(const held_system& system, const py::dict& arguments) {
  const argument_reader asked(arguments);
  const auto common = common_of(asked, system.calls_python());
  const auto command = run_of(asked, system.settings);
  program::require_positive("step", command.step);
  std::string document;
  std::vector<std::string> warnings;
  compute(system.calls_python(), [&] {
    program::progress shown;
    const auto made = make_system(system.settings);
    prepare_starts(*made, common, shown, warnings);
    const auto source = program::find_method(command.method, command.held, made->letters());
    const auto method = coefficients_at(source, *made, command.step, common.force,
                                        program::placement_asked(command.placement), warnings);
    document = program::as_json(made->judged(method, command.step, common.execution.threads)).dump();
  });
  return py::make_tuple(document, list_of(warnings));
}

}  // namespace

void add_trajectories(py::module_& module) {
  module.def("judge", &judge, rounded_as_usual());
  module.def("run", &run, rounded_as_usual());
  module.def("integrate", &integrate, rounded_as_usual());
}

}  // namespace nysalt::python
