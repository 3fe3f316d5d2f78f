// SPDX-License-Identifier: BSL-1.0
// Texts that are no potentials. What potentials mean: tests/smoke/own_systems_test.cpp and, of more of them,
// tests/long/programs/plugin_test.cpp.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "../support/program.hpp"

using namespace nysalt::test;

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
