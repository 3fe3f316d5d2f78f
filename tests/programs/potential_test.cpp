// SPDX-License-Identifier: BSL-1.0
// Potentials as text: what they mean, and texts that are none.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "../support/document.hpp"

using namespace nysalt::test;

namespace {

/// The potential energy at a point, as run prints it of starts without deviations.
double value_of(const std::string& potential, const std::string& options) {
  const auto done = run("run --potential '" + potential + "' " + options +
                        " --parameter deviation_q=0,deviation_p=0 --method verlet --step 1e-3 --horizon 1e-3 "
                        "--observables potential_energy");
  BOOST_REQUIRE_MESSAGE(done.code == 0, potential << ": " << done.err);
  const auto line = done.out.find("\n0,0,0,");
  return std::strtod(done.out.c_str() + line + 7, nullptr);
}

}  // namespace

// Each is compiled: they stand in one text, a power of ten apart, each with three digits.
BOOST_AUTO_TEST_CASE(formulas_have_their_usual_meaning) {
  const double x = 0.5;
  const double y = 2.0;
  const double k = 3.0;
  const double value = value_of(
      "-x^2 + 2*3 - 4/2/2 + k*y^-1 + 2^3^2*x + (x - y)^3 + sqrt(y)*exp(-x) + sin(pi*x) + abs(-y)^1.5 + x^0",
      "--variables x,y --parameter k=3 --around x=0.5,y=2");
  const double expected = -x * x + 6.0 - 1.0 + k / y + 512.0 * x + std::pow(x - y, 3) +
                          std::sqrt(y) * std::exp(-x) + 1.0 + std::pow(y, 1.5) + 1.0;
  BOOST_TEST(std::abs(value - expected) <=
             1e-9 * std::abs(expected));  // printed with its digits, and a step on
}

BOOST_AUTO_TEST_CASE(sums_go_over_lists_of_coordinates) {
  const double value = value_of("sum(i, 1, 9, k*(q[i+1] - q[i])^2) + sum(i, 1, 3, sum(j, i, 3, i*q[j]))",
                                "--variables 'q[10]' --parameter k=0.5 --around 'q[2]=1,q[3]=3'");
  const double expected = 0.5 * (1.0 + 4.0 + 9.0) + (1.0 * (1.0 + 3.0) + 2.0 * (1.0 + 3.0) + 3.0 * 3.0);
  BOOST_TEST(std::abs(value - expected) <= 1e-9 * expected);
}

BOOST_AUTO_TEST_CASE(texts_that_are_no_potential_are_refused) {
  struct refused_text {
    const char* text;
    const char* said;
  };
  std::string deep = "x";
  for (int i = 0; i < 300; ++i) deep = "(" + deep + ")";
  const std::vector<refused_text> all{{"x^", "the end of the text"},
                                      {"2x", "write 2*x"},
                                      {"x**2", "a power is x^2"},
                                      {"x+z", "'z' is no function"},
                                      {"x;abort()", "an operator is expected"},
                                      {"system(\"rm\")", "'system' is no function"},
                                      {"\"; #include <x>", "is expected"},
                                      {"x /* */", "is expected"},
                                      {"x // y", "is expected"},
                                      {"x\ny", "an operator is expected"},
                                      {"x\\", "an operator is expected"},
                                      {"std::exp(x)", "'std' is no function"},
                                      {"x^x", "must not depend on the coordinates"},
                                      {"((x)", "')' is expected"},
                                      {"x)", "an operator is expected"},
                                      {"exp", "'(' is expected"},
                                      {"1e999*x", "not a finite number"},
                                      {"0x10*x", "an operator is expected"},
                                      {"x[1]", "an operator is expected"},
                                      {"sum(x,1,2,x)", "a name of its own"},
                                      {"sum(i,1,99999999999,x)", "too large"},
                                      {"sum(i,1,x,x)", "an index is made of"},
                                      {"i", "'i' is no function"},
                                      {"this", "'this' is no function"},
                                      {"{x}", "is expected"},
                                      {"x,x", "an operator is expected"},
                                      {"$(id)*x", "is expected"},
                                      {deep.c_str(), "nested too deeply"}};
  for (const auto& [text, said] : all) {
    const auto done = run(fmt::format("learn --potential '{}' --variables x --step 0.1", text));
    BOOST_TEST(done.code == 2, text);
    BOOST_TEST(done.err.find(said) != std::string::npos, text << ": " << done.err);
    BOOST_TEST(std::ranges::count(done.err, '\n') == 1, done.err);
  }
  for (const auto& [options, said] : std::vector<refused_text>{
           {"--potential 'x^2'", "--potential needs --variables"},
           {"--variables x", "belong to --potential"},
           {"--potential 'x^2' --variables x --system fpu", "excludes"},
           {"--potential 'x^2' --variables x,x", "'x' is taken"},
           {"--potential 'x^2' --variables 'x y'", "is not a name"},
           {"--potential 'name*x^2' --variables x --parameter name=1", "'name' is taken"},
           {"--potential '"
            "sum(j,1,9999,sum(k,1,j+j+j+j+j+j+j+j,sum(l,1,k+k+k+k+k+k+k+k,sum(m,1,l+l+l+l+l+l"
            "+l+l,sum(n,1,m+m+m+m+m+m+m+m,sum(o,1,n+n+n+n+n+n+n+n,sum(p,1,o+o+o+o+o+o+o+o,q[p"
            "])))))))"
            "' --variables 'q[3]'",
            "goes too far"},
           {"--potential 'q[3]^2' --variables 'q[2]'", "q[1] to q[2]"},
           {"--potential 'q[1]^2' --variables 'q[0]'", "at least 1"},
           {"--potential 'k*x^2' --variables x --parameter k", "is not name=value"},
           {"--potential 'k*x^2' --variables x --parameter K=1", "lower-case"},
           {"--potential 'k*x^2' --variables x --parameter k=abc", "must be a finite number, got 'abc'"},
           {"--potential 'x^2' --variables x --mass 0", "--mass must be positive"},
           {"--potential 'x^2' --variables x --mass 1,2", "--mass must be one"},
           {"--potential 'x^2' --variables x --around y=1", "must be coordinates, got 'y'"}}) {
    const auto done = run(fmt::format("learn {} --step 0.1", options));
    BOOST_TEST(done.code == 2, options);
    BOOST_TEST(done.err.find(said) != std::string::npos, options << ": " << done.err);
  }
}
