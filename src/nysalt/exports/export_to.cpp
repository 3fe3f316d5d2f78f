// SPDX-License-Identifier: BSL-1.0

#include "nysalt/export_to.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <stdexcept>
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

namespace nysalt::detail {

std::string fill(std::string_view text, const gap_texts& values) {
  std::string result;
  while (true) {
    const auto begin = text.find('@');
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return result;
    const auto end = text.find('@', begin + 1);
    if (end == std::string_view::npos) throw std::logic_error("fill: a gap without an end");
    const auto key = text.substr(begin + 1, end - begin - 1);
    const auto found =
        std::ranges::find(values, key, [](const auto& one) { return std::string_view(one.first); });
    if (found == values.end()) throw std::logic_error(fmt::format("fill: no value for {}", key));
    result += found->second;
    text.remove_prefix(end + 1);
  }
}

std::string digits(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string digits(const std::vector<double>& values, char exponent) {
  std::string result;
  for (const double value : values) {
    std::string text = digits(value);
    if (exponent != 'e') {
      const auto at = text.find('e');
      if (at == std::string::npos) text += fmt::format("{}0", exponent);
      if (at != std::string::npos) text[at] = exponent;
    }
    result += (result.empty() ? "" : ", ") + text;
  }
  return result;
}

std::string header(const exported_method& method, std::string_view mark) {
  std::string result;
  for (const auto& line : method.about) {
    std::string plain = line;
    for (char& c : plain) {
      if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~' || c == '\\')
        c = '?';  // a backslash would go on in the next line
    }
    result += fmt::format("{} {}\n", mark, plain);
  }
  return result;
}

namespace {

/// The end of each text in Python.
constexpr const char* main_in_python = R"(if __name__ == "__main__":
    off = self_test()
    print(f"@NAME@: off by {off:.1e}")
    raise SystemExit(not off < 1e-13)
)";

}  // namespace

gap_texts values_of_header(const exported_method& method, std::string_view mark, char exponent) {
  const exported_letters kernel = kernel_of(method);
  std::string explained =
      fmt::format("{} Letters act from left to right: A(a) is q += a h M^-1 p, B(b) is p += b h f(q)", mark);
  if (kernel.count('D') > 0)
    explained += fmt::format(", D(b, c) is B(b) with the\n{} force at q + c h^2 M^-1 f(q)", mark);
  if (kernel.count('O') > 0) {
    explained += fmt::format(
        ",\n{} O(c) is p = e p + sqrt((1 - e^2) kT M) N with e = exp(-friction c h) and standard normal N",
        mark);
  }
  const self_test end = self_test_of(method);
  return {{"NAME", method.name},          {"HEADER", header(method, mark)},
          {"EXPLAINED", explained + "."}, {"MAIN", fill(main_in_python, {{"NAME", method.name}})},
          {"Q", digits(end.q, exponent)}, {"P", digits(end.p, exponent)}};
}

gap_texts values_of(const exported_method& method, std::string_view mark, char exponent) {
  gap_texts result = values_of_header(method, mark, exponent);
  const auto add = [&](const std::string& key, const exported_letters& part) {
    result.emplace_back(key, part.letters);
    // Where there is none, one that nothing reads: a list must not be empty.
    const std::vector<double> none{0.0};
    result.emplace_back(key + "_COEFFICIENTS",
                        digits(part.letters.empty() ? none : part.coefficients, exponent));
    result.emplace_back(key + "_SLOTS", std::to_string(std::max<std::size_t>(part.coefficients.size(), 1)));
  };
  add("KERNEL", kernel_of(method));
  add("START", start_of(method));
  add("FINISH", finish_of(method));
  return result;
}

void add_bath(gap_texts& values, const exported_method& method, const gap_texts& of_bath) {
  for (const auto& [key, text] : of_bath) {
    values.emplace_back(key, has_bath(method) ? fill(text, {{"NAME", method.name}}) : "");
  }
}

}  // namespace nysalt::detail
