// SPDX-License-Identifier: BSL-1.0
// The library of a source: how it is compiled, and what damage in the cache does. What a source may hold, and
// what a user may get wrong: cases/plugins.txt, cases/own_systems.txt. In tier 1:
// tests/smoke/own_systems_test.cpp.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;

namespace {

constexpr const char* well_source = R"(#include <nysalt/plugin.hpp>
struct well {
  static constexpr int dimension = 1;
  template <class T> T potential(const nysalt::vector<T, 1>& q) const { return 0.5 * q[0] * q[0]; }
};
NYSALT_SYSTEM(well, "p^2/2 + q^2/2", starts([](const well&) {
  using one = nysalt::vector<double, 1>;
  return normal_around<1>({one(1.0), one(0.0)}, 0.1, 0.1);
}));
)";

/// Where the last segment of a library ends: what follows, as names for debuggers, is not loaded.
std::uintmax_t end_of_segments(const scratch& folder, const std::string& library) {
  const auto listed =
      shell(folder, "readelf -lW " + library + " | awk '$2 ~ /^0x/ && $5 ~ /^0x/ { print $2, $5 }'");
  std::istringstream places(listed.out);
  std::uintmax_t end = 0;
  std::uintmax_t offset = 0;
  std::uintmax_t size = 0;
  while (places >> std::hex >> offset >> size) end = std::max(end, offset + size);
  return end;
}

}  // namespace

// As a full disk leaves a library behind: the source is compiled again. A damaged file that was named itself
// is not. Of a library that is cut off the loader maps also what is missing, and the first use of that is a
// signal.
BOOST_AUTO_TEST_CASE(a_damaged_library_in_the_cache_is_compiled_again) {
  const unoptimised_plugins plugins;
  const scratch folder("plugin_damaged");
  std::ofstream(folder / "well.hpp") << well_source;
  const std::string use =
      "XDG_CACHE_HOME=$PWD/cache $nysalt run --method verlet --step 0.1 --horizon 0.1 --system ";
  const auto first = shell(folder, use + "well.hpp");
  BOOST_REQUIRE_MESSAGE(first.code == 0, first.err);
  BOOST_TEST(shell(folder, "cp cache/nysalt/plugins/*.so whole.so").code == 0);
  const auto length = std::filesystem::file_size(folder / "whole.so");
  const auto cut = [&](const std::string& files, std::uintmax_t at) {
    return shell(folder, "for f in " + files + "; do head -c " + std::to_string(at) +
                             " whole.so >cut && mv cut $f; done")
        .code;
  };
  BOOST_TEST(cut("cache/nysalt/plugins/*.so", 100) == 0);
  // What a compiler left that was killed goes with the next one, unless it may be at work.
  BOOST_TEST(
      shell(folder, "cd cache/nysalt/plugins; touch -d '2 days ago' x.so.1.part; touch x.so.2.part").code ==
      0);
  const auto again = shell(folder, use + "well.hpp");
  BOOST_TEST(again.code == 0, again.err);
  BOOST_TEST(again.out == first.out);
  BOOST_TEST(!std::filesystem::exists(folder / "cache/nysalt/plugins/x.so.1.part"));
  BOOST_TEST(std::filesystem::exists(folder / "cache/nysalt/plugins/x.so.2.part"));
  BOOST_TEST(cut("cache/nysalt/plugins/*.so", length / 2) == 0);
  const auto built = shell(folder, "XDG_CACHE_HOME=$PWD/cache $nysalt build well.hpp");
  BOOST_TEST(built.code == 0, built.err);
  BOOST_TEST(shell(folder, use + "./well.so").code == 0);
  const std::uintmax_t loaded = end_of_segments(folder, "whole.so");
  BOOST_TEST_REQUIRE(loaded > 0U);
  BOOST_TEST_REQUIRE(loaded <= length);
  constexpr std::uintmax_t cuts = 50;
  for (std::uintmax_t k = 0; k < cuts; ++k) {
    const std::uintmax_t at = k * length / cuts;
    BOOST_TEST(cut("own.so", at) == 0);
    const auto done = shell(folder, use + "./own.so");
    if (at >= loaded) {
      BOOST_TEST(done.code == 0, "cut at " << at << ": " << done.err);
      BOOST_TEST(done.out == first.out);
    } else {
      BOOST_TEST(done.code == 2, "cut at " << at << ": " << done.err);
      BOOST_TEST(done.err.find("cannot load ./own.so as a library") != std::string::npos, done.err);
    }
  }
}

// Without them everything works, thirty times as slowly.
BOOST_AUTO_TEST_CASE(a_plugin_is_compiled_with_the_options_of_the_program) {
  const scratch folder("plugin_options");
  run(folder, "learn --system oscillator --step 0.01 --family nystrom --trajectories 2 --output scheme.json");
  auto flags = recorded(folder / "scheme.json").at("flags").get<std::string>();
  const std::string of_fuzzers = "fuzzer-no-link,";  // libFuzzer follows no plug-in
  if (const auto at = flags.find(of_fuzzers); at != std::string::npos) flags.erase(at, of_fuzzers.size());
  std::istringstream options(flags);
  std::ifstream file(std::filesystem::path(NYSALT_PROGRAM).parent_path() / "plugin.flags");
  const std::set<std::string> of_plugins{std::istream_iterator<std::string>(file), {}};
  int compared = 0;
  for (std::string option; options >> option; ++compared) BOOST_TEST(of_plugins.contains(option), option);
  BOOST_TEST(compared > 0);
}
