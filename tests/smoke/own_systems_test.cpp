// SPDX-License-Identifier: BSL-1.0
// A system of the user: the source that `nysalt new` writes, a source with letters, a library in C; and an
// exported method, compiled and run. More of each, and formulas: tests/long/programs.
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

/// The numbers behind those of the trajectory, the step and the time, in the line of trajectory 0 at a step.
std::array<double, 4> numbers_at(const std::string& table, int step) {
  const auto at = table.find("\n0," + std::to_string(step) + ",");
  BOOST_TEST_REQUIRE(at != std::string::npos, table);
  const char* rest = table.c_str() + table.find(',', table.find(',', at + 3) + 1);
  std::array<double, 4> all{};
  for (double& x : all) {
    char* end = nullptr;
    x = std::strtod(rest + 1, &end);
    rest = end;
  }
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_source_of_new_is_compiled_and_stepped) {
  const unoptimised_plugins plugins;
  const scratch folder("smoke_new");
  BOOST_TEST(run(folder, "new mine").code == 0);
  const std::string line =
      "run --system ./mine.hpp --masses 3 --method verlet --step 0.1 --horizon 1 --observables energy,q3 ";
  const auto done = run(folder, line);
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  BOOST_TEST(done.out.starts_with("trajectory,step,t,energy,q3\n"), done.out);
  const double begin = numbers_at(done.out, 0)[0];
  const double end = numbers_at(done.out, 10)[0];
  BOOST_TEST(begin != end);
  BOOST_TEST(std::abs(end / begin - 1.0) < 0.1);  // h^2/12 of it and more
  all_refused(folder, {{line + "--depth 0", {"--depth must be positive"}}});
  all_refused(folder, {{line + "--omega 3", {"unknown parameter '--omega'"}}});
}

BOOST_AUTO_TEST_CASE(a_letter_by_name_is_applied_and_a_wrong_one_refused) {
  const unoptimised_plugins plugins;
  const scratch folder("smoke_letter");
  std::ofstream(folder / "mine.hpp")
      << "#include <nysalt/plugin.hpp>\n#include \"" NYSALT_SOURCE_DIR
         "/tests/support/systems_with_letters.hpp\"\nusing namespace lettered;\n"
         "NYSALT_SYSTEM(turning, \"with letters\", letters<turn, cubic_kick, slipped_turn>(), "
         "starts([](const "
         "turning&) {\n  return normal_around<2>({{0.1, 0.2}, {0.2, 0.1}}, 0.02, 0.1);\n}));\n";
  const std::string line = "run --system ./mine.hpp --step 0.5 --horizon 0.5 --observables q1,q2,p1,p2 ";
  const auto done = run(folder, line + "--method word:tct");
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  auto [q1, q2, p1, p2] = numbers_at(done.out, 0);
  const auto turn = [](double& q, double& p, double t) {
    const double q0 = q;
    q = q0 * std::cos(t) + p * std::sin(t);
    p = p * std::cos(t) - q0 * std::sin(t);
  };
  turn(q1, p1, 0.25), turn(q2, p2, 0.25);
  p1 -= 0.5 * 2.0 * q1 * q2, p2 -= 0.5 * (q1 * q1 - q2 * q2);
  turn(q1, p1, 0.25), turn(q2, p2, 0.25);
  const auto end = numbers_at(done.out, 1);
  for (const double off : {end[0] - q1, end[1] - q2, end[2] - p1, end[3] - p2})
    BOOST_TEST(std::abs(off) < 1e-14);  // of numbers below 1, some roundings
  all_refused(folder, {{line + "--method word:scs", {"the letter s is not symplectic"}}});
  all_refused(folder, {{line + "--method word:tzt", {"got z"}}});
}

BOOST_AUTO_TEST_CASE(a_library_in_c_steps_as_the_bundled_system) {
  const scratch folder("smoke_c_force");
  const auto built = [&](const std::string& name, const std::string& sign) {
    std::ofstream(folder / (name + ".c"))
        << "#include \"nysalt/c_force.h\"\n"
           "int64_t nysalt_dimension(void) { return 2; }\n"
           "void nysalt_force(int64_t n, const double* q, double* f, void* data) {\n"
           "  (void)n, (void)data;\n  f[0] = -q[0] "
        << sign
        << " 2.0 * q[0] * q[1];\n  f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];\n}\n"
           "double nysalt_potential(int64_t n, const double* q, void* data) {\n  (void)n, (void)data;\n"
           "  return 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / 3.0;\n}\n"
           "void nysalt_start(int64_t n, const double* normals, double* q, double* p, void* data) {\n"
           "  (void)data;\n"
           "  for (int64_t i = 0; i < n; ++i) q[i] = 0.1 * normals[i], p[i] = 0.1 * normals[n + i];\n}\n";
    const auto done =
        shell(folder, "gcc -O2 -Wall -Wextra -Werror -shared -fPIC -I '" NYSALT_SOURCE_DIR "/include' " +
                          name + ".c -o " + name + ".so");
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
  };
  built("mine", "-");
  built("wrong", "+");
  std::ofstream(folder / "at.csv") << "q1,q2\n0.1,0.2\n-0.3,0.1\n0.2,-0.25\n";
  const auto samples = [&](const std::string& system) {
    const auto done =
        run(folder, "run --system " + system +
                        " --start at.csv --temperature 0.001 --method srkn6b --step 0.1 --horizon "
                        "20 --trajectories 3 --sample-every 50 --observables q1,q2,p1,p2");
    BOOST_TEST(done.code == 0, done.err);
    return done.out;
  };
  BOOST_TEST(samples("./mine.so") == samples("henon_heiles"));
  BOOST_TEST(samples("henon_heiles").size() > 500U);
  all_refused(folder, {{"run --system ./wrong.so --method verlet --step 0.1 --horizon 1", {"force"}}});
}

BOOST_AUTO_TEST_CASE(an_exported_method_ends_where_nysalt_does) {
  const scratch folder("smoke_export");
  const std::string test =
      "gcc -Wall -Wextra -Werror -DNYSALT_SELF_TEST method.c -o test -lm && ./test >told 2>&1";
  for (const std::string method : {"mclachlan2v", "baoab"}) {
    BOOST_TEST(run(folder, "export " + method + " --to c --output method.c").code == 0);
    BOOST_TEST(shell(folder, test).code == 0, contents(folder / "told"));
  }
  BOOST_TEST(run(folder, "export mclachlan2v --to c --output method.c").code == 0);
  BOOST_TEST(shell(folder, "sed -i 's/0[.]193183327/0.193183328/' method.c").code == 0);  // its tenth digit
  BOOST_TEST(shell(folder, test).code != 0);
}
