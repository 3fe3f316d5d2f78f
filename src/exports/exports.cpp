// SPDX-License-Identifier: BSL-1.0
#include "exports.hpp"

#include <algorithm>
#include <cctype>

#include "comparison/did_you_mean.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

const std::vector<export_host>& export_hosts() {
  static const std::vector<export_host> all{
      {"c", "C99: start, steps and finish over arrays, with a force of your own", ".c", export_to_c},
      {"cpp", "C++11, a header: the same with any callable force", ".hpp", export_to_cpp},
      {"fortran", "Fortran 2008, a module: the same with a force procedure", ".f90", export_to_fortran},
      {"python", "Python with NumPy: the same over arrays of any shape", ".py", export_to_python},
      {"julia", "Julia, a module: the same with any callable force", ".jl", export_to_julia},
      {"odeint", "Boost.Odeint: a stepper of drifts and kicks", ".hpp", export_to_odeint},
      {"sundials", "SUNDIALS ARKODE: the table of SPRKStep, a function in C", ".c", export_to_sundials},
      {"ase", "ASE: a dynamics at constant energy, of any calculator", ".py", export_to_ase},
      {"blackjax", "BlackJAX: the coefficients of a palindrome that begins with a kick", ".py",
       export_to_blackjax},
      {"mici", "Mici: the free coefficients of a symmetric composition", ".py", export_to_mici}};
  return all;
}

const export_host& find_export_host(const std::string& name) {
  const auto found = std::ranges::find(export_hosts(), name, &export_host::name);
  if (found != export_hosts().end()) return *found;
  std::vector<std::string> names;
  for (const auto& one : export_hosts()) names.emplace_back(one.name);
  refuse("export: --to must be a host that is known, got '{}': {}", name,
         did_you_mean(name, names, "nysalt export --help shows all"));
}

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

}  // namespace nysalt::program
