// SPDX-License-Identifier: BSL-1.0

#include "nysalt/export_to.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <vector>

#include "exports.hpp"
#include "fill.hpp"
#include "nysalt/version.hpp"

namespace nysalt {

namespace detail {

namespace {

struct host_with_text {
  export_host host;
  std::string (*text)(const exported_method&);
};

const std::vector<host_with_text>& all_hosts() {
  static const std::vector<host_with_text> all{
      {{"c", "C99: start, steps and finish over arrays, with a force of your own", ".c"}, export_to_c},
      {{"cpp", "C++11, a header: the same with any callable force", ".hpp"}, export_to_cpp},
      {{"fortran", "Fortran 2008, a module: the same with a force procedure", ".f90"}, export_to_fortran},
      {{"python", "Python with NumPy: the same over arrays of any shape", ".py"}, export_to_python},
      {{"julia", "Julia, a module: the same with any callable force", ".jl"}, export_to_julia},
      {{"jax", "JAX: a step as a pure function, as in jax-md", ".py"}, export_to_jax},
      {{"odeint", "Boost.Odeint: a stepper of drifts and kicks", ".hpp"}, export_to_odeint},
      {{"sundials", "SUNDIALS ARKODE: the table of SPRKStep, a function in C", ".c"}, export_to_sundials},
      {{"ordinarydiffeq", "OrdinaryDiffEq, Julia: a tableau of OrdinaryDiffEqSymplecticRK", ".jl"},
       export_to_ordinarydiffeq},
      {{"ase", "ASE: a dynamics of any calculator, also in a bath", ".py"}, export_to_ase},
      {{"openmm", "OpenMM: a CustomIntegrator, also in a bath, with constraints", ".py"}, export_to_openmm},
      {{"lammps", "LAMMPS: a fix for a plug-in, also in a bath; a word that ends with a kick", ".cpp"},
       export_to_lammps},
      {{"rebound", "REBOUND 5: an integrator in C", ".c"}, export_to_rebound},
      {{"blackjax", "BlackJAX: the coefficients of a palindrome that begins with a kick", ".py"},
       export_to_blackjax},
      {{"mici", "Mici: the free coefficients of a symmetric composition", ".py"}, export_to_mici},
      {{"gpt", "GPT, lattice fields: a scheme of a symmetric word", ".py"}, export_to_gpt},
      {{"grid", "Grid, lattice fields: an integrator with nested levels", ".h"}, export_to_grid},
      {{"chroma", "Chroma, lattice fields: lambda of the two-stage word, in XML", ".xml"}, export_to_chroma},
      {{"tmlqcd", "tmLQCD, lattice fields: lambda of the two-stage word, lines of input", ".input"},
       export_to_tmlqcd},
      {{"openqcd", "openQCD, lattice fields: lambda of the two-stage word, lines of input", ".in"},
       export_to_openqcd}};
  return all;
}

}  // namespace

std::string identifier_of(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool stays = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (stays) result += c;
    if (!stays && !result.empty() && result.back() != '_') result += '_';
  }
  while (result.ends_with('_')) result.pop_back();
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0)
    result = "method_" + result;
  return result.substr(0, 40);  // Fortran takes 63, with what is added to it
}

}  // namespace detail

std::vector<export_host> export_hosts() {
  std::vector<export_host> result;
  for (const auto& one : detail::all_hosts()) result.push_back(one.host);
  return result;
}

std::string export_to(std::string_view host, const tabulated& method, const export_options& options) {
  const auto& all = detail::all_hosts();
  const auto found = std::ranges::find(all, host, [](const auto& one) { return one.host.name; });
  if (found == all.end()) {
    std::string known;
    for (const auto& one : all) known += fmt::format("{}{}", known.empty() ? "" : ", ", one.host.name);
    detail::refuse_export("export: the host must be one of {}, got '{}'", known, host);
  }
  const std::string& name = options.name.empty() ? method.name() : options.name;
  detail::exported_method exported{method, detail::identifier_of(name), options.about};
  if (options.displaced) exported = detail::with_displaced_kicks(exported);
  const run_time_word& word = exported.method.letters();
  auto& about = exported.about;
  about.insert(about.begin(),
               fmt::format("{}: letters {}, order {}{}.", exported.method.name(), word.letters(),
                           exported.method.order, has_bath(exported) ? " without noise" : ""));
  about.push_back(
      fmt::format("Force evaluations a step, the first and last joined: {}.", word.evaluations_per_step));
  about.push_back(fmt::format("Written by nysalt {}.", version));
  return found->text(exported);
}

}  // namespace nysalt
