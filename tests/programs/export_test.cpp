// SPDX-License-Identifier: BSL-1.0
// `nysalt export`: which hosts take which method, and what is refused. Exports run in tests/smoke and
// tests/long/programs.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

const std::vector<std::string> hosts{"c",      "cpp",    "fortran",  "python",         "julia",
                                     "jax",    "odeint", "sundials", "ordinarydiffeq", "ase",
                                     "openmm", "lammps", "rebound",  "blackjax",       "mici",
                                     "gpt",    "grid",   "chroma",   "tmlqcd",         "openqcd"};

/// Which of them take a method, by a letter each in their order.
const std::map<std::string, std::string> takers{
    {"mclachlan2v", "yyyyyyyyyyyyyyyyyyyy"},   {"srkn6b", "yyyyyyyyyyyyyyyyynnn"},
    {"fg4_processed", "yyyyynnnnnnnnnnnnnnn"}, {"chin4a", "yyyyyynnnnynnnnnnnnn"},
    {"mclachlan2", "yyyyyyyyyyynynyyynnn"},    {"baoab", "yyyyyynnnyyynnnnnnnn"},
    {"obabo", "yyyyyynnnyyynnnnnnnn"},         {"aboba", "yyyyyynnnyynnnnnnnnn"},
    {"srkn6b@end", "yyyyyynnnyyynnnnnnnn"}};

}  // namespace

BOOST_AUTO_TEST_CASE(a_host_takes_what_it_can_run) {
  for (const auto& [method, taken_by] : takers) {
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      const auto done = run("export " + method + " --displaced --to " + hosts[i]);
      BOOST_TEST(done.code == (taken_by[i] == 'y' ? 0 : 2), method << " to " << hosts[i] << ": " << done.err);
      BOOST_TEST(done.out.empty() == (taken_by[i] == 'n'), method << " to " << hosts[i]);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_no_host_takes_is_refused) {
  const scratch folder("export_refused");
  const auto must_be_told = [&](const std::string& arguments, const std::string& words) {
    const auto done = run(folder, "export " + arguments);
    BOOST_TEST(done.code == 2, arguments);
    BOOST_TEST(done.out.empty());
    BOOST_TEST(done.err.find(words) != std::string::npos, done.err);
    BOOST_TEST(std::ranges::count(done.err, '\n') == 1);
  };
  must_be_told("verlet --to pyton", "did you mean python");
  must_be_told("fg4_processed --to c", "--displaced");
  must_be_told("mclachlan2 --to blackjax", "bcss2v");
  must_be_told("impulse --to c", "quadratic part");
  must_be_told("baoab --to mici", "letters O");
  must_be_told("baoab --to c --placement end", "no letters O for a placement, got BAOAB");
  must_be_told("verlet --to c --placement start", "placement");
  must_be_told("fg4_processed --to c --displaced --placement end", "processor");
  must_be_told("mclachlan2 --to lammps", "drift after its last kick");
  must_be_told("verlet --to openqcd", "bab2");
  must_be_told("learned:fg4 --to c", "must be learned first");
  must_be_told("s_aia2 --to c", "fixed coefficients");
  must_be_told("verlet --to c --step 0.1", "same at every step");
  must_be_told("verlet --to c --output nowhere/verlet.c", "nowhere");
  BOOST_TEST(run(folder, "export verlet").code == 2);
}

BOOST_AUTO_TEST_CASE(the_same_as_data) {
  const auto all = json_of(run("export verlet --to python --json"));
  BOOST_TEST(all.at("host") == "python");
  BOOST_TEST(all.at("letters") == "BAB");
  BOOST_TEST(all.at("evaluations_per_step") == 1);
  BOOST_TEST(all.at("output").is_null());
  BOOST_TEST(all.at("text").get<std::string>().find("def steps(") != std::string::npos);
}
