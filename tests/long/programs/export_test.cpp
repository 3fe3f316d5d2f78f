// SPDX-License-Identifier: BSL-1.0
// `nysalt export` writes what other languages and codes run to where nysalt's own steps end. In tier 1:
// one export in tests/smoke/own_systems_test.cpp, and programs/cases/export.txt.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "../../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

bool there_is(const scratch& folder, const std::string& command) {
  return shell(folder, "command -v " + command).code == 0;
}

/// How the self-test of a file `method.HOST` is run; empty where this machine lacks the host.
std::string self_test_in(const scratch& folder, const std::string& host) {
  if (host == "c")
    return "gcc -Wall -Wextra -Werror -DNYSALT_SELF_TEST -x c method.c -o c.test -lm && ./c.test";
  if (host == "cpp" || host == "lammps" || host == "grid")
    return "g++ -std=c++11 -Wall -Wextra -Werror -DNYSALT_SELF_TEST -x c++ method." + host + " -o " + host +
           ".test && ./" + host + ".test";
  if (host == "odeint")
    return "g++ -std=c++14 -DNYSALT_SELF_TEST -x c++ method.odeint -o odeint.test && ./odeint.test";
  if (host == "sundials" || host == "rebound")
    return "gcc -Wall -Wextra -Werror -DNYSALT_SELF_TEST -x c method." + host + " -o " + host +
           ".test -lm && ./" + host + ".test";
  if (host == "fortran" && there_is(folder, "gfortran")) {
    return "cp method.fortran method.f90 && printf 'program t\\nuse nysalt_exported\\nreal(kind(1d0)) :: "
           "off\\n"
           "call self_test(off)\\nif (.not. off < 1d-13) error stop 1\\nend\\n' > t.f90 && "
           "gfortran method.f90 t.f90 -o fortran.test && ./fortran.test";
  }
  if (host == "julia" && there_is(folder, "julia"))
    return "julia -e 'include(\"method.julia\"); exit(nysalt_exported.self_test() < 1e-13 ? 0 : 1)'";
  if (host == "python" || host == "ase" || host == "jax") {
    for (const std::string python : {"python3", "/usr/bin/python3"}) {
      if (shell(folder, python + " -c 'import numpy'").code == 0) return python + " method." + host;
    }
  }
  // Stand-ins with the loops of hosts that Debian has not, in the texts themselves, as those of SUNDIALS,
  // REBOUND, Grid and LAMMPS above.
  if (host == "blackjax" || host == "mici" || host == "gpt" || host == "openmm")
    return "python3 method." + host;
  if (host == "chroma" || host == "tmlqcd" || host == "openqcd" || host == "ordinarydiffeq" ||
      host == "julia") {
    const std::string stand_in = NYSALT_SOURCE_DIR "/tests/long/hosts/stand_in.py";
    return "python3 '" + stand_in + "' " + host + " method." + host;
  }
  return "";
}

/// What takes a second and more to compile; it is compiled for some methods.
bool is_dear(const std::string& host) {
  return host == "odeint" || host == "cpp" || host == "lammps" || host == "grid";
}

/// Each host with a method without a bath and one with, and what of letters and processors some hosts alone
/// take.
bool is_tried(const std::string& method, const std::string& host) {
  if (method == "srkn6b" || method == "baoab") return true;
  if (method == "mclachlan2v") return host == "chroma" || host == "tmlqcd" || host == "openqcd";
  if (method == "fg4_processed") return host == "c" || host == "python" || host == "julia";
  return method == "chin4a" && (host == "fortran" || host == "jax" || host == "openmm");
}

/// Exports a method to `method.HOST`, as `exported`.
finished exported(const scratch& folder, const std::string& method, const std::string& host) {
  return run(folder,
             "export " + method + " --name exported --displaced --to " + host + " --output method." + host);
}

const std::vector<std::string> hosts{"c",      "cpp",    "fortran",  "python",         "julia",
                                     "jax",    "odeint", "sundials", "ordinarydiffeq", "ase",
                                     "openmm", "lammps", "rebound",  "blackjax",       "mici",
                                     "gpt",    "grid",   "chroma",   "tmlqcd",         "openqcd"};

}  // namespace

// Which hosts take a method cases/export.txt says.
BOOST_AUTO_TEST_CASE(each_host_ends_where_nysalt_does) {
  const scratch folder("export_hosts");
  int all = 0;
  for (const std::string method : {"mclachlan2v", "srkn6b", "fg4_processed", "chin4a", "baoab"}) {
    for (const auto& host : hosts) {
      if (!is_tried(method, host) || exported(folder, method, host).code != 0) continue;
      const std::string test = self_test_in(folder, host);
      if (test.empty()) continue;
      const auto tried = shell(folder, test);
      BOOST_TEST(tried.code == 0, method << " in " << host << ": " << tried.out << tried.err);
      ++all;
    }
  }
  BOOST_TEST(all >= 25);  // 33 with gfortran and JAX
}

// 0.1931833275...: the tenth digit, which moves ten steps by 1e-11; and the coefficient of O: damping and
// noise change by 1e-9.
BOOST_AUTO_TEST_CASE(wrong_digits_are_found) {
  const scratch folder("export_wrong");
  int baths = 0;
  for (const auto& host : hosts) {
    for (const auto& [method, change] : {std::pair{"mclachlan2v", "'s/0[.]193183327/0.193183328/'"},
                                         {"baoab", R"("s/1[.]0\(d0\)\?\([,}]\)/1.000000001\1\2/")"}}) {
      const bool is_bath = std::string(method) == "baoab";
      const bool is_taken = exported(folder, method, host).code == 0;
      BOOST_TEST((is_taken || is_bath));
      const std::string test = self_test_in(folder, host);
      if (!is_taken || test.empty()) continue;
      BOOST_TEST(shell(folder, std::string("sed -i ") + change + " method." + host).code == 0);
      BOOST_TEST(shell(folder, test).code != 0, method << " in " << host);
      baths += is_bath ? 1 : 0;
    }
  }
  BOOST_TEST(baths >= 6);
}

BOOST_AUTO_TEST_CASE(every_method_is_exported_or_refused_in_a_sentence) {
  const scratch folder("export_all");
  int taken = 0;
  const auto listed = json_of(run("list --json"));
  for (const auto& method : listed.at("methods")) {
    const std::string name = method.at("name");
    const std::string letters = method.at("letters");
    const auto done = exported(folder, name, "c");
    const bool is_of_plain_letters = letters.find_first_not_of("ABDGO|") == std::string::npos;
    const bool is_adaptive = name.starts_with("s_aia") || name.starts_with("phase_fitted_");
    BOOST_TEST(done.code == (is_of_plain_letters && !is_adaptive ? 0 : 2), name << ": " << done.err);
    if (done.code != 0) {
      BOOST_TEST(std::ranges::count(done.err, '\n') == 1);
      BOOST_TEST(done.err.find(name) != std::string::npos, done.err);
      continue;
    }
    ++taken;
    const auto tried = shell(folder, self_test_in(folder, "c"));
    BOOST_TEST(tried.code == 0, name << ": " << tried.out << tried.err);
  }
  BOOST_TEST(taken >= 25);
}

BOOST_AUTO_TEST_CASE(a_scheme_tells_what_it_was_learned_for) {
  const scratch folder("export_scheme");
  const auto learned =
      run(folder, "learn --system henon_heiles --family bab3 --step 0.6 --effort quick --output s.json");
  BOOST_TEST(learned.code == 0, learned.err);
  for (const auto& host : hosts) {
    const auto done = exported(folder, "s.json", host);
    const bool is_one_number = host == "chroma" || host == "tmlqcd" || host == "openqcd";
    BOOST_TEST(done.code == (is_one_number ? 2 : 0), host << ": " << done.err);
    if (done.code != 0) continue;
    const std::string text = shell(folder, "cat method." + host).out;
    BOOST_TEST(text.find("henon_heiles() at the step 0.6") != std::string::npos, text);
    const std::string test = self_test_in(folder, host);
    if (!test.empty() && !is_dear(host)) BOOST_TEST(shell(folder, test).code == 0, host);
  }
  const auto elsewhere = run(folder, "export s.json --to c --step 0.7");
  BOOST_TEST(elsewhere.code == 2);
  BOOST_TEST(elsewhere.err.find("--step must be") != std::string::npos, elsewhere.err);
}

BOOST_AUTO_TEST_CASE(a_scheme_of_a_bath_has_its_letters) {
  const scratch folder("export_bath");
  const auto learned =
      run(folder,
          "learn --system linear_chain --friction 1 --temperature 0.5 --placement middle --family "
          "bab3 --step 0.6 --effort quick --output s.json");
  BOOST_TEST(learned.code == 0, learned.err);
  for (const std::string host : {"c", "python", "openmm", "lammps"}) {
    BOOST_TEST(exported(folder, "s.json", host).code == 0);
    const std::string text = shell(folder, "cat method." + host).out;
    BOOST_TEST(text.find("letters BABAOABAB") != std::string::npos, text.substr(0, 200));
    BOOST_TEST(text.find("friction=1") != std::string::npos, text.substr(0, 400));
    const std::string test = self_test_in(folder, host);
    if (!test.empty()) BOOST_TEST(shell(folder, test).code == 0, host);
  }
}

BOOST_AUTO_TEST_CASE(any_name_becomes_an_identifier) {
  const scratch folder("export_names");
  for (const auto& host : hosts) {
    if (is_dear(host)) continue;
    for (const std::string name : {"for", "7 days; it's"}) {
      const auto done =
          run(folder, "export mclachlan2v --name \"" + name + "\" --to " + host + " --output method." + host);
      BOOST_TEST(done.code == 0, done.err);
      const bool calls_by_name = host == "fortran" || host == "julia";  // self_test_in() knows another name
      const std::string test = calls_by_name ? "" : self_test_in(folder, host);
      if (test.empty()) continue;
      BOOST_TEST(shell(folder, test).code == 0, host << ": " << name);
    }
  }
}
