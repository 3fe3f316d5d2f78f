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
                                      {"x**2", "a power must be written as x^2"},
                                      {"x+z", "'z' must be a function"},
                                      {"x;abort()", "an operator must follow"},
                                      {"system(\"rm\")", "'system' must be a function"},
                                      {"\"; #include <x>", "must follow"},
                                      {"x /* */", "must follow"},
                                      {"x // y", "must follow"},
                                      {"x\ny", "an operator must follow"},
                                      {"x\\", "an operator must follow"},
                                      {"std::exp(x)", "'std' must be a function"},
                                      {"x^x", "must not depend on the coordinates"},
                                      {"((x)", "')' must follow"},
                                      {"x)", "an operator must follow"},
                                      {"exp", "'(' must follow"},
                                      {"1e999*x", "a number must be finite"},
                                      {"0x10*x", "an operator must follow"},
                                      {"x[1]", "an operator must follow"},
                                      {"sum(x,1,2,x)", "a name of its own"},
                                      {"sum(i,1,99999999999,x)", "a number in an index must be at most"},
                                      {"sum(i,1,x,x)", "an index must be made of"},
                                      {"i", "'i' must be a function"},
                                      {"this", "'this' must be a function"},
                                      {"{x}", "must follow"},
                                      {"x,x", "an operator must follow"},
                                      {"$(id)*x", "must follow"},
                                      {deep.c_str(), "nested less deeply"}};
  for (const auto& [text, said] : all) {
    const auto done = run(fmt::format("learn --potential '{}' --variables x --step 0.1", text));
    BOOST_TEST(done.code == 2, text);
    BOOST_TEST(done.err.find(said) != std::string::npos, text << ": " << done.err);
    BOOST_TEST(std::ranges::count(done.err, '\n') == 1, done.err);
  }
  for (const auto& [options, said] : std::vector<refused_text>{
           {"--potential 'x^2'", "--potential must come with --variables"},
           {"--variables x", "must come with --potential"},
           {"--potential 'x^2' --variables x --system fpu", "--system must come without --potential"},
           {"--potential 'x^2' --variables x,x",
            "must have different names, other than those of functions and pi, got 'x'"},
           {"--potential 'x^2' --variables 'x y'", "must be names of letters, digits and _, got 'x y'"},
           {"--potential 'name*x^2' --variables x --parameter name=1",
            "must have a name that is not one of nysalt's own, got 'name'"},
           {"--potential '"
            "sum(j,1,9999,sum(k,1,j+j+j+j+j+j+j+j,sum(l,1,k+k+k+k+k+k+k+k,sum(m,1,l+l+l+l+l+l"
            "+l+l,sum(n,1,m+m+m+m+m+m+m+m,sum(o,1,n+n+n+n+n+n+n+n,sum(p,1,o+o+o+o+o+o+o+o,q[p"
            "])))))))"
            "' --variables 'q[3]'",
            "an index must be at most 10^9 in magnitude"},
           {"--potential 'q[3]^2' --variables 'q[2]'", "must be q[1] to q[2], not q[3] to q[3]"},
           {"--potential 'q[1]^2' --variables 'q[0]'", "at least 1"},
           {"--potential 'k*x^2' --variables x --parameter k", "--parameter must be name=value, got 'k'"},
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
