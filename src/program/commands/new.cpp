// SPDX-License-Identifier: BSL-1.0
#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>

#include "../../plugin/names.hpp"
#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/json.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/communicator.hpp"

namespace nysalt::program {

namespace {

void require_name(const std::string& name) {
  // Functions of C are found in what the program has loaded.
  static const std::set<std::string> taken{
      "alignas",   "alignof",   "and",       "asm",        "auto",      "bool",        "break",
      "case",      "catch",     "char",      "class",      "concept",   "const",       "consteval",
      "constexpr", "constinit", "continue",  "decltype",   "default",   "delete",      "do",
      "double",    "else",      "enum",      "explicit",   "export",    "extern",      "false",
      "float",     "for",       "friend",    "goto",       "if",        "inline",      "int",
      "long",      "mutable",   "namespace", "new",        "noexcept",  "not",         "nullptr",
      "operator",  "or",        "private",   "protected",  "public",    "register",    "requires",
      "return",    "short",     "signed",    "sizeof",     "static",    "struct",      "switch",
      "template",  "this",      "throw",     "true",       "try",       "typedef",     "typename",
      "union",     "unsigned",  "using",     "virtual",    "void",      "volatile",    "while",
      "xor",       "nysalt",    "model",     "name",       "source",    "description", "spread",
      "potential", "parameter", "starts",    "observable", "frequency", "first_bond",  "starts_of",
      "masses",    "depth",     "width",     "main",       "std",       "assert",      "errno",
      "offsetof",  "va_arg",    "va_copy",   "va_end",     "va_start",  "linux",       "unix"};
  const bool is_function = dlsym(RTLD_DEFAULT, name.c_str()) != nullptr;
  if (!is_plain_name(name) || taken.contains(name) || is_function) {
    refuse(
        "the name of a system must be lower-case letters, digits and _, a letter first, and no word of C++ "
        "or function of C, got '{}'; take another",
        name);
  }
}

/// A chain of Morse bonds between two walls, with all that can be declared.
constexpr const char* beginning = R"(// A system of your own: change the struct and its declaration, then
//
//   nysalt build NAME.hpp
//   nysalt learn --system ./NAME.so --step 0.4
//   nysalt compare --system ./NAME.so --steps 0.06,0.1 --equal-cost --methods pefrl,srkn6b,learned:bab6 --output report
#include <nysalt/plugin.hpp>

#include <cmath>

/// H = sum p_i^2/2 + sum V(bond): masses between two walls, each bond V(r) = depth (1 - exp(-width r))^2.
struct NAME {
  static constexpr int dimension = Eigen::Dynamic;  // or a number, if it is known: then size() is not needed

  long masses = 4;
  double depth = 1.0;
  double width = 1.0;

  Eigen::Index size() const { return masses; }
  // double inverse_mass(Eigen::Index i) const { return 1.0; }  // 1/m_i, if masses are not all 1

  /// For any number T: one trajectory, many side by side, and their derivatives. The force comes from it; a
  /// member force(q, f) with f = -grad V is faster, and is checked against the potential.
  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    using std::exp;
    T sum(0.0);
    for (Eigen::Index i = 0; i <= masses; ++i) {
      T bond(0.0);
      if (i < masses) bond = bond + q[i];
      if (i > 0) bond = bond - q[i - 1];
      const T rest = 1.0 - exp(-width * bond);
      sum = sum + depth * (rest * rest);
    }
    return sum;
  }
};

/// Normal around rest: the state of trajectory n is a function of the seed and n only.
inline auto starts_of(const NAME& system, double spread) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.masses);
  return nysalt::normal_around<Eigen::Dynamic>({rest, rest}, 0.1 * spread, 0.15 * spread);
}

/// Of the first bond, at a state x with coordinates x.q and momenta x.p.
inline auto first_bond(const NAME&, const auto& x) { return x.q[0]; }

NYSALT_SYSTEM(NAME, "masses between walls, joined by Morse bonds",
              parameter("masses", &NAME::masses, "in the chain").at_least(1).at_most(1000).size(),
              parameter("depth", &NAME::depth, "of each bond").positive(),
              parameter("width", &NAME::width, "of each bond, an inverse length").positive(),
              starts([](const NAME& system, double spread) { return starts_of(system, spread); }),
              observable("first_bond", [](const NAME& system, const auto& x) { return first_bond(system, x); }));
)";

}  // namespace

int new_system(const new_command& command, const common_settings& common) {
  require_name(command.name);
  const std::filesystem::path file = command.name + ".hpp";
  on_first(all_ranks(), [&] {
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) {
      refuse("cannot write {}: a file of that name is there; take another name, or move the file",
             file.string());
    }
    require_writable(file);
    std::string text = beginning;
    for (auto at = text.find("NAME"); at != std::string::npos; at = text.find("NAME", at)) {
      text.replace(at, 4, command.name);
    }
    write_file(file, text);
  });
  if (common.json) {
    print(text_of({{"output", file.string()}}));
  } else {
    print(line_of_written(file.string()) + fmt::format("Try: nysalt build {}\n", of_letters(file.string())));
  }
  return done;
}

}  // namespace nysalt::program
